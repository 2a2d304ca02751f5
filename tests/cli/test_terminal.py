"""What every command on a case has: the result alone, JSON, progress, its folder, its help."""

import json
import os
import shutil
import subprocess
import sys
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
import typer
from rich.console import Console

import gripscale as gs
from gripscale.case_file.folder import CASE_NOTE
from gripscale.cli import app
from gripscale.core.units import si_unit
from gripscale.io.table import Column, Table
from gripscale.questions import terminal
from gripscale.questions.registry import commands
from gripscale.questions.result import warning_lines
from gripscale.questions.result_json import result_as_json

QUESTIONS = {
    "answer": ("run",),
    "comparison": ("compare", "--models", "chain_half_plane,direct"),
    "study": ("study", "--vary", "speed=0.1,0.3", "--model", "chain"),
    "sensitivity": ("sensitivity", "--bands", "1"),
}


@pytest.fixture(scope="module")
def case(inputs, tmp_path_factory):
    """The case in a folder whose results are kept, so that nothing is solved twice."""
    folder = shutil.copytree(inputs, tmp_path_factory.mktemp("kept") / "case")
    return Path(folder) / "case.toml"


def ask(shell, question, case, *options):
    command, *rest = QUESTIONS[question]
    return shell(command, case, *rest, *options)


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.usefixtures("undrawn")
def test_json_is_the_result_and_nothing_else(shell, case, question):
    done = ask(shell, question, case, "--json")
    assert done.stderr == ""
    content = json.loads(done.stdout)
    assert content["question"] == question
    assert content["case"].endswith("case.toml")
    assert content["answer"]["text"]
    assert [file["name"] for file in content["inputs"]] == ["road.txt", "dma.txt"]
    assert all(len(file["sha256"]) == 64 for file in content["inputs"])
    for table in (content["table"], content["summary"]):
        assert table["rows"]
        assert all(row.keys() == table["units"].keys() for row in table["rows"])


@pytest.mark.usefixtures("undrawn")
def test_json_of_a_run_has_the_numbers_of_its_answer(shell, case):
    first = ask(shell, "answer", case, "--json").stdout
    again = ask(shell, "answer", case, "--json").stdout
    assert first == again
    stored = gs.load(case.parent / "results" / "answer.nc")
    answer = json.loads(first)["answer"]
    assert (answer["friction"], answer["friction_interval"]) == (stored.friction, [None, None])
    assert answer["contact_fraction"] == stored.contact_fraction
    summary = json.loads(first)["summary"]
    assert summary["units"]["nominal_pressure"] == "Pa"
    assert summary["rows"][0]["nominal_pressure"] == 3e5
    assert answer["reliable"] == stored.reliable
    findings = json.loads(first)["findings"]
    assert [finding["sentence"] for finding in findings] == [
        str(finding) for finding in stored.findings
    ]
    assert "Next:" in shell("init", case.parent / "example").stdout  # quiet no more


@pytest.mark.usefixtures("undrawn")
def test_quiet_prints_answer_and_all_findings(shell, case):
    done = shell("run", case, "-q", columns=5000)
    result = gs.load(case.parent / "results" / "answer.nc")
    warnings = [*warning_lines(result.findings, widths=result.half_widths)]
    assert done.stdout.splitlines() == [*result.lines, *warnings]
    assert len(warnings) <= 7  # a heading, five findings, how many more there are


def test_every_question_has_these_options():
    group = typer.main.get_command(app)
    for name in ("run", *(name for name, _ in commands())):
        options = {word for item in group.commands[name].params for word in item.opts}
        assert {"--quiet", "-q", "--json", "--replace"} <= options, name


def test_numbers_are_in_si_units():
    names = {("mm", 1e-3): "m", ("MPa", 1e6): "Pa", ("°C", 1.0): "K", ("%", 0.01): "1"}
    names |= {("rad/s", 1.0): "rad/s", ("", 1.0): "1", ("2πA/λ", 1.0): "1", ("at rest", 1.0): "1"}
    for (unit, size), si in names.items():
        assert si_unit(unit, size) == si, unit


class Numbers(gs.Answer):
    """A result with numbers that JSON does not know."""

    def table(self):
        missing = Column("friction", np.array([0.5, np.nan]))
        ends = Column("interval", np.array([[0.1, np.inf], [1.0, 2.0]]), "", "mm", 1e-3)
        return Table("numbers", [Column("row", np.array([1, 2])), missing, ends])


