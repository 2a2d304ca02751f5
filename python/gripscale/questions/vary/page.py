"""A study in words, in tables and on its page: how its numbers run, each prediction, curves."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from gripscale.core.arrays import Array
from gripscale.core.finding import Finding, Severity, Topic, sentences
from gripscale.core.units import MILLI, display_unit_of
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import NONE, Column, Table, digits, least_to_most, percent, significant
from gripscale.model import (
    ADHESIVE_FRICTION,
    FRICTION_OUTSIDE_BAND,
    STATUS,
    input_doubts_of,
    status_words,
)
from gripscale.questions.answer.estimate import AREA_TERM, ISOTROPY_ASSUMED, LINES_TO_SURFACE
from gripscale.questions.answer.reliance import WORTH_NAMING
from gripscale.questions.chain.findings import study_sentence
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.vary.axis import (
    axis_shown,
    dimensions,
    name_of,
    names_at,
    of_numbers,
    of_points,
    places,
)
from gripscale.questions.vary.charts import study_charts
from gripscale.questions.vary.inputs import OF_THE_CHAIN
from gripscale.questions.vary.schema import (
    Role,
    label_of,
    per_prediction,
    rest_name,
    telling,
    variable_of,
)
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT, COLLAPSED
from gripscale.questions.words import HEADINGS, SYMBOLS, believed, is_estimated
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Element, Facts, Page, Section, percent_text
from gripscale.report.equations import method_section
from gripscale.report.failures import Failure, explained

_MOST_ROWS = 200  # predictions in the terminal; a page has all of them
ONE_CURVE = 1e-3  # relative distance up to which temperatures over a_T v are one curve
COLLAPSING = {"total_friction": "friction", "total_contact_fraction": "A_r/A_0"}


_SAME = 0.03  # relative change that is none
# Models in words; others by their names.
_MODELS = {"chain": "chain of sine waves", "direct": "direct contact of the measured surface"}


def study_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a study, what it is for, and what it rests on."""
    courses = [course(data, name) for name in reversed(SYMBOLS)]
    texts = [text for text in courses if text]
    if not texts:
        yield "Answer: none; no prediction has a result."
        return
    estimated = is_estimated(data, "contact_fraction")
    has_intervals = estimated and bool(data["answer_contact_fraction_low"].notnull().any())
    level = " (90 % intervals)" if has_intervals else ""
    by = "" if estimated else f" by the {_model(data)}, without an interval"
    yield f"Answer{by}: {'; '.join(texts)}{level}."
    yield from (f"  {line}" for line in study_basis(data))


def study_basis(data: xr.Dataset) -> Iterator[str]:
    """Yield what the numbers of a study are for, what they are made of and what they rest on."""
    if doubts := input_doubts_of(data):
        yield f"not to be relied on: {sentences(doubts)}"
    held = []  # what was not varied
    for name in ("pressure", "speed"):
        if name not in dimensions(data) and f"nominal_{name}" in data.attrs:
            value = float(data.attrs[f"nominal_{name}"])
            held.append(display_unit_of(data.attrs, name).text(value))
    ends = [float(data[name]) for name in ("cutoff_wavelength", CONTINUED_TO) if name in data]
    if ends:
        held.append(f"roughness down to {1e3 * min(ends):.3g} mm")
    if "thickness" in data.attrs and "thickness" not in data.dims:
        thickness = display_unit_of(data.attrs, "thickness").text(data.attrs["thickness"])
        held.append(f"rubber {thickness} thick on a rigid base")
    failed = int((data[STATUS] != CONVERGED).sum())
    count = f"{data[STATUS].size} predictions, {failed or 'none'} without a result"
    yield f"for {', '.join([*held, count])}"
    if is_estimated(data, "contact_fraction"):
        yield f"from {' × '.join(_factors(data))}"
        yield "; ".join(_rests_on(data))
    elif data.attrs.get("surface_measured") and data.attrs.get("model") == "chain":
        yield (
            "the varied input belongs to the chain only: `gripscale run` has the answer"
            if set(dimensions(data)) & set(OF_THE_CHAIN)
            else "the surface was measured: `--model direct`, the default, gives the answer"
        )
    elif data.attrs.get("model") == "direct":
        yield "no interval: the surface is too short to tell whether it stands for the whole"
    else:
        yield "no interval: no surface was measured that could judge it"


