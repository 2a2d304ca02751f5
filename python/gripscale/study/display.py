"""What the axes of a study are called in tables and figures, in readable units."""

from __future__ import annotations

import numpy as np
import xarray as xr

from gripscale.shown import GIVEN, KEYS, Shown, shown
from gripscale.units import ZERO_CELSIUS

LABELS = {
    "speed": "sliding speed $v$",
    "pressure": "nominal pressure $p$",
    "temperature": "temperature $T$",
    "smallest_wavelength": "smallest wavelength",
    "cut_off": "shortest wavelength of the roughness",
    "upper_share": "share of the heights that counts",
    "pressure_classes": "number of pressure classes",
    "waves": "number of waves",
}
"""Numeric axes by name, and what they are called."""

FIXED = {
    "temperature": Shown("°C", zero=ZERO_CELSIUS),
    "upper_share": Shown("of the heights"),
    "pressure_classes": Shown("pressure classes"),
    "waves": Shown("waves"),
}
"""Numeric axes that are shown in one way whatever was given, and their units in words."""

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


def axis_shown(result: xr.Dataset | xr.DataArray, axis: str) -> Shown:
    """Return how the values of a numeric axis are shown: in the unit they were given in."""
    return FIXED[axis] if axis in FIXED else shown(axis, unit=_given(result, axis))


def axis_label(result: xr.Dataset, axis: str) -> str:
    """Return what a figure calls a numeric axis, with its unit."""
    unit = axis_shown(result, axis).unit if axis in (*KEYS, "temperature") else "-"
    return f"{LABELS[axis]} [{unit}]"


def _given(result: xr.Dataset | xr.DataArray, axis: str) -> str:
    """Return the unit of an axis; of one that was not varied, that of the case."""
    return str(result[axis].attrs.get(GIVEN, "")) if axis in result.coords else ""


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
    return axis_shown(result, axis).text(value, digits=3)