def test_missing_and_infinite_numbers_are_null(inputs):
    result = Numbers(gs.answer(gs.read_case(inputs / "case.toml")).data)
    table = json.loads(result_as_json(result))["table"]
    assert table["units"] == {"row": "1", "friction": "1", "interval": "m"}
    assert table["rows"] == [
        {"row": 1, "friction": 0.5, "interval": [0.1, None]},
        {"row": 2, "friction": None, "interval": [1.0, 2.0]},
    ]


@pytest.mark.usefixtures("undrawn")
def test_results_of_another_case_are_not_replaced_unless_asked(shell, changed, tmp_path):
    case = changed()
    other = case.with_name("fast.toml")
    other.write_text(case.read_text().replace('"0.3 m/s"', '"3 m/s"'))
    ask(shell, "study", case)
    target = case.parent / "results" / "study"
    before = {path: path.read_bytes() for path in target.glob("*.nc")}
    command, *rest = QUESTIONS["study"]
    refused = shell(command, other, *rest, code=2)
    assert refused.stdout == ""
    assert f"holds the results of another case, {case}; --output DIR" in refused.stderr
    assert {path: path.read_bytes() for path in target.glob("*.nc")} == before
    ask(shell, "study", other, "--replace")
    assert {path: path.read_bytes() for path in target.glob("*.nc")} != before
    assert (target / CASE_NOTE).read_text().endswith("fast.toml\n")
    # a project may be moved with its results
    ask(shell, "study", case, "--replace")
    moved = tmp_path / "moved"
    moved.mkdir()
    for name in ("road.txt", "dma.txt", "case.toml", "results"):
        (tmp_path / name).rename(moved / name)
    assert "other case" not in ask(shell, "study", moved / "case.toml").output


def test_nothing_is_solved_or_printed_where_results_cannot_be_written(shell, changed, monkeypatch):
    case = changed("[output]", '[measured]\nfriction = "mu.csv"\n[output]')
    (case.parent / "mu.csv").write_text("speed [m/s],friction\n" + "0.1,0.7\n1,0.8\n2,0.9\n" * 2)
    monkeypatch.setattr("gripscale.experiment.solve.Bench.solve", None)
    monkeypatch.setattr(os, "access", lambda *_: False)
    for name in ("run", *(name for name, _ in commands())):
        done = shell(name, case, *(["--vary", "speed=1"] if name == "study" else []), code=2)
        assert done.stdout == ""
        assert "cannot be written: no permission" in done.stderr, name


def terminal_of(width):
    return Console(file=StringIO(), force_terminal=True, width=width, highlight=False, markup=False)


@pytest.fixture
def steps(monkeypatch):
    """What is written for two steps of the work."""
    monkeypatch.setenv("TERM", "xterm")

    def written(console):
        terminal.show_step(console, "first step")
        terminal.show_step(console, "second step " + 40 * "that is long ")
        terminal.end_steps()
        return str(console.file.getvalue())

    return written


def test_steps_share_one_line_of_a_terminal(steps):
    text = steps(terminal_of(80))
    assert "second step" in text
    assert "…" in text
    assert text.count("\n") == 1
    assert text.endswith("\x1b[1A\x1b[2K")  # the line is cleared


def test_a_pipe_has_no_steps_unless_lines_are_asked_for(steps, monkeypatch):
    pipe = Console(file=StringIO(), width=80, highlight=False, markup=False)
    assert steps(pipe) == ""
    monkeypatch.setenv(terminal.PROGRESS_LINES, "1")
    assert steps(pipe).startswith("first step\nsecond step")


@pytest.mark.parametrize("columns", [80, 140])
def test_help_is_whole_and_as_wide_as_the_terminal(columns):
    words = [sys.executable, "-m", "gripscale", "--help"]
    environment = os.environ | {"COLUMNS": str(columns)}
    text = subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout
    lines = text.splitlines()
    assert columns - 25 < max(map(len, lines)) <= columns
    for name, function in commands():
        summary = " ".join(str(function.__doc__).partition("\n\n")[0].split())
        assert summary in " ".join(text.split()), name


def test_the_shell_completes_commands_and_options(shell, monkeypatch):
    monkeypatch.setenv("_GRIPSCALE_COMPLETE", "complete_bash")
    for words, number, expected in (
        ("gripscale comp", 1, ["compare", "compare-rubbers", "compare-surfaces"]),
        ("gripscale run --verb", 2, ["--verbose"]),
    ):
        monkeypatch.setenv("COMP_WORDS", words)
        monkeypatch.setenv("COMP_CWORD", str(number))
        assert shell().stdout.split() == expected
