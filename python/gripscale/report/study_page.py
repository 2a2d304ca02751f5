"""The report of a study: what was varied, totals of every prediction, curves over the axes."""

from __future__ import annotations

import math
import shlex
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from gripscale.report.chapters import pointer
from gripscale.report.charts.study import study_charts
from gripscale.report.elements import Card, Element, Facts, Heading, Notice, Page, Section
from gripscale.report.elements import Table as PageTable
from gripscale.report.numbers import NONE, number
from gripscale.report.outside_band import study_sentence
from gripscale.report.run_page import method_elements, rerun_elements
from gripscale.report.source import Study
from gripscale.report.study_inputs import input_sections
from gripscale.report.study_words import telling, words_of
from gripscale.report.temperature_text import collapse_sentences, shift_sentence
from gripscale.study.axis import COUNTS
from gripscale.study.display import axis_shown, name_of, of_numbers

NAMED_FAILURES = 12
"""Failed predictions named one by one at the head of the page."""


def study_page(study: Study) -> Page:
    """Return the report of `study`."""
    data = study.data
    failed = list(_failures(study))
    sections = [
        Section("axes", "What was varied", [_axes(study), *_over_reduced_speed(data)]),
        *input_sections(study),
        Section("totals", "Totals of every prediction", _totals(study)),
        Section("curves", "Curves", study_charts(study)),
        Section("method", "Method", method_elements()),
        Section(
            "again",
            "Software, and how to run it again",
            rerun_elements(data.attrs, "", _command(study)),
        ),
    ]
    return Page(
        str(data.attrs.get("title", f"Study {study.name}")),
        f"varied: {', '.join(words_of(data, axis) for axis in study.axes)}",
        [*_notices(failed), *_beyond(data)],
        _cards(study, len(failed)),
        [section for section in sections if section.elements],
    )


def _command(study: Study) -> str:
    """Return the command that makes a study of these axes."""
    varied = " ".join(
        shlex.join(["--vary", f"{name}={_spacing(study, name) or ','.join(_given(study, name))}"])
        for name in study.axes
    )
    chosen = " --model direct" if study.data.attrs.get("model") == "direct" else ""
    return f"gripscale study case.toml {varied}{chosen}"


def _spacing(study: Study, name: str) -> str:
    """Return evenly spaced values as `--vary` takes them, such as 0.01:10:log9; else nothing."""
    values = _values(study, name)
    if len(values) < 3 or not of_numbers(study.data, name) or name in COUNTS:
        return ""
    first, last = float(values[0]), float(values[-1])
    unit = " K" if name == "temperature" else ""
    for word, spaced in (("log", np.geomspace), ("lin", np.linspace)):
        if word == "log" and not first > 0.0:
            continue
        if np.allclose(values, spaced(first, last, len(values)), rtol=1e-11, atol=0.0):
            return f"{_plain(first)}{unit}:{_plain(last)}{unit}:{word}{len(values)}"
    return ""


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
        values = [_place(study, name, i) for i in range(len(_values(study, name)))]
        variable = study.data.get(name, xr.DataArray())
        meaning = str(variable.attrs.get("long_name", name))
        unit = axis_shown(study.data, name).unit if of_numbers(study.data, name) else NONE
        rows.append([name.replace("_", " "), meaning, unit, str(len(values)), ", ".join(values)])
    headings = [
        Heading(text, words=True) for text in ("axis", "meaning", "unit", "values", "which")
    ]
    return PageTable("axes", "The axes of the study", headings, rows)


def _place(study: Study, name: str, i: int) -> str:
    """Return a value of an axis as tables show it, without its unit."""
    if name not in study.data.coords:
        return str(i + 1)
    if not of_numbers(study.data, name):
        return name_of(study.data, name, i)
    shown = number(axis_shown(study.data, name).of(study.data[name].values[i]), digits=4)
    return shown.rstrip("0").rstrip(".") if "." in shown else shown


def _over_reduced_speed(data: xr.Dataset) -> list[Element]:
    """Return how far temperatures lie apart over the reduced speed, where there are several."""
    over = [(f"{words} over a_T v", text) for words, text in collapse_sentences(data)]
    return [Facts("Speed and temperature", over)] if over else []


def _totals(study: Study) -> list[Element]:
    names = [name for name in totals_of(study) if telling(study.data[name])]
    if not names:
        return []
    headings = [
        Heading(words_of(study.data, name), _unit(study, name), words=_words(study, name))
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
        yield [_place(study, name, i) for name, i in at.items()], study.data.isel(at)


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
    if of_numbers(study.data, name):
        return axis_shown(study.data, name).unit
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
        where = ", ".join(_where(study, n, v) for n, v in zip(study.axes, place, strict=True))
        for name in states:
            if not _good(one, name):
                why = cell(one[name].values[()])
                yield f"{where}: NOT converged: {why}{pointer(why)}"
        if not states and any(math.isnan(float(one[name])) for name in totals):
            yield f"{where}: no total"


def _where(study: Study, axis: str, value: str) -> str:
    unit = _unit(study, axis)
    return f"{words_of(study.data, axis)} {value}{f' {unit}' if unit else ''}"


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
    yield from (Notice("warning", text) for text in str(data.attrs.get("notes", "")).splitlines())


def _cards(study: Study, failed: int) -> list[Card]:
    count = math.prod(study.data.sizes[name] for name in study.axes)
    return [
        Card(
            "Predictions", str(count), " × ".join(words_of(study.data, axis) for axis in study.axes)
        ),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]
