"""Are points equidistant? The even grid that fits best, and what stands off it.

    x_i = a + k_i d,   k_i whole and increasing

by least squares. Points off the grid by a small part of a step are on it: a slope times that part
is what their heights are wrong by. Where k jumps, points were left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

GRID_TOLERANCE = 0.05
"""Largest distance of a point from the even grid that fits best, in steps.

A distance rounded to a tenth of a step is just within. Uniform departures up to it add 2 d^2/3 to
the squared distance of neighbours, 0.2 % of it.
"""

COARSEST_PRINT = 0.5
"""Largest last decimal place of printed distances, in steps, that still tells neighbours apart."""

SINGLE = 1.6
"""Length, in the shortest step, to which steps are single.

Printed ones differ by the last decimal, at most half as much again; two in one are longer still.
"""


_MOST_PLACES = 1e12
"""Steps in a gap beyond which its points stand on no grid that floating point tells."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Whole places of points on an even grid, and the largest distance from it in steps."""

    place: NDArray[np.int64]
    step: float
    departure: float

    @property
    def size(self) -> int:
        """Number of points of the grid from the first point to the last."""
        return int(self.place[-1]) + 1

    @property
    def left_out(self) -> int:
        """Number of points of the grid that are not there."""
        return self.size - self.place.size

    def spread(self, values: FloatArray) -> FloatArray:
        """Return values on all points of the grid, NaN where a point was left out."""
        every = np.full(self.size, np.nan)
        every[self.place] = values
        return every

    def points(self, x: FloatArray) -> FloatArray:
        """Return all distances of the grid between the first and the last of `x`."""
        return np.linspace(x[0], x[-1], self.size)


def even_grid(x: FloatArray, resolution: float = 0.0) -> Grid | None:
    """Return the even grid that increasing distances stand on, or None if there is none.

    Parameters
    ----------
    x : array, shape (points,)
        Distances, in any unit.
    resolution : float, optional
        Last decimal place to which they are printed, in that unit. A printed distance stands
        within half of it of the true one, and the grid through printed ones within half again.
    """
    steps = np.diff(x)
    if x.size < 2 or (steps <= 0.0).any():
        return None
    for place in (np.arange(x.size), _places(steps)):
        mean_place, mean_x = place.mean(), x.mean()
        centred = place - mean_place
        step = float(centred @ (x - mean_x) / (centred @ centred))
        departure = float(np.abs(x - mean_x - step * centred).max())
        if departure <= _allowed(x, step, resolution):
            return Grid(place, step, departure / step)
    return None


def _allowed(x: FloatArray, step: float, resolution: float) -> float:
    """Return how far a point may stand from the grid, in the unit of `x`."""
    printed = 1.01 * resolution if resolution <= COARSEST_PRINT * step else 0.0
    # The rounding of x itself must not count: x far from zero has coarse floating-point steps.
    rounding = 4.0 * float(np.finfo(float).eps * np.abs(x).max())
    return max(GRID_TOLERANCE * step, printed) + rounding


def _places(steps: FloatArray) -> NDArray[np.int64]:
    """Return the whole places of points these steps apart.

    Printed steps scatter about the true one, and only the mean of all single ones tells it well
    enough to count how many a long gap holds.
    """
    step = steps[steps <= SINGLE * steps.min()].mean()
    if steps.max() > _MOST_PLACES * step:
        return np.arange(steps.size + 1)
    whole = np.maximum(np.rint(steps / step), 1.0)
    return np.concatenate(([0], np.cumsum(whole))).astype(np.int64)


def uneven_step(x: FloatArray) -> int:
    """Return the index before the first step that falls, or else that is not the usual one."""
    steps = np.diff(x)
    usual = float(np.median(steps))
    uneven = np.abs(steps - usual) > GRID_TOLERANCE * abs(usual)
    return int(np.argmax(steps <= 0.0 if (steps <= 0.0).any() else uneven))
