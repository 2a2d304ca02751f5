"""The head of a page of many predictions: what is to be believed, before how it was found."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import xarray as xr

from gripscale.io.table import significant
from gripscale.questions.chain.view import SYMBOLS
from gripscale.questions.vary import page_of_answer as study_answer
from gripscale.questions.vary import page_side_by_side as side_by_side
from gripscale.questions.vary.page import study_table
from gripscale.report.elements import Card, Page, Section
from gripscale.report.source import ReportSource, StudySource

DIMENSIONS = {"compounds": ("rubber", "compound"), "roads": ("surface", "road")}
"""What stands side by side, and what a table calls it, by the kind of result."""


def with_answer(page: Page, source: ReportSource) -> Page:
    """Return the page of a result with its answer in front; of a run or comparison as it is."""
    if not isinstance(source, StudySource):
        return page
    data = source.data
    if source.kind == "study":
        cards, lines = list(study_answer.study_cards(data)), list(study_answer.study_lines(data))
        page = _in_front(page, cards, lines)
        curves = [section for section in page.sections if section.name == "curves"]
        others = [section for section in page.sections if section.name != "curves"]
        first = Section("predictions", "Predictions", [study_table(data)])
        return replace(page, sections=[first, *curves, *others])
    if source.kind not in DIMENSIONS or "friction_ratio" not in data:
        return page
    dim, heading = DIMENSIONS[source.kind]
    page = _in_front(page, list(_ratio_cards(data, dim)), list(side_by_side.ratio_lines(data, dim)))
    table = side_by_side.believed_table(data, dim, heading)
    if source.kind == "roads" or table is None:  # the tables of roads have it already
        return page
    contact, *rest = page.sections
    return replace(page, sections=[replace(contact, elements=[table, *contact.elements]), *rest])


def _in_front(page: Page, cards: list[Card], lines: list[str]) -> Page:
    basis = [line.strip() for line in lines]
    return replace(page, cards=[*cards, *page.cards], basis=[*basis, *page.basis])


def _ratio_cards(data: xr.Dataset, dim: str) -> Iterator[Card]:
    """Yield friction of each over that of the first, with its interval."""
    names = [str(name) for name in data[dim].values]
    for i, name in enumerate(names[1:], start=1):
        ratio = float(data["friction_ratio"].values[i])
        low, high = side_by_side.ratio_ends(data, "friction", i)
        interval = f"{significant(low)} to {significant(high)} (90 %)" if math.isfinite(low) else ""
        label = f"{SYMBOLS['friction']} of {name}"
        yield Card(label, f"× {significant(ratio)}", f"that of {names[0]}; {interval}".rstrip("; "))
