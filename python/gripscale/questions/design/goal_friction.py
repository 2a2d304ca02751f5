"""Friction of a compound at the goals of a design, and its derivatives by the Prony moduli.

A goal is a speed, a temperature, a pressure and a road. Its friction is that of the direct contact
from the energy lost, averaged over the profiles of the road by their lengths. A gain is exp(G) - 1,
with G the mean of ln mu over the goals by weight, of one compound less that of another
(docs/derivations.md).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from operator import attrgetter
from typing import TypeVar

import numpy as np

from gripscale.core import Array, Checked, ComplexArray, checked, checks
from gripscale.core.errors import ConvergenceError, InputError
from gripscale.core.parallel import all_results
from gripscale.core.units import celsius
from gripscale.half_space.model import smallest_wavelength
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sampling_error import PIECE, friction_residuals, pieces_that_carry
from gripscale.half_space.sensitivity import FrictionAdjoint, relative_change
from gripscale.half_space.solve import solve_rough_contact
from gripscale.questions.design import compound_limits
from gripscale.questions.vary import friction_ratio
from gripscale.rubber import Rubber
from gripscale.surface import HeightMap, Profile, Surface

_T = TypeVar("_T")
# Residual of the adjoint system over its right side: the grid of the search errs by a per cent.
GRADIENT_TOLERANCE = 1e-5


class CompoundGoal(Checked):
    """Where friction is wanted.

    Parameters
    ----------
    speed : float
        Sliding speed [m/s], above zero.
    pressure : float
        Nominal pressure [Pa].
    temperature : float, optional
        Temperature of the rubber before the contact [K]; by default that of the measurement.
    weight : float
        Weight of the logarithm of this friction among the goals.
    road : str
        Name of the road.
    """

    speed: float = checked(checks.positive, unit="m/s")
    pressure: float = checked(checks.positive, unit="Pa")
    temperature: float | None = checked(checks.positive, unit="K", default=None)
    weight: float = checked(checks.positive, default=1.0)
    road: str = checked(checks.text, default="case")

    def __str__(self) -> str:
        parts = [f"{self.speed:g} m/s", f"{self.pressure / 1e5:g} bar"]
        if self.temperature is not None:
            parts.append(celsius(self.temperature))
        if self.road != "case":
            parts.append(self.road)
        return ", ".join(parts)


@dataclass(frozen=True)
class MeasuredPart:
    """One measurement that a goal's friction is averaged over."""

    goal: int
    surface: Profile | HeightMap
    smallest_wavelength: float  # [m]
    largest_wavelength: float  # of the road's sine waves [m]
    weight: float  # share of the road's length [-]


