"""Pressure that closes the gap at given points under a given load: GMRES on those points alone.

With K the displacement under a pressure, S = 1/K its inverse over the full surface, a subscript A
for "at the points in contact", h the heights, u_0 the rigid approach and P the load,

    K_AA p + u_0 = h_A,   sum p = P.

Preconditioned from the left with S of what is open, carried a little beyond A (E, see `extension`),
and freed of u_0 by leaving out means (P r = r - mean r),

    Q r = P S_A E P r,       Q 1 = 0,   1 . Q r = 0,

this is Q K_AA p = Q h_A for corrections p of zero sum, and Q (h_A - K_AA p) is, to first order, the
pressure still missing. GMRES (Y. Saad & M. H. Schultz, SIAM J. Sci. Stat. Comput. 7 (1986) 856,
doi:10.1137/0907058) runs in single precision on what is missing, taken anew in double precision
after each run (iterative refinement), so that single precision costs no accuracy. A system of few
points that one run does not solve is eliminated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.rough.extension import Extension
from gripscale.rough.half_space import AnyArray, Response

Array = NDArray[np.float64]
Index = NDArray[np.intp]

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
