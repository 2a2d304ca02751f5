"""Harmonics of a contact pressure that is known at the uneven places of surface nodes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def harmonics(x: Array, pressure: Array, period: float, order: NDArray[np.int_]) -> Array:
    """Return |p_k| [Pa] of the harmonics of `order`, by the trapezoidal rule.

    `x` [m] may be anywhere; where it or `pressure` [Pa] is not finite there is no node.
    """
    known = np.isfinite(x) & np.isfinite(pressure)
    place = np.mod(x[known], period)
    sequence = np.argsort(place)
    place, height = place[sequence], pressure[known][sequence]
    width = np.diff(np.append(place, place[0] + period))
    weight = 0.5 * (width + np.roll(width, 1))
    phase = np.exp(-2j * np.pi * np.outer(order, place) / period)
    return np.asarray(np.abs(phase @ (weight * height)) / period)
