"""The parameters of a law of the area term: on which scale, within which limits they are sought.

Limits are far beyond what data can say, so that reaching one means: not determined.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.calibration.points import Points
from gripscale.errors import InputError
from gripscale.interface.area_term import SHEAR_STRESSES, InterfacialShearStress
from gripscale.units import ZERO_CELSIUS

Array = NDArray[np.float64]

KINDS = ("constant", "gaussian", "le_gal_klueppel")
"""Laws that can be fitted."""

LEAST_APART = 1.0
"""Range of temperatures below which none decides an activation energy [K]."""


@dataclass(frozen=True)
class Parameter:
    """A number of a law that is fitted.

    Parameters
    ----------
    name, unit : str
        As the law calls it.
    low, high : float
        Limits of the search.
    starts : tuple of float
        Where the search begins.
    log : bool
        Whether it is positive, and its logarithm is what is fitted.
    """

    name: str
    unit: str
    low: float
    high: float
    starts: tuple[float, ...]
    log: bool = True

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


@dataclass(frozen=True)
class Family:
    """A law with some parameters free and the others held."""

    kind: str
    free: tuple[Parameter, ...]
    held: Mapping[str, float]

    def law(self, theta: Array) -> InterfacialShearStress:
        """Return the law of the numbers `theta`, shape (free parameters,)."""
        values = {p.name: p.value(float(x)) for p, x in zip(self.free, theta, strict=True)}
        made: InterfacialShearStress = SHEAR_STRESSES[self.kind](**values, **self.held)
        return made


def check_names(kind: str, fixed: Iterable[str]) -> None:
    """Raise `InputError` unless a law can be fitted and names of what is fixed belong to it."""
    checks.one_of("law", kind, KINDS)
    names = [one.name for one in fields(SHEAR_STRESSES[kind])]
    checks.known("parameter", fixed, names)


def family_of(kind: str, points: Points, fixed: Mapping[str, float]) -> Family:
    """Return the law of a kind with what is fixed held and all else free.

    An activation energy is free only where temperatures differ; without one the law has none. Its
    reference temperature is held: by default the median of the temperatures, a whole number of
    degrees Celsius.

    Raises
    ------
    InputError
        If the kind is none of `KINDS`, a fixed name is no parameter of it, its value cannot be
        used, nothing is left to be fitted, or there are not more points than free parameters.
    """
    check_names(kind, fixed)
    every = _parameters(kind, points)
    held: dict[str, Any] = {name: checks.number(name, value) for name, value in fixed.items()}
    if kind == "gaussian":
        held |= _temperature_of(points, held)
    free = tuple(one for one in every if one.name not in held)
    if not free:
        raise InputError(f"fixed must leave a parameter of the law {kind} to be fitted; got all")
    if points.speed.size <= len(free):
        raise InputError(
            f"fitting {', '.join(one.name for one in free)} needs more than {len(free)} measured "
            f"point{'s' * (len(free) > 1)}; got {points.speed.size}"
        )
    family = Family(kind, free, held)
    family.law(np.array([one.scaled(one.starts[0]) for one in free]))  # the law checks what is held
    return family


def _temperature_of(points: Points, held: Mapping[str, float]) -> dict[str, float]:
    """Return what the Gaussian law holds beside `held`: no activation energy, or its reference."""
    apart = points.temperature_range >= LEAST_APART
    if held.get("activation_energy", math.inf if apart else 0.0) == 0.0:
        if "reference_temperature" in held:
            raise InputError(
                "reference_temperature belongs to an activation_energy; got one without the other"
            )
        return {"activation_energy": 0.0}
    if "reference_temperature" in held:
        return {}
    if points.temperature is None:
        raise InputError("activation_energy needs the temperatures of the points; got none")
    middle = float(np.median(points.temperature)) - ZERO_CELSIUS
    return {"reference_temperature": round(middle) + ZERO_CELSIUS}


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
