"""README and documentation quote the numbers of the shipped case that the commands give."""

from __future__ import annotations

import json

import pytest

from studies.shipped_numbers import NUMBERS, of_comparison, of_run
from tests.samples import DOCS, ROOT

STORED = json.loads(NUMBERS.read_text(encoding="utf-8"))


def words(name: str) -> str:
    path = ROOT / name if name == "README.md" else DOCS / name
    return " ".join(path.read_text(encoding="utf-8").split())


@pytest.mark.parametrize("page", ["README.md", "direct-contact.md"])
def test_the_answer_is_quoted(page: str) -> None:
    assert STORED["compare: large strain"] in words(page)


def test_the_answer_of_a_run_is_quoted() -> None:
    for name in ("run: friction", "run: contact area"):
        assert STORED[name] in words("README.md")


def test_the_file_has_what_a_run_gives() -> None:
    assert of_run() == {name: STORED[name] for name in STORED if name.startswith("run")}


@pytest.mark.verification
def test_the_file_has_what_a_comparison_gives() -> None:
    """A minute of one core."""
    assert of_comparison() == {name: STORED[name] for name in ["compare: large strain"]}
