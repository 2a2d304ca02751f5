"""One finite-strain rubber fitted to several uniaxial tests together.

On given relaxation times the nominal stress of a material point is linear in its moduli,

    P(t) = sum_k c_k P_k(s) + sum_i G_i (s A_i,11 - s^-2 A_i,22)

    neo-Hookean    c = G_inf
    Mooney-Rivlin  c = G_inf (1 - share), G_inf share
    Yeoh           c = G_inf, G_inf c2, G_inf c3

so that the least squares of P over the peak stress of each test, each test counting alike, is a
convex problem with bounds (moduli not negative, c2 free) and one minimum: no start values, no
local minima. Bounded-variable least squares: P. B. Stark & R. L. Parker, Comput. Stat. 10 (1995)
129.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import trapezoid
from scipy.optimize import lsq_linear

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.header import MODULUS_UNITS
from gripscale.rubber.material import Rubber
from gripscale.rubber.material_point import uniaxial_network_stresses, uniaxial_stress
from gripscale.rubber.strain_energy import MooneyRivlin, NeoHookean, StrainEnergy, Yeoh

Array = NDArray[np.float64]

ENERGIES = ("neo_hookean", "mooney_rivlin", "yeoh")
"""Strain energies a fit knows."""

_LEAST_EQUILIBRIUM = 1e-3
"""The fitted G_inf is at least this share of the smallest peak stress: a rubber must have one."""

_FASTEST = 0.01
"""Shortest fitted relaxation time, as a share of the shortest test."""


@dataclass(frozen=True, init=False, eq=False)
class UniaxialTest:
    """A measured history of stretch with its nominal stress.

    Parameters
    ----------
    name : str
        What the test is called in messages and figures.
    time : array_like, shape (samples,)
        Rising [s], at least two samples.
    stretch : array_like, shape (samples,)
        Deformed over undeformed length [-], above zero; 1 at rest before the first sample.
    stress : array_like, shape (samples,)
        Nominal stress [Pa], somewhere above zero.

    Raises
    ------
    InputError
        If the lengths differ or a value is out of range.
    """

    name: str
    time: Array = field(repr=False)
    stretch: Array = field(repr=False)
    stress: Array = field(repr=False)

    def __init__(self, name: str, time: ArrayLike, stretch: ArrayLike, stress: ArrayLike) -> None:
        object.__setattr__(self, "name", str(name))
        object.__setattr__(self, "time", checks.vector("time", time, unit="s"))
        object.__setattr__(self, "stretch", checks.positive_vector("stretch", stretch))
        object.__setattr__(self, "stress", checks.vector("stress", stress, unit="Pa"))
        lengths = len(self.time), len(self.stretch), len(self.stress)
        if len(set(lengths)) != 1 or lengths[0] < 2:
            raise InputError(
                f"{name}: time, stretch and stress must have the same length, at least 2; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        if (np.diff(self.time) <= 0.0).any():
            at = int(np.argmax(np.diff(self.time) <= 0.0)) + 1
            raise InputError(f"{name}: time must rise [s]; got {self.time[at]:g} at index {at}")
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
    """Return the root mean square error of the predicted stress over the measured peak [-]."""
    error = uniaxial_stress(rubber, test.time, test.stretch) - test.stress
    return float(np.sqrt(np.mean(error**2)) / test.peak)


def work_error(rubber: Rubber, test: UniaxialTest) -> float:
    """Return the predicted over the measured work int P ds of the test, less one [-].

    For a loop that ends free of stress this is the work lost, as heat or in networks still
    stretched. Trapezoidal rule on the samples, the same for both.
    """
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
        Strain energy of the permanent network: "neo_hookean", "mooney_rivlin" or "yeoh".
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
    if len(tests) == 0:
        raise InputError("tests must hold at least one UniaxialTest; got none")
    checks.one_of("energy", energy, ENERGIES)
    times = _relaxation_times(tests, checks.whole("terms", terms, least=1, most=40), band)
    left = np.vstack([_columns(energy, times, test) * _weight(test) for test in tests])
    right = np.concatenate([test.stress * _weight(test) for test in tests])
    lower = np.zeros(left.shape[1])
    lower[0] = _LEAST_EQUILIBRIUM * min(test.peak for test in tests)
    if energy == "yeoh":
        lower[1] = -np.inf
    return FiniteStrainFit(_rubber(energy, _solve(left, right, lower), times), tuple(tests))


def read_uniaxial_test(path: str | Path, *, stress_unit: str = "Pa") -> UniaxialTest:
    """Read a test from the first sheet of an Excel file: time [s], stretch [-], nominal stress.

    Parameters
    ----------
    path : str or Path
        An xlsx file whose first three columns hold numbers in every row; no header.
    stress_unit : str
        Unit of the third column, e.g. "kPa".

    Raises
    ------
    FileError
        If openpyxl is missing (`pip install gripscale[formats]`) or the file is not as expected.
    InputError
        If the unit is unknown.
    """
    checks.one_of("stress_unit", stress_unit, MODULUS_UNITS)
    path = Path(path)
    rows = _first_sheet(path)
    try:
        if any(len(row) < 3 for row in rows):
            raise InputError("a row has fewer than three cells")
        table = np.array([row[:3] for row in rows], dtype=float).reshape(len(rows), 3)
        stress = table[:, 2] * MODULUS_UNITS[stress_unit]
        return UniaxialTest(path.stem, table[:, 0], table[:, 1], stress)
    except (TypeError, ValueError) as error:
        raise FileError(f"{path}: expected rows of time, stretch, stress ({error})") from error


def _first_sheet(path: Path) -> list[tuple[object, ...]]:
    if not path.is_file():
        raise FileError(f"{path}: no such file")
    try:
        openpyxl = import_module("openpyxl")
    except ImportError as error:
        raise FileError(f"{path}: xlsx needs openpyxl: pip install gripscale[formats]") from error
    try:
        book = openpyxl.load_workbook(path, read_only=True, data_only=True)
    except Exception as error:  # openpyxl, zipfile and the XML parser fail each in their own way
        raise FileError(f"{path}: expected an xlsx file ({type(error).__name__})") from error
    try:
        return list(book.worksheets[0].iter_rows(values_only=True))
    finally:
        book.close()


def _relaxation_times(
    tests: Sequence[UniaxialTest], terms: int, band: tuple[float, float] | None
) -> Array:
    if band is None:
        durations = [test.duration for test in tests]
        band = _FASTEST * min(durations), max(durations)
    low = checks.positive("band[0]", band[0], unit="s")
    high = checks.positive("band[1]", band[1], unit="s")
    if low >= high:
        raise InputError(f"band [s] must be a shorter and a longer time; got {low:g} and {high:g}")
    return np.geomspace(low, high, terms) if terms > 1 else np.array([np.sqrt(low * high)])


def _weight(test: UniaxialTest) -> float:
    """Return what a sample counts [1/Pa]: the squares of a test then sum to its rms_error^2."""
    return float(1.0 / (test.peak * np.sqrt(len(test.time))))


def _columns(energy: str, times: Array, test: UniaxialTest) -> Array:
    """Return the nominal stress per unit of each fitted coefficient [-], shape (samples, all)."""
    stretch = test.stretch
    networks = uniaxial_network_stresses(times, test.time, stretch)
    hooke = stretch - stretch**-2
    return np.column_stack([*(hooke * f for f in _factors(energy, stretch)), networks])


def _factors(energy: str, stretch: Array) -> list[Array]:
    """Return P_k over s - s^-2 of the coefficients c_k [-]."""
    if energy == "neo_hookean":
        return [NeoHookean().uniaxial_factor(stretch)]
    if energy == "mooney_rivlin":
        return [MooneyRivlin(share).uniaxial_factor(stretch) for share in (0.0, 1.0)]
    gauss = Yeoh(0.0, 0.0).uniaxial_factor(stretch)
    square, cube = Yeoh(1.0, 0.0), Yeoh(0.0, 1.0)
    return [gauss, *(law.uniaxial_factor(stretch) - gauss for law in (square, cube))]


def _solve(left: Array, right: Array, lower: Array) -> Array:
    """Return the bounded least-squares solution, columns scaled to unit length."""
    scale = np.linalg.norm(left, axis=0)
    bounds = (lower * scale, np.full(len(scale), np.inf))
    found = lsq_linear(left / scale, right, bounds, method="bvls", tol=1e-14)
    return np.asarray(found.x / scale, dtype=float)


def _rubber(energy: str, found: Array, times: Array) -> Rubber:
    """Return the rubber of the fitted coefficients, without elements of zero modulus."""
    count = len(found) - len(times)
    shear, law = _permanent(energy, found[:count])
    moduli = found[count:]
    used = moduli > 1e-9 * (shear + moduli.sum())
    return Rubber(3.0 * shear, 3.0 * moduli[used], times[used], strain_energy=law)


def _permanent(energy: str, c: Array) -> tuple[float, StrainEnergy]:
    """Return G_inf [Pa] and the strain energy of the coefficients c_k [Pa]."""
    if energy == "neo_hookean":
        return float(c[0]), NeoHookean()
    if energy == "mooney_rivlin":
        return float(c.sum()), MooneyRivlin(float(c[1] / c.sum()))
    return float(c[0]), Yeoh(float(c[1] / c[0]), float(c[2] / c[0]))
