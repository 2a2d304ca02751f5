"""Running integrals by the trapezoidal rule, on grids refined until a tolerance is met."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Values = tuple[Array, ...]


def divided(nodes: Array, intervals: int) -> Array:
    """Return `nodes` with each step between them cut into so many equal intervals."""
    inside = np.arange(intervals) / intervals
    return np.append((nodes[:-1, None] + np.diff(nodes)[:, None] * inside).ravel(), nodes[-1])


def filled_in(nodes: Array, widest: float) -> Array:
    """Return `nodes` with wider steps than `widest` cut into equal ones."""
    parts = np.ceil(np.diff(nodes) / widest).astype(int)
    cut = [divided(nodes[at : at + 2], count)[:-1] for at, count in enumerate(parts)]
    return np.concatenate([*cut, nodes[-1:]])


def running_integral(values: Array, x: Array) -> Array:
    """Return the integral of `values` from the first to each entry of `x`."""
    steps = 0.5 * (values[1:] + values[:-1]) * np.diff(x)
    return np.concatenate(([0.0], np.cumsum(steps)))


def refined(
    at: Callable[[int], Values], first: int, most: int, tolerance: float
) -> tuple[Values, tuple[float, ...]]:
    """Return `at(intervals)` on a grid fine enough, and what the last doubling changed.

    Intervals are doubled from `first` until the last entry of every array changes by less than
    `tolerance` of itself, or `most` is reached.
    """
    coarse = at(first)
    while True:
        first *= 2
        fine = at(first)
        errors = tuple(float(abs(b[-1] - a[-1])) for a, b in zip(coarse, fine, strict=True))
        met = all(e <= tolerance * abs(b[-1]) for e, b in zip(errors, fine, strict=True))
        if met or first >= most:
            return fine, errors
        coarse = fine
