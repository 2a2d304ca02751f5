"""Failures point to a chapter that is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.report.notices import chapter_words, explained
from gripscale.wave.problem import Status, status_in

DOCS = Path(__file__).parents[2] / "docs"

BEYOND = ExtrapolationError.see.removeprefix("docs/")


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as its site names them."""
    titles = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    plain = (re.sub(r"[^\w\s-]", "", title).strip().lower() for title in titles)
    return {re.sub(r"[\s-]+", "-", title) for title in plain}


FAILURES = [status for status in Status if status != "converged"]


@pytest.mark.parametrize("chapter", sorted({*(status.chapter for status in Status), BEYOND}))
def test_chapters_are_there(chapter: str) -> None:
    page, _, anchor = chapter.partition("#")
    assert anchor in anchors(DOCS / page)


@pytest.mark.parametrize("status", FAILURES)
def test_a_status_carries_its_sentence_and_its_advice(status: Status) -> None:
    assert status.sentence[0].isupper()
    assert status.sentence.endswith(".")
    assert status.advice.endswith(".")
    assert Status(str(status)) is status


@pytest.mark.parametrize("status", FAILURES)
def test_a_failure_says_what_to_do_and_where_to_read(status: Status) -> None:
    text = f"wave 3 of 3 did not converge: {status} at 40 % of the pressure"
    assert status_in(text) is status
    see = f"See {chapter_words(status.chapter)}"
    assert explained(text) == f"{text}. {status.advice} {see}"


def test_a_status_is_a_word_of_its_own() -> None:
    assert status_in("no time limit.dat in the folder") is None
    assert status_in("1 of 2 samples failed: tolerance not met") is Status.TOLERANCE_NOT_MET
    assert status_in("converged") is None


def test_a_chapter_is_found_without_the_source() -> None:
    words = chapter_words("docs/reading-results.md#beyond-the-measured-band")
    assert words == '"reading results: beyond the measured band" in the documentation'
    assert chapter_words("docs/limits.md") == '"limits" in the documentation'
    assert chapter_words("`gripscale keys rubber`") == "`gripscale keys rubber`"


def test_refusals_point_by_their_kind_and_others_nowhere() -> None:
    assert explained(ExtrapolationError("far beyond")) == f"far beyond; see {chapter_words(BEYOND)}"
    assert explained(InputError("speed must be positive")) == "speed must be positive"
