"""Contact on one grid: the points that touch, by a primal-dual active set.

Asked for are p >= 0, gap = K p + u_0 - h >= 0, p gap = 0 and mean p = p_0. With the gap closed at
the points A in contact and p = 0 elsewhere, the next A holds the points of A with p > 0 and the
others with gap < 0 (M. Hintermueller, K. Ito & K. Kunisch, SIAM J. Optim. 13 (2002) 865,
doi:10.1137/S1052623401383558). K is not symmetric but its symmetric part is positive definite, so
the solution is unique. The linear system is solved the better the fewer points change sides, and
well at the end; solved loosely to the end, some points change sides for ever.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gripscale.rough.gap_solver import close_gap
from gripscale.rough.grid import Array, Mask
from gripscale.rough.half_space import Response

TOLERANCE = 1e-6
"""Missing pressure over pressure at which the linear system counts as solved."""
START_TOLERANCE = 1e-4
"""The same on a grid that another one starts from: its contact fraction by octave is told, too."""
LOOSEST = 1e-2
TIGHTENING = 1e-2
"""Missing pressure allowed, over the share of points that changed sides last."""
PATIENCE, GIVING_UP = 6, 18
"""Iterations without fewer wrong points before only the worse half of them may change sides, and
before it is no use."""


@dataclass(frozen=True)
class GridContact:
    """Solution on one grid, arrays of its shape."""

    pressure: Array
    """[Pa]"""
    gap: Array
    """[m]"""
    active: Mask
    iterations: int
    products: int
    missing: float
    """Pressure still missing over the pressure [-]."""
    settled: bool
    """Whether the points in contact stopped changing, with the linear system solved."""


def solve_grid(
    response: Response,
    height: Array,
    start: Array,
    most_iterations: int,
    goal: float = TOLERANCE,
) -> GridContact:
    """Return the contact with `height` [m] under the load of `start`.

    `start` is a pressure [Pa], positive where contact is expected, with the mean that is wanted;
    `goal` the missing pressure over the pressure at which the linear system counts as solved.
    """
    flat, shape = height.reshape(-1), height.shape
    pressure, active = start.reshape(-1), start.reshape(-1) > 0.0
    displacement = np.asarray(response.displacement(start), dtype=np.float64).reshape(-1)
    load, stiffest = float(start.sum()), response.smallest_compliance
    tolerance, products, fewest, waited = LOOSEST, 1, flat.size + 1, 0
    for iteration in range(1, most_iterations + 1):
        where = np.flatnonzero(active)
        tried = np.zeros(flat.size)
        tried[where] = _loaded(pressure[where], load)
        change = (tried - pressure).astype(np.float32).reshape(shape)
        displacement += response.displacement(change).reshape(-1)
        closed = close_gap(
            response,
            where,
            flat[where],
            tried[where],
            displacement,
            tolerance,
            check=tolerance <= goal,
        )
        products += closed.products + 1
        pressure = tried
        pressure[where] = closed.pressure
        displacement = closed.displacement
        gap = displacement - flat
        gap -= gap[where].mean()
        excess = gap / -stiffest
        excess[where] = -closed.pressure
        wrong = excess > tolerance * np.sqrt(np.mean(closed.pressure**2))
        count = int(wrong.sum())
        waited = 0 if count < fewest else waited + 1
        solved = count == 0 and tolerance <= goal
        if solved or iteration == most_iterations or waited > GIVING_UP:
            break
        if waited > PATIENCE:
            wrong &= excess >= np.median(excess[wrong])
        tolerance = _next_tolerance(tolerance, count / len(where), count < fewest, goal)
        fewest = min(fewest, count)
        active = active ^ wrong
    return GridContact(
        pressure.reshape(shape),
        gap.reshape(shape),
        active.reshape(shape),
        iteration,
        products,
        closed.missing,
        count == 0 and closed.missing <= goal,
    )


def _loaded(pressure: Array, load: float) -> Array:
    """Return `pressure` without tension, scaled to sum to `load`; even if there is none."""
    positive = np.maximum(pressure, 0.0)
    total = positive.sum()
    if total == 0.0:
        return np.full(len(pressure), load / len(pressure))
    return np.asarray(positive * (load / total))


def _next_tolerance(tolerance: float, changed: float, fewer: bool, goal: float) -> float:
    wanted = min(tolerance if fewer else 0.1 * tolerance, TIGHTENING * changed)
    return max(wanted, goal if fewer else TOLERANCE)
