"""A calibration in words: its parameters, its notes, and the table of a case file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gripscale.conditions.area_term import shear_stress_to_dict
from gripscale.core import InputError, checks
from gripscale.core.units import MEGA, ZERO_CELSIUS, DisplayUnit, parse_quantity
from gripscale.questions.calibration.area_term_fit import AreaTermFit, Estimate
from gripscale.questions.calibration.profile_likelihood import LIKELIHOOD_LEVEL
from gripscale.rubber.extrapolation import WORTH_SAYING


class ParameterWords(NamedTuple):
    """A parameter of a law: in words, beside an axis, and its kind of quantity, if it has one."""

    words: str
    label: str
    kind: str = ""

    @property
    def unit(self) -> str:
        """Unit of the law; empty for a plain number."""
        return _LAW_UNITS.get(self.kind, "")


# The parameters of the laws; the reference temperature is held, never fitted.
PARAMETERS = {
    "stress_0": ParameterWords("shear stress τ_0", "stress $\\tau_0$", "pressure"),
    "width": ParameterWords("width factor c", "width $c$"),
    "speed_0": ParameterWords("speed v_0 of the largest stress", "speed $v_0$", "speed"),
    "activation_energy": ParameterWords(
        "activation energy", "activation energy $\\epsilon$", "bond energy"
    ),
    "reference_temperature": ParameterWords("", "", "temperature"),
    "ratio": ParameterWords("gain of stress at high speed", "ratio"),
    "critical_speed": ParameterWords("critical speed v_c", "critical speed $v_c$", "speed"),
    "exponent": ParameterWords("exponent n of the speed", "exponent $n$"),
}
_LAW_UNITS = {"pressure": "Pa", "speed": "m/s", "bond energy": "eV", "temperature": "K"}
# How a number in a unit of the law is written, if not in this unit.
WRITTEN = {"Pa": DisplayUnit("MPa", MEGA), "K": DisplayUnit("C", zero=ZERO_CELSIUS)}


def parse_fixed(texts: Iterable[str]) -> dict[str, float]:
    """Return parameters stated as "width=0.1" or "stress_0=5 MPa" [SI units, eV].

    Raises `InputError` if one cannot be understood.
    """
    parameters: dict[str, float] = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not name or name in parameters:
            raise InputError(
                f"fixed must be name=value, each name once; got {checks.short_repr(text)}"
            )
        kind = PARAMETERS[name].kind if name in PARAMETERS else ""
        try:
            parameters[name] = parse_quantity(value, kind) if kind else float(value)
        except ValueError as error:
            why = str(error) if kind else "expected a number"
            raise InputError(f"fixed {name} = {checks.short_repr(value)}: {why}") from error
    return parameters


UNLIKELY = 0.01  # chance of the sum of squares below which something must be wrong


def notes(calibration: AreaTermFit) -> Iterator[str]:
    """Yield a sentence on each thing to know before the numbers are used."""
    if not calibration.spread_known:
        yield (
            f"No spread is stated: the scatter of the residuals, {calibration.scatter:.2g}, "
            "takes its place, whatever its cause."
        )
    elif calibration.chance < UNLIKELY:
        yield (
            f"The residuals are {calibration.scatter:.2g} times the stated spread: law, hysteresis "
            "or spread is wrong, and the intervals are too narrow."
        )
    yield (
        "The intervals hold for the spread of the measurement alone: an error of the predicted "
        "contact area is an error of the shear stress."
    )
    held = calibration.problem.held
    if calibration.law.kind == "gaussian" and held.get("activation_energy") == 0.0:
        yield (
            "No activation energy: the temperatures in the contact are only "
            f"{calibration.problem.points.temperature_range:.2g} K apart and do not determine it. "
            "The law holds at the measured temperature."
        )
    for estimate in calibration.estimates:
        ends = {"lower": estimate.low, "upper": estimate.high}
        missing = [word for word, end in ends.items() if not np.isfinite(end)]
        if len(missing) == 2:
            yield f"{estimate.name} is not determined by the data."
        elif missing:
            yield f"The {missing[0]} end of {estimate.name} is not determined by the data."
    predicted = calibration.predicted
    without = int((~predicted.has_answer).sum())
    if without:
        why = next(s for s, k in zip(predicted.status, predicted.has_answer, strict=True) if not k)
        yield f"Measured points without a prediction, which do not count: {without}, as {why}."
    below = int((calibration.problem.points.difference < 0.0).sum())
    if below:
        yield f"Measured points below the hysteresis alone: {below}."
    beyond = int((predicted.outside_band > WORTH_SAYING).sum())
    if beyond:
        yield (
            f"Points where more than {WORTH_SAYING:.0%} of the hysteresis rests on the rubber "
            f"outside its measured frequencies: {beyond}."
        )


def shear_stress_table(calibration: AreaTermFit) -> str:
    """Return the table [conditions.shear_stress] of the fitted law, with its intervals."""
    law = shear_stress_to_dict(calibration.law)
    estimates = {estimate.name: estimate for estimate in calibration.estimates}
    source = Path(calibration.measured.source).name or "a measurement"
    lines = [
        f"# Fitted to {calibration.problem.points.speed.size} points of {source};",
        f"# intervals of {LIKELIHOOD_LEVEL:.0%} by profile likelihood, for this rubber on this "
        "surface.",
        "[conditions.shear_stress]",
        f'kind = "{law.pop("kind")}"',
    ]
    if calibration.law.kind == "gaussian" and law["activation_energy"] == 0.0:
        del law["activation_energy"], law["reference_temperature"]
        lines.insert(2, "# No activation energy: the law holds at the measured temperature.")
    for name, value in law.items():
        estimate = estimates.get(name)
        unit = PARAMETERS[name].unit if estimate is None else estimate.unit
        text = written(float(value), unit)
        text = f'"{text}"' if unit else text
        lines.append(
            f"{name} = {text}  # {'held' if estimate is None else estimate_interval(estimate)}"
        )
    return "\n".join(lines) + "\n"


def written(value: float, unit: str, digits: int | None = None) -> str:
    """Return a number of the law with its unit, of up to six digits or just `digits`."""
    display_unit = WRITTEN.get(unit, DisplayUnit(unit))
    number = float(display_unit.of(value))
    text = f"{number:.6g}" if digits is None else f"{number:#.{digits}g}".rstrip(".")
    return f"{text} {display_unit.unit}".strip()


def estimate_interval(estimate: Estimate) -> str:
    """Return the interval of a parameter in words."""
    low, high = (f"{written(end, estimate.unit, 3)}" for end in (estimate.low, estimate.high))
    below, above = math.isfinite(estimate.low), math.isfinite(estimate.high)
    if below and above:
        return f"{low} to {high}"
    if below:
        return f"from {low}, upper end not determined"
    return f"up to {high}, lower end not determined" if above else "not determined"
