"""One value of a varied input, from Python or from a text, and what it is called."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from gripscale import checks
from gripscale.errors import InputError
from gripscale.study.axis import COUNTS, QUANTITIES, UNITS
from gripscale.study.conditioned import SELECTIONS
from gripscale.surface.cut_off import CutOffRule, RmsSlope, cut_off_rule
from gripscale.units import ZERO_CELSIUS, parse_quantity


def axis_value(name: str, given: Any) -> Any:
    """Return a value of an input, other than rubber and surface, in SI units.

    Raises `InputError` if it cannot be used.
    """
    return _READERS[name](name, given)


def axis_label(name: str, value: Any) -> str:
    """Return what a value is called: a temperature in degrees C, other numbers without unit."""
    if isinstance(value, str | RmsSlope):
        return str(value)
    if isinstance(value, tuple):
        return "/".join(f"{part:g}" for part in value)
    return f"{value - ZERO_CELSIUS:.6g} C" if name == "temperature" else f"{value:.6g}"


def bare(text: str) -> bool:
    """Return whether `text` is a number without a unit."""
    try:
        float(text)
    except ValueError:
        return False
    return True


def _quantity(name: str, value: Any) -> float:
    """Read a number in SI units or a text with a unit."""
    if isinstance(value, str) and not bare(value):
        try:
            value = parse_quantity(value, QUANTITIES[name])
        except ValueError as error:
            raise InputError(f"{name} = {value!r}: {error}") from error
    if isinstance(value, str) and name == "temperature":
        raise InputError(f'temperature must have a unit, such as "20 C"; got {value!r}')
    check = checks.not_negative if name == "speed" else checks.positive
    return check(name, float(value) if isinstance(value, str) else value, unit=UNITS[name])


def _cut_off(name: str, value: Any) -> CutOffRule:
    """Read a length, or one of the other rules."""
    if not isinstance(value, str | dict | RmsSlope) or (isinstance(value, str) and bare(value)):
        return _quantity(name, value)
    try:
        return cut_off_rule(value)
    except ValueError as error:
        raise InputError(f"{name} = {value!r}: {error}") from error


def _count(name: str, value: Any) -> int:
    if isinstance(value, str) and bare(value):
        value = float(value)
    return checks.whole(name, value, least=1, most=COUNTS[name])


def _share(name: str, value: Any) -> float:
    share = checks.positive(name, float(value) if isinstance(value, str) and bare(value) else value)
    if share > 1.0:
        raise InputError(f"{name} must be at most 1; got {share:g}")
    return share


def _pair(name: str, value: Any) -> tuple[float, float]:
    """Read `3.5/2.4`, or a pair of numbers."""
    parts = value.split("/") if isinstance(value, str) else value
    try:
        first, second = (float(part) for part in parts)
    except (TypeError, ValueError) as error:
        raise InputError(f'factors must be pairs such as "3.5/2.4"; got {value!r}') from error
    for part in (first, second):
        if checks.number(name, part) <= 1.0:
            raise InputError(f"factors must be greater than 1; got {part:g}")
    return first, second


def _selection(name: str, value: Any) -> str:
    text = value.replace("_", " ") if isinstance(value, str) else value
    return checks.one_of(name, text, SELECTIONS)


_READERS: dict[str, Callable[[str, Any], Any]] = {
    **dict.fromkeys(QUANTITIES, _quantity),
    **dict.fromkeys(COUNTS, _count),
    "upper_share": _share,
    "factors": _pair,
    "cut_off": _cut_off,
    "effects": _selection,
}
