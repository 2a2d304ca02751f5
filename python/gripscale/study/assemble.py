"""From the finished predictions of a study to one Dataset over the axes that were varied."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.model import (
    ADHESIVE_FRICTION,
    CUT_OFF_EXPONENTS,
    OUTSIDE_BAND,
    TOTALS,
    WHY_NO_EXPONENT,
)
from gripscale.rubber import Rubber
from gripscale.shown import GIVEN
from gripscale.study.axis import LONG_NAMES, UNITS, Axis
from gripscale.study.decades import friction_by_decade

RENAMED = {"temperature": "wave_temperature"}
"""Variables over waves that have the name of an axis."""

Index = tuple[int, ...]
Predictions = dict[Index, xr.Dataset]

OF_ALL = (
    *TOTALS,
    ADHESIVE_FRICTION,
    *OUTSIDE_BAND,
    *CUT_OFF_EXPONENTS,
    WHY_NO_EXPONENT,
    "prediction_status",
)
"""What every model says of the whole surface."""


def combined(predictions: Predictions, axes: Sequence[Axis]) -> xr.Dataset:
    """Return every number the predictions have, in total and per wave, over `axes`.

    Predictions with fewer waves, and waves after one that failed, are NaN.
    """
    kept = {index: _kept(data) for index, data in predictions.items()}
    nested: Any = np.empty(tuple(len(axis.values) for axis in axes), dtype=object)
    for index, data in kept.items():
        nested[index] = data
    names = [axis.name for axis in axes]
    together: xr.Dataset = xr.combine_nested(
        nested.tolist(),
        concat_dim=names,
        data_vars="all",
        coords="minimal",
        compat="override",
        join="outer",
        combine_attrs="override",
    )
    result: xr.Dataset = together.transpose(*names, ...).drop_attrs(deep=False)
    return result


def by_decade(
    predictions: Predictions, axes: Sequence[Axis], rubbers: dict[Index, Rubber]
) -> dict[str, xr.DataArray]:
    """Return the friction by decade of relaxation time, over `axes` and `decade`."""
    parts = {index: friction_by_decade(one, rubbers[index]) for index, one in predictions.items()}
    found = sorted({n for part in parts.values() for n in part})
    if not found:
        return {}
    decades = range(found[0], found[-1] + 1)
    values = np.full((*(len(axis.values) for axis in axes), len(decades)), np.nan)
    for index, part in parts.items():
        if part:
            values[index] = [part.get(n, 0.0) for n in decades]
    dims = (*(axis.name for axis in axes), "decade")
    array = _labelled(
        dims, values, "1", "friction coefficient by relaxation time, split as at small strain"
    )
    time = _labelled(
        "decade", [10.0**n for n in decades], "s", "shortest relaxation time of the decade"
    )
    return {"friction_by_decade": array.assign_coords(decade=time)}


def coordinates(axes: Iterable[Axis], case: str) -> dict[str, xr.DataArray]:
    """Return the coordinates of the axes of a study of this text of a case."""
    out = {}
    for axis in axes:
        values = np.array(axis.coordinate, dtype=None if axis.numeric else object)
        out[axis.name] = _labelled(
            axis.name, values, UNITS[axis.name] if axis.numeric else "1", LONG_NAMES[axis.name]
        )
        how = axis.shown(case)
        if how is not None:
            out[axis.name].attrs[GIVEN] = how.unit
        if axis.name == "factors":
            for at, name in enumerate(("s_wavelength", "s_amplitude")):
                each = [pair[at] for pair in axis.values]
                out[name] = _labelled("factors", each, "1", f"magnification factor {name}")
    return out


def _kept(data: xr.Dataset) -> xr.Dataset:
    """Return what a study keeps of a prediction: one number a wave, and what is said of all."""
    names = [
        name
        for name, variable in data.data_vars.items()
        if name in OF_ALL
        or (variable.dims == ("scale",) and np.issubdtype(variable.dtype, np.number))
    ]
    key = xr.DataArray(
        data.attrs["prediction_key"],
        attrs={"units": "1", "long_name": "name of the file the prediction is kept in"},
    )
    kept = data[names].assign(prediction_key=key).drop_encoding()
    return kept.rename({old: new for old, new in RENAMED.items() if old in kept})


def _labelled(dims: Any, values: Any, unit: str, long_name: str) -> xr.DataArray:
    return xr.DataArray(
        np.asarray(values), dims=dims, attrs={"units": unit, "long_name": long_name}
    )
