"""Predictions side by side: what differs from the first of them, and the range of that.

With the totals X of each between low and high, all independent of each other, a difference to the
first is between low - high of the first, and high - low of the first.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr

from gripscale.errors import InputError

FEWEST, MOST = 2, 6
TOTALS = ("total_friction", "total_contact_fraction")


def require_some(name: str, given: Mapping[str, Any], what: str) -> None:
    """Raise `InputError` unless there are two to six things to be compared."""
    if not FEWEST <= len(given) <= MOST:
        raise InputError(
            f"{name} must be {FEWEST} to {MOST} {what} to be compared; got {len(given)}"
        )


def total_differences(data: xr.Dataset, dim: str) -> dict[str, xr.DataArray]:
    """Return `total_friction_difference` and so on to the first along `dim`.

    With its `_low` and `_high` where `data` has those of the totals.
    """
    out = {}
    for quantity in TOTALS:
        what = f"difference to the first, {data[quantity].attrs['long_name']}"
        out[f"{quantity}_difference"] = to_first(data[quantity], dim, what)
        if f"{quantity}_low" not in data:
            continue
        low, high = (data[f"{quantity}_{end}"] for end in ("low", "high"))
        first = xr.zeros_like(data[dim], dtype=bool)
        first[0] = True
        for end, ends in (("low", low - high.isel({dim: 0})), ("high", high - low.isel({dim: 0}))):
            name = f"{quantity}_difference_{end}"
            out[name] = ends.where(~first, 0.0).assign_attrs(attributes(f"{end}est {what}"))
    return out


def to_first(values: xr.DataArray, dim: str, long_name: str) -> xr.DataArray:
    """Return the difference of `values` [-] to the first along `dim`."""
    return (values - values.isel({dim: 0}, drop=True)).assign_attrs(attributes(long_name))


def ranges(
    data: xr.Dataset, dims: Sequence[str], ends: Mapping[str, Any], text: str
) -> dict[str, Any]:
    """Return `total_friction_low` and so on: totals times the `ends` of each, low and high."""
    return {
        f"{quantity}_{end}": (
            tuple(dims),
            data[quantity].values * factor,
            attributes(f"{end}est {data[quantity].attrs['long_name']} {text}"),
        )
        for quantity, (low, high) in ends.items()
        for end, factor in (("low", low), ("high", high))
    }


def attributes(long_name: str) -> dict[str, str]:
    """Return the attributes of a number without unit."""
    return {"units": "1", "long_name": long_name}
