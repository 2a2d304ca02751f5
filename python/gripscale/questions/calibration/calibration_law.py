"""The parameters of a law of the area term: on which scale, within which limits they are sought.

Limits are far beyond what data can say, so that reaching one means: not determined.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, NamedTuple

import numpy as np

from gripscale.conditions.area_term import SHEAR_STRESSES, InterfacialShearStress
from gripscale.core import ZERO_CELSIUS, Array, InputError, Mask, checks
from gripscale.core.units import MEGA, DisplayUnit, parse_quantity
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.questions.calibration.measured_comparison import Predicted
from gripscale.questions.vary.axis import values_by_name


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

    def only(self, chosen: Mask) -> Points:
        """Return some of the points."""
        kept: dict[str, Any] = {k: None if v is None else v[chosen] for k, v in vars(self).items()}
        return Points(**kept)


def points_of(measured: MeasuredFriction, predicted: Predicted) -> Points:
    """Return the points that have an answer; `InputError` as `fit_area_term` says."""
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
    if (spread == 0.0).any():
        raise InputError(
            "spread must be above zero to weigh a point; got 0: leave it empty if unknown"
        )
    return _all_or_none("spread", spread)


def _all_or_none(name: str, values: Array) -> Array | None:
    """Return values of all points, None where none is known; else raise `InputError`."""
    missing = np.isnan(values)
    if missing.any() and not missing.all():
        raise InputError(
            f"{name} must be stated for all points or for none; got it for {(~missing).sum()} of "
            f"{missing.size}"
        )
    return None if missing.all() else values


class ParameterWords(NamedTuple):
    """A parameter of a law in words; its kind of quantity and its unit, if it has one."""

    words: str
    kind: str = ""
    unit: str = ""


# The parameters of the laws; the reference temperature is held, never fitted.
PARAMETERS = {
    "stress_0": ParameterWords("shear stress τ_0", "pressure", "Pa"),
    "width": ParameterWords("width factor c"),
    "speed_0": ParameterWords("speed v_0 of the largest stress", "speed", "m/s"),
    "activation_energy": ParameterWords("activation energy", "bond energy", "eV"),
    "reference_temperature": ParameterWords("", "temperature", "K"),
    "ratio": ParameterWords("gain of stress at high speed"),
    "critical_speed": ParameterWords("critical speed v_c", "speed", "m/s"),
    "exponent": ParameterWords("exponent n of the speed"),
}
# How a number in a unit of the law is written, if not in this unit.
WRITTEN = {"Pa": DisplayUnit("MPa", MEGA), "K": DisplayUnit("C", zero=ZERO_CELSIUS)}


def written(value: float, unit: str, digits: int | None = None) -> str:
    """Return a number of the law with its unit, of up to six digits or just `digits`."""
    display_unit = WRITTEN.get(unit, DisplayUnit(unit))
    number = float(display_unit.of(value))
    text = f"{number:.6g}" if digits is None else f"{number:#.{digits}g}".rstrip(".")
    return f"{text} {display_unit.unit}".strip()


def parse_fixed(texts: Iterable[str]) -> dict[str, float]:
    """Return parameters stated as "width=0.1" or "stress_0=5 MPa" [SI units, eV].

    Raises `InputError` if one cannot be understood.
    """
    parameters: dict[str, float] = {}
    for name, value in values_by_name(texts, "fixed", "width=0.1").items():
        kind = PARAMETERS[name].kind if name in PARAMETERS else ""
        try:
            parameters[name] = parse_quantity(value, kind) if kind else float(value)
        except ValueError as error:
            why = str(error) if kind else "expected a number"
            raise InputError(f"fixed {name} = {checks.short_repr(value)}: {why}") from error
    return parameters


KINDS = ("constant", "gaussian", "le_gal_klueppel")  # laws that can be fitted
LEAST_APART = 1.0  # range of temperatures below which none decides an activation energy [K]


@dataclass(frozen=True)
class Parameter:
    """A number of a law that is fitted: as the law calls it, with the limits of the search."""

    name: str
    low: float
    high: float
    starts: Sequence[float]  # where the search begins
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

    def sum_of_squares(self, theta: Array) -> float:
        """Return S(theta)."""
        residuals = self.residuals(theta)
        return float(residuals @ residuals)

    def with_best_stress(self, theta: Array) -> Array:
        """Return `theta` with the stress, which is a factor, the best for all others."""
        names, spread = [parameter.name for parameter in self.free], self.points.spread
        if "stress_0" not in names:
            return theta
        at = names.index("stress_0")
        weight = 1.0 if spread is None else 1.0 / spread
        shape, wanted = self.friction(theta) * weight, self.points.difference * weight
        square = float(shape @ shape)
        factor = float(shape @ wanted) / square if square > 0.0 else 0.0
        if factor > 0.0:
            theta[at] = np.clip(theta[at] + np.log(factor), *self.free[at].limits)
        return theta

    def at_limit(self, theta: Array) -> bool:
        """Return whether a parameter is at a limit of the search; zero itself is none."""
        for parameter, x in zip(self.free, theta, strict=True):
            low, high = parameter.limits
            ends = [low, high] if parameter.low != 0.0 else [high]
            if any(abs(x - end) < _AT_LIMIT * (high - low) for end in ends):
                return True
        return False

    def holding(self, index: int, scaled: float) -> CalibrationProblem:
        """Return the problem with the free parameter at `index` held."""
        parameter, free = self.free[index], self.free[:index] + self.free[index + 1 :]
        held = {**self.held, parameter.name: parameter.value(scaled)}
        return replace(self, free=free, held=held)


def check_names(kind: str, fixed: Iterable[str]) -> list[str]:
    """Return the names of the parameters of a law; `InputError` if it cannot be fitted so."""
    checks.one_of("law", kind, KINDS)
    names = [f.name for f in fields(SHEAR_STRESSES[kind]) if f.name in PARAMETERS]
    checks.allowed_names("parameter", fixed, names)
    return names


def problem_of(kind: str, points: Points, fixed: Mapping[str, float]) -> CalibrationProblem:
    """Return the law of a kind to be fitted to points, with what is fixed held and all else free.

    An activation energy is free only where temperatures differ. Its reference temperature is held:
    by default the median of the temperatures, a whole number of degrees Celsius. Raises
    `InputError` for names and values that cannot be held, and for fewer points than parameters.
    """
    names, every = check_names(kind, fixed), parameters_of(points)
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
    free = tuple(every[name] for name in names if name in every.keys() - held.keys())
    if not free:
        raise InputError(f"fixed must leave a parameter of the law {kind} to be fitted; got all")
    if points.speed.size <= len(free):
        fitted = ", ".join(parameter.name for parameter in free)
        raise InputError(
            f"fitting {fitted} needs more than {len(free)} measured "
            f"point{'s' * (len(free) > 1)}; got {points.speed.size}"
        )
    problem = CalibrationProblem(points, kind, free, held)
    problem.law(np.array([each.scaled(each.starts[0]) for each in free]))  # checks what is held
    return problem


def parameters_of(points: Points) -> dict[str, Parameter]:
    """Return every parameter of the laws by its name, with limits and starts that suit points."""
    largest = float(np.abs(points.difference / points.leverage).max()) or 1.0
    slow, fast = float(points.speed.min()), float(points.speed.max())
    speed = (1e-8 * slow, 1e8 * fast, np.geomspace(0.1 * slow, 10.0 * fast, 7).tolist())
    every = (
        Parameter("stress_0", 1e-6 * largest, 1e6 * largest, (largest,)),
        Parameter("width", 1e-3, 1e2, (0.05, 0.3, 1.5)),
        Parameter("speed_0", *speed),
        Parameter("activation_energy", 0.0, 10.0, (0.5, 1.2), log=False),
        Parameter("ratio", 1e-3, 1e6, (3.0, 100.0)),
        Parameter("critical_speed", *speed),
        Parameter("exponent", 0.02, 20.0, (0.3, 1.0, 3.0)),
    )
    return {parameter.name: parameter for parameter in every}
