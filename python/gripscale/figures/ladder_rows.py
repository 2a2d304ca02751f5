"""The lines of the ladder of a comparison, on paper and on pages; needs no drawing library."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import xarray as xr

from gripscale.figures.measured import COLOUR, measured
from gripscale.figures.palette import GREY, INK, ORANGE
from gripscale.figures.rungs import JUDGE, flawed, on_the_surface
from gripscale.figures.stretches import predictions_beyond

BEST = "best estimate"
STAR = " *"
"""Behind the label of a rung whose friction rests partly on the rubber beyond its measured band."""


@dataclass(frozen=True)
class Row:
    """A line of the figure: a number, and the bar from the number it follows."""

    label: str
    value: float
    uncertainty: float = math.nan
    before: float = math.nan
    """Where the bar begins; NaN for none."""
    factor: float = math.nan
    samples: tuple[float, ...] = ()
    marker: str = "o"
    colour: str = INK
    filled: bool = True
    note: str = ""
    """Said in place of a number there is not."""

    @property
    def ends(self) -> tuple[float, float]:
        """The number less and plus one standard uncertainty; NaN where that is unknown."""
        spread = math.exp(self.uncertainty)
        return self.value / spread, self.value * spread


def rows_of(comparison: xr.Dataset, name: str) -> Iterator[Row]:
    """Yield the lines of one panel; both panels have the same."""
    comparison = on_the_surface(comparison)
    values = dict(
        zip(comparison.rung.values, comparison[f"total_{name}"].values.tolist(), strict=True)
    )
    for at, (rung, bad) in enumerate(zip(values, flawed(comparison), strict=True)):
        one = comparison.isel(rung=at)
        theory, judge = str(one.group.item()) == "theory", rung == JUDGE
        samples = one[f"sample_{name}"].values
        star = STAR if predictions_beyond(one) else ""
        yield Row(
            f"{one.label.item()}{star}",
            values[rung],
            float(one[f"{name}_uncertainty"]),
            math.nan if theory else values.get(str(one.follows.item()), math.nan),
            float(one[f"{name}_factor"]),
            tuple(samples[np.isfinite(samples)].tolist()) if int(one.samples) > 1 else (),
            marker="D" if judge else "s" if theory else "o",
            colour=GREY if theory else ORANGE if judge else INK,
            filled=not bad,
            note="failed" if math.isnan(values[rung]) and not theory else "none",
        )
    yield from _best(comparison, name, values.get(JUDGE, math.nan))
    yield from _measured(comparison, name)


def _best(comparison: xr.Dataset, name: str, value: float) -> Iterator[Row]:
    """Yield the factors of the best estimate, and the estimate where it differs from its base."""
    factors = comparison[f"best_{name}_factor"].values
    if not math.isfinite(float(comparison[f"best_{name}"])):
        return
    for at, factor in enumerate(factors):
        label = f"× {comparison.factor_label.values[at]}"
        if not math.isfinite(factor):
            yield Row(label, math.nan, note="not included")
            continue
        sigma = float(comparison[f"best_{name}_factor_uncertainty"][at])
        yield Row(label, value * factor, sigma, value, factor)
        value *= factor
    if np.isfinite(factors).any():
        best = float(comparison[f"best_{name}"])
        sigma = float(comparison[f"best_{name}_uncertainty"])
        yield Row(BEST, best, sigma, marker="*", colour=ORANGE)


def _measured(comparison: xr.Dataset, name: str) -> Iterator[Row]:
    """Yield the measured friction at the speed of the comparison, by temperature."""
    for series in measured(comparison):
        found = series.at(float(comparison.nominal_speed)) if name == "friction" else None
        if found is None:
            note = "not at this speed" if name == "friction" else "–"
            yield Row(series.label, math.nan, note=note)
        else:
            friction, spread = found
            yield Row(series.label, friction, spread / friction, marker="P", colour=COLOUR)
