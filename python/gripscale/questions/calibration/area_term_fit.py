"""Fitting the area term to measured friction; the hysteresis is never fitted.

mu_measured = mu_hysteresis(v, T, p) + tau_f(v, T; theta) A_r/(A_0 p)
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy
import xarray as xr

from gripscale.conditions.area_term import shear_stress_to_dict
from gripscale.core import checks, labelled, provenance
from gripscale.experiment.measured_friction import MeasuredFriction, measured_variables
from gripscale.model import STATUS, STATUS_WORD
from gripscale.questions.calibration import calibration_law as fit
from gripscale.questions.calibration import profile_likelihood as likelihood
from gripscale.questions.calibration.measured_comparison import Predicted, in_spread
from gripscale.questions.calibration.profile_likelihood import FittedLaw
from gripscale.rubber.extrapolation import WORTH_SAYING

NO_INFLUENCE = 1e-12  # relative size of a singular value below which its direction changes nothing
UNLIKELY = 0.01  # chance of the sum of squares below which something must be wrong
_SOURCE = "gripscale calibrate"

# Numbers of a parameter, in the order of an `Estimate`.
_ESTIMATE = {
    "estimate": "best value of the parameter, in its unit",
    "standard_error": "its standard error by the Jacobian",
    "low": "lower end of its interval by profile likelihood, NaN where not determined",
    "high": "upper end of it, NaN where not determined",
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
        low, high = (fit.written(end, self.unit, 3) for end in (self.low, self.high))
        if self.determined:
            return f"{low} to {high}"
        if math.isfinite(self.low):
            return f"from {low}, upper end not determined"
        if math.isfinite(self.high):
            return f"up to {high}, lower end not determined"
        return "not determined"


def estimates_of(data: xr.Dataset) -> list[Estimate]:
    """Return the fitted parameters of a `fit_area_term`, in the units of the law."""
    numbers = zip(*(data[name].values.tolist() for name in _ESTIMATE), strict=True)
    units = (unit.removesuffix("1") for unit in data.unit.values.tolist())
    names = data.parameter.values.tolist()
    return [Estimate(*parts[:2], *parts[2]) for parts in zip(names, units, numbers, strict=True)]


def fit_area_term(
    measured: MeasuredFriction,
    predicted: Predicted,
    *,
    law: str = "gaussian",
    fixed: Mapping[str, float] | None = None,
    hold_out: str | None = None,
) -> xr.Dataset:
    """Fit a law of the interfacial shear stress to measured friction.

    Weighted with the spread of the measurement; without any, all points weigh the same and the
    scatter of the residuals is taken for it.

    The result has over `measurement` what was measured, the hysteresis, the area term, their sum
    and its band; over `parameter` estimate, standard error and interval (NaN where not
    determined); over `left_out` the errors of the law fitted to the other points. Its attribute
    `law` holds the law, `notes` what to know before the numbers are used.

    Raises `InputError` if a value cannot be used, points are too few for the law, or the hysteresis
    alone exceeds what was measured at more than half of the points.

    Parameters
    ----------
    measured : MeasuredFriction
        What was measured.
    predicted : Predicted
        The hysteresis and the real contact area at its points, in their order, see
        `measured_design`.
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
    left_out: dict[str, Any] = {}
    if hold_out is not None:
        groups = likelihood.groups_of(hold_out, measured.speed, measured.temperature)
        left_out = likelihood.held_out(points, groups[predicted.has_answer], law, held)
    optimum, ends = likelihood.intervals(problem)
    columns = _at_points(measured, predicted, optimum) | _of_parameters(optimum, ends) | left_out
    variables = {
        name: labelled(dims, values, unit[0] if unit else "1", text, _SOURCE)
        for name, (dims, values, text, *unit) in columns.items()
    }
    names = [parameter.name for parameter in optimum.problem.free]
    return xr.Dataset(
        measured_variables(measured) | variables,
        coords={"parameter": names, "other_parameter": names},
        attrs={
            "title": "Area term fitted to measured friction",
            "law": json.dumps(shear_stress_to_dict(optimum.problem.law(optimum.theta))),
            "held": json.dumps(dict(optimum.problem.held)),
            "measured_source": measured.source,
            "level": likelihood.LIKELIHOOD_LEVEL,
            "threshold": optimum.threshold / optimum.unit,
            "held_out_by": hold_out or "",
            "spread_known": int(optimum.spread_known),
            "sum_of_squares": optimum.sum_of_squares,
            "degrees_of_freedom": optimum.freedom,
            "scatter": optimum.scatter,
            "notes": "\n".join(_notes(optimum, predicted)),
            **provenance.version_attributes(),
        },
    )


# A variable by its name: dimensions, values, meaning, and its unit if it has one.
_Columns = dict[str, tuple[Any, ...]]


