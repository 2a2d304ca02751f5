"""Friction measured elsewhere, as a comparison holds it: by temperature, and at one speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.figures.palette import INK
from gripscale.shown import shown
from gripscale.units import ZERO_CELSIUS

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
    how = shown("pressure", str(data.attrs.get("case", "")))
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
