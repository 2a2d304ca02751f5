"""Temperatures and strains in one vector of numbers of the same order, to be iterated on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

WARM = 20.0
"""Kelvin above which temperatures go by their logarithm: the first guess of the heat, from a cold
rubber, may be a thousand too high."""
LEAST_STRAIN = 1e-12


def mixed(warming: Array, strain: Array) -> Array:
    """Return the vector of temperature rises [K] and strains [-]."""
    warm = np.log1p(np.maximum(warming, 0.0) / WARM)
    return np.concatenate([warm, np.log(np.maximum(strain, LEAST_STRAIN))])


def separate(vector: Array) -> tuple[Array, Array]:
    """Return temperature rises [K] and strains [-] of a vector of `mixed`."""
    warm, strain = np.split(vector, 2)
    return WARM * np.expm1(np.maximum(warm, 0.0)), np.exp(strain)
