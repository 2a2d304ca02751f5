"""Units that files, case files and callers may name, and the units in which results are shown.

Inside, and in result files, all values are in SI units.
"""

from __future__ import annotations

import json
import math
import re
import unicodedata
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core.arrays import MOST
from gripscale.core.errors import InputError
from gripscale.core.wording import short_repr

Value = TypeVar("Value", float, NDArray[np.float64])

# A pound-force per square inch [Pa]: pound, standard gravity and inch are exact.
_PSI = 0.45359237 * 9.80665 / 0.0254**2
_METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "pm": 1e-12, "in": 0.0254}
_METRES |= {"km": 1e3, "Å": 1e-10, "mil": 2.54e-5, "uin": 2.54e-8, "ft": 0.3048, "yd": 0.9144}
_METRES |= {"ftUS": 1200.0 / 3937.0, "dm": 0.1, "kÅ": 1e-7, "mi": 1609.344}
_PASCALS = {"Pa": 1.0, "kPa": 1e3, "psi": _PSI, "bar": 1e5, "MPa": 1e6, "N/mm^2": 1e6, "GPa": 1e9}
_PASCALS |= {"ksi": 1e3 * _PSI, "kgf/cm^2": 98066.5, "kgf/mm^2": 9806650.0, "N/cm^2": 1e4}
_PASCALS |= {"atm": 101325.0, "kN/m^2": 1e3, "MN/m^2": 1e6, "kN/cm^2": 1e7}
_HERTZ = {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6, "GHz": 1e9, "mHz": 1e-3, "rpm": 1.0 / 60.0}
_HERTZ |= {"rad/s": 0.5 / math.pi, "krad/s": 500.0 / math.pi}

# Elementary charge times Avogadro's number: both exact in the SI.
_JOULES_PER_MOLE_IN_EV = 1.602176634e-19 * 6.02214076e23

# The units of each kind of quantity by their usual spelling; the first is the one used inside: the
# SI unit, except for the energy of a bond.
UNITS: dict[str, dict[str, float]] = {
    "length": _METRES,
    "pressure": _PASCALS,
    "modulus": _PASCALS | {"dyn/cm^2": 0.1},
    "compliance": {"1/Pa": 1.0, "1/kPa": 1e-3, "1/MPa": 1e-6, "1/GPa": 1e-9, "cm^2/dyn": 10.0}
    | {"1/psi": 1.0 / _PSI},
    "speed": {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1.0 / 3.6, "cm/s": 1e-2, "um/s": 1e-6}
    | {"mm/min": 1e-3 / 60.0, "m/min": 1.0 / 60.0, "mph": 0.44704},
    "time": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0},
    "frequency": _HERTZ,
    "temperature": {"K": 1.0, "C": 1.0, "F": 5.0 / 9.0},
    "temperature difference": {"K": 1.0, "C": 1.0, "F": 5.0 / 9.0},
    "conductivity": {"W/(m K)": 1.0, "mW/(m K)": 1e-3},
    "density": {"kg/m^3": 1.0, "g/cm^3": 1e3},
    "specific heat": {"J/(kg K)": 1.0, "kJ/(kg K)": 1e3},
    "molar energy": {"J/mol": 1.0, "kJ/mol": 1e3, "kcal/mol": 4184.0},
    "bond energy": {"eV": 1.0, "meV": 1e-3, "kJ/mol": 1e3 / _JOULES_PER_MOLE_IN_EV},
    "strain": {"1": 1.0, "%": 1e-2},
    "angle": {"rad": 1.0, "deg": math.pi / 180.0},
}

MILLI, MICRO, MEGA, SQUARE_MM = 1e-3, 1e-6, 1e6, 1e-6  # sizes of mm, um, MPa and mm^2 in SI units

ZERO_CELSIUS = 273.15
"""0 C [K]."""

# Zero [K] of the scales of temperature that do not begin at 0 K.
_ZERO = {"C": ZERO_CELSIUS, "F": 459.67 * 5.0 / 9.0}
_UNIT_NEEDED = ("temperature",)  # kinds whose plain numbers are ambiguous

