"""One finite-strain rubber fitted to several uniaxial tests together.

On given relaxation times the nominal stress of a material point is linear in its moduli,

    P(t) = sum_k c_k P_k(s) + sum_i G_i (s A_i,11 - s^-2 A_i,22)

(P_k and c_k are the strain energy's: `StrainEnergy.basis`), so that the least squares of P over the
peak stress of each test, each test counting alike, is a convex problem with bounds and one minimum:
no start values, no local minima. Bounded-variable least squares: P. B. Stark & R. L. Parker,
Comput. Stat. 10 (1995) 129.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.material import Rubber
from gripscale.rubber.material_point import uniaxial_network_stresses, uniaxial_stress
from gripscale.rubber.strain_energy import STRAIN_ENERGIES, StrainEnergy
from gripscale.rubber.uniaxial_test import Array, UniaxialTest

_LEAST_EQUILIBRIUM = 1e-3
"""The fitted G_inf is at least this share of the smallest peak stress: a rubber must have one."""

_FASTEST = 0.01
"""Shortest fitted relaxation time, as a share of the shortest test."""


@dataclass(frozen=True)
class FiniteStrainFit:
    """The rubber found, and how well it carries each test.

    Attributes
    ----------
    rubber : Rubber
        Elements whose fitted modulus is zero are left out.
    tests : tuple of UniaxialTest
        What it was fitted to.
    """

    rubber: Rubber
    tests: tuple[UniaxialTest, ...]

    @property
    def rms_errors(self) -> Array:
        """Root mean square error of the stress over the peak stress [-], shape (tests,)."""
        return np.array([rms_error(self.rubber, test) for test in self.tests])

    @property
    def work_errors(self) -> Array:
        """Predicted over measured work lost in the loop, less one [-], shape (tests,)."""
        return np.array([work_error(self.rubber, test) for test in self.tests])


def rms_error(rubber: Rubber, test: UniaxialTest) -> float:
    """Return the root mean square error of the predicted stress over the measured peak [-].

    Of all samples of the test, each counting alike. Raises `InputError` if `test` is no
    `UniaxialTest` or `rubber` no `Rubber`.
    """
    checks.instance("test", test, UniaxialTest)
    error = uniaxial_stress(rubber, test.time, test.stretch) - test.stress
    return float(np.sqrt(np.mean(error**2)) / test.peak)


def work_error(rubber: Rubber, test: UniaxialTest) -> float:
    """Return the predicted over the measured work int P ds of the test, less one [-].

    For a loop that ends free of stress this is the work lost, as heat or in networks still
    stretched. Trapezoidal rule on the samples, the same for both.
    """
    from scipy.integrate import trapezoid

    checks.instance("test", test, UniaxialTest)
    predicted = uniaxial_stress(rubber, test.time, test.stretch)
    return float(trapezoid(predicted, test.stretch) / trapezoid(test.stress, test.stretch)) - 1


def fit_finite_strain(
    tests: Sequence[UniaxialTest],
    *,
    energy: str = "neo_hookean",
    terms: int = 6,
    band: tuple[float, float] | None = None,
) -> FiniteStrainFit:
    """Fit one rubber to all `tests` together.

    Parameters
    ----------
    tests : sequence of UniaxialTest
        At least one. Each counts by its error relative to its own peak stress.
    energy : str
        Kind of strain energy of the permanent network, one of `STRAIN_ENERGIES`.
    terms : int
        Number of temporary networks, 1 to 40, their relaxation times log-spaced over `band`.
    band : tuple of two floats, optional
        Shortest and longest relaxation time [s]. Default: a hundredth of the shortest test to the
        longest test. Beyond the longest test nothing tells a slow network from a permanent one.

    Returns
    -------
    FiniteStrainFit

    Raises
    ------
    InputError
        If there is no test, or an argument is out of range.
    """
    tests = checks.instances("tests", tests, UniaxialTest)
    law = STRAIN_ENERGIES[checks.one_of("energy", energy, STRAIN_ENERGIES)]
    times = _relaxation_times(tests, checks.whole("terms", terms, least=1, most=40), band)
    left = np.vstack([_columns(law, times, test) * _weight(test) for test in tests])
    right = np.concatenate([test.stress * _weight(test) for test in tests])
    lower = np.zeros(left.shape[1])
    lower[: len(law.least_coefficients)] = law.least_coefficients
    lower[0] = _LEAST_EQUILIBRIUM * min(test.peak for test in tests)
    return FiniteStrainFit(_rubber(law, _solve(left, right, lower), times), tuple(tests))


def _relaxation_times(
    tests: Sequence[UniaxialTest], terms: int, band: tuple[float, float] | None
) -> Array:
    if band is None:
        durations = [test.duration for test in tests]
        band = _FASTEST * min(durations), max(durations)
    ends = checks.positive_vector("band", band, unit="s")
    if len(ends) != 2 or ends[0] >= ends[1]:
        raise InputError(f"band [s] must be a shorter and a longer time; got {checks.shown(band)}")
    low, high = ends
    return np.geomspace(low, high, terms) if terms > 1 else np.array([np.sqrt(low * high)])


def _weight(test: UniaxialTest) -> float:
    """Return what a sample counts [1/Pa]: the squares of a test then sum to its rms_error^2."""
    return float(1.0 / (test.peak * np.sqrt(len(test.time))))


def _columns(law: type[StrainEnergy], times: Array, test: UniaxialTest) -> Array:
    """Return the nominal stress per unit of each fitted coefficient [-], shape (samples, all)."""
    stretch = test.stretch
    networks = uniaxial_network_stresses(times, test.time, stretch)
    hooke = stretch - stretch**-2
    return np.column_stack([*(hooke * factor for factor in law.basis(stretch)), networks])


def _solve(left: Array, right: Array, lower: Array) -> Array:
    """Return the bounded least-squares solution, columns scaled to unit length."""
    from scipy.optimize import lsq_linear

    scale = np.linalg.norm(left, axis=0)
    bounds = (lower * scale, np.full(len(scale), np.inf))
    found = lsq_linear(left / scale, right, bounds, method="bvls", tol=1e-14)
    return np.asarray(found.x / scale, dtype=float)


def _rubber(law: type[StrainEnergy], found: Array, times: Array) -> Rubber:
    """Return the rubber of the fitted coefficients, without elements of zero modulus."""
    count = len(found) - len(times)
    shear, energy = law.from_coefficients(found[:count].tolist())
    moduli = found[count:]
    used = moduli > 1e-9 * (shear + moduli.sum())
    return Rubber(3.0 * shear, 3.0 * moduli[used], times[used], strain_energy=energy)
