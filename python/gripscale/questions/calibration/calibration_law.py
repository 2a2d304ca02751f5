"""The parameters of a law of the area term: on which scale, within which limits they are sought.

Limits are far beyond what data can say, so that reaching one means: not determined.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from itertools import product
from typing import Any

import numpy as np
import scipy

from gripscale.conditions.area_term import SHEAR_STRESSES, InterfacialShearStress
from gripscale.core import ZERO_CELSIUS, Array, InputError, Mask, checks
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.questions.calibration.measured_comparison import Predicted


@dataclass(frozen=True, eq=False)
class Points:
    """What a law is fitted to: measured points with an answer of the model, arrays of shape (n,).

    mu_i - mu_hysteresis,i = tau_f(v_i, T_i) A_r,i / (A_0 p_i)
    """

    speed: Array  # [m/s]
    temperature: Array | None  # in the contact [K]; None where nobody knows it
    difference: Array  # measured friction less that of the hysteresis [-]
    leverage: Array  # A_r/(A_0 p) [1/Pa]
    spread: Array | None  # of the measured friction [-]; None where none is stated

    @property
    def temperature_range(self) -> float:
        """Largest less smallest temperature in the contact [K]; zero where it is not known."""
        return 0.0 if self.temperature is None else float(np.ptp(self.temperature))

    @property
    def stress(self) -> Array:
        """The shear stress each point asks for by itself [Pa]."""
        return self.difference / self.leverage

    def only(self, chosen: Mask) -> Points:
        """Return some of the points."""
        kept: dict[str, Any] = {k: None if v is None else v[chosen] for k, v in vars(self).items()}
        return Points(**kept)


def points_of(measured: MeasuredFriction, predicted: Predicted) -> Points:
    """Return the points that have an answer, in the order of the measurement.

    Raises `InputError` for points that do not fit the measurement or cannot all be weighed alike,
    and if the hysteresis alone exceeds what was measured at more than half of them.
    """
    predicted.require_points_of(measured)
    answered = predicted.has_answer
    if not answered.any():
        raise InputError(
            f"no measured point has a prediction; the first ended with {predicted.status[0]}"
        )
    difference = (measured.friction - predicted.friction)[answered]
    below = difference < 0.0
    if 2 * below.sum() > difference.size:
        raise InputError(
            f"the hysteresis alone exceeds the measured friction at {below.sum()} of "
            f"{difference.size} points, by up to {-difference.min():.3g}: the shear stress of an "
            "area term would be negative; expected a hysteresis below the measured friction"
        )
    return Points(
        measured.speed[answered],
        _all_or_none("temperature", predicted.temperature[answered]),
        difference,
        predicted.leverage[answered],
        _spread(measured.spread[answered]),
    )


def refuse_unfit(measured: MeasuredFriction, kind: str, fixed: Mapping[str, float]) -> None:
    """Raise `InputError` for a law that no prediction can fit to the measurement."""
    # a missing temperature, which a case may know, counts as one that was measured
    kelvin = measured.temperature
    missing = np.isnan(kelvin)
    mean = ZERO_CELSIUS if missing.all() else kelvin[~missing].mean()
    kelvin = np.where(missing, mean, kelvin)
    unit, spread = np.ones_like(measured.friction), _spread(measured.spread)
    problem_of(kind, Points(measured.speed, kelvin, measured.friction, unit, spread), fixed)


def _spread(spread: Array) -> Array | None:
    """Return the spreads of points if known; else as `_all_or_none`."""
    if (spread == 0.0).any():
        raise InputError(
            "spread must be above zero to weigh a point; got 0: leave it empty if unknown"
        )
    return _all_or_none("spread", spread)


def _all_or_none(name: str, values: Array) -> Array | None:
    """Return values known of all points, None if of none; else raise `InputError`."""
    missing = np.isnan(values)
    if missing.any() and not missing.all():
        raise InputError(
            f"{name} must be stated for all points or for none; got it for {(~missing).sum()} of "
            f"{missing.size}"
        )
    return None if missing.all() else values


KINDS = ("constant", "gaussian", "le_gal_klueppel")  # laws that can be fitted
LEAST_APART = 1.0  # range of temperatures below which none decides an activation energy [K]


@dataclass(frozen=True)
class Parameter:
    """A number of a law that is fitted: as the law calls it, with the limits of the search."""

    name: str
    unit: str
    low: float
    high: float
    starts: tuple[float, ...]  # where the search begins
    log: bool = True  # whether it is positive, and its logarithm is what is fitted

    def scaled(self, value: float) -> float:
        """Return the number the search works with."""
        return math.log(value) if self.log else value

    def value(self, scaled: float) -> float:
        """Return the parameter of such a number."""
        return math.exp(scaled) if self.log else scaled

    @property
    def limits(self) -> tuple[float, float]:
        """Limits of the number the search works with."""
        return self.scaled(self.low), self.scaled(self.high)


_AT_LIMIT = 1e-3  # share of the range of a parameter within which it is at a limit


@dataclass(frozen=True, eq=False)
class CalibrationProblem:
    """A law to be fitted to points by weighted least squares.

        S(theta) = sum_i ((mu_i - mu_hysteresis,i - tau_f(v_i, T_i; theta) A_r,i/(A_0 p_i)) / s_i)^2

    with the spreads s_i, or one where none is stated.
    """

    points: Points
    kind: str
    free: tuple[Parameter, ...]
    held: Mapping[str, float]

    def law(self, theta: Array) -> InterfacialShearStress:
        """Return the law of the numbers `theta`, shape (free parameters,)."""
        values = {p.name: p.value(float(x)) for p, x in zip(self.free, theta, strict=True)}
        law: InterfacialShearStress = SHEAR_STRESSES[self.kind](**values, **self.held)
        return law

    def friction(self, theta: Array) -> Array:
        """Return the friction of the area term at the points [-]."""
        stress = self.law(theta).stress(self.points.speed, self.points.temperature)
        return self.points.leverage * stress

    def residuals(self, theta: Array) -> Array:
        """Return modelled less measured friction over the spread, shape (points,)."""
        apart = self.friction(theta) - self.points.difference
        return apart if self.points.spread is None else apart / self.points.spread

    def at_limit(self, theta: Array) -> bool:
        """Return whether a parameter is at a limit of the search; zero itself is none."""
        pairs = zip(self.free, theta, strict=True)
        return any(
            abs(x - end) < _AT_LIMIT * (parameter.limits[1] - parameter.limits[0])
            for parameter, x in pairs
            for end, value in zip(parameter.limits, (parameter.low, parameter.high), strict=True)
            if value != 0.0
        )

    def holding(self, index: int, scaled: float) -> CalibrationProblem:
        """Return the problem with the free parameter at `index` held."""
        parameter, free = self.free[index], self.free[:index] + self.free[index + 1 :]
        held = {**self.held, parameter.name: parameter.value(scaled)}
        return replace(self, free=free, held=held)


def check_names(kind: str, fixed: Iterable[str]) -> None:
    """Raise `InputError` unless a law can be fitted and names of what is fixed belong to it."""
    checks.one_of("law", kind, KINDS)
    names = [parameter.name for parameter in fields(SHEAR_STRESSES[kind])]
    checks.allowed_names("parameter", fixed, names)


def problem_of(kind: str, points: Points, fixed: Mapping[str, float]) -> CalibrationProblem:
    """Return the law of a kind to be fitted to points, with what is fixed held and all else free.

    An activation energy is free only where temperatures differ; without one the law has none. Its
    reference temperature is held: by default the median of the temperatures, a whole number of
    degrees Celsius. Raises `InputError` for names and values that cannot be held, and for fewer
    points than parameters.
    """
    check_names(kind, fixed)
    every = _parameters(kind, points)
    held: dict[str, Any] = {name: checks.number(name, value) for name, value in fixed.items()}
    if kind == "gaussian":
        apart = points.temperature_range >= LEAST_APART
        referred = "reference_temperature" in held
        if held.get("activation_energy", math.inf if apart else 0.0) == 0.0:
            if referred:
                raise InputError(
                    "reference_temperature belongs to an activation_energy; got one without the "
                    "other"
                )
            held["activation_energy"] = 0.0
        elif not referred:
            if points.temperature is None:
                raise InputError("activation_energy needs the temperatures of the points; got none")
            middle = float(np.median(points.temperature)) - ZERO_CELSIUS
            held["reference_temperature"] = round(middle) + ZERO_CELSIUS
    free = tuple(parameter for parameter in every if parameter.name not in held)
    if not free:
        raise InputError(f"fixed must leave a parameter of the law {kind} to be fitted; got all")
    if points.speed.size <= len(free):
        names = ", ".join(parameter.name for parameter in free)
        raise InputError(
            f"fitting {names} needs more than {len(free)} measured "
            f"point{'s' * (len(free) > 1)}; got {points.speed.size}"
        )
    problem = CalibrationProblem(points, kind, free, held)
    starts = np.array([parameter.scaled(parameter.starts[0]) for parameter in free])
    problem.law(starts)  # checks what is held
    return problem


def _parameters(kind: str, points: Points) -> tuple[Parameter, ...]:
    """Return every parameter of a law, with limits and starts that suit the points."""
    largest = float(np.abs(points.stress).max()) or 1.0
    slow, fast = float(points.speed.min()), float(points.speed.max())
    along = tuple(np.geomspace(0.1 * slow, 10.0 * fast, 7).tolist())
    stress = Parameter("stress_0", "Pa", 1e-6 * largest, 1e6 * largest, (largest,))

    def speed(name: str) -> Parameter:
        return Parameter(name, "m/s", 1e-8 * slow, 1e8 * fast, along)

    return {
        "constant": (stress,),
        "gaussian": (
            stress,
            Parameter("width", "", 1e-3, 1e2, (0.05, 0.3, 1.5)),
            speed("speed_0"),
            Parameter("activation_energy", "eV", 0.0, 10.0, (0.5, 1.2), log=False),
        ),
        "le_gal_klueppel": (
            stress,
            Parameter("ratio", "", 1e-3, 1e6, (3.0, 100.0)),
            speed("critical_speed"),
            Parameter("exponent", "", 0.02, 20.0, (0.3, 1.0, 3.0)),
        ),
    }[kind]


BEST_STARTS = 3  # starts, of all that are tried, from which the search goes on to its end
_TOLERANCE = 1e-8


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """The least sum of squares that was found."""

    theta: Array  # numbers of the free parameters, as the search works with them
    sum_of_squares: float
    jacobian: Array  # of the residuals by them, shape (points, free parameters)


def best(problem: CalibrationProblem) -> FittedLaw:
    """Return the least sum of squares over a grid of starts."""
    free = problem.free
    grid = product(*([parameter.scaled(value) for value in parameter.starts] for parameter in free))

    def cost(start: tuple[float, ...]) -> float:
        residuals = problem.residuals(np.array(start))
        return float(residuals @ residuals)

    starts = [tuple(_with_best_stress(problem, np.array(theta))) for theta in grid]
    optima = [refined(problem, np.array(start)) for start in sorted(starts, key=cost)[:BEST_STARTS]]
    return min(optima, key=lambda optimum: optimum.sum_of_squares)


def refined(problem: CalibrationProblem, start: Array) -> FittedLaw:
    """Return the least sum of squares near `start`."""
    if not problem.free:
        residuals = problem.residuals(start)
        return FittedLaw(start, float(residuals @ residuals), np.empty((residuals.size, 0)))
    low, high = np.array([parameter.limits for parameter in problem.free]).T
    solution = scipy.optimize.least_squares(
        problem.residuals,
        np.clip(start, low, high),
        bounds=(low, high),
        xtol=_TOLERANCE,
        ftol=_TOLERANCE,
        gtol=_TOLERANCE,
    )
    return FittedLaw(solution.x, 2.0 * float(solution.cost), np.asarray(solution.jac))


def _with_best_stress(problem: CalibrationProblem, theta: Array) -> Array:
    """Return `theta` with the stress, which is a factor, the best for all others."""
    names = [parameter.name for parameter in problem.free]
    if "stress_0" not in names:
        return theta
    at = names.index("stress_0")
    weight = 1.0 if problem.points.spread is None else 1.0 / problem.points.spread
    shape, wanted = problem.friction(theta) * weight, problem.points.difference * weight
    square = float(shape @ shape)
    factor = float(shape @ wanted) / square if square > 0.0 else 0.0
    if factor > 0.0:
        theta[at] = np.clip(theta[at] + np.log(factor), *problem.free[at].limits)
    return theta
