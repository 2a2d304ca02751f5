"""What the axes of a study are called in tables and figures, in readable units."""

from __future__ import annotations

import numpy as np
import xarray as xr

LABELS = {
    "speed": (1.0, "sliding speed $v$ [m/s]", "m/s"),
    "pressure": (1e6, "nominal pressure $p$ [MPa]", "MPa"),
    "smallest_wavelength": (1e-3, "smallest wavelength [mm]", "mm"),
    "cut_off": (1e-3, "shortest wavelength of the roughness [mm]", "mm"),
    "upper_share": (1.0, "share of the heights that counts [-]", "of the heights"),
    "pressure_classes": (1.0, "number of pressure classes [-]", "pressure classes"),
    "waves": (1.0, "number of waves [-]", "waves"),
}
"""Numeric axes: what their values are divided by, the label of the axis, the unit of a value."""

WORDS = {
    "cut_off": "where the roughness ends",
    "factors": "magnification factors $s_\\lambda/s_A$",
    "rubber": "rubber",
    "surface": "surface",
}
"""Axes that may have names for values."""


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
    if not of_numbers(result, axis):
        return str(value).replace("_", " ")
    divisor, _, unit = LABELS[axis]
    return f"{value / divisor:.3g} {unit}"
