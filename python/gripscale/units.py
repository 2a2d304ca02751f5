"""Units that files, case files and callers may name, each with its size in SI units."""

from __future__ import annotations

import math
import re
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from gripscale.checks import MOST, shown
from gripscale.errors import InputError

Value = TypeVar("Value", float, NDArray[np.float64])

_PASCALS = {"Pa": 1.0, "kPa": 1e3, "bar": 1e5, "MPa": 1e6, "N/mm^2": 1e6, "GPa": 1e9}

UNITS: dict[str, dict[str, float]] = {
    "length": {
        "m": 1.0,
        "cm": 1e-2,
        "mm": 1e-3,
        "um": 1e-6,
        "nm": 1e-9,
        "pm": 1e-12,
        "in": 0.0254,
    },
    "pressure": _PASCALS,
    "modulus": {unit: size for unit, size in _PASCALS.items() if unit != "bar"},
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1.0 / 3.6},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "frequency": {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "GHz": 1e9, "rad/s": 0.5 / math.pi},
    "temperature": {"K": 1.0, "C": 1.0, "F": 5.0 / 9.0},
    "strain": {"1": 1.0, "%": 1e-2},
}
"""The units of each kind of quantity by their usual spelling; the first is the SI unit."""

_ZERO = {"C": 273.15, "F": 459.67 * 5.0 / 9.0}
"""Where a scale does not begin at the zero of the SI unit."""

_SPELLINGS = {
    "micron": "um",
    "microns": "um",
    "micrometer": "um",
    "micrometre": "um",
    "meter": "m",
    "metre": "m",
    "meters": "m",
    "metres": "m",
    "millimeter": "mm",
    "millimetre": "mm",
    "inch": "in",
    "n/mm2": "N/mm^2",
    "n/mm²": "N/mm^2",
    "n/m2": "Pa",
    "n/m^2": "Pa",
    "hz": "Hz",
    "°c": "C",
    "degc": "C",
    "deg c": "C",
    "celsius": "C",
    "°f": "F",
    "degf": "F",
    "deg f": "F",
    "fahrenheit": "F",
    "kelvin": "K",
}

_EXAMPLES = {
    "length": "100 mm",
    "pressure": "3 bar",
    "speed": "0.3 m/s",
    "time": "0.1 s",
    "temperature": "20 C",
}
_QUANTITY = re.compile(
    r"\s*+([-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d++)?|[-+]?inf|nan)\s*+(\S*+)\s*+", re.ASCII
)


def spelled(unit: object, kind: str) -> str | None:
    """Return the usual spelling of a unit of `kind` ("length", ...), or None if it is not one."""
    if not isinstance(unit, str):
        return None
    word = unit.strip()
    word = _SPELLINGS.get(word.lower(), word)
    # Two characters look like this: the micro sign and the Greek letter.
    word = re.sub("^[µμ]", "u", word)
    return word if word in UNITS[kind] else None


def in_si(value: Value, unit: str, kind: str, name: str = "unit") -> Value:
    """Return a number or array given in a `unit` of `kind` in the SI unit.

    Raises `InputError`, which says that `name` must be one of the units of `kind`.
    """
    known = spelled(unit, kind)
    if known is None:
        raise InputError(f"{name} must be one of {listed(kind)}; got {shown(unit)}")
    return value * UNITS[kind][known] + _ZERO.get(known, 0.0)


def listed(kind: str) -> str:
    """Return the units of `kind` as a sentence lists them."""
    return ", ".join(UNITS[kind])


def parse_quantity(value: Any, kind: str) -> float:
    """Return `value`, such as "3 bar" or a plain number in the SI unit, in the SI unit of `kind`.

    Raises `ValueError` with what was expected; the caller adds the place.
    """
    if isinstance(value, int | float) and not isinstance(value, bool):
        return _finite(value, kind)
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError(f"expected a {kind} {_example(kind)}")
    number, unit = match.groups()
    if unit == "":
        raise ValueError(f"the unit is missing; expected one of {listed(kind)}")
    if spelled(unit, kind) is None:
        raise ValueError(f"unknown unit {shown(unit)}; expected one of {listed(kind)}")
    return _finite(in_si(float(number), unit, kind), kind)


def _finite(value: float, kind: str) -> float:
    if not abs(value) <= MOST:
        raise ValueError(f"expected a finite {kind} {_example(kind)}")
    return float(value)


def _example(kind: str) -> str:
    return f'such as "{_EXAMPLES[kind]}", or a plain number in {next(iter(UNITS[kind]))}'
