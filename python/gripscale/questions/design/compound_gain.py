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
from dataclasses import dataclass
from itertools import groupby
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

    Both are lists of `GoalFriction.contacts`, on grids that are fine enough for a friction;
    `rubber` is the standard error of G from the measurement of the rubber (`series_error`).
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


def _shares(friction: GoalFriction, contacts: Sequence[RoughContact]) -> Array:
    """Return the share of each part in G: its goal's weight times its share of the friction."""
    each = np.array([contact.friction_from_dissipation for contact in contacts])
    total = friction.averaged(list(each))
    parts = friction.parts
    return np.array(
        [
            friction.weights[part.goal] * part.weight * mu / total[part.goal]
            for part, mu in zip(parts, each, strict=True)
        ]
    )


def _sampling(
    friction: GoalFriction, before: Sequence[RoughContact], after: Sequence[RoughContact]
) -> tuple[float, float]:
    """Return the standard error of G from the pieces of the profiles, and its freedom.

    Goals on one profile have the same pieces; profiles are independent.
    """
    shares = _shares(friction, before), _shares(friction, after)
    order = sorted(range(len(before)), key=lambda i: id(friction.parts[i].surface))
    differences, carrying = [], []
    for _, members in groupby(order, key=lambda i: id(friction.parts[i].surface)):
        residuals, fewest = np.zeros(0), math.inf
        for i in members:
            piece = PIECE * friction.parts[i].largest_wavelength
            low, high = (
                share[i] * friction_residuals(contacts[i], piece)
                for share, contacts in zip(shares, (before, after), strict=True)
            )
            residuals = residuals + (high - low) if residuals.size else high - low
            fewest = min(fewest, pieces_that_carry(before[i], piece))
        differences.append(residuals)
        carrying.append(fewest)
    return scatter_of_pieces(differences, carrying)


def series_derivatives(
    friction: GoalFriction, contacts: Sequence[RoughContact], measured: Rubber
) -> Array:
    """Return s . ln(E*_k/E*_0) [-] of each admissible series of a `measured` rubber, (series,).

    `contacts` are those of this rubber, or of a design that multiplies its modulus.
    """
    slopes = [
        series_changes(contact, rubber_at(measured, friction.goals[part.goal].temperature))
        for part, contact in zip(friction.parts, contacts, strict=True)
    ]
    return np.asarray(_shares(friction, contacts) @ np.array(slopes))
