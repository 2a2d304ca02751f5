"""Contact on one grid: the points that touch, by a primal-dual active set.

Asked for are p >= 0, gap = K p + u_0 - h >= 0, p gap = 0 and mean p = p_0. With the gap closed at
the points A in contact and p = 0 elsewhere, the next A holds the points of A with p > 0 and the
others with gap < 0 (M. Hintermueller, K. Ito & K. Kunisch, SIAM J. Optim. 13 (2002) 865,
doi:10.1137/S1052623401383558). K is not symmetric but its symmetric part is positive definite, so
the solution is unique. The linear system is solved the better the fewer points change sides, and
well at the end; solved loosely to the end, some points change sides for ever.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from gripscale.half_space.grid import Mask
from gripscale.half_space.response import AnyArray, Response

# The gap carried a little beyond the contact, where the pressure has to vanish.
#
# The pressure p that closes a gap r at the points A in contact lifts the surface outside A by K p
# as well. Were that known, S = 1/K of the whole displacement would be p at once. Of an elastic body
#
#     (S u)(x)  ~  sum_y (u(x) - u(y)) / |x - y|^(d+1),    d = 1 on a line, 2 on a map
#
# (the half Laplacian: M. Kwasnicki, Fract. Calc. Appl. Anal. 20 (2017) 7, def. 2.7,
# doi:10.1515/fca-2017-0002), which is zero outside A: u there is the mean of the others with these
# weights. Kept are the points of A at most two steps away along each axis; points outside A count
# as u(x) itself and all that is farther as zero with a weight of 0.3, the best of 0 to 3 measured
# on elastic and lossy rubbers.

Index = NDArray[np.intp]

REACH = 1
"""Steps along each axis."""
FAR = 2.0
"""Weight of what is farther, that of a neighbour being one."""


@dataclass(frozen=True)
class Extension:
    """Points around a contact and what a gap is carried there by."""

    around: Index
    """As indices of the flattened grid."""
    weights: scipy.sparse.csr_array
    """From the points in contact, in single precision, shape (around, in contact)."""

    @classmethod
    def of(cls, active: Mask) -> Extension:
        """Return the extension from the points `active` of a periodic grid."""
        around = np.flatnonzero(_near(active) & ~active)
        touching = np.flatnonzero(active)
        order = np.full(active.size, -1, dtype=np.int32)
        order[touching] = np.arange(len(touching), dtype=np.int32)
        rows, columns, weights = [], [], []
        for step, other in _neighbours(around, active.shape):
            column = order[other]
            row = np.flatnonzero(column >= 0).astype(np.int32)
            rows.append(row)
            columns.append(column[row])
            weights.append(np.full(len(row), _weight(step), dtype=np.float32))
        row, weight = np.concatenate(rows), np.concatenate(weights)
        total = np.bincount(row, weight, len(around)) + FAR
        weight /= total[row].astype(np.float32)
        shape = len(around), len(touching)
        entries = weight, (row, np.concatenate(columns))
        return cls(around, scipy.sparse.csr_array(entries, shape=shape))


def _neighbours(around: Index, shape: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], Index]]:
    """Yield each step and where it leads from the points `around` of a periodic grid."""
    place = np.unravel_index(around, shape)
    steps = range(-REACH, REACH + 1)
    moved = [[(axis + by) % n for by in steps] for axis, n in zip(place, shape, strict=True)]
    for step in itertools.product(steps, repeat=len(shape)):
        if any(step):
            other = np.zeros_like(around)
            for n, axis, by in zip(shape, moved, step, strict=True):
                other = other * n + axis[by + REACH]
            yield step, other


def _near(active: Mask) -> Mask:
    """Return the points at most `REACH` steps along each axis from an active one."""
    near = active
    for axis in range(active.ndim):
        moved = [np.roll(near, by, axis) for by in range(-REACH, REACH + 1) if by]
        near = near | np.logical_or.reduce(moved)
    return near


def _weight(step: tuple[int, ...]) -> float:
    square = sum(by * by for by in step)
    return float(square ** (-0.5 * (len(step) + 1)))


# Pressure that closes the gap at given points under a given load: GMRES on those points alone.
#
# With K the displacement under a pressure, S = 1/K its inverse over the full surface, a subscript A
# for "at the points in contact", h the heights, u_0 the rigid approach and P the load,
#
#     K_AA p + u_0 = h_A,   sum p = P.
#
# Preconditioned from the left with S of what is open, carried a little beyond A (E, see
# `extension`), and freed of u_0 by leaving out means (P r = r - mean r),
#
#     Q r = P S_A E P r,       Q 1 = 0,   1 . Q r = 0,
#
# this is Q K_AA p = Q h_A for corrections p of zero sum, and Q (h_A - K_AA p) is, to first order,
# the pressure still missing. GMRES (Y. Saad & M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986)
# 856, doi:10.1137/0907058) runs in single precision on what is missing, taken anew in double
# precision after each run (iterative refinement), so that single precision costs no accuracy. A
# system of few points that one run does not solve is eliminated.

Array = NDArray[np.float64]

SHORTEST, LONGEST = 60, 240
"""Most products of a run of GMRES, twice as many after each that fell short; as many vectors of
the points in contact are kept. Very lossy rubber needs some hundred."""
REDUCTION = 1e-4
"""Least reduction asked of one run: more would be lost in single precision."""
RUNS = 5
FEW = 600
"""Points in contact up to which the system is eliminated if a run of GMRES falls short. Not at
once: elimination wakes the threads of BLAS, whose waiting costs more than the iterations."""


@dataclass(frozen=True)
class ClosedGap:
    """What closes the gap at the points in contact."""

    pressure: Array
    """At the points [Pa]."""
    displacement: Array
    """Under it, over the whole grid [m], flattened."""
    missing: float
    """Pressure still missing over the pressure, both root mean square [-]."""
    products: int
    """Products with K and S each."""


class PointsInContact:
    """The projected operator on some points of a grid."""

    def __init__(self, response: Response, where: Index) -> None:
        self._response = response
        self._where = where
        active = np.zeros(response.grid.points, dtype=bool)
        active[where] = True
        self._extension = Extension.of(active.reshape(response.grid.shape))
        self._single = np.zeros(response.grid.points, dtype=np.float32)
        self.products = 0

    def missing(self, gap: AnyArray) -> AnyArray:
        """Return Q r [Pa] of what is open, r [m], at the points."""
        gap = (gap - gap.mean(dtype=np.float64)).astype(np.float32, copy=False)
        full, around = self._spread(gap), self._extension.around
        full[around] = self._extension.weights @ gap
        pressure = self._applied(self._response.pressure, full)[self._where]
        full[around] = 0.0
        pressure -= pressure.mean(dtype=np.float64)
        return pressure

    def displacement(self, pressure: AnyArray) -> AnyArray:
        """Return K p [m] over the whole grid, flattened."""
        self.products += 1
        return self._applied(self._response.displacement, self._spread(pressure))

    def __call__(self, pressure: AnyArray) -> AnyArray:
        """Return Q K_AA p."""
        return self.missing(self.displacement(pressure)[self._where])

    def _spread(self, values: AnyArray) -> AnyArray:
        """Return `values` at the points and zero elsewhere; in single precision until the next."""
        single = values.dtype == np.float32
        full = self._single if single else np.zeros(self._single.size, dtype=values.dtype)
        full[self._where] = values
        return full

    def _applied(self, apply: Callable[[AnyArray], AnyArray], full: AnyArray) -> AnyArray:
        return apply(full.reshape(self._response.grid.shape)).reshape(-1)


def close_gap(
    response: Response,
    where: Index,
    height: Array,
    start: Array,
    displacement: Array,
    tolerance: float,
    *,
    check: bool,
) -> ClosedGap:
    """Return the pressure that closes the gap at the points `where`.

    Parameters
    ----------
    response : Response
        The half-space.
    where : array of int
        Points in contact, as indices of the flattened grid.
    height : array
        Heights there [m].
    start : array
        A pressure there with the load wanted [Pa]; its sum is kept.
    displacement : array
        K of it over the whole grid, flattened [m].
    tolerance : float
        Missing pressure to stop at, over the pressure [-].
    check : bool
        Whether the missing pressure is worked out at the end and not taken from GMRES.
    """
    points = PointsInContact(response, where)
    pressure = start.copy()
    size, most = float(np.linalg.norm(pressure)), SHORTEST
    for run in range(RUNS + 1):
        lacking = points.missing(height - displacement[where])
        norm = float(np.linalg.norm(lacking))
        if norm <= tolerance * size or run == RUNS or not np.isfinite(norm):
            break
        target, before = max(REDUCTION, 0.5 * tolerance * size / norm), points.products
        correction, left = gmres(points, lacking / np.float32(norm), target, most)
        short = points.products - before == most
        if short:
            most = min(2 * most, LONGEST)
        pressure += norm * correction
        pressure += (start.sum() - pressure.sum()) / len(pressure)
        if short and len(where) <= FEW:
            pressure, left = _direct(response, where, height, float(start.sum())), 0.0
        displacement = np.asarray(points.displacement(pressure), dtype=np.float64)
        norm *= left
        if norm <= tolerance * size and not check:
            break
    return ClosedGap(pressure, displacement, norm / size, points.products)


def _direct(response: Response, where: Index, height: Array, load: float) -> Array:
    """Return the pressure by elimination, the rigid approach and the load as a border."""
    shape, size = response.grid.shape, len(where)
    place = np.unravel_index(where, shape)
    apart = [(axis[:, None] - axis) % n for axis, n in zip(place, shape, strict=True)]
    stiffest = response.smallest_compliance  # scales the border
    system = np.full((size + 1, size + 1), stiffest)
    system[:size, :size] = response.influence[tuple(apart)]
    system[size, size] = 0.0
    return np.asarray(np.linalg.solve(system, np.append(height, stiffest * load))[:size])


def gmres(
    operator: Callable[[AnyArray], AnyArray], right: AnyArray, target: float, most: int
) -> tuple[AnyArray, float]:
    """Return x with |right - operator(x)| at `target`, or at its least after `most` products.

    The second value is what is left of |right|, as GMRES has it. `right` has unit length. Arnoldi
    vectors by modified Gram-Schmidt, least squares by rotations.
    """
    basis = [right]
    triangle = np.zeros((most, most))
    rotations: list[complex] = []
    reduced = [1.0]
    for k in range(most):
        vector = operator(basis[k])
        column = []
        for other in basis:
            column.append(np.dot(other, vector))
            vector -= column[-1] * other
        column.append(np.linalg.norm(vector))
        for i, turn in enumerate(rotations):
            column[i : i + 2] = _rotated(turn, *column[i : i + 2])
        radius = np.hypot(*column[k:])
        rotations.append(complex(*column[k:]) / radius)
        triangle[:k, k], triangle[k, k] = column[:k], radius
        reduced[k:] = _rotated(rotations[k], reduced[k], 0.0)
        if abs(reduced[k + 1]) <= target or column[k + 1] <= 1e-6 * radius:
            break
        basis.append(vector / column[k + 1])
    weights = np.linalg.solve(triangle[: k + 1, : k + 1], reduced[: k + 1])
    out = np.zeros_like(right)
    for weight, vector in zip(weights, basis, strict=False):
        out += np.float32(weight) * vector
    return out, abs(reduced[k + 1])


def _rotated(turn: complex, first: float, second: float) -> tuple[float, float]:
    c, s = turn.real, turn.imag
    return c * first + s * second, c * second - s * first


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
