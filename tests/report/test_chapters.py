"""Failures point to a chapter that is there."""

import pytest

from gripscale.cli.docs import anchors
from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.core.status import Status
from gripscale.report.failures import Failure, chapter_words, explained
from tests.samples import DOCS

BEYOND = ExtrapolationError.see.removeprefix("docs/")


FAILURES = [status for status in Status if status != "converged"]


@pytest.mark.parametrize("chapter", sorted({*(status.chapter for status in Status), BEYOND}))
def test_chapters_are_there(chapter):
    page, _, anchor = chapter.partition("#")
    assert anchor in anchors((DOCS / page).read_text(encoding="utf-8"))


@pytest.mark.parametrize("status", FAILURES)
def test_a_failure_says_what_to_do_and_where_to_read(status):
    assert status.sentence[0].isupper()
    assert status.sentence.endswith(".")
    assert status.advice.endswith(".")
    text = f"wave 3 of 3 did not converge: {status} at 40 % of the pressure"
    see = f"See {chapter_words(status.chapter)}"
    assert explained(Failure(text, str(status))) == f"{text}. {status.advice} {see}"


@pytest.mark.parametrize("word", ["", "converged", "a word of a later version"])
def test_a_failure_without_a_known_word_is_its_sentence(word):
    text = "wave 3 of 3 did not converge: iteration limit"
    assert explained(Failure(text, word)) == text


def test_a_chapter_is_found_without_the_source():
    words = chapter_words("docs/reading-results.md#beyond-the-measured-band")
    assert words == "`gripscale docs reading-results#beyond-the-measured-band`"
    assert chapter_words("docs/limits.md") == "`gripscale docs limits`"
    assert chapter_words("`gripscale keys rubber`") == "`gripscale keys rubber`"


def test_refusals_point_by_their_kind_and_others_nowhere():
    assert explained(ExtrapolationError("far beyond")) == f"far beyond; see {chapter_words(BEYOND)}"
    assert explained(InputError("speed must be positive")) == "speed must be positive"
