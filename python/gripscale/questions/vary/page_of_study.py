"""The page of a study: the answer over what was varied, the predictions, and their inputs."""

from __future__ import annotations

import math
from collections.abc import Iterator

import xarray as xr

from gripscale.core.finding import Finding, Severity, Topic
from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.questions.chain.findings import study_sentence
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.vary.axis import dimensions
from gripscale.questions.vary.charts import study_charts
from gripscale.questions.vary.page import (
    axes_table,
    collapse_sentences,
    shift_sentence,
    study_failures,
    study_table,
    totals_table,
)
from gripscale.questions.vary.page_of_answer import study_cards, study_lines
from gripscale.questions.vary.words import words_of
from gripscale.report.again import rerun_section
from gripscale.report.elements import Card, Element, Facts, Page, Section
from gripscale.report.equations import method_section
from gripscale.report.failures import explained

_NAMED_FAILURES = 12
"""Failed predictions that have a finding each."""


def study_findings(data: xr.Dataset) -> Iterator[Finding]:
    """Yield predictions without a result, extrapolation of the rubber, and notes on surfaces."""
    failed = list(study_failures(data))
    yield from (Finding(Severity.ERROR, explained(each)) for each in failed[:_NAMED_FAILURES])
    if rest := len(failed[_NAMED_FAILURES:]):
        yield Finding(Severity.ERROR, f"{rest} more did not converge; see the table of totals.")
    if beyond := study_sentence(data):
        share = float(data[FRICTION_OUTSIDE_BAND].max())
        text = f"{beyond} There the Prony series is an extrapolation."
        yield Finding(Severity.WARNING, text, share, topic=Topic.RUBBER)
    notes = [shift_sentence(data), *str(data.attrs.get("notes", "")).splitlines()]
    yield from (Finding(Severity.WARNING, text, topic=Topic.SURFACE) for text in notes if text)


def study_page(data: xr.Dataset) -> Page:
    """Return the page of a study: answer, predictions and curves, then the inputs."""
    collapsed = [(f"{words} over a_T v", text) for words, text in collapse_sentences(data)]
    axes: list[Element] = [axes_table(data)]
    axes += [Facts("Speed and temperature", collapsed)] if collapsed else []
    curves, *inputs = study_sections(data)
    return Page.of(
        str(data.attrs.get("title", "Study")),
        f"varied: {', '.join(words_of(data, axis) for axis in dimensions(data))}",
        study_findings(data),
        [*study_cards(data), *count_cards(data)],
        [
            Section("predictions", "Predictions", [study_table(data)]),
            curves,
            Section("axes", "What was varied", axes),
            *inputs,
            method_section(),
            rerun_section(data.attrs),
        ],
        (line.strip() for line in study_lines(data)),
    )


def study_sections(data: xr.Dataset) -> list[Section]:
    """Return the chapters on curves, inputs and totals."""
    totals = totals_table(data)
    return [
        Section("curves", "Curves", study_charts(data)),
        *input_sections(data),
        Section("totals", "Totals of every prediction", [] if totals is None else [totals]),
    ]


def count_cards(data: xr.Dataset) -> list[Card]:
    """Return how many predictions there are, and how many of them failed."""
    failed = len(list(study_failures(data)))
    count = math.prod(data.sizes[name] for name in dimensions(data))
    axes = " × ".join(words_of(data, axis) for axis in dimensions(data))
    return [
        Card("Predictions", str(count), axes),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]
