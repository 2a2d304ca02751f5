"""The units in which results are shown: those the case gives its load and its lengths in.

Inside, and in result files, all is in SI units. A result carries the text of its case, and an axis
of a study the unit its values were given in (`GIVEN`); what was a plain number is shown in the
usual unit.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.units import UNITS, unit_of

GIVEN = "given_unit"
"""Attribute of a coordinate: the unit its values were given in, where they had one."""

USUAL = {"pressure": "MPa", "speed": "m/s", "length": "mm"}
"""The unit of each kind of quantity where none was given."""

KEYS = {
    "pressure": ("load", "pressure"),
    "speed": ("load", "speed"),
    "footprint": ("load", "length"),
    "smallest_wavelength": ("surface", "length"),
    "cut_off": ("surface", "length"),
}
"""Keys of a case that are shown as they are given, with their table and kind of quantity."""


@dataclass(frozen=True)
class Shown:
    """How numbers in SI units are shown."""

    unit: str
    divisor: float = 1.0
    """Size of the unit in SI units."""
    zero: float = 0.0
    """Where the unit begins to count, in SI units."""

    def of(self, values: ArrayLike) -> NDArray[np.float64]:
        """Return values in SI units as they are shown."""
        return (np.asarray(values, dtype=float) - self.zero) / self.divisor

    def text(self, value: float, digits: int = 6) -> str:
        """Return a value in SI units as it is shown, with its unit."""
        return f"{float(self.of(value)):.{digits}g} {self.unit}"


def shown(name: str, case: str = "", unit: str = "") -> Shown:
    """Return how one of `KEYS` is shown.

    Parameters
    ----------
    name
        The key.
    case
        Text of the case, whose unit is taken where `unit` is empty.
    unit
        The unit it was given in.
    """
    kind = KEYS[name][1]
    chosen = unit or given_units(case).get(name) or USUAL[kind]
    return Shown(chosen, UNITS[kind][chosen])


@lru_cache(maxsize=64)
def given_units(case: str) -> Mapping[str, str]:
    """Return the unit of each of `KEYS` that has one in the text of a case."""
    try:
        tables = tomllib.loads(case)
    except tomllib.TOMLDecodeError:
        return {}
    found = {}
    for name, (table, kind) in KEYS.items():
        keys = tables.get(table)
        unit = unit_of(keys.get(name), kind) if isinstance(keys, dict) else ""
        if unit:
            found[name] = unit
    return found
