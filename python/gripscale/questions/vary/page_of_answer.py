"""The answer of a study: how friction and contact area run over what was varied, and by what."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.core.arrays import Array
from gripscale.core.finding import sentences
from gripscale.core.units import display_unit_of
from gripscale.io.table import least_to_most, significant
from gripscale.model import STATUS, input_doubts_of
from gripscale.questions.answer.estimate import AREA_TERM, ISOTROPY_ASSUMED, LINES_TO_SURFACE
from gripscale.questions.answer.reliance import WORTH_NAMING
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.vary.axis import axis_shown, dimensions, name_of, of_numbers
from gripscale.questions.vary.inputs import OF_THE_CHAIN
from gripscale.questions.words import HEADINGS, SYMBOLS, believed, is_estimated
from gripscale.report.elements import Card, percent_text

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
    status = data[STATUS]
    failed = int((status != "converged").sum())
    count = f"{status.size} predictions, {failed or 'none'} without a result"
    yield f"for {', '.join([*_held(data), count])}"
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
    for name in reversed(SYMBOLS):
        values = data[believed(data, name)].values
        if not np.isfinite(values).any() or not np.nanmax(values) > 0.0:
            continue
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        title = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"
        ends = dict.fromkeys(map(significant, (low, high)))
        yield Card(title, " to ".join(ends), _card_detail(data, name))


def course(data: xr.Dataset, name: str) -> str:
    """Return in words how `friction` or `contact_fraction` runs over the axes of a study.

    Empty where it has no value, or nothing slides.
    """
    column = believed(data, name)
    values = data[column].where(data[column] > 0.0).values  # none at rest
    if not np.isfinite(values).any():
        return ""
    title = f"{HEADINGS[name]} {SYMBOLS[name]}"
    axes = dimensions(data)
    if values.size == 1:
        return f"{title} is {_number(data, name, (0,) * values.ndim)}"
    if len(axes) > 1 or not of_numbers(data, axes[0]):
        shape = values.shape
        low, high = (
            tuple(int(i) for i in np.unravel_index(int(pick(values)), shape))
            for pick in (np.nanargmin, np.nanargmax)
        )
        return f"{title} from {_at(data, name, low)} to {_at(data, name, high)}"
    return f"{title} {_along(data, name, values)}"


def _along(data: xr.Dataset, name: str, values: Array) -> str:
    """Return how a number runs over one axis of numbers: its ends, and what is beyond them."""
    there = np.flatnonzero(np.isfinite(values))
    first, last = int(there[0]), int(there[-1])
    low, high = (int(pick(values)) for pick in (np.nanargmin, np.nanargmax))
    ends = values[[first, last]]
    start, end = (_at(data, name, (i,)) for i in (first, last))
    if values[high] <= values[low] * (1.0 + _SAME):
        return f"hardly changes, from {_at(data, name, (low,))} to {_at(data, name, (high,))}"
    for extreme, word, beyond in (
        (high, "highest", values[high] > ends.max() * (1.0 + _SAME)),
        (low, "lowest", values[low] < ends.min() * (1.0 - _SAME)),
    ):
        if beyond:
            return f"from {start} by its {word}, {_at(data, name, (extreme,))}, to {end}"
    return f"{'rises' if ends[1] > ends[0] else 'falls'} from {start} to {end}"


def _number(data: xr.Dataset, name: str, index: tuple[int, ...]) -> str:
    """Return a number with its interval, such as `0.19 (0.15 to 0.23)`."""
    column = believed(data, name)
    text = significant(float(data[column].values[index]))
    if f"{column}_low" not in data:
        return text
    low, high = (float(data[f"{column}_{end}"].values[index]) for end in ("low", "high"))
    return text if math.isnan(low) else f"{text} ({significant(low)} to {significant(high)})"


def _at(data: xr.Dataset, name: str, index: tuple[int, ...]) -> str:
    places = (
        name_of(data, axis, int(i)) if axis in data.coords else f"{axis} {int(i) + 1}"
        for axis, i in zip(dimensions(data), index, strict=True)
    )
    return f"{_number(data, name, index)} at {', '.join(places)}"


def _model(data: xr.Dataset) -> str:
    name = str(data.attrs.get("model", "model"))
    return _MODELS.get(name, name.replace("_", " "))


def _held(data: xr.Dataset) -> Iterator[str]:
    """Yield the load and the cut-off that were not varied."""
    for name in ("pressure", "speed"):
        if name not in dimensions(data) and f"nominal_{name}" in data.attrs:
            value = float(data.attrs[f"nominal_{name}"])
            yield display_unit_of(data.attrs, name).text(value)
    ends = [float(data[name]) for name in ("cutoff_wavelength", CONTINUED_TO) if name in data]
    if ends:
        yield f"roughness down to {1e3 * min(ends):.3g} mm"
    if "thickness" in data.attrs and "thickness" not in data.dims:
        thickness = display_unit_of(data.attrs, "thickness").text(data.attrs["thickness"])
        yield f"rubber {thickness} thick on a rigid base"


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


def _card_detail(data: xr.Dataset, name: str) -> str:
    """Return over what a range of answers is, and its widest interval."""
    axes = dimensions(data)
    over = " × ".join(_reach(data, axis) for axis in axes)
    if not is_estimated(data, name):
        return f"{_model(data)}; {over}"
    width = float(data[f"answer_{name}_half_width"].max())
    interval = f"; ± {percent_text(width)} (90 %)" if math.isfinite(width) else ""
    return f"answer{interval}; {over}"


def _reach(data: xr.Dataset, axis: str) -> str:
    """Return the ends of an axis of numbers, or how many names it has."""
    if not of_numbers(data, axis):
        count = data.sizes[axis]
        return f"{count} {axis.replace('_', ' ')}{'s' if count > 1 and axis != 'effects' else ''}"
    unit, values = axis_shown(data, axis), data[axis].values
    ends = dict.fromkeys(unit.text(float(value), 3) for value in (values.min(), values.max()))
    return " to ".join(ends)
