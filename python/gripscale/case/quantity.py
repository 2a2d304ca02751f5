"""Quantities a case file states with their unit, "3 bar" or "100 mm", or as plain SI numbers."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator

from gripscale.units import parse_quantity


def _positive(value: float) -> float:
    if value <= 0.0:
        raise ValueError("expected a value greater than zero")
    return value


def _not_negative(value: float) -> float:
    if value < 0.0:
        raise ValueError("expected zero or a positive value")
    return value


def _reader(kind: str, check: Any = float) -> BeforeValidator:
    return BeforeValidator(lambda value: check(parse_quantity(value, kind)))


Pressure = Annotated[float, _reader("pressure", _positive)]
Stress = Annotated[float, _reader("pressure", _not_negative)]
Length = Annotated[float, _reader("length", _positive)]
Position = Annotated[float, _reader("length")]
Duration = Annotated[float, _reader("time", _positive)]
Speed = Annotated[float, _reader("speed", _not_negative)]
MovingSpeed = Annotated[float, _reader("speed", _positive)]
Temperature = Annotated[float, _reader("temperature", _positive)]
TemperatureDifference = Annotated[float, _reader("temperature difference", _positive)]
Strain = Annotated[float, _reader("strain", _positive)]
Conductivity = Annotated[float, _reader("conductivity", _positive)]
Density = Annotated[float, _reader("density", _positive)]
SpecificHeat = Annotated[float, _reader("specific heat", _positive)]
MolarEnergy = Annotated[float, _reader("molar energy", _positive)]
BondEnergy = Annotated[float, _reader("bond energy", _not_negative)]
