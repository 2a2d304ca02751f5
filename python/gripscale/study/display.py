"""What the axes of a study are called in tables and figures, in readable units."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gripscale.units import ZERO_CELSIUS


class Shown(NamedTuple):
    """How a numeric axis is shown."""

    divisor: float
    """Size of the unit in SI units."""
    label: str
    """Of the axis, with the unit."""
    unit: str
    zero: float = 0.0
    """Where the unit begins to count, in SI units."""

    def of(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return values in SI units as they are shown."""
        return (np.asarray(values, dtype=float) - self.zero) / self.divisor


LABELS = {
    "speed": Shown(1.0, "sliding speed $v$ [m/s]", "m/s"),
    "pressure": Shown(1e6, "nominal pressure $p$ [MPa]", "MPa"),
    "temperature": Shown(1.0, "temperature $T$ [°C]", "°C", ZERO_CELSIUS),
    "smallest_wavelength": Shown(1e-3, "smallest wavelength [mm]", "mm"),
    "cut_off": Shown(1e-3, "shortest wavelength of the roughness [mm]", "mm"),
    "upper_share": Shown(1.0, "share of the heights that counts [-]", "of the heights"),
    "pressure_classes": Shown(1.0, "number of pressure classes [-]", "pressure classes"),
    "waves": Shown(1.0, "number of waves [-]", "waves"),
}
"""Numeric axes by name."""

WORDS = {
    "cut_off": "where the roughness ends",
    "effects": "effects",
    "factors": "magnification factors $s_\\lambda/s_A$",
    "rubber": "rubber",
    "surface": "surface",
}
"""Axes that may have names for values."""

MODELS = {"chain": "chain", "direct": "direct contact"}
"""What models that know effects are called."""

EFFECTS = {"all": "all effects", "none": "no effects"}
"""What selections of effects are called where nothing else says what they are of."""


def dimensions(result: xr.Dataset) -> list[str]:
    """Return the axes that were varied, in order."""
    return [str(name) for name in result.total_friction.dims]


def numeric(result: xr.Dataset) -> list[str]:
    """Return the varied axes of numbers with at least two values, longest first."""
    found = [n for n in dimensions(result) if result.sizes[n] > 1 and of_numbers(result, n)]
    return sorted(found, key=lambda name: -result.sizes[name])


def of_numbers(result: xr.Dataset, axis: str) -> bool:
    """Return whether an axis has numbers for values; a cut-off may be a rule in words."""
    return axis in LABELS and bool(np.issubdtype(result[axis].dtype, np.number))


def name_of(result: xr.Dataset, axis: str, i: int) -> str:
    """Return what value `i` of an axis is called, with its unit."""
    value = result[axis].values[i]
    if axis == "effects":
        return EFFECTS.get(str(value), str(value))
    if not of_numbers(result, axis):
        return str(value).replace("_", " ")
    shown = LABELS[axis]
    return f"{float(shown.of(value)):.3g} {shown.unit}"
