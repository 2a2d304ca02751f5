"""Variables of results with their unit, meaning and source."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr


def labelled(dims: Any, values: Any, unit: str, long_name: str, source: str) -> xr.Variable:
    """Return `values` as a variable with the attributes that every result has."""
    import xarray as xr

    attrs = {"units": unit, "long_name": long_name, "source": source}
    return xr.Variable(dims, np.asarray(values), attrs)
