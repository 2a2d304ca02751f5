"""Every command of README and documentation is one that the program knows, and runs."""

import re
import shlex
import shutil

import pytest
import typer
from typer.testing import CliRunner

from gripscale.case_file import write_example
from gripscale.cli import app
from tests.samples import DOCS, EXAMPLES, ROOT

PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
BLOCK = re.compile(r"^```(\w*)\n(.*?)^```$", flags=re.DOTALL | re.MULTILINE)
PLACEHOLDER = re.compile(r"\b[A-Z]{3,}\b")
"""Words such as CASE and FOLDER, which stand for what the reader has."""
TESTED_ELSEWHERE = ("gripscale app", "gripscale reproduce")
"""One opens a server; the other takes an hour."""


def commands(page):
    """Yield the commands of the shell blocks of a page, as they stand."""
    for language, block in BLOCK.findall(page.read_text(encoding="utf-8")):
        for line in block.splitlines() if language in ("", "sh", "console") else ():
            words = line.removeprefix("$ ").partition("  #")[0].strip()
            if words.startswith("gripscale "):
                yield words


def test_readme_has_commands():
    assert len(list(commands(ROOT / "README.md"))) > 10


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_command_is_known(page):
    for words in commands(page):
        arguments = shlex.split(words)[1:]
        context = typer.Context(typer.main.get_command(app))
        while hasattr(context.command, "resolve_command"):
            name, command, arguments = context.command.resolve_command(context, arguments)
            context = command.make_context(name, arguments, parent=context)
            arguments = context._protected_args + context.args


@pytest.mark.verification
def test_the_commands_of_the_readme_run_in_an_empty_folder(tmp_path, monkeypatch):
    """One after the other, as they stand: ten minutes of one core."""
    monkeypatch.chdir(tmp_path)
    write_example("own")
    shutil.copy("own/data/road/20211011_aylesbury_dec_station_0.dat", "road.dat")
    shutil.copy("own/data/friction/S100_master_curve.csv", "dma.csv")
    for words in commands(ROOT / "README.md"):
        ran(words)


@pytest.mark.verification
@pytest.mark.parametrize("page", PAGES[1:], ids=lambda page: page.name)
def test_the_commands_of_a_page_run(page, tmp_path, monkeypatch):
    """In a folder with a case and what the pages call their files; most with a coarser case."""
    wanted = [words for words in commands(page) if not PLACEHOLDER.search(words)]
    if page.name in ("tutorial.md", "app.md") or not wanted:
        pytest.skip("no commands, or tested elsewhere")
    monkeypatch.chdir(tmp_path)
    write_example(".", "sweeps")
    shutil.copytree(EXAMPLES, "examples")
    shutil.copy("road.txt", "other_road.txt")
    for name in ("dma.txt", "new_compound.txt", "competitor.txt"):
        shutil.copy(EXAMPLES / "data" / "rubber" / "measured_dma.txt", name)
    ran("gripscale run case.toml")
    ran("gripscale study case.toml --vary speed=0.1,1")
    ran('gripscale fit-rubber sweeps.csv --reference-temperature "20 C" --output .')  # rubber.json
    for words in wanted:
        ran(words)


def ran(words):
    if words.startswith(TESTED_ELSEWHERE):
        return
    outcome = CliRunner().invoke(app, shlex.split(words)[1:], env={"COLUMNS": "100"})
    assert outcome.exit_code == 0, f"{words}: {outcome.output[-2000:]}"
