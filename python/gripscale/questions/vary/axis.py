"""What a study can vary: the inputs with their units, and one of them with its values."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import InputError, checks
from gripscale.core.units import (
    GIVEN,
    KEYS,
    ZERO_CELSIUS,
    DisplayUnit,
    display_unit,
    parse_quantity,
    unit_of,
)
from gripscale.experiment.design import named_values
from gripscale.model import MOST_CLASSES
from gripscale.surface.cut_off import CutOffRule, RmsSlope, cut_off_rule
from gripscale.surface.sine_fit import MOST_SINE_WAVES

# Axes of numbers, with the kind of quantity.
_QUANTITIES = {
    "speed": "speed",
    "pressure": "pressure",
    "temperature": "temperature",
    "smallest_wavelength": "length",
    "cut_off": "length",
    "thickness": "length",
}

COLDEST = 100.0  # temperature [K] below which a number without a unit is taken for degrees
# Axes of whole numbers, with the largest.
COUNTS = {"waves": MOST_SINE_WAVES, "pressure_classes": MOST_CLASSES}
_NUMBERS = (*_QUANTITIES, *COUNTS, "top_height_fraction")  # axes whose values are numbers

# All axes.
LONG_NAMES = {
    "speed": "sliding speed",
    "pressure": "nominal pressure",
    "temperature": "temperature of the rubber before the contact",
    "smallest_wavelength": "smallest wavelength",
    "thickness": "thickness of the rubber",
    "cut_off": "shortest wavelength of the roughness",
    "top_height_fraction": "fraction of the heights, from the top, that counts",
    "waves": "number of waves",
    "pressure_classes": "number of pressure classes",
    "factors": "magnification factors of wavelength and amplitude",
    "effects": "effects of the conditions on the rubber",
    "rubber": "rubber",
    "surface": "surface",
}

_SI = {"speed": "m/s", "pressure": "Pa", "temperature": "K", "length": "m"}
# All axes, with the units of their values.
AXIS_UNITS = {name: _SI.get(_QUANTITIES.get(name, ""), "1") for name in LONG_NAMES}

# Numeric axes by name, and what they are called in tables and figures.
AXIS_LABELS = {name: LONG_NAMES[name] for name in _NUMBERS} | {
    "speed": "sliding speed $v$",
    "pressure": "nominal pressure $p$",
    "temperature": "temperature $T$",
}


@dataclass(frozen=True)
class Axis:
    """One varied input: its values as the study uses them, and what they are called."""

    name: str
    values: tuple[Any, ...]
    labels: tuple[str, ...]
    unit: str = ""  # the unit the values were given in; empty for plain numbers

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, in the unit of `AXIS_UNITS`."""
        return self.name in _NUMBERS and not any(
            isinstance(value, str | RmsSlope) for value in self.values
        )

    @property
    def coordinate(self) -> list[Any]:
        """Values along the axis of a Dataset: numbers, or labels."""
        return list(self.values) if self.numeric else list(self.labels)

    def display_unit(self, units: Mapping[str, str]) -> DisplayUnit | None:
        """Return how its values are shown in a study of a case that states `units`.

        None of what is no pressure, speed or length.
        """
        if not self.numeric or self.name not in KEYS:
            return None
        return display_unit(self.name, {self.name: self.unit} if self.unit else units)

    def called(self, i: int, units: Mapping[str, str]) -> str:
        """Return what value `i` is called in a study of a case that states `units`."""
        unit = self.display_unit(units)
        return self.labels[i] if unit is None else unit.text(self.values[i])


def axis_value(name: str, value: Any) -> Any:
    """Return a value of an input, other than rubber and surface, in SI units.

    Raises `InputError` if it cannot be used.
    """
    if name in _QUANTITIES:
        return _cut_off(name, value) if name == "cut_off" else _quantity(name, value)
    if name in COUNTS:
        return checks.whole(name, plain_number(value), least=1, most=COUNTS[name])
    if name == "factors":
        parts = value.split("/") if isinstance(value, str) else value
        try:
            first, second = (float(part) for part in parts)
        except (TypeError, ValueError) as error:
            raise InputError(f'factors must be pairs such as "3.5/2.4"; got {value!r}') from error
        for part in (first, second):
            if checks.number(name, part) <= 1.0:
                raise InputError(f"factors must be greater than 1; got {part:g}")
        return (first, second)
    if name == "effects":
        # which of them there are, only the conditions of a model tell
        return checks.instance(name, value, str).replace("_", " ")
    share = checks.positive(name, plain_number(value))
    if share > 1.0:
        raise InputError(f"{name} must be at most 1; got {share:g}")
    return share


