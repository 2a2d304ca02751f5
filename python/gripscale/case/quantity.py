"""Quantities a case file states with their unit, "3 bar" or "100 mm", or as plain SI numbers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import GetCoreSchemaHandler
from pydantic_core import core_schema

from gripscale.case.expected import Words
from gripscale.case.reading import Reading
from gripscale.units import listed, parse_quantity, spelled, such_as


def _positive(value: float) -> float:
    if value <= 0.0:
        raise ValueError("expected a value greater than zero")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise ValueError("expected zero or a positive value")
    return value


@dataclass(frozen=True)
class Quantity(Reading):
    """Read with its unit, then checked."""

    kind: str
    check: Callable[[float], float]

    def read(self, value: Any) -> float:
        """Return a number in SI units."""
        return self.check(parse_quantity(value, self.kind))


def _quantity(kind: str, check: Callable[[float], float] = float) -> Quantity:
    return Quantity(f"a {kind} {such_as(kind)}", kind, check)


@dataclass(frozen=True)
class Unit(Words):
    """A unit of one kind of quantity."""

    kind: str

    def __get_pydantic_core_schema__(
        self, source: Any, handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Look at the text once pydantic knows that it is one."""
        return core_schema.no_info_after_validator_function(self._check, handler(source))

    def _check(self, value: str) -> str:
        if spelled(value, self.kind) is None:
            raise ValueError(f"expected {self.words}")
        return value


def unit_of_file(kind: str) -> Unit:
    """Return the type of a key that names the unit of a file."""
    return Unit(f"one of {listed(kind)}", kind)


Pressure = Annotated[float, _quantity("pressure", _positive)]
Stress = Annotated[float, _quantity("pressure", _not_negative)]
Length = Annotated[float, _quantity("length", _positive)]
Position = Annotated[float, _quantity("length")]
Duration = Annotated[float, _quantity("time", _positive)]
Speed = Annotated[float, _quantity("speed", _not_negative)]
MovingSpeed = Annotated[float, _quantity("speed", _positive)]
Temperature = Annotated[float, _quantity("temperature", _positive)]
TemperatureDifference = Annotated[float, _quantity("temperature difference", _positive)]
Strain = Annotated[float, _quantity("strain", _positive)]
Conductivity = Annotated[float, _quantity("conductivity", _positive)]
Density = Annotated[float, _quantity("density", _positive)]
SpecificHeat = Annotated[float, _quantity("specific heat", _positive)]
MolarEnergy = Annotated[float, _quantity("molar energy", _positive)]
BondEnergy = Annotated[float, _quantity("bond energy", _not_negative)]
