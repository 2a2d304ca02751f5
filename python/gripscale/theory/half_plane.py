"""One wave by small-strain theory: steady sliding of a viscoelastic half-plane.

Geometry: plane strain, frictionless, small slope; rigid wave w = A cos(k x) at rest,
k = 2 pi/lambda, crest at x = 0; the rubber lies above and slides over it towards +x with speed v.
A harmonic exp(i m k x) that stands still in this frame is seen by the rubber at the angular
frequency m k v, so

    u_m = 2 p_m / (m k M(m k v)),        M = E*/(1-nu^2) = 4 G* (3K + G*) / (3K + 4 G*)

K. L. Johnson, Contact Mechanics (1985), sec. 13.2, doi:10.1017/CBO9781139171731, with the complex
modulus in place of the elastic one (correspondence principle). Friction opposes the sliding:

    mu = mean(p dw/dx) / mean(p)                            from the contact traction
    mu = (4 / mean(p)) sum_m |p_m|^2 Im M(m k v) / |M(m k v)|^2    from the energy lost

A model independent of the finite-strain block, right where slopes are small. The mean state has
no part in it: a mean pressure and shear only shift a linear half-plane, so the load time has no
effect.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.theory.elastic import (
    full_contact_friction,
    full_contact_pressure,
    plane_strain_modulus,
    poisson,
)
from gripscale.wave.kernel import face_of
from gripscale.wave.problem import Load, Sine, Status, WaveProblem
from gripscale.wave.result import WaveResult

# Frictionless contact of a linear half-plane with a periodic rigid surface, by boundary elements.
#
# Everything here is dimensionless: abscissa theta = k x in [-pi, pi), heights over the amplitude,
# pressures over the mean pressure. The pressure is piecewise linear on N equal elements; harmonic m
# of the pressure raises the surface by c(m) times itself (c complex: the surface lags behind). With
# hat functions, whose Fourier coefficients are sinc^2(m/N), a nodal pressure p_j gives at node i
#
#     u_i = d + sum_j K_(i-j) p_j,   K_j = (1/N) sum_(m != 0) c(m) sinc^2(m/N) exp(i m theta_j)
#
# and contact asks for gap = u - w >= 0, p >= 0, gap p = 0 at every node, mean p = 1. Viscosity
# makes K unsymmetric, but its symmetric part is positive definite, so the solution is unique (R. W.
# Cottle, J.-S. Pang, R. E. Stone, The Linear Complementarity Problem, 1992, sec. 3.1). The active
# set is found by block pivoting, and one node at a time where blocks stall (J. J. Judice & F. M.
# Pires, Comput. Oper. Res. 21 (1994) 587, doi:10.1016/0305-0548(94)90106-6).

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


_FEWEST_IN_CONTACT = 8


@dataclass(frozen=True)
class HalfPlane:
    """Solver of one wave at small strain.

    Parameters
    ----------
    points : int
        Nodes per wavelength, 16 to 8192; a multiple of a power of two is solved fastest.
    poisson_ratio : float, optional
        Constant Poisson's ratio, E* then being Young's modulus; by default shear relaxes at
        constant bulk modulus and Poisson's ratio follows the frequency.
    most_iterations : int
        Active-set iterations allowed on each grid.

    Raises
    ------
    InputError
        If an argument is out of its range.
    """

    name: ClassVar[str] = "half_plane"

    points: int = 1024
    poisson_ratio: float | None = None
    most_iterations: int = 200

    def __post_init__(self) -> None:
        checked: dict[str, Any] = {
            "points": checks.whole("points", self.points, least=16, most=8192),
            "most_iterations": checks.whole(
                "most_iterations", self.most_iterations, least=1, most=100_000
            ),
        }
        if self.poisson_ratio is not None:
            checked["poisson_ratio"] = poisson(self.poisson_ratio)
        for name, value in checked.items():
            object.__setattr__(self, name, value)

    @classmethod
    def of(cls, **options: Any) -> HalfPlane:
        """Return the solver of keyword arguments; unknown ones are refused."""
        checks.allowed_names("option", options, cls.__dataclass_fields__)
        return cls(**options)

    def solve(self, problem: WaveProblem, start: WaveResult | None = None) -> WaveResult:
        """Return contact and friction of `problem`.

        Raises `InputError` if there is a `start`: grids nested from coarse to fine need none.
        """
        if start is not None:
            raise InputError(
                "start must be None: the half-plane model is solved on nested grids and starts "
                f"from nothing; got a result of {start.model}"
            )
        if not isinstance(problem.profile, Sine):
            raise InputError(
                "profile must be a Sine for the half-plane model of one wave; "
                f"got a {type(problem.profile).__name__}"
            )
        wave = _Wave(problem.profile, problem.load, self.points)

        def modulus(number: Array) -> ComplexArray:
            return _modulus(problem.rubber, number * wave.frequency, self.poisson_ratio)

        first = complex(modulus(np.ones(1))[0])
        full = full_contact_pressure(first, **wave.shape)
        filled = wave.pressure >= full
        found = _fill(wave, first) if filled else _touch(wave, modulus, self.most_iterations)
        return _result(problem, wave, found, filled=filled)


@face_of(HalfPlane)
def solve_half_plane(
    rubber: Rubber,
    *,
    wavelength: float,
    amplitude: float,
    pressure: float,
    speed: float,
    load_time: float = float("inf"),
    points: int = HalfPlane.points,
    poisson_ratio: float | None = None,
    most_iterations: int = HalfPlane.most_iterations,
) -> WaveResult:
    """Return contact and friction of one wave by small-strain theory.

    Parameters
    ----------
    rubber : Rubber
        The sliding half-plane.
    wavelength, amplitude : float
        Of the rigid wave, amplitude half peak to valley [m], above zero.
    pressure : float
        Mean pressure [Pa], above zero.
    speed : float
        Sliding speed [m/s]; zero is the relaxed, elastic contact.
    load_time : float
        How long the load has lasted [s]; recorded, without effect in small strain.
    points, poisson_ratio, most_iterations
        See `HalfPlane`.

    Returns
    -------
    WaveResult
        With `model` "half_plane", stretches NaN (a half-plane's surface does not show them) and
        `details`: `contact_edges` [m], `points`, `points_in_contact`, `full_contact`. A `status`
        other than "converged" says why not to trust the numbers.

    Raises
    ------
    InputError
        If an argument is out of its range, or the rubber at rest is a melt: the pressure is more
        than ten times the equilibrium modulus.
    """
    problem = WaveProblem(rubber, Sine(wavelength, amplitude), Load(pressure, speed, load_time))
    if problem.load.speed == 0.0:
        require_load_bearing(rubber, problem.load.pressure, math.inf)
    return HalfPlane(points, poisson_ratio, most_iterations).solve(problem)


def _result(problem: WaveProblem, wave: _Wave, found: _Found, *, filled: bool) -> WaveResult:
    return WaveResult(
        wavelength=wave.profile.wavelength,
        amplitude=wave.profile.amplitude,
        pressure_received=wave.pressure,
        speed=wave.load.speed,
        load_time=wave.load.load_time,
        contact_fraction=sum(end - start for start, end in found.edges) / (2.0 * np.pi),
        friction=found.friction,
        friction_from_dissipation=found.friction_from_dissipation,
        status=found.status,
        newton_iterations=found.iterations,
        residual=found.residual,
        min_stretch=float("nan"),
        max_stretch=float("nan"),
        x=wave.x,
        pressure=found.pressure,
        rubber=problem.rubber,
        model=HalfPlane.name,
        details={
            "points": wave.points,
            "points_in_contact": found.points_in_contact,
            "contact_edges": [
                (start / wave.number, end / wave.number) for start, end in found.edges
            ],
            "full_contact": filled,
        },
    )


@dataclass(frozen=True)
class _Wave:
    """What is asked, and on how many nodes."""

    profile: Sine
    load: Load
    points: int

    @property
    def shape(self) -> dict[str, float]:
        return {"wavelength": self.profile.wavelength, "amplitude": self.profile.amplitude}

    @property
    def pressure(self) -> float:
        return self.load.pressure

    @property
    def number(self) -> float:
        return 2.0 * np.pi / self.profile.wavelength

    @property
    def frequency(self) -> float:
        """Angular frequency k v [rad/s]."""
        return 2.0 * np.pi * self.load.speed / self.profile.wavelength

    @property
    def slope(self) -> float:
        return self.number * self.profile.amplitude

    @property
    def x(self) -> Array:
        return nodes(self.points) / self.number


@dataclass(frozen=True)
class _Found:
    """What is answered; edges as angles k x [rad], pressure [Pa]."""

    edges: list[tuple[float, float]]
    friction: float
    friction_from_dissipation: float
    pressure: Array
    points_in_contact: int
    iterations: int = 0
    residual: float = 0.0
    status: Status = Status.CONVERGED


def _fill(wave: _Wave, modulus: complex) -> _Found:
    """Return full contact: one harmonic of pressure, ahead of the wave by the loss angle."""
    friction = full_contact_friction(modulus, pressure=wave.pressure, **wave.shape)
    swing = full_contact_pressure(modulus, **wave.shape)
    phase = wave.number * wave.x + float(np.angle(modulus))
    return _Found(
        edges=[(-np.pi, np.pi)],
        friction=friction,
        friction_from_dissipation=friction,
        pressure=wave.pressure + swing * np.cos(phase),
        points_in_contact=wave.points,
    )


def _touch(wave: _Wave, modulus: Callable[[Array], ComplexArray], limit: int) -> _Found:
    """Return partial contact, by boundary elements."""

    def compliance(number: Array) -> ComplexArray:
        return 2.0 * wave.pressure / (wave.slope * number * modulus(number))

    contact = solve_periodic_contact(compliance, np.cos, wave.points, limit)
    harmonics = pressure_harmonics(contact.pressure)
    stiffness = modulus(np.arange(1.0, len(harmonics) + 1.0))
    lost = np.abs(harmonics) ** 2 * stiffness.imag / np.abs(stiffness) ** 2
    return _Found(
        edges=contact_edges(contact),
        friction=float(wave.slope * harmonics[0].imag),
        friction_from_dissipation=float(4.0 * wave.pressure * lost.sum()),
        pressure=wave.pressure * contact.pressure,
        points_in_contact=int(contact.active.sum()),
        iterations=contact.iterations,
        residual=_residual(contact),
        status=_status(contact),
    )


def _modulus(rubber: Rubber, omega: Array, poisson_ratio: float | None) -> ComplexArray:
    """Return the plane strain modulus M [Pa] at `omega` [rad/s]."""
    if poisson_ratio is None:
        return rubber.plane_strain_modulus(omega)
    return rubber.complex_modulus(omega) * plane_strain_modulus(1.0, poisson_ratio)


def _status(contact: PeriodicContact) -> Status:
    if not contact.settled:
        return Status.ACTIVE_SET_NOT_SETTLED
    narrow = int(contact.active.sum()) < _FEWEST_IN_CONTACT
    return Status.CONTACT_TOO_NARROW if narrow else Status.CONVERGED


def _residual(contact: PeriodicContact) -> float:
    """Return the tension left in the contact and the load's error, over the applied force."""
    tension = -np.minimum(contact.pressure, 0.0).mean()
    return float(tension + abs(contact.pressure.mean() - 1.0))
