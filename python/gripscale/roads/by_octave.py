"""Friction by octaves of wavelength that are the same for every model and road.

Between the waves of a chain, and within the octaves of a direct contact, the friction of all longer
waves is taken to be linear in the logarithm of the wavelength, as frictions add.
"""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]


def octave_ends(longest: float, shortest: float) -> Array:
    """Return the lower ends of octaves [m] from `longest` to `shortest`: powers of two of 1 mm."""
    first, last = np.ceil(np.log2(longest / 1e-3)), np.floor(np.log2(shortest / 1e-3))
    return np.asarray(1e-3 * 2.0 ** np.arange(first, last - 1.0, -1.0))


def running_friction(answer: xr.Dataset, ends: Array) -> Array:
    """Return the friction [-] of all waves longer than each of `ends` [m], which fall.

    Of an answer of the chain, or of the direct contact; NaN without its parts by wavelength.
    """
    if "octave_friction" in answer:
        parts = (answer["octave_friction"].fillna(0.0) * answer["weight"]).sum("profile")
        ordered = parts.sortby("wavelength", ascending=False)
        wavelength, friction = ordered["wavelength"].values, ordered.values
    elif "friction" in answer and answer["friction"].dims == ("scale",):
        wavelength, friction = answer["wavelength"].values, answer["friction"].values
    else:
        return np.full(ends.shape, np.nan)
    running = np.cumsum(friction)
    place = -np.log(wavelength)
    return np.asarray(np.interp(-np.log(ends), place, running, left=0.0, right=running[-1]))