@dataclass
class GoalFriction:
    """Friction at all goals, solved for one compound after the other.

    Contacts have a grid with four points in the smallest wave, each solved from that of the
    compound before: the friction is a few per cent low there, its derivative within one per cent.
    """

    rubber: Rubber  # today's
    goals: Sequence[CompoundGoal]
    parts: Sequence[MeasuredPart] = field(repr=False)
    workers: int = 1
    thickness: float | None = None  # of the rubber [m]; None: a half-space
    _before: dict[int, RoughContact] = field(default_factory=dict, repr=False)
    _solved: dict[bytes, tuple[float, Array]] = field(default_factory=dict, repr=False)
    _terms: dict[int, ComplexArray] = field(default_factory=dict, repr=False)

    @classmethod
    def of(
        cls,
        rubber: Rubber,
        goals: Sequence[CompoundGoal],
        roads: Mapping[str, Surface],
        workers: int = 1,
        thickness: float | None = None,
    ) -> GoalFriction:
        """Return the friction at `goals` on `roads` by their names.

        Raises `InputError` if a road has no measurement, or the rubber no shift to a goal.
        """
        parts = []
        for index, goal in enumerate(checks.instances("goals", list(goals), CompoundGoal)):
            compound_limits.require_shift(rubber, goal.temperature, "a goal")
            road = roads[checks.one_of("road", goal.road, roads)]
            if road.measured is None:
                why = f"got sine waves stated by hand with {goal.road}"
                raise InputError(f"a design needs a measured road; {why}")
            longest = float(road.sines.wavelength[0])
            surfaces: list[Profile | HeightMap] = list(road.measured.surfaces)
            # the period of a line of n points is n spacings
            lengths = [float((s.x[-1] - s.x[0]) * len(s.x) / (len(s.x) - 1)) for s in surfaces]
            for surface, length in zip(surfaces, lengths, strict=True):
                shortest = smallest_wavelength(road, surface)
                parts.append(MeasuredPart(index, surface, shortest, longest, length / sum(lengths)))
        return cls(rubber, goals, parts, workers, thickness)

    @property
    def weights(self) -> Array:
        """Weights of the goals, their sum one."""
        weights = np.array([goal.weight for goal in self.goals])
        return np.asarray(weights / weights.sum())

    def contacts(self, rubber: Rubber, *, tolerance: float | None = None) -> list[RoughContact]:
        """Return the contact of `rubber` on each part, from that of the compound before.

        Raises `ConvergenceError` if one cannot be used.
        """
        bodies = [compound_limits.rubber_at(rubber, goal.temperature) for goal in self.goals]

        def solve(index: int, _: object) -> RoughContact:
            part, goal = self.parts[index], self.goals[self.parts[index].goal]
            contact = solve_rough_contact(
                bodies[part.goal],
                part.surface,
                pressure=goal.pressure,
                speed=goal.speed,
                thickness=self.thickness,
                smallest_wavelength=part.smallest_wavelength,
                tolerance=tolerance,
                start=self._before.get(index),
            )
            if not contact.has_friction:
                raise ConvergenceError(f"the contact at {goal} has no friction: {contact.status}")
            return contact

        solved = self._each(solve)
        if tolerance is None:
            self._before = dict(enumerate(solved))
        return solved

    def averaged(self, values: Sequence[Array | float]) -> Array:
        """Return the averages over the parts of each goal, shape (goals, ...)."""
        rows = [part.weight * np.asarray(v) for part, v in zip(self.parts, values, strict=True)]
        of_goal = np.array([part.goal for part in self.parts])
        return np.array([sum(np.array(rows)[of_goal == i]) for i in range(len(self.goals))])

    def log_friction(self, ratio: Array) -> tuple[float, Array]:
        """Return the weighted mean of ln mu [-] of moduli times `ratio`, and its gradient.

        What was solved is kept: points of a curve are sought from the same compounds.
        """
        key = np.asarray(ratio, dtype=float).tobytes()
        if key not in self._solved:
            solved = self.contacts(compound_limits.changed(self.rubber, ratio))

            def slope(index: int, _: object) -> Array:
                """Return d mu / d r_i of one part, all terms of E* at once."""
                contact, kelvin = solved[index], self.goals[self.parts[index].goal].temperature
                adjoint = FrictionAdjoint.of(contact, tolerance=GRADIENT_TOLERANCE)
                if index not in self._terms:  # the same for all compounds: their grid is
                    grid, body = contact.grid, compound_limits.rubber_at(self.rubber, kelvin)
                    omega = contact.speed * np.broadcast_to(grid.along, grid.spectrum_shape)
                    storage, loss = compound_limits.modulus_parts(body, np.abs(omega))
                    self._terms[index] = storage + 1j * np.sign(omega)[..., None] * loss
                _, relative = relative_change(contact)
                changes = np.moveaxis(relative[..., None] * self._terms[index], -1, 0)
                return np.array([float(adjoint.by_modulus(change).sum()) for change in changes])

            slopes = self._each(slope)
            friction = self.averaged([contact.friction_from_dissipation for contact in solved])
            gradient = self.averaged(slopes) / friction[:, None]
            value = float(self.weights @ np.log(friction))
            self._solved[key] = value, np.asarray(self.weights @ gradient)
        return self._solved[key]

    def _each(self, work: Callable[[int, object], _T]) -> list[_T]:
        """Return the work of each part, on all threads; the parts are independent."""
        return all_results([partial(work, i) for i in range(len(self.parts))], self.workers)


# Estimated relative error of the contacts whose friction is stated, as in comparisons.
DESIGN_TOLERANCE = 0.05


