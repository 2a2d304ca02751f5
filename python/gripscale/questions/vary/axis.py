"""What a study can vary: inputs with their units, one with its values, and the table of points."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from gripscale.core import InputError, checks
from gripscale.core.units import (
    UNITS,
    USUAL,
    ZERO_CELSIUS,
    DisplayUnit,
    parse_quantity,
    unit_of,
)
from gripscale.experiment.design import named_values
from gripscale.model import Model
from gripscale.questions.vary.inputs import Setting, at_temperature, with_effects
from gripscale.surface.cut_off import RmsSlope, cut_off_rule


class VariedInput(NamedTuple):
    """One input that a study can vary."""

    long_name: str
    # The setting of a point with a value; None: the study chooses a rubber or a surface.
    change: Callable[[Setting, Any], Setting] | None = None
    quantity: str = ""  # kind of quantity; empty for names
    example: str = "1:10:log5"  # of a range
    symbol: str = ""

    @property
    def unit(self) -> str:
        """SI unit of its values."""
        return next(iter(UNITS[self.quantity])) if self.quantity else "1"


def _of_load(name: str) -> Callable[[Setting, Any], Setting]:
    return lambda setting, value: setting.with_load(**{name: value})


def _of_waves(name: str) -> Callable[[Setting, Any], Setting]:
    return lambda setting, value: setting.with_waves(**{name: value})


def _of_model(change: Callable[[Model, Any], Model]) -> Callable[[Setting, Any], Setting]:
    return lambda setting, value: replace(setting, model=change(setting.model, value))


# In the order in which they change a setting: effects that are left out may be a temperature.
VARIED_INPUTS = {
    "speed": VariedInput("sliding speed", _of_load("speed"), "speed", "0.01 m/s:10 m/s:log7", "v"),
    "pressure": VariedInput(
        "nominal pressure", _of_load("pressure"), "pressure", "1 bar:5 bar:lin5", "p"
    ),
    "temperature": VariedInput(
        "temperature before the contact",
        _of_model(at_temperature),
        "temperature",
        "0 C:60 C:lin7",
        "T",
    ),
    "smallest_wavelength": VariedInput(
        "smallest wavelength", _of_waves("smallest_wavelength"), "length", "0.1 mm:1 mm:log4"
    ),
    "thickness": VariedInput(
        "thickness of the rubber", _of_load("thickness"), "length", "1 mm:8 mm:log4"
    ),
    "cut_off": VariedInput(
        "shortest wavelength of the roughness", _of_waves("cut_off"), "length", "0.1 mm:1 mm:log4"
    ),
    "effects": VariedInput("effects of the conditions on the rubber", _of_model(with_effects)),
    "rubber": VariedInput("rubber"),
    "surface": VariedInput("surface"),
}

COLDEST = 100.0  # temperature [K] below which a number without a unit is taken for degrees
MOST_VALUES = 1000

_RANGE = re.compile(r"\s*([^:]+?)\s*:\s*([^:]+?)\s*:\s*(lin|log)(\d+)\s*")


@dataclass(frozen=True)
class Axis:
    """One varied input: its values as the study uses them, and what they are called."""

    name: str
    values: tuple[Any, ...]
    labels: tuple[str, ...]
    unit: str = ""  # the unit the values were given in; empty for plain numbers

    @classmethod
    def of(cls, name: str, value: Any) -> Axis:
        """Return the axis of an input from its values, or a text as on the command line.

        Raises `InputError` if a value cannot be used, or two are equal.
        """
        checks.one_of("vary", name, VARIED_INPUTS)
        if name in ("rubber", "surface"):
            values, labels = named_values(name, value)
        else:
            values = tuple(axis_value(name, entry) for entry in _entries(name, value))
            worded = any(isinstance(value, RmsSlope | str) for value in values)
            unit = f" {VARIED_INPUTS[name].unit}" if worded else ""
            labels = tuple(_label(name, value, unit) for value in values)
        if not 1 <= len(values) <= MOST_VALUES:
            raise InputError(f"{name} must have 1 to {MOST_VALUES} values; got {len(values)}")
        twice = {label for label in labels if labels.count(label) > 1}
        if twice:
            raise InputError(f"{name} must have different values; got {min(twice)} more than once")
        texts = re.split("[,:]", value) if isinstance(value, str) else _entries(name, value)
        kind = VARIED_INPUTS[name].quantity
        units = (unit_of(text, kind) for text in texts if kind in USUAL)
        return cls(name, values, labels, next(filter(None, units), ""))

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, in SI units; a cut-off may be a rule in words."""
        return bool(VARIED_INPUTS[self.name].quantity) and not any(
            isinstance(value, str | RmsSlope) for value in self.values
        )

    def display_unit(self, units: Mapping[str, str]) -> DisplayUnit | None:
        """Return the unit of its values beside the `units` of a case; None for other quantities."""
        kind = VARIED_INPUTS[self.name].quantity
        if not self.numeric or kind not in USUAL:
            return None
        unit = self.unit or units.get(self.name) or USUAL[kind]
        return DisplayUnit(unit, UNITS[kind][unit])

    def called(self, i: int, units: Mapping[str, str]) -> str:
        """Return what value `i` is called in a study of a case that states `units`."""
        unit = self.display_unit(units)
        return self.labels[i] if unit is None else unit.text(self.values[i])