def plain_number(value: Any) -> Any:
    """Return the number that a text without a unit spells, or `value` as it is."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def _quantity(name: str, value: Any) -> float:
    number = plain_number(value)
    if isinstance(number, str):
        try:
            number = parse_quantity(number, _QUANTITIES[name])
        except ValueError as error:
            raise InputError(f"{name} = {value!r}: {error}") from error
    elif isinstance(value, str) and name == "temperature":
        raise InputError(f'temperature must have a unit, such as "20 C"; got {value!r}')
    check = checks.not_negative if name == "speed" else checks.positive
    si = check(name, number, unit=AXIS_UNITS[name])
    if name == "temperature" and si < COLDEST:
        raise InputError(
            f'temperature must be in kelvin or have a unit, such as "20 C"; got {si:g} K'
        )
    return si


def _cut_off(name: str, value: Any) -> CutOffRule:
    if not isinstance(plain_number(value), str | dict | RmsSlope):
        return _quantity(name, value)
    try:
        return cut_off_rule(value)
    except ValueError as error:
        raise InputError(f"{name} = {value!r}: {error}") from error


# Numeric axes that are shown in one way whatever was given, and their units in words.
FIXED = {
    "temperature": DisplayUnit("°C", zero=ZERO_CELSIUS),
    "top_height_fraction": DisplayUnit("of the heights"),
    "pressure_classes": DisplayUnit("pressure classes"),
    "waves": DisplayUnit("waves"),
}

# Axes that may have names for values.
WORDS = {
    "cut_off": "where the roughness ends",
    "effects": "effects",
    "factors": "magnification factors $s_\\lambda/s_A$",
    "rubber": "rubber",
    "surface": "surface",
}

MODELS = {"chain": "chain", "direct": "direct contact"}  # what models that know effects are called
# What selections of effects are called where nothing else says what they are of.
EFFECTS = {"all": "all effects", "none": "no effects"}


def axis_shown(result: xr.Dataset | xr.DataArray, axis: str) -> DisplayUnit:
    """Return how the values of a numeric axis are shown: in the unit they were given in."""
    if axis in FIXED:
        return FIXED[axis]
    unit = result[axis].attrs.get(GIVEN, "") if axis in result.coords else ""
    return display_unit(axis, {axis: str(unit)})


def axis_label(result: xr.Dataset, axis: str) -> str:
    """Return what a figure calls a numeric axis, with its unit."""
    unit = axis_shown(result, axis).unit if axis in (*KEYS, "temperature") else "-"
    return f"{AXIS_LABELS[axis]} [{unit}]"


def dimensions(result: xr.Dataset) -> list[str]:
    """Return the axes that were varied, in order."""
    return [str(name) for name in result.total_friction.dims]


def places(result: xr.Dataset) -> Iterator[dict[str, int]]:
    """Yield the place of every prediction on the axes."""
    names = dimensions(result)
    for index in np.ndindex(*(result.sizes[name] for name in names)):
        yield dict(zip(names, index, strict=True))


def points(result: xr.Dataset) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield what each place is called, such as "0.3 m/s", and what holds there."""
    for at in places(result):
        yield ", ".join(name_of(result, axis, i) for axis, i in at.items()), result.isel(at)


def numeric(result: xr.Dataset) -> list[str]:
    """Return the varied axes of numbers with at least two values, longest first."""
    axes = [n for n in dimensions(result) if result.sizes[n] > 1 and of_numbers(result, n)]
    return sorted(axes, key=lambda name: -result.sizes[name])


def of_numbers(result: xr.Dataset, axis: str) -> bool:
    """Return whether an axis has numbers for values; a cut-off may be a rule in words."""
    return axis in AXIS_LABELS and bool(np.issubdtype(result[axis].dtype, np.number))


def name_of(result: xr.Dataset, axis: str, i: int) -> str:
    """Return what value `i` of an axis is called, with its unit."""
    value = result[axis].values[i]
    if axis == "effects":
        return EFFECTS.get(str(value), str(value))
    if not of_numbers(result, axis):
        return str(value).replace("_", " ")
    return axis_shown(result, axis).text(value, digits=3)


# Axes with their values, from Python or from a text such as one of these.
#
# - speed=0.003:30:log9: nine speeds [m/s], evenly spaced in their logarithm (lin9: evenly)
# - pressure=1 bar,3 bar: a list, with units
# - cut_off=0.5 mm,instrument,rms_slope 1.3: lengths and the other rules of a case file
# - top_height_fraction=0.3:1:lin8, pressure_classes=1,2,4,8: numbers and whole numbers
# - factors=3.5/2.4,3/2.2,6/3: magnification factors of wavelength and amplitude
# - temperature=0 C:60 C:lin7, 20 C,40 C: always with a unit; effects=all,no heat,none: what of the
#   conditions of the model counts
# - rubber=case,dma.txt: the case's own, a master curve, a rubber known by name

MOST_VALUES = 1000
MOST_AXES = 2

# Ranges of the quantities.
_EXAMPLES = {
    "speed": "0.01 m/s:10 m/s:log7",
    "pressure": "1 bar:5 bar:lin5",
    "temperature": "0 C:60 C:lin7",
    "smallest_wavelength": "0.1 mm:1 mm:log4",
    "cut_off": "0.1 mm:1 mm:log4",
    "thickness": "1 mm:8 mm:log4",
}

