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
Length = Annotated[float, _reader("length", _positive)]
Position = Annotated[float, _reader("length")]
Duration = Annotated[float, _reader("time", _positive)]
Speed = Annotated[float, _reader("speed", _not_negative)]
Temperature = Annotated[float, _reader("temperature", _positive)]