def _at_points(measured: MeasuredFriction, predicted: Predicted, optimum: FittedLaw) -> _Columns:
    at, there = "measurement", predicted.has_answer
    area_term = predicted.area_term(optimum.problem.law(optimum.theta), measured.speed)
    friction = predicted.friction + area_term
    apart = friction - measured.friction
    # the root of the diagonal of the hat matrix
    directions, sizes, _ = np.linalg.svd(optimum.jacobian, full_matrices=False)
    felt = directions[:, sizes > NO_INFLUENCE * sizes.max()]
    share, spread = np.sqrt((felt**2).sum(axis=1)), optimum.problem.points.spread
    error, width = np.full((2, there.size), np.nan)
    error[there] = share * (optimum.scatter if spread is None else spread)
    # a law that misses the points by more than their spread is no better than its scatter
    scatter = optimum.scatter if spread is None else spread * max(optimum.scatter, 1.0)
    width[there] = optimum.quantile * np.hypot(error[there], scatter)
    text = "half of its interval by the fit"
    beyond = "share of it that rests on the rubber outside the measured frequencies"
    status, words = np.array([predicted.status, predicted.status_word], dtype=object)
    return {
        "nominal_pressure": (at, predicted.pressure, "nominal pressure of the prediction", "Pa"),
        "contact_temperature": (at, predicted.temperature, "temperature in the contact", "K"),
        "contact_fraction": (at, predicted.contact_fraction, "real over nominal contact area"),
        "hysteresis": (at, predicted.friction, "friction of the hysteresis"),
        "friction_outside_band": (at, predicted.outside_band, beyond),
        STATUS: (at, status, "converged, or why"),
        STATUS_WORD: (at, words, "word of the status"),
        "area_term": (at, area_term, "friction of the area term"),
        "friction": (at, friction, "hysteresis and area term"),
        "friction_band": (at, error * optimum.quantile, text),
        "friction_half_width": (at, width, f"{text} and the measurement"),
        "difference": (at, apart, "predicted less measured friction"),
        "difference_in_spread": (at, in_spread(apart, measured.spread), "the same over the spread"),
    }


def _of_parameters(optimum: FittedLaw, ends: tuple[tuple[float, float], ...]) -> _Columns:
    each, free = "parameter", optimum.problem.free
    covariance = optimum.unit * optimum.covariance
    errors = np.sqrt(np.diag(covariance))
    rows = []
    for at, (parameter, interval) in enumerate(zip(free, ends, strict=True)):
        value = parameter.value(float(optimum.theta[at]))
        error = float(errors[at]) * (value if parameter.log else 1.0)
        limits = (parameter.value(end) if math.isfinite(end) else math.nan for end in interval)
        rows.append((value, error, *limits))
    columns: _Columns = {
        name: (each, values, text)
        for (name, text), values in zip(_ESTIMATE.items(), zip(*rows, strict=True), strict=True)
    }
    units = [fit.PARAMETERS[parameter.name].unit or "1" for parameter in free]
    correlation = covariance / np.outer(errors, errors)
    return columns | {
        "unit": (each, np.array(units, dtype=object), "its unit"),
        "correlation": ((each, "other_parameter"), correlation, "of the estimates"),
    }


def _notes(optimum: FittedLaw, predicted: Predicted) -> Iterator[str]:
    points = optimum.problem.points
    if not optimum.spread_known:
        yield (
            f"No spread is stated: the scatter of the residuals, {optimum.scatter:.2g}, "
            "takes its place, whatever its cause."
        )
    elif scipy.special.chdtrc(optimum.freedom, optimum.sum_of_squares) < UNLIKELY:
        yield (
            f"The residuals are {optimum.scatter:.2g} times the stated spread: law, hysteresis "
            "or spread is wrong, and the intervals are too narrow."
        )
    if optimum.problem.kind == "gaussian" and optimum.problem.held.get("activation_energy") == 0:
        yield (
            "No activation energy: the temperatures in the contact are only "
            f"{points.temperature_range:.2g} K apart and do not determine it. "
            "The law holds at the measured temperature."
        )
    if without := int((~predicted.has_answer).sum()):
        why = next(s for s, k in zip(predicted.status, predicted.has_answer, strict=True) if not k)
        yield f"Measured points without a prediction, which do not count: {without}, as {why}."
    if below := int((points.difference < 0.0).sum()):
        yield f"Measured points below the hysteresis alone: {below}."
    if beyond := int((predicted.outside_band > WORTH_SAYING).sum()):
        yield (
            f"Points where more than {WORTH_SAYING:.0%} of the hysteresis rests on the rubber "
            f"outside its measured frequencies: {beyond}."
        )
