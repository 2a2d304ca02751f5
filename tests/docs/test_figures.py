"""Each figure of the pages stands on a page, and CONTRIBUTING has the command that draws it."""

from __future__ import annotations

import re
from importlib.util import find_spec

import pytest

from tests.docs.style import figures
from tests.samples import DOCS, ROOT

NAMES = {path.stem for path in (DOCS / "figures").iterdir()}
TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
SECTION = TEXT.partition("## Figures of the pages\n")[2].partition("\n## ")[0]
ROWS = [row.strip("| ").split(" | ") for row in SECTION.splitlines() if row.startswith("| `")]


def test_every_figure_is_drawn_by_one_command() -> None:
    listed = [name for cell, _ in ROWS for name in re.findall(r"`(.*?)`", cell)]
    series = {name for name in NAMES if name.startswith(("book_", "paper_"))}
    assert sorted(listed) == sorted(NAMES - series | {"book_*", "paper_*"})


@pytest.mark.parametrize("command", [command for _, command in ROWS])
def test_modules_and_files_of_the_commands_exist(command: str) -> None:
    for module in re.findall(r"python -m ([\w.]+)", command):
        assert find_spec(module) is not None
    for file in re.findall(r"examples/[\w./]+", command):
        assert (ROOT / file).exists()


def test_every_figure_stands_on_a_page() -> None:
    pages = (page.read_text(encoding="utf-8") for page in DOCS.glob("*.md"))
    used = {
        target.removeprefix("figures/").partition(".")[0] for p in pages for target in figures(p)
    }
    assert used == NAMES
