"""A study in tables and on its page: what was varied, each prediction, curves and inputs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core.finding import Finding, Severity, Topic
from gripscale.core.units import MILLI
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import NONE, Column, Table, digits, percent, significant
from gripscale.model import ADHESIVE_FRICTION, FRICTION_OUTSIDE_BAND, STATUS, status_words
from gripscale.questions.chain.findings import study_sentence
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.vary.axis import axis_shown, dimensions, name_of, of_numbers, places
from gripscale.questions.vary.charts import study_charts
from gripscale.questions.vary.page_of_answer import study_cards, study_lines
from gripscale.questions.vary.schema import Role, label_of, rest_name, telling, variable_of
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT, COLLAPSED
from gripscale.questions.words import SYMBOLS, believed, is_estimated
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Element, Facts, Page, Section
from gripscale.report.equations import method_section
from gripscale.report.failures import Failure, explained, failures_in

_MOST_ROWS = 200  # predictions in the terminal; a page has all of them
ONE_CURVE = 1e-3  # relative distance up to which temperatures over a_T v are one curve
COLLAPSING = {"total_friction": "friction", "total_contact_fraction": "A_r/A_0"}


def study_table(data: xr.Dataset) -> Table:
    """Return area, friction and status of each prediction of a study, over what was varied."""
    chosen = list(places(data))
    rows = [data.isel(index) for index in chosen[:_MOST_ROWS]]

    def each(name: str) -> list[float]:
        return [float(row[name]) for row in rows]

    columns = []
    for axis in dimensions(data):
        names = [name_of(data, axis, index[axis]) for index in chosen[:_MOST_ROWS]]
        columns.append(Column(axis, names, axis.replace("_", " ")))
    if BEYOND_SHIFT in data:
        marks = [" *" if bool(row[BEYOND_SHIFT]) else "" for row in rows]
        columns[-1] = columns[-1].of(columns[-1].values, marks=marks)
    keys = len(columns)
    columns += answer_columns(data, each)
    if not is_estimated(data, "friction") and "total_friction_from_dissipation" in data:
        lost = each("total_friction_from_dissipation")
        columns.append(Column("friction_from_dissipation", lost, "μ", "losses"))
    if ADHESIVE_FRICTION in data:
        term = np.array(each(believed(data, "adhesive_friction")))
        columns.append(Column("area_term", term, "μ", "area term"))
        if is_estimated(data, "total_friction"):  # the answer has it
            columns.insert(-1, Column("hysteresis", each("answer_friction"), "μ", "hysteresis"))
        else:
            total = term + np.array(each("total_friction"))
            columns.append(Column("friction_with_area_term", total, "μ", "with it"))
    largest = [
        float(row.wavelength[int(np.nanargmax(row.friction.values))])
        if {"wavelength", "friction"} <= set(row) and float(row.total_friction) > 1e-9
        else math.nan
        for row in rows
    ]
    if np.isfinite(largest).any():
        columns.append(
            Column("largest_wave", largest, "largest μ of", "mm", MILLI, format="{:.3g}".format)
        )
    if study_sentence(data):
        shares = each(FRICTION_OUTSIDE_BAND)
        columns.append(Column("outside_band", shares, "μ", "beyond band", format=percent))
    rest = rest_name(believed(data, "contact_fraction"))
    if rest in data:
        columns.append(Column("static", each(rest), "A_r/A_0", "at rest"))
    status = [str(row.prediction_status.item()) for row in rows]
    columns.append(Column("status", status))
    more = len(chosen) - len(rows)
    notes = [f"{more} more predictions are in the result file."] if more else []
    bad = [text != CONVERGED for text in status]
    return Table("study", columns, "Predictions of the study", notes, keys=keys, bad=bad)


def answer_columns(data: xr.Dataset, each: Callable[[str], Sequence[float]]) -> Iterator[Column]:
    """Yield friction and contact area with their intervals, by the numbers of each row."""
    for name in reversed(SYMBOLS):
        column = believed(data, name)
        # no friction at rest is none, not zero
        values = [value or math.nan for value in each(column)]
        yield Column(column, values, SYMBOLS[name])
        if f"{column}_low" in data and data[f"{column}_low"].notnull().any():
            ends = np.stack([each(f"{column}_{end}") for end in ("low", "high")], axis=1)
            yield Column(f"{column}_interval", ends, "90 %")


def study_parts(data: xr.Dataset) -> Iterator[str | Table]:
    """Yield the predictions as a table, and how far temperatures over a_T v are one curve."""
    yield study_table(data)
    yield from (f"Over a_T v, {words}: {text}." for words, text in collapse_sentences(data))


def failed_predictions(data: xr.Dataset) -> tuple[list[Failure], int]:
    """Return each prediction without totals, and how many predictions there are."""
    names = [name for name in (STATUS, rest_name(STATUS)) if name in data]
    failed = [failure for name in names for failure in failures_in(data, name)]
    return failed, sum(data[name].size for name in names)


def shift_sentence(data: xr.Dataset) -> str:
    """Return which temperatures lie beyond the shift; empty if none does."""
    if BEYOND_SHIFT not in data or not bool(data[BEYOND_SHIFT].any()):
        return ""
    flags = data[BEYOND_SHIFT]
    if "temperature" in flags.dims:
        others = [dim for dim in flags.dims if dim != "temperature"]
        which = np.flatnonzero(flags.any(dim=others).values)
        names = ", ".join(name_of(data, "temperature", int(i)) for i in which)
        text = f"{names} {'lie' if which.size > 1 else 'lies'}"
    else:
        text = f"{int(flags.sum())} of {flags.size} predictions lie"
    return f"{text} beyond the temperatures of the shift of the rubber."


def collapse_sentences(data: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield quantities of a study over speed and temperature, and how far over a_T v they differ.

    Nothing of other studies.
    """
    for name, words in COLLAPSING.items():
        if COLLAPSED[name] in data:
            yield words, _collapse(data[COLLAPSED[name]])


