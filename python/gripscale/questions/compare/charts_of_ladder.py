"""What comparisons show: the look of each model, rows of the ladder, measured friction."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.charts import style
from gripscale.charts.chart import Series
from gripscale.charts.style import GREY, INK, ORANGE
from gripscale.core.units import DisplayUnit
from gripscale.experiment.measured_friction import measured_series
from gripscale.half_space.model import DirectContact
from gripscale.questions.answer.intervals import UPPER_LIMITS
from gripscale.questions.answer.variables import answer_number
from gripscale.questions.view import STAR

ASIDE = ("windows",)  # groups of other surfaces, which only give factors of the answer
# Share of friction or area from which on a wavelength is drawn: longer waves do nothing.
SEEN = 0.01


def flawed(comparison: xr.Dataset) -> NDArray[np.bool_]:
    """Return whether a sample of each model failed."""
    return np.asarray((comparison["converged_samples"] < comparison["samples"]).values)


def varied(comparison: xr.Dataset) -> str:
    """Return the axis of a comparison, or an empty text if nothing was varied."""
    return next((str(dim) for dim in comparison.total_friction.dims if dim != "model"), "")


def worth_drawing(comparison: xr.Dataset) -> NDArray[np.bool_]:
    """Return for each octave whether a model has friction or lost area down to it."""
    friction, area = comparison.running_friction, comparison.running_contact_fraction
    if not friction.size:  # maps and windows at finite strain have no octaves
        return np.zeros(0, dtype=np.bool_)
    begun = np.abs(friction) > SEEN * np.abs(friction).max("wavelength")
    return np.asarray((begun | (area < 1.0 - SEEN)).any("model").values)


def on_the_surface(comparison: xr.Dataset) -> xr.Dataset:
    """Return the comparison without the models of other surfaces, unless it has no others."""
    chosen = [str(group) not in ASIDE for group in comparison.group.values]
    return comparison.isel(model=chosen) if any(chosen) else comparison


def by_label(comparison: xr.Dataset) -> xr.Dataset:
    """Return the models called by what figures and texts call them."""
    return comparison.assign_coords(model=("model", comparison["label"].values))


MARKERS = "osD^v"  # of measurements at several temperatures or pressures


def measured_points(data: xr.Dataset, speed_unit: DisplayUnit) -> Iterator[Series]:
    """Yield the points of each measured series over speed, in `speed_unit`, with their spread."""
    for number, series in enumerate(measured_series(data)):
        spread = np.nan_to_num(series.spread)
        ends: dict[str, Any] = {"low": series.friction - spread, "high": series.friction + spread}
        yield Series(speed_unit.of(series.speed), series.friction, INK, series.label, "",
                     marker=MARKERS[number % len(MARKERS)], size=5.5, filled=False, order=5.0,
                     clip=False, **ends)  # fmt: skip


BEST = "answer"


@dataclass(frozen=True)
class Row:
    """A line of the figure: a number, and the bar from the number it follows."""

    label: str
    value: float
    uncertainty: float = math.nan
    before: float = math.nan  # where the bar begins; NaN for none
    factor: float = math.nan
    samples: tuple[float, ...] = ()
    marker: str = "o"
    colour: str = INK
    filled: bool = True
    note: str = ""  # said in place of a number there is not
    most: float = math.inf  # upper limit of the number, where it has one

    @property
    def ends(self) -> tuple[float, float]:
        """The number less and plus one standard uncertainty; NaN where that is unknown."""
        spread = math.exp(self.uncertainty)
        return self.value / spread, min(self.value * spread, self.most)

    @property
    def numbers(self) -> list[float]:
        """All that is drawn on the line."""
        numbers = (self.value, self.before, *self.samples, *self.ends)
        return [number for number in numbers if math.isfinite(number)]


def rows_of(comparison: xr.Dataset, name: str) -> Iterator[Row]:
    """Yield the lines of one panel; both panels have the same."""
    for row in _rows(comparison, name):
        yield replace(row, most=UPPER_LIMITS.get(name, math.inf))


def _rows(comparison: xr.Dataset, name: str) -> Iterator[Row]:
    comparison = on_the_surface(comparison)
    totals = comparison[f"total_{name}"].values.tolist()
    values = dict(zip(comparison.model.values, totals, strict=True))
    for at, (member, bad) in enumerate(zip(values, flawed(comparison), strict=True)):
        solved = comparison.isel(model=at)
        theory, judge = str(solved.group.item()) == "theory", member == DirectContact.name
        samples = solved[f"sample_{name}"].values
        star = STAR if style.predictions_beyond(solved) else ""
        yield Row(
            f"{solved.label.item()}{star}",
            values[member],
            float(solved[f"{name}_uncertainty"]),
            math.nan if theory else values.get(str(solved.follows.item()), math.nan),
            float(solved[f"{name}_factor"]),
            tuple(samples[np.isfinite(samples)].tolist()) if int(solved.samples) > 1 else (),
            marker="D" if judge else "s" if theory else "o",
            colour=GREY if theory else ORANGE if judge else INK,
            filled=not bad,
            note="failed" if math.isnan(values[member]) and not theory else "none",
        )
    yield from _best(comparison, name, values.get(DirectContact.name, math.nan))
    for series in measured_series(comparison):
        point = series.at(float(comparison.nominal_speed)) if name == "friction" else None
        if point is None:
            note = "not at this speed" if name == "friction" else "–"
            yield Row(series.label, math.nan, note=note)
        else:
            friction, spread = point
            yield Row(series.label, friction, spread / friction, marker="P", colour=INK)


def _best(comparison: xr.Dataset, name: str, value: float) -> Iterator[Row]:
    """Yield the factors of the answer, and the answer itself where it has any."""
    factors = comparison[f"answer_{name}_factor"].values
    if not math.isfinite(float(comparison[f"answer_{name}"])):
        return
    for at, factor in enumerate(factors):
        label = f"× {comparison.factor_label.values[at]}"
        if not math.isfinite(factor):
            yield Row(label, math.nan, note="not included")
            continue
        sigma = float(comparison[f"answer_{name}_factor_uncertainty"][at])
        yield Row(label, value * factor, sigma, value, factor)
        value *= factor
    if np.isfinite(factors).any():
        answer = answer_number(comparison, name)
        width = math.log(answer.value / answer.low) if answer.value > 0.0 else math.nan
        yield Row(BEST, answer.value, width, marker="*", colour=ORANGE)
