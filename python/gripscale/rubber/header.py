"""What the header of a master curve file says: which column is what, in which unit."""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from dataclasses import dataclass

FREQUENCY_UNITS = {
    "Hz": 1.0,
    "kHz": 1e3,
    "MHz": 1e6,
    "GHz": 1e9,
    "rad/s": 0.5 / math.pi,
}
"""Accepted units of frequency, each with its size in Hz."""

MODULUS_UNITS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "N/mm²": 1e6}
"""Accepted units of modulus, each with its size in Pa."""

_KNOWN_UNITS = {**FREQUENCY_UNITS, **MODULUS_UNITS}
_NAME_AND_UNIT = re.compile(r"^(?P<name>.*?)\s*[(\[]\s*(?P<unit>[^()\[\]]+?)\s*[)\]]\s*$")
_NAME_SLASH_UNIT = re.compile(r"^(?P<name>.*\S)\s+/\s*(?P<unit>\S+)\s*$")
_CELLS_WITH_UNITS = re.compile(r"([^()\[\]]+[(\[][^()\[\]]+[)\]])")


@dataclass(frozen=True)
class Column:
    """One column as its header names it."""

    name: str
    unit: str | None


def read_header(
    lines: list[str], count: int, expected: Collection[str] = ()
) -> list[Column] | None:
    """Return the columns named by the header `lines` of a table of `count` columns, or None.

    A line is one of names if a quantity, a unit or one of the `expected` names is among them.
    Accepts `name (unit)`, `name [unit]` and `name / unit`, or a line of names and one of units.
    """
    names: list[Column] | None = None
    units: list[str] | None = None
    for line in lines:
        cells = _split(line, count)
        if cells is None:
            continue
        bare = [cell.strip("()[] ") for cell in cells]
        if any(cell in _KNOWN_UNITS for cell in bare):
            units = bare
        elif any(_names(column, expected) for column in map(_column, cells)):
            names = [_column(cell) for cell in cells]
    if names is not None and units is not None:
        return [Column(c.name, c.unit or u) for c, u in zip(names, units, strict=True)]
    return names


def quantity(name: str) -> str | None:
    """Return `frequency`, `storage` or `loss` if the column `name` clearly says so, else None."""
    text = _plain(name)
    low = text.lower()
    if "factor" in low or "tan" in low or "log" in low:
        return None
    if "freq" in low or low in {"f", "omega", "ω"}:
        return "frequency"
    if "loss" in low or re.match(r"^[eg]''", low):
        return "loss"
    if "stor" in low or re.match(r"^[eg]'", low):
        return "storage"
    return None


def modulus_kind(name: str) -> str | None:
    """Return `E` or `G` if the column `name` says which modulus it is, else None."""
    text = _plain(name)
    found = set()
    if re.search(r"(?<![A-Za-z])E(?![A-Za-z])", text.replace("_", " ")):
        found.add("E")
    if re.search(r"(?<![A-Za-z])G(?![A-Za-z])", text.replace("_", " ")):
        found.add("G")
    if re.search(r"young|tensile", text, re.IGNORECASE):
        found.add("E")
    if re.search(r"shear", text, re.IGNORECASE):
        found.add("G")
    return found.pop() if len(found) == 1 else None


def _split(line: str, count: int) -> list[str] | None:
    """Return the line cut into `count` cells by the first separator that fits, or None."""
    for separator in (r"\t", r";", r",", r"\s{2,}", r"\s+"):
        cells = [cell.strip().strip('"').strip() for cell in re.split(separator, line.strip())]
        if len(cells) == count:
            return cells
    cells = [cell.strip(" ,;\t") for cell in _CELLS_WITH_UNITS.findall(line)]
    return cells if len(cells) == count else None


def _names(column: Column, expected: Collection[str]) -> bool:
    known_unit = column.unit is not None and column.unit in _KNOWN_UNITS
    return known_unit or quantity(column.name) is not None or column.name in expected


def _column(cell: str) -> Column:
    match = _NAME_AND_UNIT.match(cell) or _NAME_SLASH_UNIT.match(cell)
    return Column(match["name"], match["unit"]) if match else Column(cell, None)


def _plain(name: str) -> str:
    """Return the name with one kind of prime, so that E'' can be told from E'."""
    text = name.strip()
    for prime in ("’", "′", "`", "´"):
        text = text.replace(prime, "'")
    return text.replace("″", "''").replace('"', "''")
