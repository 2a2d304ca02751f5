"""README and documentation quote the numbers of the shipped case that the commands give."""

import json

import pytest

from studies.shipped_numbers import NUMBERS, of_comparison, of_run
from tests.samples import DOCS, ROOT

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
