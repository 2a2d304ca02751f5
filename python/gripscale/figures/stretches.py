"""Which parts of a curve rest on the rubber beyond its measured band, on paper and on pages.

They are drawn dashed. Needs no drawing library.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.rubber.extrapolation import WORTH_SAYING

BEYOND = "beyond the measured band"
"""What a dashed line is, in legends."""
BEYOND_BESIDE = "beyond the\nmeasured band"
"""The same in a legend beside panels."""
FLAG = "outside_band"

Flags = NDArray[np.bool_]


def stretches(beyond: ArrayLike) -> Iterator[tuple[slice, bool]]:
    """Yield runs of points that are joined in one way, and whether that is beyond the band.

    A line is beyond the band if one of its ends is; neighbouring runs share a point.
    """
    flags = np.asarray(beyond, dtype=bool)
    joined = flags[1:] | flags[:-1]
    if not joined.size:
        yield slice(0, flags.size), bool(flags.any())
        return
    changes = [0, *(np.flatnonzero(np.diff(joined)) + 1), joined.size]
    for first, last in pairwise(changes):
        yield slice(int(first), int(last) + 1), bool(joined[first])


def predictions_beyond(data: xr.Dataset) -> Flags:
    """Return for each prediction whether some of its friction rests on extrapolation."""
    if FRICTION_OUTSIDE_BAND not in data:
        return np.zeros(data["total_friction"].shape, dtype=bool)
    return np.asarray(data[FRICTION_OUTSIDE_BAND] > WORTH_SAYING)


def waves_beyond(data: xr.Dataset) -> Flags:
    """Return for each wave whether it excites the rubber beyond the band."""
    if FLAG not in data:
        return np.zeros(data["wavelength"].shape, dtype=bool)
    return np.asarray(data[FLAG] == 1.0)


def down_to(beyond: ArrayLike) -> Flags:
    """Return for what is summed up over waves whether one of them so far is beyond the band."""
    return np.asarray(np.logical_or.accumulate(np.asarray(beyond, dtype=bool)))
