"""Finite strain of a material point: its stress, measured tests, and a rubber fitted to them.

The permanent network has the strain energy W; each Maxwell element is a temporary network:

    tau_i dA_i/dt = C^-1 - A_i,   A_i = 1 before the first sample
    S = G_inf b + sum_i G_i A_i - p C^-1,   b = 2/G_inf dW/dC,   p from the free side faces

Source: J. Lubliner, Mech. Res. Commun. 12 (1985) 93, doi:10.1016/0093-6413(85)90075-8.
The memory integral is exact for C^-1 linear in time between samples (R. L. Taylor, K. S. Pister &
G. L. Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45, doi:10.1002/nme.1620020106):

    A <- e^-x A + ((1 - e^-x)/x - e^-x) Y_old + (1 - (1 - e^-x)/x) Y_new,   Y = C^-1,  x = dt/tau

Uniaxial stretch s:  P = dW/ds + sum_i G_i (s A_11 - s^-2 A_22),   Y_11 = s^-2,  Y_22 = s.
Simple shear g:      T = dW/dg + sum_i G_i (g + A_12),             Y_12 = -g,  Y_22 = A_22 = 1.

In simple shear the temporary networks are linear at any amplitude: T is then that of small strain.
On given relaxation times the nominal stress is linear in the moduli,

    P(t) = sum_k c_k P_k(s) + sum_i G_i (s A_i,11 - s^-2 A_i,22)

(P_k and c_k are the strain energy's: `StrainEnergy.basis`), so that the least squares of P over
the peak stress of each test, each test counting alike, is a convex problem with bounds and one
minimum: no start values, no local minima. Bounded-variable least squares: P. B. Stark & R. L.
Parker, Comput. Stat. 10 (1995) 129.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, FileError, InputError, Vector, checked, checks
from gripscale.core.units import quantity_in_si
from gripscale.io.text_table import file_path, read_sheets
from gripscale.rubber.material import Rubber
from gripscale.rubber.strain_energy import STRAIN_ENERGIES


class UniaxialTest(Checked, eq=False):
    """A history of stretch with its nominal stress; `InputError` for values out of range."""

    name: str = checked(checks.text)
    """What the test is called in messages and figures."""
    time: Vector = checked(checks.vector, unit="s", repr=False)
    """Rising [s], shape (samples,), at least two samples."""
    stretch: Vector = checked(checks.positive_vector, repr=False)
    """Deformed over undeformed length [-], shape (samples,), above zero; 1 at rest, at first."""
    stress: Vector = checked(checks.vector, unit="Pa", repr=False)
    """Nominal stress [Pa], shape (samples,), somewhere above zero."""

    def __post_init__(self) -> None:
        super().__post_init__()
        name = self.name
        checks.same_length(2, time=self.time, stretch=self.stretch, stress=self.stress)
        falls = np.diff(self.time, prepend=-np.inf) <= 0.0
        checks.refuse_entries(self.time, falls, f"{name}: time must rise [s]")
        if self.peak <= 0.0:
            raise InputError(f"{name}: stress must be above zero [Pa] somewhere")

    @property
    def peak(self) -> float:
        """Largest nominal stress [Pa]."""
        return float(self.stress.max())

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])


def read_uniaxial_test(path: str | Path, *, stress_unit: str = "Pa") -> UniaxialTest:
    """Read a test from the first sheet of an Excel file: time [s], stretch [-], nominal stress.

    These are the first three columns, with numbers in every row and no header; `stress_unit` is the
    unit of the third, such as kPa. Raises `FileError` if openpyxl is missing (`pip install
    'gripscale[export]'`) or the file is not as expected, `InputError` if the unit is unknown.
    """
    pascal = quantity_in_si(1.0, stress_unit, "modulus", "stress_unit")
    path = file_path(path)
    rows = next(iter(read_sheets(path).values()))
    try:
        if any(len(row) < 3 for row in rows):
            raise InputError("a row has fewer than three cells")
        table = np.array([row[:3] for row in rows], dtype=float).reshape(len(rows), 3)
        return UniaxialTest(path.stem, table[:, 0], table[:, 1], table[:, 2] * pascal)
    except (TypeError, ValueError) as error:
        raise FileError(f"{path}: expected rows of time, stretch, stress ({error})") from error


# Below this x = dt/tau the weights are taken from their power series (next term below 1e-14).
_SMALL_STEP = 1e-3


def uniaxial_stress(rubber: Rubber, time: ArrayLike, stretch: ArrayLike) -> Array:
    """Return the nominal stress [Pa] of a bar in uniaxial tension or compression, shape (samples,).

    The bulk modulus is taken as infinite. Raises `InputError` if a time falls, a stretch is not
    positive, or the lengths differ.

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid.
    time : array_like, shape (samples,)
        Times of the samples [s], not falling; two equal times make a step.
    stretch : array_like, shape (samples,)
        Deformed over undeformed length [-], above zero. Before the first sample the bar is at rest
        and undeformed: a first stretch other than 1 is a step.
    """
    checks.instance("rubber", rubber, Rubber)
    ratio = checks.positive_vector("stretch", stretch)
    elapsed = _times(time, ratio, "stretch")
    permanent = rubber.strain_energy.uniaxial_factor(ratio) * (ratio - ratio**-2)
    temporary = uniaxial_network_stresses(rubber.relaxation_times, elapsed, ratio)
    equilibrium = rubber.equilibrium_shear_modulus
    return np.asarray(equilibrium * permanent + temporary @ rubber.shear_moduli)


def simple_shear_stress(rubber: Rubber, time: ArrayLike, shear: ArrayLike) -> Array:
    """Return the shear stress [Pa] of a block in simple shear, nominal and true, shape (samples,).

    `shear` is displacement over height [-], shape (samples,). Volume does not change, so the bulk
    modulus does not matter; `time` and the rest before it are as in `uniaxial_stress`. Raises
    `InputError` if a time falls, a value is not finite, or the lengths differ.
    """
    checks.instance("rubber", rubber, Rubber)
    amount = checks.vector("shear", shear)
    elapsed = _times(time, amount, "shear")
    permanent = rubber.strain_energy.shear_factor(amount) * amount
    states = network_states(rubber.relaxation_times, elapsed, -amount[:, None], rest=(0.0,))
    temporary = (amount[:, None] + states[..., 0]) @ rubber.shear_moduli
    return np.asarray(rubber.equilibrium_shear_modulus * permanent + temporary)


def uniaxial_network_stresses(relaxation_times: Array, time: Array, stretch: Array) -> Array:
    """Return s A_11 - s^-2 A_22: nominal stress over shear modulus [-], shape (samples, terms)."""
    inverse = np.column_stack([stretch**-2, stretch])
    states = network_states(relaxation_times, time, inverse, rest=(1.0, 1.0))
    return np.asarray(
        stretch[:, None] * states[..., 0] - (stretch**-2)[:, None] * states[..., 1], dtype=float
    )


def network_states(
    relaxation_times: Array, time: Array, inverse: Array, rest: tuple[float, ...]
) -> Array:
    """Return the states A_i of the networks, (samples, terms, components), by the recurrence above.

    `inverse` are components of C^-1, (samples, components), `rest` those of the unit tensor.
    """
    step = np.diff(time)[:, None] / relaxation_times
    kept = np.exp(-step)
    # Weights of Y at the start and at the end of steps x = dt/tau.
    x = np.maximum(step, _SMALL_STEP)
    mean = -np.expm1(-x) / x
    small = step < _SMALL_STEP
    before = np.where(small, step * (0.5 - step * (1 / 3 - step / 8)), mean - np.exp(-x))
    after = np.where(small, step * (0.5 - step * (1 / 6 - step / 24)), 1.0 - mean)
    states = np.empty((len(time), len(relaxation_times), inverse.shape[1]))
    states[0] = rest
    new = before[..., None] * inverse[:-1, None, :] + after[..., None] * inverse[1:, None, :]
    for sample in range(len(step)):
        states[sample + 1] = kept[sample, :, None] * states[sample] + new[sample]
    return states


def _times(time: ArrayLike, driven: Array, name: str) -> Array:
    elapsed = checks.vector("time", time, unit="s")
    checks.same_length(1, time=elapsed, **{name: driven})
    falls = np.diff(elapsed, prepend=-np.inf) < 0.0
    checks.refuse_entries(elapsed, falls, "time must not fall [s]")
    return elapsed


# The fitted G_inf is at least this share of the smallest peak stress: a rubber must have one.
_LEAST_EQUILIBRIUM = 1e-3
_FASTEST = 0.01  # shortest fitted relaxation time, as a share of the shortest test


@dataclass(frozen=True)
class FiniteStrainFit:
    """The rubber found, and how well it carries each test."""

    rubber: Rubber
    """Elements whose fitted modulus is zero are left out."""
    tests: tuple[UniaxialTest, ...]
    """What it was fitted to."""

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

    Raises `InputError` if there is no test, or an argument is out of range.

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
    """
    tests = checks.instances("tests", tests, UniaxialTest)
    law = STRAIN_ENERGIES[checks.one_of("energy", energy, STRAIN_ENERGIES)]
    terms = checks.whole("terms", terms, least=1, most=40)
    if band is None:
        durations = [test.duration for test in tests]
        band = _FASTEST * min(durations), max(durations)
    low, high = checks.interval("band", band, unit="s")
    times = np.geomspace(low, high, terms) if terms > 1 else np.array([np.sqrt(low * high)])
    # Nominal stress per unit of each coefficient; the squares of a test sum to its rms_error^2.
    columns, measured = [], []
    for test in tests:
        stretch, weight = test.stretch, 1.0 / (test.peak * np.sqrt(len(test.time)))
        networks = uniaxial_network_stresses(times, test.time, stretch)
        permanent = [(stretch - stretch**-2) * factor for factor in law.basis(stretch)]
        columns.append(np.column_stack([*permanent, networks]) * weight)
        measured.append(test.stress * weight)
    matrix = np.vstack(columns)
    lower = np.zeros(matrix.shape[1])
    lower[: len(law.least_coefficients)] = law.least_coefficients
    lower[0] = _LEAST_EQUILIBRIUM * min(test.peak for test in tests)
    from scipy.optimize import lsq_linear

    scale = np.linalg.norm(matrix, axis=0)
    bounds = (lower * scale, np.full(len(scale), np.inf))
    fit = lsq_linear(matrix / scale, np.concatenate(measured), bounds, method="bvls", tol=1e-14)
    coefficients = np.asarray(fit.x / scale, dtype=float)
    count = len(coefficients) - len(times)
    shear, strain_energy = law.from_coefficients(coefficients[:count].tolist())
    moduli = coefficients[count:]
    used = moduli > 1e-9 * (shear + moduli.sum())
    rubber = Rubber(3.0 * shear, 3.0 * moduli[used], times[used], strain_energy=strain_energy)
    return FiniteStrainFit(rubber, tuple(tests))