_OTHER_SPELLINGS = {
    "um": ("micron", "microns", "micrometer", "micrometre", "micrometers", "micrometres"),
    "m": ("meter", "metre", "meters", "metres"),
    "mm": ("millimeter", "millimetre", "millimeters", "millimetres"),
    "nm": ("nanometer", "nanometre", "nanometers", "nanometres"),
    "km": ("kilometer", "kilometre", "kilometers", "kilometres"),
    "Å": ("å", "angstrom", "angstroms", "ångström", "ångstrom"),
    "in": ("inch", "inches", '"', "″"),
    "mil": ("mils", "thou"),
    "uin": ("µin", "μin", "microinch", "microinches"),
    "ft": ("foot", "feet"),
    "ftUS": ("ftus", "us-ft", "usft", "ft-us", "us survey foot", "us survey feet"),
    "W/(m K)": ("w/mk", "w/(mk)", "w/(m*k)", "w/m/k"),
    "J/(kg K)": ("j/kgk", "j/(kgk)", "j/(kg*k)", "j/kg/k"),
    "kJ/(kg K)": ("kj/(kgk)",),
    "N/mm^2": ("n/mm^2",),
    "Pa": ("n/m^2",),
    "dyn/cm^2": ("dyne/cm^2", "dynes/cm^2"),
    "kgf/mm^2": ("kp/mm^2",),
    "psi": ("lbf/in2", "lbf/in^2"),
    "ksi": ("kpsi",),
    "kgf/cm^2": ("kg/cm^2", "kp/cm^2"),
    "Hz": ("hz", "cps"),
    "rad/s": ("rad/sec", "rad s-1", "rad s^-1", "rad·s-1", "rads-1", "rad.s-1", "rad/s."),
    "rpm": ("cpm", "cycles/min", "1/min", "min-1", "min^-1", "u/min", "r/min"),
    "1/Pa": ("pa-1", "pa^-1", "m^2/n"),
    "cm^2/dyn": ("cm^2/dyne",),
    "C": ("°c", "degc", "deg. c", "celsius"),
    "F": ("°f", "degf", "deg. f", "fahrenheit"),
    "K": ("kelvin",),
    "deg": ("°", "degree", "degrees"),
}
_SPELLINGS = {word: unit for unit, words in _OTHER_SPELLINGS.items() for word in words}

_EXAMPLES = {
    "length": "100 mm",
    "pressure": "3 bar",
    "modulus": "5 MPa",
    "frequency": "10 Hz",
    "angle": "45 deg",
    "speed": "0.3 m/s",
    "time": "0.1 s",
    "temperature": "20 C",
    "temperature difference": "100 K",
    "strain": "2 %",
    "conductivity": "0.25 W/(m K)",
    "density": "1150 kg/m^3",
    "specific heat": "1500 J/(kg K)",
    "molar energy": "80 kJ/mol",
    "bond energy": "0.9 eV",
}
_QUANTITY = re.compile(
    r"\s*+([-+]?(?:\d++(?:\.\d*+)?|\.\d++)(?:[eE][-+]?\d++)?|[-+]?inf|nan)"
    r"\s*+(\S*+(?: [^\s\d]\S*+)*+)\s*+",
    re.ASCII,
)


def spelled(unit: object, kind: str) -> str | None:
    """Return the usual spelling of a unit of `kind` ("length", ...), or None if it is not one."""
    if not isinstance(unit, str):
        return None
    word = unit.strip()
    if not (word.isascii() or word in _SPELLINGS):  # ㎜, ㎫ and ℃ are one letter, as is a raised 2
        word = unicodedata.normalize("NFKC", word).replace("\u2212", "-")
    word = re.sub(r"(?<=m)(?=[23]($|/))", "^", word)
    word = _SPELLINGS.get(word.lower(), _SPELLINGS.get(word.lower().replace(" ", ""), word))
    word = re.sub("^μ", "u", word)  # to which the micro sign, which looks alike, is normalised
    if word.isupper() and kind in ("modulus", "frequency"):  # not MHZ, which may be mHz
        capitals = [unit for unit in UNITS[kind] if unit.upper() == word]
        word = capitals[0] if len(capitals) == 1 else word
    return word if word in UNITS[kind] else None


