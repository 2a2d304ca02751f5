"""A fitted law of the area term: its parameters, how well each is known, what it says of points."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.stats
from numpy.typing import NDArray

from gripscale.calibration.held_out import HeldOut
from gripscale.calibration.least_squares import Optimum, Problem
from gripscale.calibration.parameters import Parameter
from gripscale.calibration.profile import LEVEL, Profile, covariance, threshold_of
from gripscale.interface.area_term import InterfacialShearStress
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.predicted import Predicted

Array = NDArray[np.float64]

FACTORS_SHOWN = 3.0
"""How far the profile of an end that is not determined is kept, in the numbers of the search."""

NO_INFLUENCE = 1e-12
"""Relative size of a singular value below which its direction changes nothing."""


@dataclass(frozen=True)
class Estimate:
    """A fitted parameter, in the unit of the law."""

    name: str
    unit: str
    value: float
    standard_error: float
    """From the Jacobian: what a parabola would say."""
    low: float
    """Lower end of the interval by profile likelihood; NaN where the data do not determine it."""
    high: float
    """Upper end; NaN likewise."""

    @property
    def determined(self) -> bool:
        """Whether both ends are."""
        return math.isfinite(self.low) and math.isfinite(self.high)


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """A law of the area term fitted to measured friction beside a predicted hysteresis."""

    measured: MeasuredFriction
    predicted: Predicted
    """The hysteresis and the contact at the measured points, which are not fitted."""
    problem: Problem
    """What was fitted: the points that have an answer, and the law with its free parameters."""
    optimum: Optimum
    """The least sum of squares."""
    ends: tuple[tuple[float, float], ...]
    """Of each interval in the numbers of the search; infinite where not determined."""
    held_out: tuple[HeldOut, ...] = ()
    """What the law says of points it was not fitted to, where asked for."""
    held_out_by: str = ""
    """Whether a temperature or a decade of speed was left out; empty for neither."""

    @property
    def law(self) -> InterfacialShearStress:
        """The law with the best parameters."""
        return self.problem.family.law(self.optimum.theta)

    @property
    def spread_known(self) -> bool:
        """Whether the spread was stated, and not taken from the residuals."""
        return self.problem.points.spread is not None

    @property
    def freedom(self) -> int:
        """Degrees of freedom: points less parameters."""
        return self.problem.points.speed.size - len(self.problem.family.free)

    @property
    def scatter(self) -> float:
        """Root of the sum of squares over the degrees of freedom.

        In units of the spread where it is stated, else the spread the residuals imply [-].
        """
        return math.sqrt(self.optimum.sum_of_squares / self.freedom)

    @property
    def chance(self) -> float:
        """Probability of a sum of squares so large if law, hysteresis and spreads were right.

        NaN where no spread is stated.
        """
        if not self.spread_known:
            return math.nan
        return float(scipy.stats.chi2.sf(self.optimum.sum_of_squares, self.freedom))

    @property
    def threshold(self) -> float:
        """By how much the sum of squares rises at the ends of an interval, as in `profiles`."""
        scale = 1.0 if self.spread_known else self.scatter**2
        return threshold_of(self.optimum, known=self.spread_known) / scale

    @property
    def estimates(self) -> list[Estimate]:
        """The free parameters."""
        errors = np.sqrt(np.diag(self._covariance))
        return list(self._estimates(errors))

    @property
    def correlation(self) -> Array:
        """Of the estimates, shape (free, free), of logarithms where they are positive."""
        errors = np.sqrt(np.diag(self._covariance))
        return np.asarray(self._covariance / np.outer(errors, errors))

    @property
    def area_term(self) -> Array:
        """Friction of the area term at the measured points [-], NaN without an answer."""
        return self.predicted.area_term(self.law, self.measured.speed)

    @property
    def friction(self) -> Array:
        """Hysteresis and area term at the measured points [-]."""
        return self.predicted.friction + self.area_term

    @property
    def friction_error(self) -> Array:
        """Standard error of that by the fit [-]: the root of the diagonal of the hat matrix."""
        directions, sizes, _ = np.linalg.svd(self.optimum.jacobian, full_matrices=False)
        felt = directions[:, sizes > NO_INFLUENCE * sizes.max()]
        share = np.sqrt((felt**2).sum(axis=1))
        spread = self.problem.points.spread
        return self._at_measured(share * (self.scatter if spread is None else spread))

    @property
    def band(self) -> Array:
        """Half of the interval of the friction at the measured points [-], at `LEVEL`."""
        tail = 0.5 * (1.0 + LEVEL)
        known = self.spread_known
        return self.friction_error * float(
            scipy.stats.norm.ppf(tail) if known else scipy.stats.t.ppf(tail, self.freedom)
        )

    @cached_property
    def profiles(self) -> dict[str, tuple[Array, Array]]:
        """Values of each free parameter and how much the sum of squares exceeds its least there.

        In units of what one standard error adds: over the interval and a little beyond, and a
        factor of 20 where an end is not determined.
        """
        scale = 1.0 if self.spread_known else self.scatter**2
        return {
            one.name: self._profile(place, one, scale)
            for place, one in enumerate(self.problem.family.free)
        }

    @property
    def _covariance(self) -> Array:
        scale = 1.0 if self.spread_known else self.scatter**2
        return scale * covariance(self.optimum.jacobian)

    def _estimates(self, errors: Array) -> Iterator[Estimate]:
        for at, one in enumerate(self.problem.family.free):
            value = one.value(float(self.optimum.theta[at]))
            error = float(errors[at]) * (value if one.log else 1.0)
            low, high = (one.value(x) if math.isfinite(x) else math.nan for x in self.ends[at])
            yield Estimate(one.name, one.unit, value, error, low, high)

    def _profile(self, place: int, one: Parameter, scale: float) -> tuple[Array, Array]:
        centre, limits = float(self.optimum.theta[place]), one.limits
        shown = []
        for way, end in zip((-1, 1), self.ends[place], strict=True):
            away = 1.3 * abs(end - centre) if math.isfinite(end) else FACTORS_SHOWN
            shown.append(float(np.clip(centre + way * away, *limits)))
        values, excess = Profile(self.problem, self.optimum, place).curve(*shown)
        return np.array([one.value(float(x)) for x in values]), excess / scale

    def _at_measured(self, values: Array) -> Array:
        out = np.full(self.measured.speed.size, np.nan)
        out[self.predicted.known] = values
        return out
