"""How much friction one compound has over another on the same road, with its interval.

    G = sum_k W_k ln(mu_k / mu_k,0),    gain = exp(G) - 1

over the goals with weights W_k, of direct contacts by the energy lost. Both compounds slide on the
same pieces of the same profiles, so that most of what a short profile leaves open cancels. What is
left has three sources:

- sampling: the scatter of the pieces of the road (`gripscale.half_space.sampling_error`). With the
  relative residuals e_i of a piece under each compound, var(G) = n/(n - 1) sum (e_i - e_i,0)^2.
- grid: the change of G from the grid before the last, times 0.4 (`grid_sequence`), or the
  difference between the gains of the two frictions, whichever is larger; even within it.
- rubber: other series fit today's measurement as well. The design multiplies E*(w) by a function of
  frequency, whatever the series; with s the derivative of ln mu along a change of ln E*, a series k
  changes G by (s - s_0) . ln(E*_k/E*_0), to first order. Each series is an extreme of three
  standard deviations, and the largest change is taken for three. Another compound was measured by
  itself: its series and today's each change one friction, and both errors count.

Finite strain and the step from lines to a surface multiply both frictions alike and are left out.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
import xarray as xr

from gripscale.core.arrays import Array
from gripscale.half_space.result import RoughContact
from gripscale.half_space.sampling_error import (
    FEWEST_PIECES,
    PIECE,
    error_of_residuals,
    friction_residuals,
    pieces_that_carry,
)
from gripscale.half_space.sensitivity import FrictionAdjoint, relative_change
from gripscale.questions.answer.intervals import LogError, combined, half_width
from gripscale.questions.design.compound_limits import rubber_at
from gripscale.questions.design.goal_friction import GoalFriction
from gripscale.rubber import Rubber

ERROR_RATIO = 0.4
"""Error after halving the spacing over the change by it, as in `grid_sequence`."""
EXTREME = 3.0
"""Standard deviations of an admissible series from the best one."""


@dataclass(frozen=True)
class Gain:
    """Logarithm of the friction of a compound over that of another, and its errors."""

    log_ratio: float
    """G [-]."""
    twice_cut_off: float
    """G with twice the cut-off of the road [-]."""
    sampling: float
    """Standard error of G [-]; NaN if the road has too few pieces."""
    freedom: float
    """Degrees of freedom of the sampling error."""
    grid: float
    """Largest error of G from the grids [-]."""
    rubber: float = math.nan
    """Standard error of G from the measurement of the rubber [-]; NaN if nobody knows it."""

    @property
    def interval(self) -> tuple[float, float]:
        """Interval of the gain, exp(G) - 1, that holds it 9 times in 10; NaN if not known."""
        sampling = LogError(xr.DataArray(self.sampling), xr.DataArray(self.freedom))
        grid = LogError(xr.DataArray(self.grid / math.sqrt(3.0)), xr.DataArray(math.inf))
        errors = [sampling, grid]
        if math.isfinite(self.rubber):
            errors.append(LogError(xr.DataArray(self.rubber), xr.DataArray(math.inf)))
        error = combined(errors)
        width = math.asinh(float(half_width(error)))
        return math.expm1(self.log_ratio - width), math.expm1(self.log_ratio + width)


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

    def on_coarser_grid(contact: RoughContact) -> float:
        """Return the friction on the grid before the last of the same surface, or on the last."""
        same = [grid for grid in contact.grids if grid.cut_off == contact.grids[-1].cut_off]
        return same[-2:][0].friction_from_dissipation

    def at_twice_the_cut_off(contact: RoughContact) -> float:
        octave = float(2.0**contact.cut_off_exponents.friction)
        return contact.friction_from_dissipation * octave

    total = log_ratio(lambda contact: contact.friction_from_dissipation)
    grid = max(
        ERROR_RATIO * abs(total - log_ratio(on_coarser_grid)),
        abs(total - log_ratio(lambda contact: contact.friction)),
    )
    sampling, freedom = _sampling(friction, before, after)
    return Gain(total, log_ratio(at_twice_the_cut_off), sampling, freedom, grid, rubber)


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
    errors, freedom = [], 0.0
    for _, members in groupby(order, key=lambda i: id(friction.parts[i].surface)):
        residuals, carrying = np.zeros(0), math.inf
        for i in members:
            piece = PIECE * friction.parts[i].largest_wavelength
            low, high = (
                share[i] * friction_residuals(contacts[i], piece)
                for share, contacts in zip(shares, (before, after), strict=True)
            )
            residuals = residuals + (high - low) if residuals.size else high - low
            carrying = min(carrying, pieces_that_carry(before[i], piece))
        errors.append(error_of_residuals(residuals, carrying))
        freedom += carrying - 1.0
    if freedom < FEWEST_PIECES - 1:
        return math.nan, math.nan
    return math.hypot(*(error for error in errors if math.isfinite(error))), freedom


def series_derivatives(
    friction: GoalFriction, contacts: Sequence[RoughContact], measured: Rubber
) -> Array:
    """Return s . ln(E*_k/E*_0) [-] of each admissible series of a `measured` rubber, (series,).

    `contacts` are those of this rubber, or of a design that multiplies its modulus.
    """
    slopes = []
    for part, contact in zip(friction.parts, contacts, strict=True):
        best = rubber_at(measured, friction.goals[part.goal].temperature)
        if best.admissible is None:
            slopes.append(np.zeros(0))
            continue
        adjoint, grid = FrictionAdjoint.of(contact), contact.grid
        modulus, relative = relative_change(contact)
        omega = contact.speed * grid.along
        others = best.admissible.complex_moduli(np.abs(omega))
        others.imag *= np.sign(omega)
        ratios = np.log(others / best.complex_modulus(omega))
        along = [float(adjoint.by_modulus(relative * modulus * ratio).sum()) for ratio in ratios]
        slopes.append(np.array(along) / contact.friction_from_dissipation)
    return np.asarray(_shares(friction, contacts) @ np.array(slopes))


def series_error(changes: Array) -> float:
    """Return the standard error of the changes of G by each series; NaN without a series.

    Of a design they are the difference of two `series_derivatives`, because one measurement is
    behind both compounds.
    """
    return float(np.abs(changes).max()) / EXTREME if changes.size else math.nan
