"""Contact on one grid by a primal-dual active set, with a preconditioned Krylov solver.

The contact has p >= 0, gap = K p + u_0 - h >= 0, p gap = 0 and mean p = p_0. With the gap closed at
the points A in contact and p = 0 elsewhere, the next A holds the points of A with p > 0 and the
others with gap < 0 (M. Hintermueller, K. Ito & K. Kunisch, SIAM J. Optim. 13 (2002) 865,
doi:10.1137/S1052623401383558). K is not symmetric but its symmetric part is positive definite, so
the solution is unique. The tolerance of the linear system falls with the number of points that
change sides; with a loose tolerance at the end the active sets may cycle.

With K the displacement under a pressure, S = 1/K its inverse over the full surface, a subscript A
for the points in contact, h the heights, u_0 the rigid approach and P the load, the linear system
is

    K_AA p + u_0 = h_A,   sum p = P.

It is preconditioned from the left: means are left out (P r = r - mean r), which removes u_0, the
open gap is extended a little beyond A (E), and S is applied,

    Q r = P S_A E P r,       Q 1 = 0,   1 . Q r = 0,

so that Q K_AA p = Q h_A is solved for corrections p of zero sum, and Q (h_A - K_AA p) is, to first
order, the missing pressure. GMRES (Y. Saad & M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986)
856, doi:10.1137/0907058) runs in single precision on the residual, which is recomputed in double
precision after each run (iterative refinement): single precision costs no accuracy. A system of few
points that one run does not solve is eliminated directly.

The extension E: the pressure that closes a gap r at A also lifts the surface outside A. With this
displacement u known everywhere, S u would be p at once. For an elastic body

    (S u)(x)  ~  sum_y (u(x) - u(y)) / |x - y|^(d+1),    d = 1 on a line, 2 on a map

(the half Laplacian: M. Kwasnicki, Fract. Calc. Appl. Anal. 20 (2017) 7, def. 2.7,
doi:10.1515/fca-2017-0002) is zero outside A. On a line this is a harmonic function of a half-plane,
whose value in an open gap of the length g follows from all contacts by the Poisson kernel. Of each
of the two next to the gap, with their lengths L and the distances a and b of a point from its end
and from the other one, the weight is the harmonic measure

    w = 2/pi arctan sqrt(L b / ((L + g) a)),

with `CONTACT_REACH` L in place of L for the contacts behind it. It needs half the products of the
neighbours alone, on roads and self-affine lines. On a map u(x) next to A is the mean of the others
with the weights of the sum, over the neighbours of x in A. Neighbours outside A count as u(x)
itself, and all farther points as zero with the weight `FAR`, chosen by measurements on elastic and
lossy rubbers.

Of very lossy rubber, E* ~ (i w)^a, S is of the order 1 + a and its weights fall off as
|x - y|^-(2 + a): the displacement of a gap is that of its two ends. At the order 2 it would be
linear between them, and so it is taken on lines of such rubber. A lossy line then needs a fifth of
the products (loss angles 0.5 to 1.2); maps converge without.

The open points of a pool of trapped water (`gripscale.half_space.water`) have one pressure, and the
mean of their gap is given. They belong to A, with gaps and pressures replaced by their means over
the pool, before E and after S.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gripscale._kernel import GapExtension, gmres
from gripscale.core.arrays import Array, Mask
from gripscale.half_space.grid import Single
from gripscale.half_space.regions import Averaged, Pools
from gripscale.half_space.response import AnyArray, Response
from gripscale.theory.half_plane import GridContact

_Index = NDArray[np.intp]
FAR = 2.0  # weight of all farther points of a map, over that of a neighbour along an axis
# Length of the contacts beside a gap with those behind them, over their own: from 10 to 40 the
# products differ by less than a tenth.
CONTACT_REACH = 20.0
# Loss angle, median of the waves, above which a line takes the linear extension [rad].
LOSSY = 0.45
# Factor of Q r there: it is 3 to 30 times smaller than the error of the pressure (root mean square,
# against elimination), and ten times more at the ends of the contacts.
SHORTFALL = 1e3
# Factor of the tolerances of the first iterations there. What is missing is long: with less
# accuracy many points outside the contacts join them, and leave again one after the other.
SHARPER = 0.1
# Most products of a run of GMRES, doubled after each run that does not reach its target. As many
# vectors of the points in contact are kept. Very lossy maps need some hundred.
_SHORTEST, _LONGEST = 60, 240
# Least reduction of the residual in one run: single precision does not resolve more.
REDUCTION = 1e-4
RUNS = 5
# Points in contact up to which the system is eliminated if a run of GMRES does not reach its
# target. Not before: elimination wakes the threads of BLAS, whose waiting costs more than the
# iterations.
FEW = 600


class Accuracy(NamedTuple):
    """When a contact counts as solved."""

    missing: float  # missing pressure over the pressure
    wrong: float = 0.0  # points on the wrong side over those in contact


CONTACT_ACCURACY = Accuracy(1e-6)
# For differences between contacts on one grid.
DIFFERENCE_ACCURACY = Accuracy(1e-4)
# Of a grid that another one starts from, whose numbers are reported too.
START_ACCURACY = Accuracy(1e-4, 1e-3)
# For what another rubber changes: the contact fraction within a tenth of a per cent.
COARSE_ACCURACY = Accuracy(2e-4, 2e-3)
# Least missing pressure on grids in single precision.
SINGLE_TOLERANCE = 3e-4
# Missing pressure above which what a correction moves is computed in single precision elsewhere,
# whose rounding is a hundred times smaller.
SINGLE_ENOUGH = 1e-5
LOOSEST = 1e-2
TIGHTENING = 1e-2  # missing pressure allowed, over the share of points that changed sides last
# Iterations without fewer wrong points before only the worse half of them may change sides, and
# before the iteration ends.
PATIENCE, GIVING_UP = 6, 18
MOST_ITERATIONS = 60  # active sets tried on a grid


@dataclass(frozen=True)
class ClosedGap:
    """Solution of the linear system of the points in contact."""

    pressure: Array  # at the points [Pa]
    missing: float  # missing pressure over the pressure, both root mean square [-]
    products: int  # products with K and S each


def is_lossy_line(response: Response) -> bool:
    """Return whether E is that of a line of very lossy rubber."""
    return len(response.grid.shape) == 1 and abs(response.loss_angle) > LOSSY


class PointsInContact:
    """The projected operator on some points of a grid."""

    def __init__(self, response: Response, where: _Index, averaged: Averaged | None = None) -> None:
        self._response = response
        self._where = where
        self._averaged = averaged
        active = np.zeros(response.grid.points, dtype=bool)
        active[where] = True
        self._lossy_line = is_lossy_line(response)
        if len(response.grid.shape) > 1:
            self._extension = GapExtension.of_map(active.reshape(response.grid.shape), FAR)
        else:
            self._extension = GapExtension.of_line(
                active, None if self._lossy_line else CONTACT_REACH
            )
        self._single = np.zeros(response.grid.shape, dtype=np.float32)
        self.products = 0

    def missing(self, gap: AnyArray) -> AnyArray:
        """Return Q r [Pa] of the open gap r [m] at the points."""
        if self._averaged is not None:
            gap = self._averaged(gap)
        gap = (gap - gap.mean(dtype=np.float64)).astype(np.float32, copy=False)
        extended = self._on_grid(gap)
        self._extension.extend(extended.reshape(-1))
        pressure = self._response.pressure(extended).reshape(-1)[self._where]
        if self._averaged is not None:
            pressure = self._averaged(pressure)
        pressure -= pressure.mean(dtype=np.float64)
        if self._lossy_line:
            pressure *= np.float32(SHORTFALL)
        return pressure

    def displacement(self, pressure: AnyArray) -> AnyArray:
        """Return K p [m] over the whole grid, flattened."""
        self.products += 1
        return self._response.displacement(self._on_grid(pressure)).reshape(-1)

    def _on_grid(self, values: AnyArray) -> AnyArray:
        """Return values at the points over the grid, zero elsewhere, until the next call."""
        if values.dtype != np.float32:
            double = np.asarray(values, dtype=np.float64)
            return _on_grid(self._where, double, self._single.size).reshape(self._single.shape)
        self._single.fill(0.0)
        self._single.reshape(-1)[self._where] = values
        return self._single

    def correction(self, right: Single, target: float, most: int) -> tuple[Single, float]:
        """Return p with |right - Q K_AA p| <= `target`, or the least after `most` products.

        The second value is this residual as GMRES estimates it. `right` has unit length.
        """
        if self._averaged is not None:
            return gmres(self._image, right, target, most)[:2]
        numbers = (SHORTFALL if self._lossy_line else 1.0, target, most)
        pressure, residual, products = self._response.correction(
            right, self._where, self._extension, numbers
        )
        self.products += products
        return pressure, residual

    def _image(self, pressure: Single) -> Single:
        """Return Q K_AA p."""
        image = self.missing(self.displacement(pressure)[self._where])
        return image.astype(np.float32, copy=False)


def close_gap(
    response: Response,
    where: _Index,
    gap: AnyArray,
    start: Array,
    tolerance: float,
    *,
    check: bool,
    averaged: Averaged | None = None,
    room: Array | float = 0.0,
) -> ClosedGap:
    """Return the pressure that closes the gap at the points `where`.

    `start` is a pressure there, whose sum is kept, `gap` what it leaves open over the whole grid
    [m], flattened, up to a constant; what the pressure changes is added to it. `tolerance` is the
    missing pressure at the end over the pressure, or over what is missing first if the start is
    zero. With `check` GMRES is not believed at the end. `averaged` takes means over pools, whose
    mean gaps are the `room` [m].
    """
    points = PointsInContact(response, where, averaged)
    pressure = start.copy()
    size, most = _length(pressure), _SHORTEST
    for run in range(RUNS + 1):
        residual = points.missing(room - gap[where])
        norm = _length(residual)
        size = size or norm
        if norm <= tolerance * size or run == RUNS or not np.isfinite(norm):
            break
        target, before = max(REDUCTION, 0.5 * tolerance * size / norm), points.products
        residual /= norm
        correction, reduction = points.correction(
            residual.astype(np.float32, copy=False), target, most
        )
        short = points.products - before == most
        if short:
            most = min(2 * most, _LONGEST)
        if short and len(where) <= FEW and averaged is None:
            change, reduction = _eliminated(response, where, room - gap[where]), 0.0
        else:
            precision = np.float32 if tolerance > SINGLE_ENOUGH else gap.dtype
            change = np.asarray(norm * correction.astype(precision), dtype=precision)
            change -= change.mean(dtype=np.float64)
        pressure += change
        gap += points.displacement(change)
        norm *= reduction
        if norm <= tolerance * size and not check:
            break
    return ClosedGap(pressure, norm / size, points.products)


def _eliminated(response: Response, where: _Index, opened: AnyArray) -> Array:
    """Return the pressure of zero sum that closes a gap; approach and sum border the system."""
    size, shape = len(where), response.grid.shape
    position = np.unravel_index(where, shape)
    distance = [(axis[:, None] - axis) % n for axis, n in zip(position, shape, strict=True)]
    stiffest = response.smallest_compliance  # scales the border to the size of the other entries
    system = np.full((size + 1, size + 1), stiffest)
    system[:size, :size] = response.influence[tuple(distance)]
    system[size, size] = 0.0
    return np.asarray(np.linalg.solve(system, np.append(opened, 0.0))[:size])


def solve_grid(
    response: Response,
    height: Array,
    start: Array,
    accuracy: Accuracy = CONTACT_ACCURACY,
    pools: Pools | None = None,
    active: Mask | None = None,
) -> GridContact:
    """Return the contact with `height` [m] under the load of `start`.

    `start` is a pressure [Pa] with the required mean, positive where contact is expected.
    With `pools` the load rests on their water too; `active` then are the points of `start` in
    contact. Arrays of the size of the grid have its precision, and are as few as can be.
    """
    shape, real = height.shape, response.grid.real
    load, stiffest = float(start.sum(dtype=np.float64)), response.smallest_compliance
    active = (start > 0.0).reshape(-1) if active is None else active.reshape(-1).copy()
    loaded = np.flatnonzero(start)
    pressure = start.reshape(-1)[loaded].astype(real)  # at the points `loaded`, zero elsewhere
    del start
    gap = -height.reshape(-1).astype(real, copy=False)
    least, finest = 0.0, CONTACT_ACCURACY.missing
    if real != np.float64:
        least = finest = SINGLE_TOLERANCE
    goal = max(accuracy.missing, least)
    sharper = SHARPER if is_lossy_line(response) else 1.0
    tolerance, products, fewest, waited = sharper * LOOSEST, 1, height.size + 1, 0
    for iteration in range(1, MOST_ITERATIONS + 1):
        averaged: Averaged | None = None
        where, room = np.flatnonzero(active), np.zeros(1)
        if pools is not None:
            where = np.flatnonzero(active | pools.under_pressure(active))
            averaged, room = pools.averaging(where, active)
        change = _on_grid(loaded, pressure, height.size)
        tried = _under_load(change[where], load, averaged)
        # from the last pressure to the one tried; at first all of it, in full precision
        if iteration == 1:
            change.fill(0.0)
        else:
            change = np.negative(change, out=change).astype(np.float32, copy=False)
        change[where] += tried
        gap += response.displacement(change.reshape(shape)).reshape(-1)
        del change
        closed = close_gap(
            response,
            where,
            gap,
            tried,
            tolerance,
            check=tolerance <= goal,
            averaged=averaged,
            room=room,
        )
        products += closed.products + 1
        loaded, pressure = where, closed.pressure
        approach = float(gap[where].mean(dtype=np.float64) - room.mean())
        limit = tolerance * math.sqrt(np.mean(pressure**2))
        wrong, tension = gap < approach - stiffest * limit, -pressure
        if pools is not None:
            everywhere = _on_grid(loaded, pressure, height.size)
            tension = pools.pressures(everywhere, active)[pools.label[active]] - everywhere[active]
        wrong[active] = tension > limit
        count = int(np.count_nonzero(wrong))
        if pools is not None:
            following = pools.refilled(everywhere, gap - approach, active)
            count += int((following.filled != pools.filled).sum())
            pools = following
        waited = 0 if count < fewest else waited + 1
        solved = count <= accuracy.wrong * len(where) and tolerance <= goal
        if solved or iteration == MOST_ITERATIONS or waited > GIVING_UP:
            break
        if waited > PATIENCE and wrong.any():
            excess = (approach - gap) / stiffest
            excess[active] = tension
            wrong &= excess >= np.median(excess[wrong])
        # tighter with fewer changes, and tenfold where the number of wrong points does not fall
        fewer = count < fewest
        share = sharper * count / len(where)
        wanted = min(tolerance if fewer else 0.1 * tolerance, TIGHTENING * share)
        tolerance = max(wanted, goal if fewer else min(goal, finest))
        fewest = min(fewest, count)
        active ^= wrong
    gap -= real.type(approach)
    return GridContact(
        _on_grid(loaded, pressure, height.size).reshape(shape),
        gap.reshape(shape),
        active.reshape(shape),
        iteration,
        settled=solved and closed.missing <= goal,
        products=products,
        missing=closed.missing,
    )


def _length(values: AnyArray) -> float:
    """Return the root of the sum of squares; `np.linalg.norm` wakes the threads of BLAS."""
    return math.sqrt(np.square(values).sum(dtype=np.float64))


def _on_grid(where: _Index, values: Array, points: int) -> Array:
    """Return values at some points over a flattened grid, zero elsewhere."""
    full = np.zeros(points, dtype=values.dtype)
    full[where] = values
    return full


def _under_load(pressure: Array, load: float, averaged: Averaged | None) -> Array:
    """Return the pressure [Pa] without tension, scaled to a load; even if nothing is left."""
    positive = np.maximum(pressure, 0.0)
    if averaged is not None:
        positive = averaged(positive)
    total = positive.sum(dtype=np.float64)
    if total == 0.0:
        return np.full(pressure.shape, load / len(pressure), dtype=pressure.dtype)
    return np.asarray(positive * pressure.dtype.type(load / total))
