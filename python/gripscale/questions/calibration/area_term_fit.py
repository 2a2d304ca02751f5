"""Fitting the area term to measured friction; the hysteresis is never fitted.

mu_measured = mu_hysteresis(v, T, p) + tau_f(v, T; theta) A_r/(A_0 p)
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy
import xarray as xr

from gripscale.conditions.area_term import (
    FittedPoints,
    InterfacialShearStress,
    shear_stress_to_dict,
)
from gripscale.core import Array, Described, checks, labelled, provenance
from gripscale.experiment.measured_friction import MeasuredFriction, measured_variables
from gripscale.model import STATUS, STATUS_WORD
from gripscale.questions.calibration import calibration_law as fit
from gripscale.questions.calibration import profile_likelihood as likelihood
from gripscale.questions.calibration.measured_comparison import Predicted, in_spread

# How far the profile of an end that is not determined is kept, in the numbers of the search.
FACTORS_SHOWN = 3.0
NO_INFLUENCE = 1e-12  # relative size of a singular value below which its direction changes nothing
_SOURCE = "gripscale calibrate"

# Numbers of a parameter by the fields of an `Estimate`, with their names and meanings.
_ESTIMATE = {
    "value": ("estimate", "best value of the parameter, in its unit"),
    "standard_error": ("standard_error", "its standard error by the Jacobian"),
    "low": ("low", "lower end of its interval by profile likelihood, NaN where not determined"),
    "high": ("high", "upper end of it, NaN where not determined"),
}
# Numbers of what was left out by the fields of a `HeldOut`, with their names and meanings.
_HELD_OUT = {
    "points": ("points", "measured points left out"),
    "rms_inside": ("rms_inside", "rms residual of the points that were fitted"),
    "rms_outside": ("rms_outside", "rms error at the points left out"),
    "rms_outside_in_spread": ("rms_outside_in_spread", "the same, over the spread"),
    "why_not": ("why_not", "why the other points cannot predict them, empty where they can"),
    "value": ("left_out", "temperature [K] or decade [m/s]"),
}


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

    @property
    def words(self) -> str:
        """What texts call it."""
        return fit.PARAMETERS[self.name].words

    def text(self, digits: int) -> str:
        """Return its value with so many digits and its unit."""
        return fit.written(self.value, self.unit, digits)

    @property
    def interval(self) -> str:
        """Its interval in words."""
        if not math.isfinite(self.low) and not math.isfinite(self.high):
            return "not determined"
        low, high = (fit.written(end, self.unit, 3) for end in (self.low, self.high))
        if self.determined:
            return f"{low} to {high}"
        if math.isfinite(self.low):
            return f"from {low}, upper end not determined"
        return f"up to {high}, lower end not determined"


@dataclass(frozen=True, eq=False, repr=False)
class AreaTermFit(Described):
    """A law of the area term fitted to measured friction beside a predicted hysteresis."""

    measured: MeasuredFriction
    predicted: Predicted
    """The hysteresis and the contact at the measured points, which are not fitted."""
    optimum: fit.FittedLaw
    """The least sum of squares."""
    ends: tuple[tuple[float, float], ...]
    """Of each interval in the numbers of the search; infinite where not determined."""
    held_out: tuple[likelihood.HeldOut, ...] = ()
    """What the law says of points it was not fitted to, where asked for."""
    held_out_by: str = ""
    """Whether a temperature or a decade of speed was left out; empty for neither."""
    fitted_to: FittedPoints | None = None
    """The record that the law carries of its points, where answers can use it."""

    @property
    def problem(self) -> fit.CalibrationProblem:
        """What was fitted: the points that have an answer, and the law with its free parameters."""
        return self.optimum.problem

    @property
    def law(self) -> InterfacialShearStress:
        """The law with the best parameters."""
        law: Any = self.problem.law(self.optimum.theta)
        return law if self.fitted_to is None else replace(law, fitted_to=self.fitted_to)  # type: ignore[no-any-return]

    @property
    def spread_known(self) -> bool:
        """Whether the spread was stated, and not taken from the residuals."""
        return self.problem.points.spread is not None

    @property
    def freedom(self) -> int:
        """Degrees of freedom: points less parameters."""
        return self.optimum.freedom

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
        return float(scipy.special.chdtrc(self.freedom, self.optimum.sum_of_squares))

    @property
    def threshold(self) -> float:
        """By how much the sum of squares rises at the ends of an interval, as in `profiles`."""
        return self.optimum.threshold / self._unit

    @property
    def estimates(self) -> list[Estimate]:
        """The free parameters."""
        estimates = []
        for at, parameter in enumerate(self.problem.free):
            value = parameter.value(float(self.optimum.theta[at]))
            error = float(self._errors[at]) * (value if parameter.log else 1.0)
            low, high = (
                parameter.value(end) if math.isfinite(end) else math.nan for end in self.ends[at]
            )
            unit = fit.PARAMETERS[parameter.name].unit
            estimates.append(Estimate(parameter.name, unit, value, error, low, high))
        return estimates

    @property
    def correlation(self) -> Array:
        """Of the estimates, shape (free, free), of logarithms where they are positive."""
        return np.asarray(self._covariance / np.outer(self._errors, self._errors))

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
        error = np.full(self.measured.speed.size, np.nan)
        error[self.predicted.has_answer] = share * (self.scatter if spread is None else spread)
        return error

    @property
    def band(self) -> Array:
        """Half of the interval of the friction at the measured points [-], at `LEVEL`."""
        return self.friction_error * self._quantile

    @property
    def half_width(self) -> Array:
        """Half of the interval of the friction by fit and measurement, of the points fitted [-].

        A law that misses the points by more than their spread is no better than its scatter.
        """
        spread, error = self.problem.points.spread, self.friction_error[self.predicted.has_answer]
        measured = self.scatter if spread is None else spread * max(self.scatter, 1.0)
        return self._quantile * np.hypot(error, measured)

    @property
    def _quantile(self) -> float:
        """Half width of an interval at `LEVEL` over a standard error."""
        tail = 0.5 * (1.0 + fit.LIKELIHOOD_LEVEL)
        normal, student = scipy.special.ndtri(tail), scipy.special.stdtrit(self.freedom, tail)
        return float(normal if self.spread_known else student)

    @cached_property
    def profiles(self) -> dict[str, tuple[Array, Array]]:
        """Values of each free parameter and how much the sum of squares exceeds its least there.

        In units of what one standard error adds: over the interval and a little beyond, and a
        factor of 20 where an end is not determined.
        """
        profiles = {}
        for at, parameter in enumerate(self.problem.free):
            centre, limits = float(self.optimum.theta[at]), parameter.limits
            ends = []
            for way, end in zip((-1, 1), self.ends[at], strict=True):
                away = 1.3 * abs(end - centre) if math.isfinite(end) else FACTORS_SHOWN
                ends.append(float(np.clip(centre + way * away, *limits)))
            values, excess = likelihood.LikelihoodProfile(self.optimum, at).curve(*ends)
            in_units = np.array([parameter.value(float(value)) for value in values])
            profiles[parameter.name] = in_units, excess / self._unit
        return profiles

    @property
    def _unit(self) -> float:
        """Sum of squares that one standard error adds."""
        return 1.0 if self.spread_known else self.scatter**2

    @property
    def _covariance(self) -> Array:
        return self._unit * self.optimum.covariance

    @property
    def _errors(self) -> Array:
        return np.sqrt(np.diag(self._covariance))

    def to_dataset(self) -> xr.Dataset:
        """Return the calibration as a labelled Dataset.

        Over `measurement`: what was measured, the hysteresis, the area term, their sum and its
        band. Over `parameter`: estimate, standard error, interval (NaN where not determined),
        profile. Over `left_out`: the errors of the law fitted to the other points.
        """
        predicted, measured, estimates = self.predicted, self.measured, self.estimates
        data: dict[str, xr.Variable] = measured_variables(measured)

        def add(name: str, dims: Any, values: Any, text: str, unit: str = "1") -> None:
            data[name] = labelled(dims, values, unit, text, _SOURCE)

        at, each = "measurement", "parameter"
        add("nominal_pressure", at, predicted.pressure, "nominal pressure of the prediction", "Pa")
        add("contact_temperature", at, predicted.temperature, "temperature in the contact", "K")
        add("contact_fraction", at, predicted.contact_fraction, "real over nominal contact area")
        add("hysteresis", at, predicted.friction, "friction of the hysteresis")
        beyond = "share of it that rests on the rubber outside the measured frequencies"
        add("friction_outside_band", at, predicted.outside_band, beyond)
        add(STATUS, at, np.array(predicted.status, dtype=object), "converged, or why")
        add(STATUS_WORD, at, np.array(predicted.status_word, dtype=object), "word of the status")
        add("area_term", at, self.area_term, "friction of the area term")
        add("friction", at, self.friction, "hysteresis and area term")
        add("friction_band", at, self.band, "half of its interval by the fit")
        apart = self.friction - measured.friction
        add("difference", at, apart, "predicted less measured friction")
        over = in_spread(apart, measured.spread)
        add("difference_in_spread", at, over, "the same over the spread")
        for field, (name, text) in _ESTIMATE.items():
            add(name, each, [getattr(estimate, field) for estimate in estimates], text)
        units = [estimate.unit or "1" for estimate in estimates]
        add("unit", each, np.array(units, dtype=object), "its unit")
        square = (each, "other_parameter")
        add("correlation", square, self.correlation, "of the estimates")
        values, excess = zip(*self.profiles.values(), strict=True)
        add("profile_value", (each, "step"), values, "value at which the parameter is held")
        text = "rise of the sum of squares, NaN where another parameter has no room"
        add("profile_excess", (each, "step"), excess, text)
        for field, (name, text) in _HELD_OUT.items() if self.held_out else ():
            add(name, "left_out", [getattr(group, field) for group in self.held_out], text)
        names = [estimate.name for estimate in estimates]
        return xr.Dataset(
            data,
            coords=dict.fromkeys(square, names),
            attrs={
                "title": "Area term fitted to measured friction",
                "law": json.dumps(shear_stress_to_dict(self.law)),
                "held": json.dumps(dict(self.problem.held)),
                "measured_source": self.measured.source,
                "level": fit.LIKELIHOOD_LEVEL,
                "threshold": self.threshold,
                "held_out_by": self.held_out_by,
                "spread_known": int(self.spread_known),
                "sum_of_squares": self.optimum.sum_of_squares,
                "degrees_of_freedom": self.freedom,
                "scatter": self.scatter,
                **provenance.version_attributes(),
            },
        )


def fit_area_term(
    measured: MeasuredFriction,
    predicted: Predicted,
    *,
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
) -> AreaTermFit:
    """Fit a law of the interfacial shear stress to measured friction.

    Weighted with the spread of the measurement; without any, all points weigh the same and the
    scatter of the residuals is taken for it.

    Raises `InputError` if a value cannot be used, points are too few for the law, or the hysteresis
    alone exceeds what was measured at more than half of the points.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : Predicted
        The hysteresis and the real contact area at its points, in their order, see
        `predictions_at`.
    law : str
        "constant", "gaussian" or "le_gal_klueppel", see `gripscale.conditions`.
    fixed : mapping of str to float, optional
        Parameters of the law that are known [SI units, eV], by name.
    hold_out : str, optional
        "temperature" or "speed": predict each temperature, or each decade of speed, from the
        others.
    """
    checks.instance("measured", measured, MeasuredFriction)
    checks.instance("predicted", predicted, Predicted)
    held = {} if fixed is None else dict(checks.instance("fixed", fixed, Mapping))  # type: ignore[type-abstract]
    points = fit.points_of(measured, predicted)
    problem = fit.problem_of(law, points, held)
    if hold_out is None:
        return AreaTermFit(measured, predicted, *likelihood.intervals(problem))
    groups = likelihood.groups_of(hold_out, measured.speed, measured.temperature)
    optimum, ends = likelihood.intervals(problem)
    others = likelihood.held_out(points, groups[predicted.has_answer], law, held)
    return AreaTermFit(measured, predicted, optimum, ends, others, hold_out)