def _collapse(collapsed: xr.DataArray) -> str:
    distance = float(collapsed)
    if np.isnan(distance):
        return (
            "cannot be compared: the temperatures do not overlap, or the speeds are too far apart "
            "to interpolate"
        )
    attrs = collapsed.attrs
    reached = (
        f"temperatures up to {percent(distance)} apart, at {attrs['points']} of "
        f"{attrs['overlapping_points']} points, where the interpolation errs by less than "
        f"{percent(float(attrs['interpolation_error']))}"
    )
    if distance <= max(ONE_CURVE, float(attrs["interpolation_error"])):
        return f"one curve, {reached}"
    return f"{reached}; one curve would be below {100.0 * ONE_CURVE:g} % but for errors of the mesh"


def axes_table(data: xr.Dataset) -> Table:
    """Return the axes of a study with their values."""
    axes = dimensions(data)
    units = [axis_shown(data, name).unit if of_numbers(data, name) else "" for name in axes]
    values = [[place_text(data, name, i) for i in range(data.sizes[name])] for name in axes]
    meanings = [
        str(data[name].attrs.get("long_name", name)) if name in data.variables else name
        for name in axes
    ]
    columns = [
        Column("axis", [name.replace("_", " ") for name in axes]),
        Column("meaning", meanings),
        Column("unit", units, words=True),
        Column("values", [str(len(each)) for each in values]),
        Column("which", [", ".join(each) for each in values]),
    ]
    return Table("axes", columns, "The axes of the study")


def place_text(data: xr.Dataset, axis: str, i: int) -> str:
    """Return a value of an axis as tables show it, without its unit."""
    if axis not in data.coords:
        return str(i + 1)
    if not of_numbers(data, axis):
        return name_of(data, axis, i)
    text = significant(float(axis_shown(data, axis).of(data[axis].values[i])), 4)
    return text.rstrip("0").rstrip(".") if "." in text else text


