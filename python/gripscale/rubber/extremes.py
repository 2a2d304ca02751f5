"""The extremes among the Prony series that fit: how far E*(w) may go before the data object.

With A z = b the equations of the fit in units of the scatter, and f(z) one of E', E'' at one
frequency, an extreme is the z >= 0 with the largest (or least) f(z) for which

    |A z - b|^2 <= min |A z - b|^2 + 9,

three standard deviations of f alone (profile likelihood; D. J. Venzon & S. H. Moolgavkar, Appl.
Stat. 37 (1988) 87, doi:10.2307/2347496). f is held at a value by one heavy row, and the value is
moved until the limit is met. The smoothing is so weak that it cannot rule out any spectrum the data
allow by more than a standard deviation; what bounds the extremes is that moduli are not negative,
relaxation times lie within two decades of the band, and the glassy modulus leaves Poisson's ratio
positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.maxwell_fit import (
    Curve,
    Equations,
    Prior,
    equations,
    non_negative,
    relaxation_times,
)
from gripscale.rubber.maxwell_shapes import loss_shape, storage_shape

Array = NDArray[np.float64]

_RISE = 9.0
"""Allowed rise of the sum of squares in units of the scatter."""
_SMOOTHING = 1.0
_PER_DECADE = 2.0
"""Relaxation times per decade: E'' of equal elements then ripples by 0.04 %."""
_MOST_TERMS = 80
_INSIDE = 2.0
"""Decades between the frequencies within the band at which extremes are sought."""
_HEAVY = 1e3
_FIRST_STEP, _LARGEST_STEP, _HALVINGS = 0.02, 12.0, 6
_LEAST_SHARE = 1e-4
"""Share of the smallest measured E'' below which a modulus counts as nothing."""
_DIGITS = 6


@dataclass(frozen=True)
class _Reduced:
    """The equations after orthogonal reduction, with their minimum."""

    triangle: Array
    right: Array
    best: Array

    def rise(self, solution: Array) -> float:
        """Return the sum of squares of a solution over the least one."""
        return self._squares(solution) - self._squares(self.best)

    def held(self, row: Array, value: float) -> Array:
        """Return the best solution for which `row` has about this value."""
        matrix = np.vstack([self.triangle, _HEAVY * row])
        return non_negative(matrix, np.append(self.right, _HEAVY * value))

    def _squares(self, solution: Array) -> float:
        error = self.triangle @ solution - self.right
        return float(error @ error)


def extremes(
    curve: Curve, scatter: tuple[float, float], beyond: float, largest_modulus: float
) -> AdmissibleSeries:
    """Return the extreme series for a curve whose E' and E'' scatter by so much [-].

    `beyond` is how far relaxation times reach past both ends [decades], `largest_modulus` the limit
    of E_inf + sum E_i [Pa].
    """
    problem = open_equations(curve, scatter, beyond, largest_modulus)
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    orthogonal, triangle = np.linalg.qr(problem.matrix)
    right = orthogonal.T @ problem.right
    reduced = _Reduced(triangle, right, non_negative(triangle, right))
    found, least = [reduced.best], _LEAST_SHARE * float(curve.loss.min())
    for omega in _frequencies(curve.omega, decades, beyond):
        for row, offset in _functionals(problem, omega):
            found += [_furthest(reduced, row, offset, sign, least) for sign in (1.0, -1.0)]
    return _series(problem, found)


def open_equations(
    curve: Curve, scatter: tuple[float, float], beyond: float, largest_modulus: float
) -> Equations:
    """Return the equations in units of the scatter, smoothed so little that the data decide.

    Arguments as for `extremes`.
    """
    decades = math.log10(curve.omega[-1] / curve.omega[0])
    terms = min(max(2, round(_PER_DECADE * decades) + 1), _MOST_TERMS)
    times = relaxation_times(curve.omega, terms, beyond)
    weights = 1.0 / scatter[0], 1.0 / scatter[1]
    return equations(curve, times, Prior(_SMOOTHING, _SMOOTHING, largest_modulus, *weights))


def _frequencies(omega: Array, decades: float, beyond: float) -> Array:
    """Return where extremes are sought: in the band, and once and twice half-way beyond."""
    inside = np.geomspace(omega[0], omega[-1], max(1, round(decades / _INSIDE)) + 1)
    outside = 10.0 ** (beyond * np.array([0.5, 1.0])) if beyond > 0.0 else np.zeros(0)
    return np.concatenate([omega[0] / outside, inside, omega[-1] * outside])


def _functionals(problem: Equations, omega: float) -> list[tuple[Array, float]]:
    """Return E' and E'' at `omega` [rad/s] as rows of z, with the part that is not free."""
    phase = omega * problem.times
    storage = np.concatenate([[problem.unit], storage_shape(phase) * problem.scale, [0.0]])
    loss = np.concatenate([[0.0], loss_shape(phase) * problem.scale, [0.0]])
    return [(storage, problem.floor), (loss, 0.0)]


def _furthest(
    reduced: _Reduced, row: Array, offset: float, direction: float, least: float
) -> Array:
    """Return the solution with the largest (1) or least (-1) value of `row` the data allow.

    Values below `least` count as nothing.
    """
    start = max(float(row @ reduced.best) + offset, least)
    inside, outside, best = 0.0, _FIRST_STEP, reduced.best

    def at(step: float) -> tuple[Array, bool]:
        value = max(start * math.exp(direction * step) - offset, 0.0)
        solution = reduced.held(row / start, value / start)
        return solution, reduced.rise(solution) <= _RISE

    solution, allowed = at(outside)
    while allowed and outside < _LARGEST_STEP:
        inside, best, outside = outside, solution, 2.0 * outside
        solution, allowed = at(outside)
    for _ in range(_HALVINGS):
        middle = 0.5 * (inside + outside)
        solution, allowed = at(middle)
        if allowed:
            inside, best = middle, solution
        else:
            outside = middle
    return best


def _series(problem: Equations, found: list[Array]) -> AdmissibleSeries:
    """Return the solutions as series, to six digits, elements of no weight as zero."""
    spectra = [problem.spectrum(solution) for solution in found]
    moduli = np.array([spectrum.moduli for spectrum in spectra])
    equilibrium = np.array([spectrum.equilibrium for spectrum in spectra])
    moduli[moduli <= 1e-9 * (moduli.sum(axis=1, keepdims=True) + equilibrium[:, None])] = 0.0
    return AdmissibleSeries(problem.times, _rounded(equilibrium), _rounded(moduli))


def _rounded(values: Array) -> Array:
    with np.errstate(divide="ignore"):
        place = 10.0 ** (np.floor(np.log10(np.where(values > 0.0, values, 1.0))) - _DIGITS + 1)
    return np.asarray(np.round(values / place) * place)