def axis_value(name: str, value: Any) -> Any:
    """Return a value of an input, other than rubber and surface, in SI units.

    Raises `InputError` if it cannot be used.
    """
    number, kind = plain_number(value), VARIED_INPUTS[name]
    if not kind.quantity:  # which effects there are, only the conditions of a model tell
        return checks.instance(name, value, str).replace("_", " ")
    if name == "temperature" and isinstance(value, str) and not isinstance(number, str):
        raise InputError(f'temperature must have a unit, such as "20 C"; got {value!r}')
    try:
        if name == "cut_off" and isinstance(number, str | dict | RmsSlope):
            return cut_off_rule(value)
        if isinstance(number, str):
            number = parse_quantity(number, kind.quantity)
    except ValueError as error:
        raise InputError(f"{name} = {value!r}: {error}") from error
    check = checks.not_negative if name == "speed" else checks.positive
    si = check(name, number, unit=kind.unit)
    if name == "temperature" and si < COLDEST:
        raise InputError(
            f'temperature must be in kelvin or have a unit, such as "20 C"; got {si:g} K'
        )
    return si


def plain_number(value: Any) -> Any:
    """Return the number that a text without a unit spells, or `value` as it is."""
    try:
        return float(value) if isinstance(value, str) else value
    except ValueError:
        return value


def axes_of(vary: Mapping[str, Any]) -> tuple[Axis, ...]:
    """Return the axes of `vary`: values, or a text as on the command line, by name.

    Raises `InputError` if there are none or more than two, or a value cannot be used.
    """
    if len(vary) not in (1, 2):
        inputs = ", ".join(VARIED_INPUTS)
        raise InputError(f"a study varies one or two of {inputs}; got {len(vary)}")
    return tuple(Axis.of(name, values) for name, values in vary.items())


def values_by_name(texts: Iterable[str], option: str, example: str) -> dict[str, str]:
    """Return the values of texts `name=values` by name.

    Raises `InputError` that calls them `option` if one is no such text, or two have one name.
    """
    values: dict[str, str] = {}
    for text in texts:
        name, separator, value = (part.strip() for part in text.partition("="))
        if not separator or not value:
            raise InputError(f'{option} must be such as "{example}"; got {text!r}')
        if name in values:
            raise InputError(f"{option} must name different inputs; got {name} twice")
        values[name] = value
    return values


def parse_axes(texts: Sequence[str], names: Collection[str] = VARIED_INPUTS) -> dict[str, str]:
    """Return the values of inputs, each one of `names`, from texts such as `speed=0.1,1`.

    Raises `InputError` if two texts name one input, or one is no such text.
    """
    values = values_by_name(texts, "vary", "speed=0.003:30:log9")
    return {checks.one_of("vary", name, names): value for name, value in values.items()}


def _label(name: str, value: Any, unit: str) -> str:
    if isinstance(value, str | RmsSlope):
        return str(value)
    return f"{value - ZERO_CELSIUS:.6g} C" if name == "temperature" else f"{value:.6g}{unit}"


def _entries(name: str, value: Any) -> Iterable[Any]:
    """Return single values of a list, a text `a,b,c`, a text `a:b:log5`, or a single value."""
    if not isinstance(value, str):
        return value if isinstance(value, Iterable) else [value]
    if ":" not in value:
        return [part.strip() for part in value.split(",")]
    match = _RANGE.fullmatch(value)
    if match is None:
        raise InputError(
            f"{name} must be a range of first value, last value and spacing (lin or log) with the "
            f'number of values, such as "{VARIED_INPUTS[name].example}"; got {value!r}'
        )
    first, last, spacing, count = match.groups()
    if not VARIED_INPUTS[name].quantity:
        raise InputError(f"{name} must be a list, not a range; got {first}:{last}")
    if isinstance(plain_number(first), str) != isinstance(plain_number(last), str):
        raise InputError(f"{name} must have a unit at both ends or none; got {first}:{last}")
    number = checks.whole(f"{name}: number of values", int(count), least=2, most=MOST_VALUES)
    low, high = axis_value(name, first), axis_value(name, last)
    if low >= high:
        raise InputError(f"{name} must go from low to high; got {first}:{last}")
    if spacing == "log":
        checks.positive(f"{name} of a log range", low)
    spaced = np.geomspace(low, high, number) if spacing == "log" else np.linspace(low, high, number)
    return [low, *(float(f"{value:.12g}") for value in spaced[1:-1]), high]