def study_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield the range of friction and contact area over a study."""
    reaches = []  # ends of axes of numbers, or how many names there are
    for axis in dimensions(data):
        text = f"{data.sizes[axis]} {axis.replace('_', ' ')}"
        if of_numbers(data, axis):
            unit = axis_shown(data, axis)
            text = least_to_most(data[axis].values, partial(unit.text, digits=3))
        elif data.sizes[axis] > 1 and axis != "effects":
            text += "s"
        reaches.append(text)
    for name in reversed(SYMBOLS):
        values = data[believed(data, name)].values
        if not (values > 0.0).any():
            continue
        detail = _model(data)
        if is_estimated(data, name):
            width = float(data[f"answer_{name}_half_width"].max())
            detail = f"answer; ± {percent_text(width)} (90 %)" if math.isfinite(width) else "answer"
        title = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"
        yield Card(title, least_to_most(values), f"{detail}; {' × '.join(reaches)}")


def course(data: xr.Dataset, name: str) -> str:
    """Return in words how `friction` or `contact_fraction` runs over the axes of a study.

    Empty where it has no value, or nothing slides.
    """
    best = believed(data, name)
    values = of_points(data, best)
    values = np.where(values > 0.0, values, np.nan)  # none at rest
    if not np.isfinite(values).any():
        return ""
    ends = [of_points(data, f"{best}_{end}") for end in ("low", "high") if f"{best}_{end}" in data]

    def number(i: int) -> str:
        interval = [significant(float(end[i])) for end in ends if math.isfinite(end[i])]
        return significant(float(values[i])) + (f" ({' to '.join(interval)})" if interval else "")

    def at(i: int) -> str:
        return f"{number(i)} at {names_at(data, every[i])}"

    title, axes = f"{HEADINGS[name]} {SYMBOLS[name]}", dimensions(data)
    every = list(places(data))
    if values.size == 1:
        return f"{title} is {number(0)}"
    if len(axes) == 1 and of_numbers(data, axes[0]):
        return f"{title} {_along(values, at)}"
    return f"{title} from {at(int(np.nanargmin(values)))} to {at(int(np.nanargmax(values)))}"


def _along(values: Array, at: Callable[[int], str]) -> str:
    """Return how a number runs over one axis of numbers: its ends, and what is beyond them."""
    there = np.flatnonzero(np.isfinite(values))
    first, last = int(there[0]), int(there[-1])
    low, high = int(np.nanargmin(values)), int(np.nanargmax(values))
    ends = values[[first, last]]
    if values[high] <= values[low] * (1.0 + _SAME):
        return f"hardly changes, from {at(low)} to {at(high)}"
    if values[high] > ends.max() * (1.0 + _SAME):
        return f"from {at(first)} by its highest, {at(high)}, to {at(last)}"
    if values[low] < ends.min() * (1.0 - _SAME):
        return f"from {at(first)} by its lowest, {at(low)}, to {at(last)}"
    return f"{'rises' if ends[1] > ends[0] else 'falls'} from {at(first)} to {at(last)}"


def _model(data: xr.Dataset) -> str:
    name = str(data.attrs.get("model", "model"))
    return _MODELS.get(name, name.replace("_", " "))


def _factors(data: xr.Dataset) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first; ranges where they vary."""
    yield _MODELS["direct"]
    for at, label in enumerate(data.factor_label.values):
        ranges = []
        for name in reversed(SYMBOLS):
            values = data[f"answer_{name}_factor"].isel(factor=at).values
            ranges.append(f"{SYMBOLS[name]} × {least_to_most(values)}")
        error = data["answer_friction_factor_uncertainty"].isel(factor=at)
        same = all(text.endswith(f"× {significant(1.0)}") for text in ranges)
        factor = f"1 ± {percent_text(float(error.max()))}" if same else ", ".join(ranges)
        yield f"{label} ({factor})"


