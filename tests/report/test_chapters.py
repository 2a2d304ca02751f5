"""Failures point to a chapter that is there."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.report.notices import STATUS_CHAPTERS, pointer
from gripscale.wave.problem import Status
from tests.samples import DOCS

BEYOND = ExtrapolationError.see.removeprefix("docs/")


def anchors(page: Path) -> set[str]:
    """Return the anchors of a page's headings, as its site names them."""
    titles = re.findall(r"^#+ (.+)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    plain = (re.sub(r"[^\w\s-]", "", title).strip().lower() for title in titles)
    return {re.sub(r"[\s-]+", "-", title) for title in plain}


def test_every_status_has_its_chapter() -> None:
    assert set(STATUS_CHAPTERS) == set(Status)


@pytest.mark.parametrize("chapter", sorted({*STATUS_CHAPTERS.values(), BEYOND}))
def test_chapters_are_there(chapter: str) -> None:
    page, _, anchor = chapter.partition("#")
    assert anchor in anchors(DOCS / page)


@pytest.mark.parametrize("status", [one for one in Status if one != "converged"])
def test_a_text_that_names_a_status_points_to_its_chapter(status: Status) -> None:
    text = f"wave 3 of 3 did not converge: {status} at 40 % of the pressure"
    assert pointer(text) == f"; see docs/{STATUS_CHAPTERS[status]}"


def test_refusals_point_by_their_kind_and_others_nowhere() -> None:
    assert pointer(ExtrapolationError("far beyond")) == f"; see docs/{BEYOND}"
    assert pointer(InputError("speed must be positive")) == ""
