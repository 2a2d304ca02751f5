"""How much friction one compound has over another on the same road, with its interval.

    G = sum_k W_k ln(mu_k / mu_k,0),    gain = exp(G) - 1

over the goals with weights W_k, of direct contacts by the energy lost. Both compounds slide on the
same pieces of the same profiles, so that most of what a short profile leaves open cancels; what is
left is in `gripscale.questions.vary.friction_ratio`. The design multiplies E*(w) by a function of
frequency, whatever series fits today's measurement: series k changes G by the difference of its
effects on both. Another compound was measured by itself, and both errors count.

Finite strain and the step from lines to a surface multiply both frictions alike and are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import attrgetter

import numpy as np

from gripscale.core.arrays import Array
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sampling_error import PIECE, friction_residuals, pieces_that_carry
from gripscale.questions.design.compound_limits import rubber_at
from gripscale.questions.design.goal_friction import GoalFriction
from gripscale.questions.vary.friction_ratio import (
    FrictionRatio,
    coarse_friction,
    grid_error,
    scatter_of_pieces,
    series_changes,
)
from gripscale.rubber import Rubber

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
        slopes = [
            series_changes(contact, rubber_at(measured, friction.goals[part.goal].temperature))
            for part, contact in zip(friction.parts, contacts, strict=True)
        ]
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
        ratio = FrictionRatio.of_sources(self.log_ratio, sampling, grid, self.rubber)
        low, high = ratio.interval
        return low - 1.0, high - 1.0


def gain(
    friction: GoalFriction,
    before: Sequence[RoughContact],
    after: Sequence[RoughContact],
    rubber: float = math.nan,
) -> Gain:
    """Return the gain of the compound of contacts `after` over that of contacts `before`.

    Both are those of `SolvedCompound`; `rubber` is the standard error of G from the measurement of
    the rubber (`series_error`).
    """
    weights = friction.weights

    def log_ratio(measure: Callable[[RoughContact], float]) -> float:
        """Return G of a friction of the contacts."""
        low, high = (
            friction.averaged([measure(contact) for contact in c]) for c in (before, after)
        )
        return float(weights @ np.log(high / low))

    def at_twice_the_cut_off(contact: RoughContact) -> float:
        octave = float(2.0**contact.cut_off_exponents.friction)
        return contact.friction_from_dissipation * octave

    frictions = {"coarse_friction": coarse_friction}
    grid = grid_error(lambda name: log_ratio(frictions.get(name, attrgetter(name))))
    total = log_ratio(attrgetter("friction_from_dissipation"))
    doubled = log_ratio(at_twice_the_cut_off)
    return Gain(total, doubled, *_sampling(friction, before, after), grid, rubber)


def _sampling(
    friction: GoalFriction, before: Sequence[RoughContact], after: Sequence[RoughContact]
) -> tuple[float, float]:
    """Return the standard error of G from the pieces of the profiles, and its freedom.

    Goals on one profile have the same pieces; profiles are independent.
    """
    pairs = [(contacts, _shares(friction, contacts)) for contacts in (before, after)]
    differences: dict[int, Array | float] = {}
    carrying: dict[int, float] = {}
    for i, part in enumerate(friction.parts):
        road, piece = id(part.surface), PIECE * part.largest_wavelength
        low, high = (share[i] * friction_residuals(solved[i], piece) for solved, share in pairs)
        differences[road] = differences.get(road, 0.0) + (high - low)
        carrying[road] = min(carrying.get(road, math.inf), pieces_that_carry(before[i], piece))
    return scatter_of_pieces([*map(np.asarray, differences.values())], [*carrying.values()])
