"""What commands print, what pages show and what can be done: as kept here, for people to compare.

Where they are meant to change, `python -m tests.golden.make_experiments` writes the texts anew and
`python -m tests.golden.abilities` the abilities, and the change is read before it is committed.
"""

import difflib
import re
from pathlib import Path

import pytest

from tests.report.reading import Page

from .abilities import FILE, abilities
from .experiment_numbers import experiment_numbers
from .experiments import COMMANDS
from .instruction_set import instruction_set, kept_values, moved
from .quantities import all_numbers
from .texts import KEPT, kept_texts, texts

HERE = Path(__file__).parent
BEFORE = kept_texts(HERE / "texts")


@pytest.fixture(scope="module")
def now(experiments):
    return texts(experiments)


@pytest.fixture(scope="module")
def same():
    """Whether the texts were written on these instructions; elsewhere last digits differ."""
    return str(kept_values(HERE / "experiments.npz")["instruction_set"]) == instruction_set()


def test_every_text_is_there(now):
    assert {*KEPT} == BEFORE.keys() <= now.keys()


@pytest.mark.parametrize("name", KEPT)
def test_text_is_as_it_was(name, now, same):
    before, after = BEFORE[name], now[name]
    if not same:
        before, after = _without_numbers(before), _without_numbers(after)
    changes = difflib.unified_diff(before.splitlines(), after.splitlines(), lineterm="", n=0)
    assert before == after, "\n".join(changes)


def test_all_that_could_be_done_can_be_done():
    before = FILE.read_text(encoding="utf-8").splitlines()
    changes = list(difflib.unified_diff(before, abilities(), lineterm="", n=0))
    assert not changes, "\n".join(changes)


def _without_numbers(text):
    """Return the words of a text: a number of another length moves the columns of a table."""
    return re.sub(r"[\s─]+", " ", re.sub(r"[-+−]?\d[\d.]*(e[-+−]?\d+)?|\bnan\b", "#", text))


PAGES = [name for name in COMMANDS if not name.startswith(("fit_", "keys"))]


@pytest.fixture(scope="module", params=PAGES)
def page(request, experiments):
    return Page(experiments.folder / request.param / "report.html")


def test_a_page_is_one_file_that_asks_for_nothing(page, experiments):
    named = [attrs.get("src") or attrs.get("href") for _, attrs in page.tags]
    assert [value for value in named if value and not value.startswith(("data:", "#"))] == []
    policy = next(a["content"] or "" for _, a in page.tags if "http-equiv" in a)
    assert "default-src 'none'" in policy
    scripts = policy.partition("script-src ")[2].partition(";")[0].split()
    assert len(scripts) == 2
    assert all(source.startswith("'sha256-") for source in scripts)
    assert len(page.source) < 3e6
    assert str(experiments.folder) not in page.source


def test_what_a_page_shows_has_texts(page):
    pictures = [attrs for tag, attrs in page.tags if tag == "img"]
    assert all(attrs.get("alt") for attrs in pictures)
    plots = [attrs for _, attrs in page.tags if attrs.get("class") == "plot"]
    assert all(attrs.get("aria-label") and attrs.get("role") == "img" for attrs in plots)
    for name, rows in page.tables.items():
        assert all(row and all(row) for row in rows[1:]), name
    assert not re.search(r"\{\{|\}\}|\bnan\b", page.text), "left behind by a template or a number"


def test_no_number_has_moved():
    kept, now = kept_values(HERE / "golden.npz"), all_numbers()
    assert kept.keys() - {"instruction_set"} <= now.keys()
    assert not moved(kept, now, ("newton_iterations", "load_steps", "residual"))


def test_no_result_of_a_command_has_moved(experiments):
    kept, now = kept_values(HERE / "experiments.npz"), experiment_numbers(experiments)
    assert kept.keys() - {"instruction_set"} == now.keys()
    counted = ("iterations", "steps", "residual", "mismatch", "error", "passes", "grid_points")
    assert not moved(kept, now, counted)
