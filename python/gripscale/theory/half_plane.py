"""One wave by small-strain theory: steady sliding of a viscoelastic half-plane.

Harmonic m of the pressure p over the rigid wave w = A cos(k x) raises the surface by

    u_m = 2 p_m / (m k M(m k v)),        M = E*/(1-nu^2) = 4 G* (3K + G*) / (3K + 4 G*)
    mu  = mean(p dw/dx) / mean(p) = (4 / mean(p)) sum_m |p_m|^2 Im M(m k v) / |M(m k v)|^2

K. L. Johnson, Contact Mechanics (1985), sec. 13.2, doi:10.1017/CBO9781139171731. Boundary elements
over theta = k x with a piecewise linear pressure, and an active set by block pivoting (J. J. Judice
& F. M. Pires, Comput. Oper. Res. 21 (1994) 587, doi:10.1016/0305-0548(94)90106-6): docs/method.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np

from gripscale.core import Checked, InputError, Status, checked, checks
from gripscale.core.arrays import Array, ComplexArray, Mask, Quantity
from gripscale.rubber import Rubber
from gripscale.rubber.material import require_load_bearing
from gripscale.theory import elastic, layers
from gripscale.wave.problem import Sine, WaveLoad, WaveProblem
from gripscale.wave.result import ScaleResult

Compliance = Callable[[Array], ComplexArray]

_ALIASES = 16  # harmonics summed, in units of N; the neglected ones fall off as m^-3
_PATIENCE = 5  # iterations without fewer wrong nodes before single nodes change sides
_COARSEST = 64
_FEWEST_IN_CONTACT = 8


@dataclass(frozen=True)
class GridContact:
    """Contact on a periodic grid by an active set: arrays of the shape of the grid."""

    pressure: Array  # in the unit of the solver: [Pa], or over the mean pressure
    gap: Array  # in the unit of the solver: [m], or over the amplitude
    active: Mask
    iterations: int
    settled: bool  # whether the active set stopped changing, with the linear system solved
    products: int = 0  # products with the influence matrix, of an iterative solver
    # Residual of the linear system over the pressure [-], of an iterative solver.
    missing: float = 0.0


def nodes(points: int) -> Array:
    """Return the angles of the nodes, from -pi [rad], shape (points,)."""
    return -np.pi + 2.0 * np.pi * np.arange(points) / points


def solve_periodic_contact(
    compliance: Compliance, height: Callable[[Array], Array], points: int, most_iterations: int
) -> GridContact:
    """Return the contact of compliances c(m) and a surface over angles [rad], on nested grids."""
    levels = [points]
    while levels[0] % 2 == 0 and levels[0] > _COARSEST:
        levels.insert(0, levels[0] // 2)
    active = height(nodes(levels[0])) > 0.0
    iterations = 0
    for level in levels:
        if len(active) != level:
            finer = np.repeat(active, 2)
            active = finer | np.roll(finer, -1)
        contact = _pivoted(compliance, height(nodes(level)), active, most_iterations)
        active = contact.active
        iterations += contact.iterations
    return replace(contact, iterations=iterations)


def _pivoted(
    compliance: Compliance, height: Array, active: Mask, most_iterations: int
) -> GridContact:
    """Return the contact on one grid by block pivoting from the `active` nodes."""
    points = len(height)
    influence = influence_column(compliance, points)
    transform = np.fft.fft(influence)
    fewest, patience = points + 1, _PATIENCE
    for iteration in range(1, most_iterations + 1):
        # closes the gap at the active nodes; the border is the rigid offset d and the mean pressure
        where = np.flatnonzero(active)
        size = len(where)
        system = np.zeros((size + 1, size + 1))
        system[:size, :size] = influence[(where[:, None] - where[None, :]) % points]
        system[:size, size] = 1.0
        system[size, :size] = 1.0 / points
        try:
            solution = np.linalg.solve(system, np.append(height[where], 1.0))
        except np.linalg.LinAlgError:  # no node is active, or compliances are lost in rounding
            return GridContact(np.zeros(points), -height, active, iteration, settled=False)
        pressure = np.zeros(points)
        pressure[where], offset = solution[:size], float(solution[size])
        gap = np.fft.ifft(transform * np.fft.fft(pressure)).real + offset - height
        wrong = np.where(active, pressure < 0.0, gap < -1e-12)
        count = int(wrong.sum())
        if count == 0:
            return GridContact(pressure, gap, active, iteration, settled=True)
        if count < fewest:
            fewest, patience = count, _PATIENCE
        elif patience > 0:
            patience -= 1
        else:
            wrong[: np.flatnonzero(wrong)[-1]] = False
        active = active ^ wrong
    return GridContact(pressure, gap, active ^ wrong, most_iterations, settled=False)


def influence_column(compliance: Compliance, points: int) -> Array:
    """Return K, the first column of the circulant influence matrix, shape (points,)."""
    number = np.arange(1, _ALIASES * points + 1)
    value = compliance(number.astype(float)) * np.sinc(number / points) ** 2
    folded = np.zeros(points, dtype=np.complex128)
    np.add.at(folded, number % points, value)
    np.add.at(folded, -number % points, value.conj())
    return np.asarray(np.fft.ifft(folded).real)


def pressure_harmonics(pressure: Array) -> ComplexArray:
    """Return the Fourier coefficients m = 1, 2, ... of the piecewise linear pressure, to 16 N."""
    points = len(pressure)
    number = np.arange(1, _ALIASES * points + 1)
    at_nodes = np.fft.fft(pressure) / points
    origin = np.where(number % 2 == 0, 1.0, -1.0)  # theta starts at -pi
    return np.asarray(at_nodes[number % points] * origin * np.sinc(number / points) ** 2)


def contact_edges(contact: GridContact) -> list[tuple[float, float]]:
    """Return the contact patches as (start, end) angles [rad]; one across +-pi has end > pi."""
    active, gap, points = contact.active, contact.gap, len(contact.gap)
    if active.all():
        return [(-np.pi, np.pi)]
    step = 2.0 * np.pi / points
    starts = np.flatnonzero(active & ~np.roll(active, 1)).tolist()
    ends = np.flatnonzero(active & ~np.roll(active, -1)).tolist()
    patches = []
    for start in starts:
        end = next((end for end in ends if end >= start), ends[0] + points)
        first = start - _edge_offset(gap, active, start, -1)
        last = end + _edge_offset(gap, active, end % points, +1)
        patches.append((-np.pi + step * first, -np.pi + step * last))
    return patches


def _edge_offset(gap: Array, active: Mask, node: int, side: int) -> float:
    """Return how far beyond the last active node the contact ends [elements, 0 to 1].

    Outside the edge of a smooth contact the gap grows as (distance)^(3/2), so gap^(2/3) at the two
    nearest open nodes is extrapolated to zero.
    """
    points = len(gap)
    near, far = (node + side) % points, (node + 2 * side) % points
    if active[far] or gap[far] <= max(gap[near], 0.0):
        return 0.5
    here, there = max(gap[near], 0.0) ** (2.0 / 3.0), gap[far] ** (2.0 / 3.0)
    return float(np.clip(1.0 - here / (there - here), 0.0, 1.0))


class HalfPlane(Checked):
    """Solver of one wave at small strain; `InputError` if an argument is out of its range."""

    name: ClassVar[str] = "half_plane"

    points: int = checked(checks.whole, least=16, most=8192, default=1024)
    """Nodes per wavelength, 16 to 8192; a multiple of a power of two is solved fastest."""
    most_iterations: int = checked(checks.whole, least=1, most=100_000, default=200)
    """Active-set iterations allowed on each grid."""

    @classmethod
    def of(cls, **options: Any) -> HalfPlane:
        """Return the solver of keyword arguments; raise `InputError` for an unknown one."""
        checks.allowed_names("option", options, cls.__dataclass_fields__)
        return cls(**options)

    def solve(self, problem: WaveProblem, start: ScaleResult | None = None) -> ScaleResult:
        """Return contact and friction of `problem`.

        Raises `InputError` for a `start`, which the nested grids do not use, and for a profile
        other than a sine.
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
        load, wave = problem.load, problem.profile
        k = 2.0 * np.pi / wave.wavelength
        frequency = 2.0 * np.pi * load.speed / wave.wavelength
        x = nodes(self.points) / k

        def modulus(number: Array) -> ComplexArray:
            omega = number * frequency
            return layers.effective_modulus(problem.rubber, omega, k * number, problem.thickness)

        first = complex(modulus(np.ones(1))[0])
        sizes = {"wavelength": wave.wavelength, "amplitude": wave.amplitude}
        swing = elastic.full_contact_pressure(first, **sizes)
        full = load.pressure >= swing
        status, iterations, residual = Status.CONVERGED, 0, 0.0
        if full:
            # one harmonic of pressure, ahead of the wave by the loss angle
            edges, in_contact = [(-np.pi, np.pi)], self.points
            sizes["pressure"] = load.pressure
            friction = dissipated = elastic.full_contact_friction(first, **sizes)
            pressure = load.pressure + swing * np.cos(k * x + float(np.angle(first)))
        else:
            slope = k * wave.amplitude

            def compliance(number: Array) -> ComplexArray:
                return 2.0 * load.pressure / (slope * number * modulus(number))

            contact = solve_periodic_contact(compliance, np.cos, self.points, self.most_iterations)
            edges, in_contact = contact_edges(contact), int(contact.active.sum())
            harmonics = pressure_harmonics(contact.pressure)
            stiffness = modulus(np.arange(1.0, len(harmonics) + 1.0))
            lost = np.abs(harmonics) ** 2 * stiffness.imag / np.abs(stiffness) ** 2
            friction = float(slope * harmonics[0].imag)
            dissipated = float(4.0 * load.pressure * lost.sum())
            pressure, iterations = load.pressure * contact.pressure, contact.iterations
            tension = -np.minimum(contact.pressure, 0.0).mean()
            residual = float(tension + abs(contact.pressure.mean() - 1.0))
            if not contact.settled:
                status = Status.ACTIVE_SET_NOT_SETTLED
            elif in_contact < _FEWEST_IN_CONTACT:
                status = Status.CONTACT_TOO_NARROW
        return ScaleResult(
            wavelength=wave.wavelength,
            amplitude=wave.amplitude,
            pressure_received=load.pressure,
            speed=load.speed,
            load_time=load.load_time,
            contact_fraction=sum(end - start for start, end in edges) / (2.0 * np.pi),
            friction=friction,
            friction_from_dissipation=dissipated,
            status=status,
            newton_iterations=iterations,
            residual=residual,
            min_stretch=math.nan,
            max_stretch=math.nan,
            x=x,
            pressure=pressure,
            rubber=problem.rubber,
            model=HalfPlane.name,
            details={
                "points": self.points,
                "points_in_contact": in_contact,
                "contact_edges": [(start / k, end / k) for start, end in edges],
                "full_contact": full,
            },
        )


def solve_half_plane(
    rubber: Rubber,
    *,
    wavelength: Quantity,
    amplitude: Quantity,
    pressure: Quantity,
    speed: Quantity,
    load_time: Quantity = float("inf"),
    points: int = HalfPlane.points,
    most_iterations: int = HalfPlane.most_iterations,
) -> ScaleResult:
    """Return contact and friction of one wave by small-strain theory.

    The result has the `model` "half_plane", stretches NaN (the surface of a half-plane does not
    show them) and `details`: `contact_edges` [m], `points`, `points_in_contact`, `full_contact`. A
    `status` other than "converged" says why not to trust the numbers. Raises `InputError` if an
    argument is out of its range, or the rubber at rest is a melt: the pressure is more than ten
    times the equilibrium modulus.

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
    points, most_iterations
        See `HalfPlane`.
    """
    problem = WaveProblem(rubber, Sine(wavelength, amplitude), WaveLoad(pressure, speed, load_time))
    if problem.load.speed == 0.0:
        require_load_bearing(rubber, problem.load.pressure, math.inf)
    return HalfPlane(points, most_iterations).solve(problem)
