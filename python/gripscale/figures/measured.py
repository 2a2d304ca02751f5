"""Friction measured elsewhere, as a comparison holds it: by temperature, and at one speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.figures.palette import INK
from gripscale.units import ZERO_CELSIUS

COLOUR = INK
"""Of everything measured."""

Array = NDArray[np.float64]


class Series(NamedTuple):
    """Measured friction at one temperature over rising speed [m/s]; spreads may be NaN."""

    label: str
    speed: Array
    friction: Array
    spread: Array

    def at(self, speed: float) -> tuple[float, float] | None:
        """Return friction and spread at `speed`, interpolated in its logarithm; None outside."""
        if not self.speed[0] <= speed <= self.speed[-1]:
            return None
        place, at = np.log(self.speed), math.log(speed)
        return float(np.interp(at, place, self.friction)), float(np.interp(at, place, self.spread))


def measured(comparison: xr.Dataset) -> Iterator[Series]:
    """Yield what was measured at each temperature, to the kelvin; nothing without a measurement."""
    if "measured_friction" not in comparison:
        return
    kelvin = np.round(comparison.measured_temperature.values)
    for value in np.unique(kelvin):
        unknown = bool(np.isnan(value))
        chosen = np.isnan(kelvin) if unknown else kelvin == value
        label = "measured" if unknown else f"measured, {value - ZERO_CELSIUS:.0f} °C"
        columns = (comparison[f"measured_{n}"].values for n in ("speed", "friction", "spread"))
        yield Series(label, *(column[chosen] for column in columns))