def _rests_on(data: xr.Dataset) -> Iterator[str]:
    """Yield the largest shares of the answers that rest on what was not measured well."""
    sampling = float(data["answer_friction_sampling_error"].max())
    has_intervals = math.isfinite(sampling)
    if has_intervals:
        yield f"sampling of the surface up to ± {percent_text(sampling)} of it (standard error)"
    else:
        yield "no interval: the surface is too short to tell whether it stands for the whole"
    steep = float(data["answer_steep_share"].max())
    if steep > WORTH_NAMING:
        yield f"up to {percent_text(steep)} of the friction on slopes above 1"
    if LINES_TO_SURFACE in data.factor_label.values:
        yield ISOTROPY_ASSUMED
    if has_intervals and not {"surface", "rubber"} & set(dimensions(data)):
        yield "most of an interval is common to all points: their differences are known better"
    if AREA_TERM in data:
        term = data[AREA_TERM]
        low, high = float(term.min()), float(term.max())
        yield f"{significant(low)} to {significant(high)} of the friction is the area term"
    if has_intervals:
        yield "intervals leave out errors of the master curve"


def study_table(data: xr.Dataset) -> Table:
    """Return area, friction and status of each prediction of a study, over what was varied."""
    every = list(places(data))
    shown_places = every[:_MOST_ROWS]

    def each(name: str) -> Array:
        return of_points(data, name)[:_MOST_ROWS]

    columns = [
        Column(axis, [name_of(data, axis, at[axis]) for at in shown_places], axis.replace("_", " "))
        for axis in dimensions(data)
    ]
    keys = len(columns)
    if BEYOND_SHIFT in data:
        marks = [" *" if beyond else "" for beyond in each(BEYOND_SHIFT)]
        columns[-1] = columns[-1].of(columns[-1].values, marks=marks)
    columns += answer_columns(data, each)
    if not is_estimated(data, "friction") and "total_friction_from_dissipation" in data:
        lost = each("total_friction_from_dissipation")
        columns.append(Column("friction_from_dissipation", lost, "μ", "losses"))
    if ADHESIVE_FRICTION in data:
        term = each(believed(data, "adhesive_friction"))
        area_term = Column("area_term", term, "μ", "area term")
        if is_estimated(data, "total_friction"):  # the answer has it
            hysteresis = Column("hysteresis", each("answer_friction"), "μ", "hysteresis")
            columns += [hysteresis, area_term]
        else:
            total = term + each("total_friction")
            columns += [area_term, Column("friction_with_area_term", total, "μ", "with it")]
    if {"wavelength", "friction"} <= set(data):
        rows = (data.isel(at) for at in shown_places)
        largest = [
            float(row.wavelength[int(np.nanargmax(row.friction.values))]) if sliding else math.nan
            for row, sliding in zip(rows, each("total_friction") > 1e-9, strict=True)
        ]
        if np.isfinite(largest).any():
            text = "{:.3g}".format
            columns.append(
                Column("largest_wave", largest, "largest μ of", "mm", MILLI, format=text)
            )
    if study_sentence(data):
        shares = each(FRICTION_OUTSIDE_BAND)
        columns.append(Column("outside_band", shares, "μ", "beyond band", format=percent))
    rest = rest_name(believed(data, "contact_fraction"))
    if rest in data:
        columns.append(Column("static", each(rest), "A_r/A_0", "at rest"))
    status = [str(text) for text in each("prediction_status")]
    columns.append(Column("status", status))
    more = len(every) - len(shown_places)
    notes = [f"{more} more predictions are in the result file."] if more else []
    bad = [text != CONVERGED for text in status]
    return Table("study", columns, "Predictions of the study", notes, keys=keys, bad=bad)


