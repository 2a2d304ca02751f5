"""The report of a study: what was varied, totals of every prediction, curves over the axes."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from gripscale.report.charts.study import study_charts
from gripscale.report.elements import Card, Element, Facts, Heading, Notice, Page, Section
from gripscale.report.elements import Table as PageTable
from gripscale.report.input_tables import without_folder
from gripscale.report.numbers import NONE, number
from gripscale.report.outside_band import study_sentence
from gripscale.report.run_page import method_elements, rerun_elements
from gripscale.report.source import Study
from gripscale.report.temperature_text import collapse_sentences, shift_sentence

NAMED_FAILURES = 12
"""Failed predictions named one by one at the head of the page."""


def study_page(study: Study) -> Page:
    """Return the report of `study`."""
    data = study.data
    failed = list(_failures(study))
    sections = [
        Section("axes", "What was varied", [_axes(study), *_facts(data)]),
        Section("totals", "Totals of every prediction", _totals(study)),
        Section("curves", "Curves", study_charts(study)),
        Section("method", "Method", method_elements()),
        Section("again", "Software", rerun_elements(data.attrs, "", _command(study))),
    ]
    return Page(
        str(data.attrs.get("title", f"Study {study.name}")),
        f"varied: {', '.join(study.axes)}",
        [*_notices(failed), *_beyond(data)],
        _cards(study, len(failed)),
        [section for section in sections if section.elements],
    )


def _command(study: Study) -> str:
    """Return the command that makes a study of these axes."""
    varied = " ".join(
        shlex.join(["--vary", f"{name}={','.join(_given(study, name))}"]) for name in study.axes
    )
    chosen = " --model direct" if study.data.attrs.get("model") == "direct" else ""
    return f"gripscale study case.toml {varied}{chosen}"


def _given(study: Study, name: str) -> Iterator[str]:
    """Yield the values of an axis as `--vary` takes them."""
    unit = " K" if name == "temperature" else ""
    for value in _values(study, name):
        yield f"{_plain(value)}{unit}"


def _plain(value: Any) -> str:
    return f"{value:.12g}" if isinstance(value, float) else str(value) or NONE


def totals_of(study: Study) -> list[str]:
    """Return the names of what there is one number or text of per prediction."""
    axes = set(study.axes)
    return [
        str(name)
        for name, variable in study.data.data_vars.items()
        if variable.dims and set(variable.dims) <= axes and not str(name).endswith("_key")
    ]


def _axes(study: Study) -> PageTable:
    rows = []
    for name in study.axes:
        values = [_plain(value) for value in _values(study, name)]
        variable = study.data.get(name, xr.DataArray())
        meaning = str(variable.attrs.get("long_name", name))
        unit = str(variable.attrs.get("units", "1")).replace("1", NONE)
        rows.append([name, meaning, unit, str(len(values)), ", ".join(values)])
    headings = [
        Heading(text, words=True) for text in ("axis", "meaning", "unit", "values", "which")
    ]
    return PageTable("axes", "The axes of the study", headings, rows)


def _facts(data: xr.Dataset) -> list[Element]:
    """Return the attributes that are short texts or numbers: the provenance."""
    pairs = [
        (str(name).replace("_", " "), without_folder(cell(value)))
        for name, value in data.attrs.items()
        if not str(name).startswith("version_") and name != "case" and len(str(value)) <= 600
    ]
    over = [(f"{words} over a_T v", text) for words, text in collapse_sentences(data)]
    facts = (("Speed and temperature", over), ("Provenance", pairs))
    return [Facts(title, told) for title, told in facts if told]


def _totals(study: Study) -> list[Element]:
    names = totals_of(study)
    if not names:
        return []
    headings = [
        Heading(name.replace("_", " "), _unit(study, name), words=_words(study, name))
        for name in [*study.axes, *names]
    ]
    rows: list[list[str]] = []
    bad: set[tuple[int, int]] = set()
    for i, (place, one) in enumerate(_predictions(study)):
        values = [one[name].values[()] for name in names]
        rows.append([*place, *(cell(value) for value in values)])
        if any(name.endswith("status") and not _good(one, name) for name in names):
            bad |= {(i, j) for j in range(len(headings))}
    caption = f"Totals of all {len(rows)} predictions"
    return [PageTable("totals", caption, headings, rows, bad=frozenset(bad))]


def _predictions(study: Study) -> Iterator[tuple[list[str], xr.Dataset]]:
    """Yield every point of the study: its place on the axes in words, and its Dataset."""
    sizes = [study.data.sizes[name] for name in study.axes]
    for index in product(*(range(size) for size in sizes)):
        at = dict(zip(study.axes, index, strict=True))
        yield [_plain(_values(study, name)[i]) for name, i in at.items()], study.data.isel(at)


def _values(study: Study, name: str) -> Sequence[Any]:
    """Return the coordinate of an axis, or its numbers where it has none."""
    if name in study.data.coords:
        return list(study.data[name].values)
    return list(range(1, study.data.sizes[name] + 1))


def cell(value: Any) -> str:
    """Return a number or a text as a table shows it; never empty."""
    if isinstance(value, int | float | np.number | np.bool_):
        return number(value, digits=4)
    return str(value) or NONE


def _unit(study: Study, name: str) -> str:
    unit = str(study.data[name].attrs.get("units", "")) if name in study.data.variables else ""
    return "" if unit == "1" else unit


def _words(study: Study, name: str) -> bool:
    return name in study.data.variables and study.data[name].dtype.kind not in "fiub"


def _good(one: xr.Dataset, name: str) -> bool:
    return str(one[name].values[()]) == "converged"


def _failures(study: Study) -> Iterator[str]:
    """Yield a sentence for each prediction that is not `converged`, or has a NaN total."""
    names = totals_of(study)
    states = [name for name in names if name.endswith("status")]
    totals = [n for n in names if n == "total_contact_fraction" or n == "contact_fraction"]
    for place, one in _predictions(study):
        where = ", ".join(f"{n} {v}" for n, v in zip(study.axes, place, strict=True))
        for name in states:
            if not _good(one, name):
                yield f"{where}: NOT converged: {cell(one[name].values[()])}"
        if not states and any(math.isnan(float(one[name])) for name in totals):
            yield f"{where}: no total"


def _notices(failed: Sequence[str]) -> list[Notice]:
    shown = [Notice("error", text) for text in failed[:NAMED_FAILURES]]
    if len(failed) > NAMED_FAILURES:
        rest = len(failed) - NAMED_FAILURES
        shown.append(Notice("error", f"{rest} more did not converge; see the table of totals."))
    return shown


def _beyond(data: xr.Dataset) -> Iterator[Notice]:
    """Yield a warning if some of the friction rests on extrapolation."""
    text = study_sentence(data)
    if text:
        yield Notice("warning", f"{text} There the Prony series is an extrapolation.")
    shifted = shift_sentence(data)
    if shifted:
        yield Notice("warning", shifted)


def _cards(study: Study, failed: int) -> list[Card]:
    count = math.prod(study.data.sizes[name] for name in study.axes)
    return [
        Card("Predictions", str(count), " × ".join(study.axes)),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]