_RANGE = re.compile(r"\s*([^:]+?)\s*:\s*([^:]+?)\s*:\s*(lin|log)(\d+)\s*")


def axes_of(vary: Mapping[str, Any]) -> tuple[Axis, ...]:
    """Return the axes of `vary`: values, or a text as on the command line, by name.

    Raises `InputError` if there are none or more than two, or a value cannot be used.
    """
    if not 1 <= len(vary) <= MOST_AXES:
        raise InputError(f"a study varies one or two of {', '.join(AXIS_UNITS)}; got {len(vary)}")
    return tuple(_axis(name, values) for name, values in vary.items())


def parse_vary(text: str, names: Iterable[str] = AXIS_UNITS) -> tuple[str, str]:
    """Return name and values of `name=values`, with one of `names`.

    Raises `InputError` if it is not that.
    """
    name, separator, values = text.partition("=")
    if not separator or not values.strip():
        raise InputError(f'vary must be such as "speed=0.003:30:log9"; got {text!r}')
    return checks.one_of("vary", name.strip(), [*names]), values


def parse_axes(texts: Sequence[str], names: Iterable[str] = AXIS_UNITS) -> dict[str, Any]:
    """Return the values of inputs by name from texts such as `speed=0.1,1`.

    Raises `InputError` if two texts name one input, or one is no such text.
    """
    pairs = [parse_vary(text, names) for text in texts]
    if len(dict(pairs)) < len(pairs):
        raise InputError(f"vary must name different inputs; got {', '.join(n for n, _ in pairs)}")
    return dict(pairs)


def _axis(name: str, value: Any) -> Axis:
    checks.one_of("vary", name, AXIS_UNITS)
    if name in ("rubber", "surface"):
        values, labels = named_values(name, value)
    else:
        values = tuple(axis_value(name, entry) for entry in _entries(name, value))
        worded = any(isinstance(value, RmsSlope | str) for value in values)
        unit = f" {AXIS_UNITS[name]}" if worded else ""
        labels = tuple(_label(name, value, unit) for value in values)
    if not 1 <= len(values) <= MOST_VALUES:
        raise InputError(f"{name} must have 1 to {MOST_VALUES} values; got {len(values)}")
    twice = {label for label in labels if labels.count(label) > 1}
    if twice:
        raise InputError(f"{name} must have different values; got {min(twice)} more than once")
    units: Iterable[str | None] = ()
    if name in KEYS:
        texts = re.split("[,:]", value) if isinstance(value, str) else _entries(name, value)
        units = (unit_of(text, _QUANTITIES[name]) for text in texts)
    return Axis(name, values, labels, next(filter(None, units), ""))


def _label(name: str, value: Any, unit: str) -> str:
    """Return what a value is called: a temperature in degrees C, other numbers with a `unit`."""
    if isinstance(value, tuple):
        return "/".join(f"{part:g}" for part in value)
    if isinstance(value, str | RmsSlope):
        return str(value)
    text = f"{value - ZERO_CELSIUS:.6g} C" if name == "temperature" else f"{value:.6g}"
    return f"{text}{unit if isinstance(value, float) else ''}"


def _entries(name: str, value: Any) -> Iterable[Any]:
    """Return single values of a list, a text `a,b,c`, a text `a:b:log5`, or a single value."""
    if not isinstance(value, str):
        return value if isinstance(value, Iterable) else [value]
    match = _RANGE.fullmatch(value)
    if match is not None:
        return _spaced(name, *match.groups())
    if ":" not in value:
        return [part.strip() for part in value.split(",")]
    parts = value.split(":")
    if len(parts) == 2:
        wrong = "the third part is missing"
    elif len(parts) == 3 and parts[0].strip() and parts[1].strip():
        wrong = f"{parts[2].strip()!r} is neither lin nor log with a number"
    else:
        wrong = f"it has {len(parts)} parts, or an empty one"
    raise InputError(
        f"{name} must be a range of first value, last value and spacing with the number of values, "
        f'such as "{_EXAMPLES.get(name, "1:10:log5")}"; {wrong} in {value!r}'
    )


def _spaced(name: str, first: str, last: str, spacing: str, count: str) -> list[float]:
    """Return evenly spaced values between two ends in SI units, the ends exactly."""
    if name not in _NUMBERS:
        raise InputError(f"{name} must be a list, not a range; got {first}:{last}")
    if isinstance(plain_number(first), str) != isinstance(plain_number(last), str):
        raise InputError(f"{name} must have a unit at both ends or none; got {first}:{last}")
    number = checks.whole(f"{name}: number of values", int(count), least=2, most=MOST_VALUES)
    low, high = axis_value(name, first), axis_value(name, last)
    if low >= high:
        raise InputError(f"{name} must go from low to high; got {first}:{last}")
    if spacing == "lin":
        values = np.linspace(low, high, number)
    else:
        checks.positive(f"{name} of a log range", low)
        values = np.geomspace(low, high, number)
    if name in COUNTS:
        return [float(value) for value in np.unique(np.rint(values))]
    return [low, *(float(f"{value:.12g}") for value in values[1:-1]), high]