def _shares(friction: GoalFriction, contacts: Sequence[RoughContact]) -> Array:
    """Return the share of each part in G: its goal's weight times its share of the friction."""
    each = np.array([contact.friction_from_dissipation for contact in contacts])
    goals = [part.goal for part in friction.parts]
    weights = friction.weights[goals] * np.array([part.weight for part in friction.parts])
    return np.asarray(weights * each / friction.averaged(list(each))[goals])


@dataclass(frozen=True)
class SolvedCompound:
    """A compound at the goals, and how far another series of its measurement changes ln mu."""

    contacts: Sequence[RoughContact] = field(repr=False)  # fine enough for a friction
    # s . ln(E*_k/E*_0) [-] of each admissible series, (series,), on the grid of the search.
    series: Array = field(repr=False)

    @classmethod
    def of(cls, friction: GoalFriction, rubber: Rubber, measured: Rubber) -> SolvedCompound:
        """Solve a compound: `measured` itself, or a design that multiplies its modulus."""
        contacts = friction.contacts(rubber)
        slopes = []
        for part, contact in zip(friction.parts, contacts, strict=True):
            kelvin = friction.goals[part.goal].temperature
            body = compound_limits.rubber_at(measured, kelvin)
            slopes.append(friction_ratio.series_changes(contact, body))
        series = np.asarray(_shares(friction, contacts) @ np.array(slopes))
        return cls(friction.contacts(rubber, tolerance=DESIGN_TOLERANCE), series)


@dataclass(frozen=True)
class Gain:
    """Logarithm of the friction of a compound over that of another, and its errors."""

    log_ratio: float  # G [-]
    twice_cut_off: float  # G with twice the cut-off of the road [-]
    sampling: float  # standard error of G [-] from the pieces of the road; NaN if it has too few
    freedom: float  # degrees of freedom of the sampling error
    grid: float  # largest error of G from the grids [-]; the truth is even within it
    # Standard error of G from the measurement of the rubber [-]; NaN if nobody knows it.
    rubber: float = math.nan

    @property
    def interval(self) -> tuple[float, float]:
        """Interval of the gain, exp(G) - 1, that holds it 9 times in 10; NaN if not known."""
        sampling, grid = (self.sampling, self.freedom), self.grid / math.sqrt(3.0)
        ratio = friction_ratio.FrictionRatio.of_sources(self.log_ratio, sampling, grid, self.rubber)
        low, high = ratio.interval
        return low - 1.0, high - 1.0


def gain(
    friction: GoalFriction,
    before: Sequence[RoughContact],
    after: Sequence[RoughContact],
    rubber: float = math.nan,
) -> Gain:
    """Return the gain of the compound of contacts `after` over that of contacts `before`.

    `rubber` is the standard error of G from the measurement of the rubber (`series_error`).
    """

    def log_ratio(name: str) -> float:
        """Return G of a friction of the contacts."""
        measure = measures.get(name, attrgetter(name))
        low, high = (friction.averaged([measure(c) for c in each]) for each in (before, after))
        return float(friction.weights @ np.log(high / low))

    def at_twice_the_cut_off(contact: RoughContact) -> float:
        octave = float(2.0**contact.cut_off_exponents.friction)
        return contact.friction_from_dissipation * octave

    measures: dict[str, Callable[[RoughContact], float]] = {
        "coarse_friction": friction_ratio.coarse_friction, "doubled": at_twice_the_cut_off
    }  # fmt: skip
    total, doubled = log_ratio("friction_from_dissipation"), log_ratio("doubled")
    grid = friction_ratio.grid_error(log_ratio)
    pairs = [(contacts, _shares(friction, contacts)) for contacts in (before, after)]
    # goals on one profile have the same pieces; profiles are independent
    differences: dict[int, Array | float] = {}
    carrying: dict[int, float] = {}
    for i, part in enumerate(friction.parts):
        road, piece = id(part.surface), PIECE * part.largest_wavelength
        low, high = (share[i] * friction_residuals(solved[i], piece) for solved, share in pairs)
        differences[road] = differences.get(road, 0.0) + (high - low)
        carrying[road] = min(carrying.get(road, math.inf), pieces_that_carry(before[i], piece))
    pieces = [*map(np.asarray, differences.values())]
    sampling = friction_ratio.scatter_of_pieces(pieces, [*carrying.values()])
    return Gain(total, doubled, *sampling, grid, rubber)
