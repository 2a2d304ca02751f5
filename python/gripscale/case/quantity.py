"""Quantities with their unit, "3 bar" or "100 mm"; a plain number is in SI units."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any

from pydantic import BeforeValidator

UNITS: dict[str, dict[str, float]] = {
    "pressure": {"Pa": 1.0, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "N/mm^2": 1e6, "GPa": 1e9},
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "nm": 1e-9},
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1.0 / 3.6},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "temperature": {"K": 1.0, "C": 1.0, "°C": 1.0},
}
_EXAMPLES = {"pressure": "3 bar", "length": "100 mm", "speed": "0.3 m/s", "time": "0.1 s"}
_EXAMPLES["temperature"] = "20 C"
_ZERO = {"C": 273.15, "°C": 273.15}
_QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?|[-+]?inf|nan)\s*(\S*)\s*")


def parse_quantity(value: Any, kind: str) -> float:
    """Return `value` in the SI unit of `kind` ("pressure", "length", "speed" ...).

    Raises `ValueError` with what was expected: the reader of the case adds file and key.
    """
    units = UNITS[kind]
    if isinstance(value, int | float) and not isinstance(value, bool):
        return _finite(float(value), kind)
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError(f"expected a {kind} {_example(kind)}")
    number, unit = match.groups()
    if unit == "":
        raise ValueError(f"the unit is missing; expected one of {', '.join(units)}")
    if unit not in units:
        raise ValueError(f"unknown unit {unit!r}; expected one of {', '.join(units)}")
    return _finite(float(number) * units[unit] + _ZERO.get(unit, 0.0), kind)


def _finite(value: float, kind: str) -> float:
    if not math.isfinite(value):
        raise ValueError(f"expected a finite {kind} {_example(kind)}")
    return value


def _example(kind: str) -> str:
    return f'such as "{_EXAMPLES[kind]}", or a plain number in {next(iter(UNITS[kind]))}'


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
Speed = Annotated[float, _reader("speed", _not_negative)]
Temperature = Annotated[float, _reader("temperature", _positive)]
Time = Annotated[float, _reader("time", _positive)]
