"""The fitted law as the table of a case file, ready to be pasted."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.calibration.profile import LEVEL
from gripscale.interface.area_term import shear_stress_to_dict
from gripscale.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from gripscale.calibration.fitted import Estimate, FittedLaw

WRITTEN: Mapping[str, tuple[Callable[[float], float], str]] = {
    "Pa": (lambda value: value / 1e6, "MPa"),
    "m/s": (lambda value: value, "m/s"),
    "eV": (lambda value: value, "eV"),
    "K": (lambda value: value - ZERO_CELSIUS, "C"),
    "": (lambda value: value, ""),
}
"""How a number in a unit of the law is written: conversion and unit."""

HELD_UNITS = {
    "stress_0": "Pa",
    "speed_0": "m/s",
    "critical_speed": "m/s",
    "activation_energy": "eV",
    "reference_temperature": "K",
}
"""Units of parameters that may be held; the others have none."""


def shear_stress_table(calibration: FittedLaw) -> str:
    """Return the table [conditions.shear_stress] of the fitted law, with its intervals."""
    law = shear_stress_to_dict(calibration.law)
    estimates = {one.name: one for one in calibration.estimates}
    source = Path(calibration.measured.source).name or "a measurement"
    lines = [
        f"# Fitted to {calibration.problem.points.speed.size} points of {source};",
        f"# intervals of {LEVEL:.0%} by profile likelihood, for this rubber on this surface.",
        "[conditions.shear_stress]",
        f'kind = "{law.pop("kind")}"',
    ]
    if calibration.law.kind == "gaussian" and law["activation_energy"] == 0.0:
        del law["activation_energy"], law["reference_temperature"]
        lines.insert(2, "# No activation energy: it holds at the temperature measured.")
    for name, value in law.items():
        lines.append(" ".join(_line(name, float(value), estimates.get(name))))
    return "\n".join(lines) + "\n"


def written(value: float, unit: str, digits: int | None = None) -> str:
    """Return a number of the law with its unit: six digits as far as they count, or `digits`."""
    convert, name = WRITTEN[unit]
    number = convert(value)
    text = f"{number:.6g}" if digits is None else f"{number:#.{digits}g}".rstrip(".")
    return f"{text} {name}".strip()


def interval(estimate: Estimate) -> str:
    """Return the interval of a parameter in words, in the unit it is written in."""
    low, high = (f"{written(end, estimate.unit, 3)}" for end in (estimate.low, estimate.high))
    if estimate.determined:
        return f"{low} to {high}"
    if math.isfinite(estimate.low):
        return f"from {low}, upper end not determined"
    if math.isfinite(estimate.high):
        return f"up to {high}, lower end not determined"
    return "not determined"


def _line(name: str, value: float, estimate: Estimate | None) -> Iterator[str]:
    unit = estimate.unit if estimate is not None else HELD_UNITS.get(name, "")
    text = written(value, unit)
    yield f"{name} = {text}" if not unit else f'{name} = "{text}"'
    yield f" # {'held' if estimate is None else interval(estimate)}"