def totals_of(data: xr.Dataset) -> list[str]:
    """Return the names of what there is one number or text of per prediction, best ones first."""
    axes = set(dimensions(data))
    roles = {
        str(name): variable_of(data, str(name)).role
        for name, variable in data.data_vars.items()
        if variable.dims and set(variable.dims) <= axes
    }
    names = [name for name, role in roles.items() if role not in (Role.EVIDENCE, Role.RECORD)]
    return sorted(names, key=lambda name: roles[name] not in (Role.ANSWER, Role.END))


def totals_table(data: xr.Dataset) -> Table | None:
    """Return all totals of all predictions that tell something; None without any."""
    axes, names = dimensions(data), [n for n in totals_of(data) if telling(data[n])]
    if not names:
        return None
    chosen = list(places(data))
    rows = [data.isel(index) for index in chosen]
    columns = [
        Column(
            axis,
            [place_text(data, axis, index[axis]) for index in chosen],
            label_of(data, axis),
            axis_unit(data, axis),
            words=axis in data.variables and data[axis].dtype.kind not in "fiub",
        )
        for axis in axes
    ]
    for name in names:
        values: list[Any] = [row[name].values[()] for row in rows]
        unit = str(data[name].attrs.get("units", "")).replace("1", "")
        columns.append(Column(name, values, label_of(data, name), unit, format=digits(4)))
    states = [name for name in names if variable_of(data, name).role == Role.STATUS]
    bad = [any(str(row[name].values[()]) != CONVERGED for name in states) for row in rows]
    return Table("totals", columns, f"Totals of all {len(rows)} predictions", bad=bad)


def axis_unit(data: xr.Dataset, axis: str) -> str:
    """Return the unit in which an axis is shown, empty without one."""
    return axis_shown(data, axis).unit if of_numbers(data, axis) else ""


def study_failures(data: xr.Dataset) -> Iterator[Failure]:
    """Yield each prediction that is not `converged`, or has a NaN total."""
    names = totals_of(data)
    states = [name for name in names if variable_of(data, name).role == Role.STATUS]
    totals = [name for name in names if variable_of(data, name).measures == "contact_fraction"]
    for index in places(data):
        row = data.isel(index)
        where = ", ".join(
            " ".join(filter(None, [label_of(data, n), place_text(data, n, i), axis_unit(data, n)]))
            for n, i in index.items()
        )
        for name in states:
            if (status := str(row[name].values[()])) != CONVERGED:
                word = str(status_words(row, name).item())
                yield Failure(f"{where}: NOT converged: {status or NONE}", word)
        if not states and any(math.isnan(float(row[name])) for name in totals):
            yield Failure(f"{where}: no total")


_NAMED_FAILURES = 12  # failed predictions that have a finding each


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
    totals = totals_table(data)
    return Page.of(
        f"Study: {case_title(data.attrs)}",
        f"varied: {', '.join(label_of(data, axis) for axis in dimensions(data))}",
        study_findings(data),
        [*study_cards(data), *count_cards(data)],
        [
            Section("predictions", "Predictions", [study_table(data)]),
            Section("curves", "Curves", study_charts(data)),
            Section("axes", "What was varied", axes),
            *input_sections(data),
            Section("totals", "Totals of every prediction", [] if totals is None else [totals]),
            method_section(),
            rerun_section(data.attrs),
        ],
        (line.strip() for line in study_lines(data)),
    )


def count_cards(data: xr.Dataset) -> list[Card]:
    """Return how many predictions there are, and how many of them failed."""
    failed = len(list(study_failures(data)))
    count = math.prod(data.sizes[name] for name in dimensions(data))
    axes = " × ".join(label_of(data, axis) for axis in dimensions(data))
    return [
        Card("Predictions", str(count), axes),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]
