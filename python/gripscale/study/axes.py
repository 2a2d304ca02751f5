"""What a study varies: axes with their values, from Python or from a text such as one of these.

- speed=0.003:30:log9: nine speeds [m/s], evenly spaced in their logarithm (lin9: evenly)
- pressure=1 bar,3 bar: a list, with units
- cut_off=0.5 mm,instrument,rms_slope 1.3: lengths and the other rules of a case file
- upper_share=0.3:1:lin8, pressure_classes=1,2,4,8: numbers and whole numbers
- factors=3.5/2.4,3/2.2,6/3: magnification factors of wavelength and amplitude
- temperature=0 C:60 C:lin7, 20 C,40 C: always with a unit; effects=all,no heat,none: what of the
  conditions of the model counts
- rubber=case,dma.txt: the case's own, a master curve, a rubber known by name
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.shown import KEYS
from gripscale.study.axis import COUNTS, NUMBERS, QUANTITIES, UNITS, Axis
from gripscale.study.axis_value import axis_label, axis_value, bare
from gripscale.surface.cut_off import RmsSlope
from gripscale.units import unit_of

MOST_VALUES = 1000
MOST_AXES = 2

_RANGE = re.compile(r"\s*([^:]+?)\s*:\s*([^:]+?)\s*:\s*(lin|log)(\d+)\s*")


def axes_of(vary: Mapping[str, Any]) -> tuple[Axis, ...]:
    """Return the axes of `vary`: values, or a text as on the command line, by name.

    Raises `InputError` if there are none or more than two, or a value cannot be used.
    """
    if not 1 <= len(vary) <= MOST_AXES:
        raise InputError(f"a study varies one or two of {', '.join(UNITS)}; got {len(vary)}")
    return tuple(_axis(name, values) for name, values in vary.items())


def parse_vary(text: str) -> tuple[str, str]:
    """Return name and values of `name=values`; raise `InputError` if it is not that."""
    name, separator, values = text.partition("=")
    if not separator or not values.strip():
        raise InputError(f'vary must be such as "speed=0.003:30:log9"; got {text!r}')
    return checks.one_of("vary", name.strip(), UNITS), values


def _axis(name: str, given: Any) -> Axis:
    checks.one_of("vary", name, UNITS)
    if name in ("rubber", "surface"):
        values, labels = _named(name, given)
    else:
        values = tuple(axis_value(name, entry) for entry in _entries(name, given))
        worded = any(isinstance(value, RmsSlope | str) for value in values)
        unit = f" {UNITS[name]}" if worded else ""
        labels = tuple(
            f"{axis_label(name, v)}{unit if isinstance(v, float) else ''}" for v in values
        )
    if not 1 <= len(values) <= MOST_VALUES:
        raise InputError(f"{name} must have 1 to {MOST_VALUES} values; got {len(values)}")
    twice = {label for label in labels if labels.count(label) > 1}
    if twice:
        raise InputError(f"{name} must have different values; got {min(twice)} more than once")
    return Axis(name, values, labels, _unit_given(name, given))


def _unit_given(name: str, given: Any) -> str:
    """Return the first unit among the values of an axis; empty where all are plain numbers."""
    if name not in KEYS:
        return ""
    texts = re.split("[,:]", given) if isinstance(given, str) else _entries(name, given)
    units = (unit_of(text, QUANTITIES[name]) for text in texts)
    return next(filter(None, units), "")


def _entries(name: str, given: Any) -> Iterable[Any]:
    """Return single values of a list, a text `a,b,c`, a text `a:b:log5`, or a single value."""
    if isinstance(given, str):
        found = _RANGE.fullmatch(given)
        if found is not None:
            return _spaced(name, *found.groups())
        if ":" in given:
            raise InputError(_no_range(name, given))
        return [part.strip() for part in given.split(",")]
    return given if isinstance(given, Iterable) else [given]


def _no_range(name: str, given: str) -> str:
    """Return a sentence on a text with colons that is no range: which of its parts is wrong."""
    example = {"speed": "0.01 m/s:10 m/s:log7", "pressure": "1 bar:5 bar:lin5"}
    example |= {"temperature": "0 C:60 C:lin7"}
    example |= dict.fromkeys(("smallest_wavelength", "cut_off"), "0.1 mm:1 mm:log4")
    parts = given.split(":")
    wrong = (
        "the third part is missing"
        if len(parts) == 2
        else f"{parts[2].strip()!r} is neither lin nor log with a number"
        if len(parts) == 3 and parts[0].strip() and parts[1].strip()
        else f"it has {len(parts)} parts, or an empty one"
    )
    return (
        f"{name} must be a range of first value, last value and spacing with the number of values, "
        f'such as "{example.get(name, "1:10:log5")}"; {wrong} in {given!r}'
    )


def _spaced(name: str, first: str, last: str, spacing: str, count: str) -> list[float]:
    """Return evenly spaced values between two ends in SI units, the ends exactly."""
    if name not in NUMBERS:
        raise InputError(f"{name} must be a list, not a range; got {first}:{last}")
    if bare(first) != bare(last):
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


def _named(name: str, given: Any) -> tuple[tuple[Any, ...], tuple[str, ...]]:
    """Return values and labels of rubbers or surfaces: a mapping, or texts and paths."""
    if isinstance(given, Mapping):
        return tuple(given.values()), tuple(str(label) for label in given)
    entries = given.split(",") if isinstance(given, str) else list(given)
    for entry in entries:
        if not isinstance(entry, str | Path):
            raise InputError(
                f"{name} must be names and files, or a mapping from names; got {entry!r:.60}"
            )
    texts = [str(entry).strip() for entry in entries]
    stems = tuple(Path(text).stem for text in texts)
    return tuple(texts), stems if len(set(stems)) == len(stems) else tuple(texts)