def si_unit(unit: str, size: float) -> str:
    """Return the SI unit of numbers that are shown in a `unit` of this `size`."""
    for kind, units in UNITS.items():
        spelling = spelled(unit, kind)
        if spelling is not None and math.isclose(units[spelling], size):
            return next(iter(units))
    is_formula = not unit.isascii() or " " in unit  # such as 2πA/λ, of a number without a unit
    return unit if size == 1.0 and unit and not is_formula else "1"


def size_of_count(unit: object, kind: str) -> float | None:
    """Return the size of a unit of counts, such as "0.5 um", in the SI unit; None of any other."""
    match = _QUANTITY.fullmatch(unit) if isinstance(unit, str) and kind == "length" else None
    spelling = None if match is None else spelled(match[2], kind)
    size = float(match[1]) * UNITS[kind][spelling] if match and spelling else 0.0
    return size if 0.0 < size <= MOST else None


def quantity_in_si(value: Value, unit: str, kind: str, name: str = "unit") -> Value:
    """Return a number or array given in a `unit` of `kind`, or in counts, in the SI unit."""
    spelling, size = spelled(unit, kind), size_of_count(unit, kind)
    if size is not None:
        return value * size
    if spelling is None:
        raise InputError(f"{name} must be one of {listed(kind)}; got {short_repr(unit)}")
    zero = _ZERO.get(spelling, 0.0) if kind == "temperature" else 0.0
    return value * UNITS[kind][spelling] + zero


def in_mm(length: float, digits: int = 6) -> str:
    """Return a length [m] as text in mm."""
    return f"{plain(1e3 * length, digits)} mm"