def answer_columns(data: xr.Dataset, each: Callable[[str], ArrayLike]) -> Iterator[Column]:
    """Yield friction and contact area with their intervals, by the numbers of each row."""
    for name in reversed(SYMBOLS):
        column = believed(data, name)
        values = np.asarray(each(column))
        # no friction at rest is none, not zero
        yield Column(column, np.where(values == 0.0, math.nan, values), SYMBOLS[name])
        if f"{column}_low" in data and data[f"{column}_low"].notnull().any():
            ends = np.stack([each(f"{column}_{end}") for end in ("low", "high")], axis=1)
            yield Column(f"{column}_interval", ends, "90 %")


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
        if COLLAPSED[name] not in data:
            continue
        distance, attrs = float(data[COLLAPSED[name]]), data[COLLAPSED[name]].attrs
        if math.isnan(distance):
            yield (
                words,
                "cannot be compared: the temperatures do not overlap, or the speeds are too far "
                "apart to interpolate",
            )
            continue
        error = float(attrs["interpolation_error"])
        reached = (
            f"temperatures up to {percent(distance)} apart, at {attrs['points']} of "
            f"{attrs['overlapping_points']} points, where the interpolation errs by less than "
            f"{percent(error)}"
        )
        limit = f"one curve would be below {100.0 * ONE_CURVE:g} % but for errors of the mesh"
        one_curve = distance <= max(ONE_CURVE, error)
        yield words, f"one curve, {reached}" if one_curve else f"{reached}; {limit}"


def axes_table(data: xr.Dataset) -> Table:
    """Return the axes of a study with their values."""
    axes = dimensions(data)
    values = [[place_text(data, name, i) for i in range(data.sizes[name])] for name in axes]
    meanings = [str(data[name].attrs.get("long_name", name)) for name in axes]
    columns = [
        Column("axis", [name.replace("_", " ") for name in axes]),
        Column("meaning", meanings),
        Column("unit", [axis_unit(data, name) for name in axes], words=True),
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


def axis_unit(data: xr.Dataset, axis: str) -> str:
    """Return the unit in which an axis is shown, empty without one."""
    return axis_shown(data, axis).unit if of_numbers(data, axis) else ""


def totals_of(data: xr.Dataset) -> dict[str, Role]:
    """Return what there is one number or text of per prediction, best ones first."""
    roles = {name: variable.role for name, variable in per_prediction(data, dimensions(data))}
    best = (Role.ANSWER, Role.END)
    kept = [name for name, role in roles.items() if role not in (Role.EVIDENCE, Role.RECORD)]
    return {name: roles[name] for name in sorted(kept, key=lambda name: roles[name] not in best)}


def totals_table(data: xr.Dataset) -> Table | None:
    """Return all totals of all predictions that tell something; None without any."""
    totals = {name: role for name, role in totals_of(data).items() if telling(data[name])}
    if not totals:
        return None
    every = list(places(data))
    columns = [
        Column(
            axis,
            [place_text(data, axis, at[axis]) for at in every],
            label_of(data, axis),
            axis_unit(data, axis),
            words=axis in data.variables and data[axis].dtype.kind not in "fiub",
        )
        for axis in dimensions(data)
    ]
    for name in totals:
        unit = str(data[name].attrs.get("units", "")).replace("1", "")
        values = of_points(data, name).tolist()
        columns.append(Column(name, values, label_of(data, name), unit, format=digits(4)))
    states = [of_points(data, name) for name, role in totals.items() if role == Role.STATUS]
    bad = np.any([status != CONVERGED for status in states], axis=0) if states else ()
    return Table("totals", columns, f"Totals of all {len(every)} predictions", bad=bad)


def study_failures(data: xr.Dataset) -> Iterator[Failure]:
    """Yield each prediction that is not `converged`, or has a NaN total."""
    roles = totals_of(data)
    states = [name for name, role in roles.items() if role == Role.STATUS]
    totals = [name for name in roles if variable_of(data, name).measures == "contact_fraction"]
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
    labels = [label_of(data, axis) for axis in dimensions(data)]
    failed, count = len(list(study_failures(data))), len(list(places(data)))
    counts = [
        Card("Predictions", str(count), " × ".join(labels)),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]
    collapsed = [(f"{words} over a_T v", text) for words, text in collapse_sentences(data)]
    axes: list[Element] = [axes_table(data)]
    axes += [Facts("Speed and temperature", collapsed)] if collapsed else []
    totals = totals_table(data)
    return Page.of(
        f"Study: {case_title(data.attrs)}",
        f"varied: {', '.join(labels)}",
        study_findings(data),
        [*study_cards(data), *counts],
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
