"""Figures, links, files, citation and numbers of the pages are those that there are."""

import json
import re
import tomllib
from importlib.util import find_spec

import pytest
import yaml

from studies.shipped_numbers import NUMBERS, of_comparison, of_run
from tests.docs.style import figures
from tests.samples import DOCS, ROOT

NAMES = {path.stem for path in (DOCS / "figures").iterdir()}
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
SECTION = TEXT.partition("## Figures of the pages\n")[2].partition("\n## ")[0]
ROWS = [row.strip("| ").split(" | ") for row in SECTION.splitlines() if row.startswith("| `")]


def test_every_figure_is_drawn_by_one_command():
    listed = [name for cell, _ in ROWS for name in re.findall(r"`(.*?)`", cell)]
    series = {name for name in NAMES if name.startswith(("book_", "paper_"))}
    assert sorted(listed) == sorted(NAMES - series | {"book_*", "paper_*"})


@pytest.mark.parametrize("command", [command for _, command in ROWS])
def test_modules_and_files_of_the_commands_exist(command):
    for module in re.findall(r"python -m ([\w.]+)", command):
        assert find_spec(module) is not None
    for file in re.findall(r"examples/[\w./]+", command):
        assert (ROOT / file).exists()


def test_every_figure_stands_on_a_page():
    pages = (page.read_text(encoding="utf-8") for page in DOCS.glob("*.md"))
    used = {
        target.removeprefix("figures/").partition(".")[0] for p in pages for target in figures(p)
    }
    assert used == NAMES


def test_citation_has_the_required_keys_and_the_version_of_the_package():
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert citation["cff-version"] == "1.2.0"
    assert {"message", "title", "authors", "references"} <= set(citation)
    assert citation["authors"] == [{"name": "The gripscale developers"}]
    for reference in citation["references"]:
        assert {"type", "title", "authors"} <= set(reference)
    package = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert citation["version"] == package["version"]
    assert citation["license"] == package["license"]


PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md")])
LINK = re.compile(r"\]\(([^)#]+)(?:#[^)]*)?\)")
FILE = re.compile(r"`((?:rust|python|tests|benchmarks|examples|docs)/[\w./-]+)`")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_and_names_of_files_lead_somewhere(page):
    text = page.read_text(encoding="utf-8")
    links = [page.parent / target for target in LINK.findall(text) if "://" not in target]
    for path in [*links, *(ROOT / name for name in FILE.findall(text))]:
        assert path.exists(), f"{page.name} points to {path}"


def test_tests_of_the_page_on_verification_exist():
    """Names without a folder are in tests/verification."""
    text = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")
    names = re.findall(r"`(test_\w+\.py)`", text)
    assert len(names) > 10
    assert not [name for name in names if not (ROOT / "tests" / "verification" / name).exists()]


STORED = json.loads(NUMBERS.read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("page", "name"),
    [
        (ROOT / "README.md", "compare: large strain"),
        (ROOT / "README.md", "run: friction"),
        (ROOT / "README.md", "run: contact area"),
        (DOCS / "direct-contact.md", "compare: large strain"),
    ],
)
def test_the_answer_is_quoted(page, name):
    assert STORED[name] in " ".join(page.read_text(encoding="utf-8").split())


def test_the_file_has_what_a_run_gives():
    assert of_run() == {name: STORED[name] for name in STORED if name.startswith("run")}


@pytest.mark.verification
def test_the_file_has_what_a_comparison_gives():
    """A minute of one core."""
    assert of_comparison() == {name: STORED[name] for name in ["compare: large strain"]}
