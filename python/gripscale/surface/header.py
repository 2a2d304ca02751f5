"""What the lines above heights state: the distance of their points, and units.

    # Spacing: 0.1 mm            Schrittweite [mm]; 0,1
    # Height unit: um            Einheit der Höhe: µm
    # Units: mm                  dx = 10 um, dy = 20 um

Names are read in English and German, values with their unit, in brackets behind the name or behind
the number. A spacing without one has the unit of distances.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from gripscale.core.units import quantity_in_si, spelled
from gripscale.io.cells import Line

_PAIR = re.compile(
    r"[\s#%!/*\"]*(?P<name>[^:=;\t\[(]+?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*[:=;\t]\s*"
    r"(?P<value>[^;\t]*?)\s*(?P<behind>[;\t]\s*[^\s\d;]+)?[\s;\"]*"
)
_VALUE = re.compile(r"(\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)\s*(\S*)")
_STEP = (
    r"(?:(?:point|sample|sampling|pixel)[ -]?)?(?:spacing|step(?: size)?|increment)"
    r"|(?:point|sampling) (?:distance|interval)|pixel ?size|schrittweite|(?:mess|abtast)schritt"
    r"|(?:punkt|messpunkt|abtast)abstand|abtastintervall|pixelgr(?:ö|oe)(?:ß|ss)e|raster(?:weite|maß)"
)
_ALONG, _ACROSS = (
    re.compile(rf"d{axis}|delta ?{axis}|{axis}[ -]?(?:{_STEP})|(?:{_STEP})(?: (?:in )?{axis})")
    for axis in "xy"
)
_BOTH = re.compile(_STEP)
_UNIT = r"units?|einheit(?:en)?"
_OF_ALL = re.compile(rf"(?:length )?(?:{_UNIT})")
_OF_HEIGHTS = re.compile(
    rf"(?:height|z|value)[ -_]?(?:{_UNIT})|(?:{_UNIT}) (?:z|(?:of |der )?(?:heights?|höhen?|z))"
    r"|(?:höhen|z)-?einheit"
)
_OF_DISTANCES = re.compile(
    rf"(?:distance|lateral|xy?)[ -_]?(?:{_UNIT})|(?:{_UNIT}) (?:xy?|(?:of |der )?(?:distances?|x))"
    r"|(?:weg|längen|x)-?einheit"
)
_MOST_LINES = 100
"""Lines of a header."""


@dataclass(frozen=True)
class Header:
    """The distance of points [m] and the units that a header states, each None if it does not."""

    x_unit: str | None = None
    z_unit: str | None = None
    step: tuple[float, float] | None = None
    """Along x and along y, the same if one is stated."""


def read_header(lines: Sequence[Line]) -> Header:
    """Return what the first lines of a file state."""
    units: dict[str, str] = {}
    steps: dict[str, tuple[float, str | None]] = {}
    for _, line in lines[:_MOST_LINES]:
        pair = _PAIR.fullmatch(line)
        if pair is None:
            continue
        name = pair["name"].strip().lower()
        unit = spelled(pair["value"], "length")
        number = _VALUE.fullmatch(pair["value"])
        if unit is not None:
            for axis, names in (("x", _OF_DISTANCES), ("z", _OF_HEIGHTS), ("", _OF_ALL)):
                if names.fullmatch(name):
                    units.setdefault(axis, unit)
        elif number is not None:
            behind = (pair["behind"] or "").strip("; \t")
            written = next((u for u in (pair["unit"], number[2], behind) if u), None)
            value = float(number[1].replace(",", "."))
            if value <= 0.0 or not (written is None or spelled(written, "length")):
                continue
            for axis, names in (("x", _ALONG), ("y", _ACROSS), ("", _BOTH)):
                if names.fullmatch(name):
                    steps.setdefault(axis, (value, spelled(written, "length")))
    x_unit = units.get("x", units.get(""))
    along = steps.get("x", steps.get(""))
    across = steps.get("y", along)
    step = None
    if along is not None and across is not None:
        lengths = [(value, unit or x_unit) for value, unit in (along, across)]
        if all(unit for _, unit in lengths):
            first, second = (quantity_in_si(v, str(u), "length") for v, u in lengths)
            step = first, second
    return Header(x_unit, units.get("z", units.get("")), step)
