"""The pages of a report, one for each kind of result: cards, notices and chapters."""

from __future__ import annotations

import math
from collections.abc import Iterable

import xarray as xr

from gripscale.charts.draw import image
from gripscale.charts.page_elements import words_of
from gripscale.core.finding import Finding, Severity, Topic
from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.questions.chain import findings as notices
from gripscale.questions.chain.run_folder import RunSource
from gripscale.questions.chain.run_page import run_page
from gripscale.questions.compare.page import comparison_page
from gripscale.questions.compare.stored import Compared
from gripscale.questions.inputs import page as inputs
from gripscale.questions.result import Result
from gripscale.questions.vary import page as study
from gripscale.questions.vary import page_side_by_side as side_by_side
from gripscale.questions.vary.charts import study_charts
from gripscale.questions.vary.charts_side_by_side import compound_pictures, road_pictures
from gripscale.report.again import rerun_section
from gripscale.report.elements import Card, Element, Facts, Page, Section, Text
from gripscale.report.equations import method_section
from gripscale.report.failures import Failure, explained
from gripscale.report.source import ReportSource, StudySource

ROADS = (
    "The same rubber under the same load on each road: in the chain of its sine waves, and in the "
    "direct contact of its whole profile. A range holds 90 % of what other stretches of the same "
    "road might give. A difference is significant if its range does not contain zero."
)
COMPOUNDS = (
    "Each compound on the same road under the same load. A range is what the measured moduli leave "
    "open. A difference is significant if its range does not contain zero."
)
NAMED_FAILURES = 12
"""Failed predictions named one by one at the head of the page."""


def page_of(source: ReportSource) -> Page:
    """Return the page of a result."""
    if isinstance(source, RunSource):
        return run_page(source)
    if isinstance(source, Compared):
        return comparison_page(source)
    if isinstance(source, Result):
        return source.page_content()
    pages = {
        "study": study_page,
        "compounds": compounds_page,
        "roads": roads_page,
    }
    return pages[source.kind](source)


def study_page(source: StudySource) -> Page:
    """Return the report of a study."""
    data = source.data
    collapsed = [(f"{words} over a_T v", text) for words, text in study.collapse_sentences(data)]
    axes: list[Element] = [study.axes_table(data)]
    axes += [Facts("Speed and temperature", collapsed)] if collapsed else []
    return Page.of(
        str(data.attrs.get("title", f"Study {source.name}")),
        f"varied: {', '.join(words_of(data, axis) for axis in source.axes)}",
        _study_notices(data),
        _study_cards(source),
        [
            Section("axes", "What was varied", axes),
            *_study_sections(source),
            method_section(),
            rerun_section(data.attrs),
        ],
    )


def _study_sections(source: StudySource) -> list[Section]:
    """Return the chapters on inputs, totals and curves."""
    totals = study.totals_table(source.data)
    return [
        *inputs.input_sections(source),
        Section("totals", "Totals of every prediction", [] if totals is None else [totals]),
        Section("curves", "Curves", study_charts(source.data)),
    ]


def _study_notices(data: xr.Dataset) -> list[Finding]:
    failed = list(study.study_failures(data))
    heads = _errors(failed[:NAMED_FAILURES])
    if len(failed) > NAMED_FAILURES:
        rest = len(failed) - NAMED_FAILURES
        heads.append(
            Finding(Severity.ERROR, f"{rest} more did not converge; see the table of totals.")
        )
    beyond = notices.study_sentence(data)
    if beyond:
        share = float(data[FRICTION_OUTSIDE_BAND].max())
        text = f"{beyond} There the Prony series is an extrapolation."
        heads.append(Finding(Severity.WARNING, text, share, topic=Topic.RUBBER))
    notes = [study.shift_sentence(data), *str(data.attrs.get("notes", "")).splitlines()]
    return [
        *heads,
        *(Finding(Severity.WARNING, text, topic=Topic.SURFACE) for text in notes if text),
    ]


def _errors(failed: Iterable[Failure]) -> list[Finding]:
    """Return what has no result, with what to do about it."""
    return [Finding(Severity.ERROR, explained(each)) for each in failed]


def _study_cards(source: StudySource) -> list[Card]:
    failed = len(list(study.study_failures(source.data)))
    count = math.prod(source.data.sizes[name] for name in source.axes)
    axes = " × ".join(words_of(source.data, axis) for axis in source.axes)
    return [
        Card("Predictions", str(count), axes),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]


def roads_page(source: StudySource) -> Page:
    """Return the report of roads side by side."""
    data = source.data
    statistics, friction = map(image, road_pictures(data))
    sentences = [
        *side_by_side.roads_sentences(data),
        *str(data.attrs.get("notes", "")).splitlines(),
    ]
    return Page.of(
        f"Roads side by side: {', '.join(data.surface.values.tolist())}",
        str(data.attrs.get("title", "")),
        _errors(side_by_side.failed_totals(data)),
        [],
        [
            Section(
                "roads",
                "Contact and friction",
                [Text(ROADS), *side_by_side.roads_tables(data), *map(Text, sentences), friction],
            ),
            Section("statistics", "The roads", [statistics]),
            rerun_section(data.attrs),
        ],
    )


def compounds_page(source: StudySource) -> Page:
    """Return the report of compounds side by side: differences, then what a study has."""
    data = source.data
    names = [str(name) for name in data.rubber.values]
    elements: list[Element] = [Text(COMPOUNDS), side_by_side.compounds_table(data)]
    elements += map(Text, side_by_side.compounds_sentences(data))
    rubbers = inputs.rubbers_of(data)
    moduli = dict(zip(names, rubbers, strict=True)) if len(rubbers) == len(names) else {}
    elements += map(image, compound_pictures(data, moduli))
    return Page.of(
        f"Compounds side by side: {', '.join(names)}",
        str(data.attrs.get("title", "")),
        _study_notices(data),
        _study_cards(source),
        [
            Section("compounds", "Contact and friction", elements),
            *_study_sections(source),
            method_section(),
            rerun_section(data.attrs),
        ],
    )
