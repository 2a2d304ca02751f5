"""The lines of the ladder of a comparison, on paper and on pages; needs no drawing library."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.charts.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PURPLE,
    SKY,
    YELLOW,
    predictions_beyond,
)
from gripscale.core.units import ZERO_CELSIUS, display_unit

# How the rungs of a comparison look, on paper and on pages; needs no drawing library.
#
# A rung is told from the others by marker as well as by colour. Its own line is solid or dotted:
# dashed is what rests on the rubber beyond its measured band.

JUDGE = "direct"
"""The rung the others are judged by."""
ASIDE = ("windows", "map")
"""Groups of other surfaces, which only give the factors of the best estimate."""
SEEN = 0.01
"""Share of friction or area from which on a wavelength is drawn: longer waves do nothing."""


class Look(NamedTuple):
    """Colour, dash and marker of a rung; the words are those of matplotlib and of Bokeh."""

    colour: str
    dash: str
    marker: str
    bokeh_marker: str


_LOOKS = {
    "chain": Look(BLUE, "solid", "o", "circle"),
    "chain_half_plane": Look(SKY, "solid", "s", "square"),
    "chain_upper": Look(SKY, "dotted", "<", "hex"),
    "sines": Look(GREEN, "solid", "^", "triangle"),
    "random_phases": Look(PURPLE, "solid", "v", "inverted_triangle"),
    JUDGE: Look(ORANGE, "solid", "D", "diamond"),
    "persson": Look(GREY, "dotted", "P", "plus"),
    "klueppel_heinrich": Look(YELLOW, "dotted", "X", "x"),
}
_OTHERS = (
    Look(YELLOW, "solid", "d", "diamond_cross"),
    Look(YELLOW, "dotted", ">", "star"),
    Look(INK, "solid", "h", "square_pin"),
    Look(GREY, "dotted", "p", "triangle_pin"),
)
"""For rungs that have no look of their own, in turn."""


def look_of(rung: str) -> Look:
    """Return the look of a rung of its own, or of a stranger."""
    return _LOOKS.get(rung) or _OTHERS[0]


def looks(comparison: xr.Dataset) -> list[tuple[str, Look]]:
    """Return name and look of each rung, in order."""
    names = [str(name) for name in comparison["rung"].values]
    strangers = [name for name in names if name not in _LOOKS]
    return [
        (name, _LOOKS.get(name) or _OTHERS[strangers.index(name) % len(_OTHERS)]) for name in names
    ]


def flawed(comparison: xr.Dataset) -> list[bool]:
    """Return for each rung whether a sample of it failed."""
    counts = comparison["converged_samples"] < comparison["samples"]
    return [bool(one) for one in counts.values]


def varied(comparison: xr.Dataset) -> str:
    """Return the axis of a comparison, or an empty text if nothing was varied."""
    return next((str(dim) for dim in comparison.total_friction.dims if dim != "rung"), "")


def worth_drawing(comparison: xr.Dataset) -> NDArray[np.bool_]:
    """Return for each octave whether a rung has friction or lost area down to it."""
    friction, area = comparison.running_friction, comparison.running_contact_fraction
    begun = np.abs(friction) > SEEN * np.abs(friction).max("wavelength")
    return np.asarray((begun | (area < 1.0 - SEEN)).any("rung").values)


def on_the_surface(comparison: xr.Dataset) -> xr.Dataset:
    """Return the comparison without the rungs that are not of the surface itself."""
    return comparison.isel(rung=[str(group) not in ASIDE for group in comparison.group.values])


# Friction measured elsewhere, as a comparison holds it: by temperature, and at one speed.

COLOUR = INK
"""Of everything measured."""

Array = NDArray[np.float64]


class Series(NamedTuple):
    """Measured friction at one temperature and pressure over rising speed [m/s].

    Spreads may be NaN.
    """

    label: str
    speed: Array
    friction: Array
    spread: Array
    chosen: NDArray[np.bool_]
    """Which points of the measurement these are."""

    def at(self, speed: float) -> tuple[float, float] | None:
        """Return friction and spread at `speed`, interpolated in its logarithm; None outside."""
        if not self.speed[0] <= speed <= self.speed[-1]:
            return None
        place, at = np.log(self.speed), math.log(speed)
        return float(np.interp(at, place, self.friction)), float(np.interp(at, place, self.spread))


def measured(data: xr.Dataset) -> Iterator[Series]:
    """Yield what was measured at each temperature, to the kelvin, and each pressure.

    Nothing without a measurement.
    """
    if "measured_friction" not in data:
        return
    kelvin = np.round(data.measured_temperature.values)
    unknown = np.full(kelvin.size, np.nan)
    pascal = data.measured_pressure.values if "measured_pressure" in data else unknown
    several = np.unique(pascal).size > 1
    how = display_unit("pressure", data.attrs)
    for value in np.unique(kelvin):
        for load in np.unique(pascal):
            chosen = _same(kelvin, value) & _same(pascal, load)
            if chosen.any():
                pressure = how.text(float(load), 3) if several and not np.isnan(load) else ""
                parts = ["measured", *_words(float(value), pressure)]
                speed, friction, spread = (
                    data[f"measured_{name}"].values[chosen]
                    for name in ("speed", "friction", "spread")
                )
                yield Series(", ".join(parts), speed, friction, spread, chosen)


def _same(values: Array, value: float) -> NDArray[np.bool_]:
    return np.isnan(values) if np.isnan(value) else values == value


def _words(kelvin: float, pressure: str) -> Iterator[str]:
    if not math.isnan(kelvin):
        yield f"{kelvin - ZERO_CELSIUS:.0f} °C"
    if pressure:
        yield pressure


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
