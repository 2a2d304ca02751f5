"""Frictionless contact of a linear half-plane with a periodic rigid surface, by boundary elements.

Everything here is dimensionless: abscissa theta = k x in [-pi, pi), heights over the amplitude,
pressures over the mean pressure. The pressure is piecewise linear on N equal elements; harmonic m
of the pressure raises the surface by c(m) times itself (c complex: the surface lags behind). With
hat functions, whose Fourier coefficients are sinc^2(m/N), a nodal pressure p_j gives at node i

    u_i = d + sum_j K_(i-j) p_j,   K_j = (1/N) sum_(m != 0) c(m) sinc^2(m/N) exp(i m theta_j)

and contact asks for gap = u - w >= 0, p >= 0, gap p = 0 at every node, mean p = 1. Viscosity makes
K unsymmetric, but its symmetric part is positive definite, so the solution is unique (R. W. Cottle,
J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, 1992, sec. 3.1). The active set is
found by block pivoting, and one node at a time where blocks stall (J. J. Judice & F. M. Pires,
Comput. Oper. Res. 21 (1994) 587, doi:10.1016/0305-0548(94)90106-6).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]
Compliance = Callable[[Array], ComplexArray]

_ALIASES = 16
"""Harmonics summed, in units of N; those left out fall off as m^-3."""
_PATIENCE = 5
_COARSEST = 64


@dataclass(frozen=True)
class PeriodicContact:
    """Solution on N nodes, theta = -pi + 2 pi i/N."""

    pressure: Array
    """Over the mean pressure [-]."""
    gap: Array
    """Over the amplitude [-]."""
    active: Mask
    iterations: int
    settled: bool
    """Whether the active set stopped changing."""


def nodes(points: int) -> Array:
    """Return the angles of the nodes, from -pi [rad], shape (points,)."""
    return -np.pi + 2.0 * np.pi * np.arange(points) / points


def solve_periodic_contact(
    compliance: Compliance, height: Callable[[Array], Array], points: int, most_iterations: int
) -> PeriodicContact:
    """Return the contact, found on ever finer grids that hand each other the active set.

    `compliance` gives c(m) for m = 1, 2, ...; `height` the rigid surface at angles [rad].
    """
    levels = [points]
    while levels[0] % 2 == 0 and levels[0] > _COARSEST:
        levels.insert(0, levels[0] // 2)
    active = height(nodes(levels[0])) > 0.0
    iterations = 0
    for level in levels:
        if len(active) != level:
            finer = np.repeat(active, 2)
            active = finer | np.roll(finer, -1)
        contact = _solve_level(compliance, height(nodes(level)), active, most_iterations)
        active = contact.active
        iterations += contact.iterations
    return PeriodicContact(
        contact.pressure, contact.gap, contact.active, iterations, contact.settled
    )


def pressure_harmonics(pressure: Array) -> ComplexArray:
    """Return the Fourier coefficients m = 1, 2, ... of the piecewise linear pressure, to 16 N.

    p(theta) = mean + sum_m 2 Re[ p_m exp(i m theta) ].
    """
    points = len(pressure)
    number = np.arange(1, _ALIASES * points + 1)
    at_nodes = np.fft.fft(pressure) / points
    origin = np.where(number % 2 == 0, 1.0, -1.0)  # theta starts at -pi
    return np.asarray(at_nodes[number % points] * origin * np.sinc(number / points) ** 2)


def contact_edges(contact: PeriodicContact) -> list[tuple[float, float]]:
    """Return the contact patches as (start, end) angles [rad], located inside the elements.

    Outside the edge of a smooth contact the gap grows as (distance)^(3/2), so gap^(2/3) at the two
    nearest open nodes is extrapolated to zero. A patch across +-pi has end > pi.
    """
    active, gap, points = contact.active, contact.gap, len(contact.gap)
    if active.all():
        return [(-np.pi, np.pi)]
    step = 2.0 * np.pi / points
    starts = np.flatnonzero(active & ~np.roll(active, 1))
    ends = np.flatnonzero(active & ~np.roll(active, -1))
    patches: list[tuple[float, float]] = []
    for start in starts:
        later = ends[ends >= start]
        end = int(later[0]) if later.size else int(ends[0]) + points
        first = float(start - _edge_offset(gap, active, int(start), -1))
        last = float(end + _edge_offset(gap, active, end % points, +1))
        patches.append((-np.pi + step * first, -np.pi + step * last))
    return patches


def _edge_offset(gap: Array, active: Mask, node: int, side: int) -> float:
    """Return how far beyond the last active node the contact ends [elements, 0 to 1]."""
    points = len(gap)
    near, far = (node + side) % points, (node + 2 * side) % points
    if active[far] or gap[far] <= max(gap[near], 0.0):
        return 0.5
    here, there = max(gap[near], 0.0) ** (2.0 / 3.0), gap[far] ** (2.0 / 3.0)
    return float(np.clip(1.0 - here / (there - here), 0.0, 1.0))


def influence_column(compliance: Compliance, points: int) -> Array:
    """Return K, the first column of the circulant influence matrix, shape (points,)."""
    number = np.arange(1, _ALIASES * points + 1)
    value = compliance(number.astype(float)) * np.sinc(number / points) ** 2
    folded = np.zeros(points, dtype=np.complex128)
    np.add.at(folded, number % points, value)
    np.add.at(folded, -number % points, value.conj())
    return np.asarray(np.fft.ifft(folded).real)


def _solve_level(
    compliance: Compliance, height: Array, active: Mask, most_iterations: int
) -> PeriodicContact:
    influence = influence_column(compliance, len(height))
    transform = np.fft.fft(influence)
    fewest, patience = len(height) + 1, _PATIENCE
    for iteration in range(1, most_iterations + 1):
        try:
            pressure, offset = _solve_active(influence, height, active)
        except np.linalg.LinAlgError:  # no node is left, or compliances are lost in rounding
            return PeriodicContact(np.zeros(len(height)), -height, active, iteration, False)
        gap = np.fft.ifft(transform * np.fft.fft(pressure)).real + offset - height
        wrong = np.where(active, pressure < 0.0, gap < -1e-12)
        count = int(wrong.sum())
        if count == 0:
            return PeriodicContact(pressure, gap, active, iteration, True)
        if count < fewest:
            fewest, patience = count, _PATIENCE
        elif patience > 0:
            patience -= 1
        else:
            wrong[: np.flatnonzero(wrong)[-1]] = False
        active = active ^ wrong
    return PeriodicContact(pressure, gap, active ^ wrong, most_iterations, False)


def _solve_active(influence: Array, height: Array, active: Mask) -> tuple[Array, float]:
    """Return nodal pressures with the gap closed at all active nodes, and the rigid offset d."""
    points = len(height)
    where = np.flatnonzero(active)
    size = len(where)
    system = np.zeros((size + 1, size + 1))
    system[:size, :size] = influence[(where[:, None] - where[None, :]) % points]
    system[:size, size] = 1.0
    system[size, :size] = 1.0 / points
    solution = np.linalg.solve(system, np.append(height[where], 1.0))
    pressure = np.zeros(points)
    pressure[where] = solution[:size]
    return pressure, float(solution[size])
