"""The plateau of a height difference correlation: where it begins and how high it is.

Beyond the longest wavelength of a surface, heights a lag apart are unrelated and C_z is twice the
variance. The plateau begins at the first lag at which C_z reaches 90 % of its own mean over all
larger lags: a curve that still rises stays far below that mean, one that has settled scatters
about it. A tenth is left for a measured plateau, which is finite and drifts by as much.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.profile import FloatArray

REACHED = 0.9
"""Fraction of the mean over all larger lags at which the plateau begins."""

SHORTEST_PLATEAU = 2.0
"""Ratio of the largest lag to the plateau's first lag below which it is not called a plateau."""


@dataclass(frozen=True)
class Plateau:
    """Where C_z stops rising: its first lag [m] and its level [m^2]."""

    lag: float
    level: float


def find_plateau(hdc: HeightDifference) -> Plateau | None:
    """Return the plateau of a height difference correlation, or None if it is not reached.

    The level is the median of C_z over the plateau's lags, weighted evenly in log lag: neither the
    last of the rise nor a drift at the largest lags moves it much.
    """
    weight = log_weights(hdc.lag)
    tail_mean = np.cumsum((weight * hdc.value)[::-1])[::-1] / np.cumsum(weight[::-1])[::-1]
    # The last lag is its own mean, so a curve that rises to its end is caught by the ratio below.
    first = int(np.argmax(hdc.value >= REACHED * tail_mean))
    if hdc.lag[-1] < SHORTEST_PLATEAU * hdc.lag[first]:
        return None
    level = _weighted_median(hdc.value[first:], weight[first:])
    return Plateau(float(hdc.lag[first]), level)


def _weighted_median(values: FloatArray, weight: FloatArray) -> float:
    order = np.argsort(values)
    share = np.cumsum(weight[order])
    return float(values[order][np.searchsorted(share, 0.5 * share[-1])])


def log_weights(lag: FloatArray) -> FloatArray:
    """Return the width in log lag that each lag stands for, so that decades count alike."""
    if lag.size == 1:
        return np.ones(1)
    logs = np.log10(lag)
    edges = np.concatenate((logs[:1], 0.5 * (logs[1:] + logs[:-1]), logs[-1:]))
    return np.diff(edges)