def plain(value: float, digits: int) -> str:
    """Return a number with so many significant digits, without an exponent up to a million."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < 1e6 else text


def listed(kind: str) -> str:
    """Return the units of `kind`, separated by commas."""
    return ", ".join(UNITS[kind])


def parse_quantity(value: Any, kind: str) -> float:
    """Return `value`, such as "3 bar" or a plain number in the SI unit, in the SI unit of `kind`.

    Temperatures must have their unit. Raises `ValueError` with what was expected; the caller adds
    where it was found.
    """
    if isinstance(value, int | float) and not isinstance(value, bool):
        if kind in _UNIT_NEEDED:
            raise ValueError(f"the unit is missing; expected a {kind} {such_as(kind)}")
        return _finite(value, kind)
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    if match is None:
        raise ValueError(f"expected a {kind} {such_as(kind)}")
    number, unit = match.groups()
    if unit == "":
        raise ValueError(f"the unit is missing; expected one of {listed(kind)}")
    if spelled(unit, kind) is None:
        raise ValueError(f"unknown unit {short_repr(unit)}; expected one of {listed(kind)}")
    return _finite(quantity_in_si(float(number), unit, kind), kind)


# Kind of quantity by its SI unit: of pressure and modulus the former, whose units are more.
_KINDS = {next(iter(sizes)): kind for kind, sizes in reversed(UNITS.items())} | {
    "rad/s": "frequency"
}


def si_value(name: str, value: Any, unit: str, kind: str = "", *, strict: bool = True) -> Any:
    """Return `value` in the SI `unit` if it is a text such as "3 bar", or a list with such texts.

    `kind` is the kind of quantity where the unit does not say it. Raises `InputError` for a number
    with another unit or none, and where it is `strict` for other texts; any other value is returned
    as it is.
    """
    kind = kind or _KINDS.get(unit, "")
    if isinstance(value, list | tuple) and any(isinstance(item, str) for item in value):
        return [si_value(f"each of {name}", item, unit, kind, strict=strict) for item in value]
    if not kind or not isinstance(value, str):
        return value
    if not strict and kind not in _UNIT_NEEDED and not _QUANTITY.fullmatch(value):
        return value
    try:
        return parse_quantity(value, kind) / UNITS[kind].get(unit, 1.0)
    except ValueError as error:
        raise InputError(f"{name} = {short_repr(value)}: {error}") from error


# SI units with prefixes in steps of a thousand.
_READABLE = ("m", "mm", "um", "nm", "GPa", "MPa", "kPa", "Pa", "s", "ms", "us", "MHz", "kHz", "Hz")


def readable(value: float, unit: str) -> str:
    """Return a value in the SI `unit` as text in the unit of its size, such as 0.1 mm."""
    sizes = UNITS[_KINDS[unit]] if unit in _READABLE else {}
    fits = [u for u in _READABLE if u in sizes and 0.9999 <= abs(value) / sizes[u] < 1e5]
    if fits:
        unit = max(fits, key=lambda u: sizes[u])
        value /= sizes[unit]
    return f"{plain(value, 4)} {unit}".removesuffix(" 1").rstrip()


def unit_of(value: object, kind: str) -> str:
    """Return the usual spelling of the unit of a quantity such as "3 bar"; empty without a unit."""
    match = _QUANTITY.fullmatch(value) if isinstance(value, str) else None
    return "" if match is None else spelled(match[2], kind) or ""


def _finite(value: float, kind: str) -> float:
    if not abs(value) <= MOST:
        raise ValueError(f"expected a finite {kind} {such_as(kind)}")
    return float(value)


def such_as(kind: str) -> str:
    """Return an example of a quantity of `kind`, to follow the name of the kind in a message."""
    if kind in _UNIT_NEEDED:
        return f'such as "{_EXAMPLES[kind]}"'
    unit = next(iter(UNITS[kind]))
    plain = "a plain number" if unit == "1" else f"a plain number in {unit}"
    return f'such as "{_EXAMPLES[kind]}", or {plain}'


def celsius(kelvin: float, form: str = "z.3g") -> str:
    """Return a temperature [K] in degrees Celsius, its number as the format `form`."""
    return f"{kelvin - ZERO_CELSIUS:{form}} °C"


DISPLAY_UNITS = "display_units"  # attribute of a result: the units its case states, by key, as JSON
GIVEN = "given_unit"  # attribute of a coordinate: the unit in which its values were stated, if any

# The unit of each kind of quantity stated without one.
USUAL = {"pressure": "MPa", "speed": "m/s", "length": "mm"}

# Keys of a case that are shown in their stated unit, with their table and kind of quantity.
KEYS = {
    "pressure": ("load", "pressure"),
    "speed": ("load", "speed"),
    "footprint": ("load", "length"),
    "thickness": ("rubber", "length"),
    "smallest_wavelength": ("surface", "length"),
    "cut_off": ("surface", "length"),
}


@dataclass(frozen=True)
class DisplayUnit:
    """The unit in which numbers in SI units are shown."""

    unit: str
    divisor: float = 1.0
    """Size of the unit in SI units."""
    zero: float = 0.0
    """Zero of the scale of the unit, in SI units."""

    def of(self, values: ArrayLike) -> NDArray[np.float64]:
        """Convert values in SI units to this unit."""
        return (np.asarray(values, dtype=float) - self.zero) / self.divisor

    def text(self, value: float, digits: int = 6) -> str:
        """Return a value in SI units as text in this unit."""
        return f"{plain(float(self.of(value)), digits)} {self.unit}"


def display_unit(name: str, units: Mapping[str, str] | None = None) -> DisplayUnit:
    """Return the unit in which one of `KEYS` is shown: of the stated `units`, or the usual one."""
    kind = KEYS[name][1]
    chosen = (units or {}).get(name) or USUAL[kind]
    return DisplayUnit(chosen, UNITS[kind][chosen])


def display_unit_of(attrs: Mapping[str, Any], name: str) -> DisplayUnit:
    """Return the unit in which one of `KEYS` is shown of a result with these attributes."""
    return display_unit(name, json.loads(attrs.get(DISPLAY_UNITS, "{}")))


def stated_units(tables: Mapping[str, Any]) -> dict[str, str]:
    """Return the unit of each of `KEYS` that has one in the tables of a case."""
    units = {}
    for name, (table, kind) in KEYS.items():
        keys = tables.get(table)
        unit = unit_of(keys.get(name), kind) if isinstance(keys, dict) else ""
        if unit:
            units[name] = unit
    return units
