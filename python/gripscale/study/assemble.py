"""From the finished chains of a study to one Dataset over the axes that were varied."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.rubber import Rubber
from gripscale.study.axes import LONG_NAMES, UNITS, Axis
from gripscale.study.decades import friction_by_decade

Index = tuple[int, ...]
Cells = dict[Index, xr.Dataset]

TOTALS = {
    "total_contact_fraction": ("contact_fraction", "real over nominal contact area, all waves"),
    "total_friction": ("friction", "friction coefficient, all waves"),
    "total_friction_from_dissipation": (
        "friction_from_dissipation",
        "friction coefficient from the energy lost in the rubber, all waves",
    ),
}
"""Names of the totals, with the attribute of one chain they come from."""


def per_wave(cells: Cells, axes: Sequence[Axis]) -> dict[str, xr.DataArray]:
    """Return every number the chains have per wave, over `axes` and `scale`.

    Chains with fewer waves, and waves after one that failed, are NaN.
    """
    shape = tuple(len(axis.values) for axis in axes)
    dims = (*(axis.name for axis in axes), "scale")
    names = dict.fromkeys(name for cell in cells.values() for name in wave_numbers(cell))
    waves = max((cell.sizes["scale"] for cell in cells.values()), default=0)
    out = {}
    for name in names:
        values = np.full((*shape, waves), math.nan)
        attrs: dict[str, Any] = {}
        for index, cell in cells.items():
            if name in cell:
                values[index][: cell.sizes["scale"]] = cell[name].values
                attrs = attrs or dict(cell[name].attrs)
        out[name] = xr.DataArray(values, dims=dims, attrs=attrs)
    return out


def totals(cells: Cells, axes: Sequence[Axis]) -> dict[str, xr.DataArray]:
    """Return area, friction, status and key of each chain, over `axes`."""
    shape = tuple(len(axis.values) for axis in axes)
    dims = tuple(axis.name for axis in axes)
    out = {}
    for name, (attribute, long_name) in TOTALS.items():
        values = np.full(shape, math.nan)
        for index, cell in cells.items():
            values[index] = cell.attrs[attribute]
        out[name] = _labelled(dims, values, long_name)
    for name, attribute, long_name in (
        ("case_status", "case_status", "converged, or why not"),
        ("case_key", "case_key", "name of the file the chain is kept in"),
    ):
        texts = np.full(shape, "", dtype=object)
        for index, cell in cells.items():
            texts[index] = cell.attrs[attribute]
        out[name] = _labelled(dims, texts, long_name)
    return out


def by_decade(
    cells: Cells, axes: Sequence[Axis], rubbers: dict[Index, Rubber]
) -> dict[str, xr.DataArray]:
    """Return the friction by decade of relaxation time, over `axes` and `decade`."""
    parts = {index: friction_by_decade(cell, rubbers[index]) for index, cell in cells.items()}
    found = sorted({n for part in parts.values() for n in part})
    if not found:
        return {}
    decades = range(found[0], found[-1] + 1)
    values = np.full((*(len(axis.values) for axis in axes), len(decades)), math.nan)
    for index, part in parts.items():
        if part:
            values[index] = [part.get(n, 0.0) for n in decades]
    dims = (*(axis.name for axis in axes), "decade")
    array = _labelled(
        dims, values, "friction coefficient by relaxation time, split as at small strain"
    )
    time = xr.DataArray(
        [10.0**n for n in decades],
        dims="decade",
        attrs={"units": "s", "long_name": "shortest relaxation time of the decade"},
    )
    return {"friction_by_decade": array.assign_coords(decade=time)}


def coordinates(axes: Iterable[Axis], waves: int) -> dict[str, xr.DataArray]:
    """Return the coordinates of the axes and of the waves."""
    out = {"scale": _labelled("scale", np.arange(1, waves + 1), "number of the wave")}
    for axis in axes:
        values = np.array(axis.coordinate, dtype=None if axis.numeric else object)
        attrs = {"units": UNITS[axis.name], "long_name": LONG_NAMES[axis.name]}
        out[axis.name] = xr.DataArray(values, dims=axis.name, attrs=attrs)
        if axis.name == "factors":
            for at, name in enumerate(("s_wavelength", "s_amplitude")):
                each = np.array([pair[at] for pair in axis.values])
                out[name] = _labelled("factors", each, f"magnification factor {name}")
    return out


def wave_numbers(cell: xr.Dataset) -> list[str]:
    """Return the names of what a chain has one number of per wave."""
    return [
        str(name)
        for name, variable in cell.data_vars.items()
        if variable.dims == ("scale",) and np.issubdtype(variable.dtype, np.number)
    ]


def _labelled(dims: Any, values: Any, long_name: str) -> xr.DataArray:
    return xr.DataArray(values, dims=dims, attrs={"units": "1", "long_name": long_name})
