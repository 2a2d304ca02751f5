"""What the lines above heights state: the distance of their points, and units.

    # Spacing: 0.1 mm       Schrittweite [mm]; 0,1       dx = 10 um
    # Height unit: um       Einheit der Höhe: µm         # Units: mm

Names are read in English and German. A spacing without a unit has that of distances.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from gripscale.core.units import quantity_in_si, spelled
from gripscale.io.cells import Line

_PAIR = re.compile(
    r"[\s#%!/*\"]*(?P<name>[^:=;\t\[(]+?)\s*(?:[\[(](?P<unit>[^\])]*)[\])])?\s*[:=;\t]\s*"
    r"(?:(?P<number>\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?)[\s;]*)?(?P<word>[^\s;]*)[\s;\"]*"
)
_STEP = (
    r"(?:(?:point|sampl(?:e|ing)|pixel)[ -]?)?(?:spacing|step(?: size)?|increment)"
    r"|(?:point|sampl(?:e|ing))[ -](?:distance|interval)|pixel ?size|pixelgr(?:ö|oe)(?:ß|ss)e"
    r"|schrittweite|(?:mess|abtast)schritt|(?:mess)?punktabstand|abtast(?:abstand|weite)"
)
_UNIT = r"(?:units?|einheit(?:en)?)"
_OF = r" (?:of |der |in )?"
_NAMES = {
    "dx": rf"d ?x|delta ?x|x[ -]?(?:{_STEP})|(?:{_STEP})(?: (?:in )?x)?",
    "dy": rf"d ?y|delta ?y|y[ -]?(?:{_STEP})|(?:{_STEP}) (?:in )?y",
    "x": rf"(?:distance|lateral|weg|längen|xy?)[ -]?{_UNIT}|{_UNIT}{_OF}(?:distances?|xy?)",
    "z": rf"(?:height|value|höhen|z)[ -]?{_UNIT}|{_UNIT}{_OF}(?:heights?|höhen?|z)",
    "xz": rf"(?:length )?{_UNIT}",
}
_MOST_LINES = 100  # lines of a header


@dataclass(frozen=True)
class Header:
    """The distance of points [m] and the units that a header states, each None if it does not."""

    x_unit: str | None = None
    z_unit: str | None = None
    step: tuple[float, float] | None = None  # along x and along y, the same if one is stated


def read_header(lines: Sequence[Line]) -> Header:
    """Return what the first lines of a file state."""
    units: dict[str, str | None] = {}
    steps: dict[str, tuple[float, str | None]] = {}
    for pair in filter(None, (_PAIR.fullmatch(line) for _, line in lines[:_MOST_LINES])):
        low = pair["name"].lower()
        name = next((key for key, names in _NAMES.items() if re.fullmatch(names, low)), "")
        unit = spelled(pair["unit"] or pair["word"], "length")
        if name.startswith("d") and pair["number"]:
            if unit or not (pair["unit"] or pair["word"]):
                steps.setdefault(name, (float(pair["number"].replace(",", ".")), unit))
        elif name and unit and not pair["number"]:
            units.update(dict.fromkeys(name, unit))
    x_unit, first = units.get("x"), steps.get("dx")
    step = None
    if first is not None:
        (dx, along), (dy, across) = first, steps.get("dy", first)
        along, across = along or x_unit, across or x_unit
        if along and across and min(dx, dy) > 0.0:
            step = quantity_in_si(dx, along, "length"), quantity_in_si(dy, across, "length")
    return Header(x_unit, units.get("z"), step)
