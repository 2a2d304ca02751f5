"""The types of arrays that all packages hand to one another, and runs of marks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
AnyComplexArray = NDArray[np.complexfloating]
Mask = NDArray[np.bool_]

# Quantities beyond these are mistakes; within them no square or product of two overflows.
LEAST, MOST = 1e-100, 1e100

if TYPE_CHECKING:
    Quantity = float | Any

    class Vector:
        """Type of a checked field that is given as anything array-like and read as an array."""

        def __get__(self, instance: object, owner: type) -> Array: ...
        def __set__(self, instance: object, value: ArrayLike | None) -> None: ...
else:
    Quantity = float | str
    """A number in the SI unit, or a text with its unit such as "3 bar"."""
    Vector = Array


def runs(marked: Mask) -> list[tuple[int, int]]:
    """Return where each run of marks begins and ends, the end not included."""
    ends = np.flatnonzero(np.diff(np.concatenate(([0], marked.astype(np.int8), [0])))).tolist()
    return list(zip(ends[::2], ends[1::2], strict=True))


def labelled(dims: Any, values: Any, unit: str, long_name: str, source: str) -> xr.Variable:
    """Return `values` as a variable with the attributes that every result has."""
    import xarray as xr

    attrs = {"units": unit, "long_name": long_name, "source": source}
    return xr.Variable(dims, np.asarray(values), attrs)
