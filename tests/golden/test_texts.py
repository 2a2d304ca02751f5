"""What commands print, what pages show and what can be done: as kept here, for people to compare.

Where they are meant to change, `python -m tests.golden.make_experiments` writes the texts anew and
`python -m tests.golden.abilities` the abilities, and the change is read before it is committed.
"""

from __future__ import annotations

import difflib
import re
from pathlib import Path

import pytest

from .abilities import FILE, abilities
from .experiments import Experiments
from .instruction_set import instruction_set, kept_values
from .texts import KEPT, kept_texts, texts

HERE = Path(__file__).parent
BEFORE = kept_texts(HERE / "texts")


@pytest.fixture(scope="module")
def now(experiments: Experiments) -> dict[str, str]:
    return texts(experiments)


@pytest.fixture(scope="module")
def same() -> bool:
    """Whether the texts were written on these instructions; elsewhere last digits differ."""
    return str(kept_values(HERE / "experiments.npz")["instruction_set"]) == instruction_set()


def test_every_text_is_there(now: dict[str, str]) -> None:
    assert {*KEPT} == BEFORE.keys() <= now.keys()


@pytest.mark.parametrize("name", KEPT)
def test_text_is_as_it_was(name: str, now: dict[str, str], same: bool) -> None:
    before, after = BEFORE[name], now[name]
    if not same:
        before, after = _without_numbers(before), _without_numbers(after)
    changes = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    assert before == after, "\n".join(changes)


def test_all_that_could_be_done_can_be_done() -> None:
    before = FILE.read_text(encoding="utf-8").splitlines()
    changes = list(difflib.unified_diff(before, abilities(), lineterm="", n=0))
    assert not changes, "\n".join(changes)


def _without_numbers(text: str) -> str:
    """Return the words of a text: a number of another length moves the columns of a table."""
    return re.sub(r"[\s─]+", " ", re.sub(r"[-+−]?\d[\d.]*(e[-+−]?\d+)?|\bnan\b", "#", text))
