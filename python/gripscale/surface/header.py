"""What the lines above heights state: the distance of their points, and units.

    # Spacing: 0.1 mm       Schrittweite [mm]; 0,1       dx = 10 um       "XY calibration","50","um"
    # Width: 3.2 mm         X distance = 200 mm          Scan size: 3.2 mm x 3.2 mm
    # Height unit: um       Einheit der Höhe: µm         # Units: mm
    # 1 count = 0.5 um      height conversion factor (-> m) = 6.3e-8

Names are read in English and German. A spacing without a unit has that of distances. Points of a
column reach from end to end of a stated length, pixels of a table fill it.

A file of ERD (road profiles, University of Michigan) states the step in its second line, points of
Zygo the size of a pixel in the eighth.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from gripscale.core.units import quantity_in_si, spelled
from gripscale.io.cells import Line, is_number

_NUMBER = r"[-+]?\d+(?:[.,]\d+)?(?:[eE][-+]?\d+)?"
_PAIR = re.compile(
    r"[\s#%!/*\"]*(?P<name>[^:=;\t\[(,]+?)\s*(?:[\[(](?:->\s*)?(?P<unit>[^\])]*)[\])])?"
    rf"(?:\s*[:=;\t,][:=;\t,\s]*|\s+(?=\d))(?:(?P<number>{_NUMBER})[\s;,]*)?"
    r"(?P<word>[^\s;,]*?)(?:(?:/|\s*\bper\s+)(?P<each>sample|pixel|px|point|pt|pkt|count|digit|lsb|bit)s?)?"
    rf"(?:\s*[x×*]\s*(?P<second>{_NUMBER})\s*(?P<last>[^\s;,]*))?[\s;,\"]*"
)
_STEP = (
    r"(?:(?:data |measur\w+ )?(?:point|sampl(?:e|ing)|pixel|lateral)s?[ -]?)?"
    r"(?:spacing|step(?: ?(?:size|width|distance|length))?|increment|pitch|interval)"
    r"|(?:lateral|pixel|sampling|xy)[ -]?(?:resolution|calibration|kalibrierung|キャリブレーション)"
    r"|(?:point|sampl(?:e|ing))[ -]distance|pixel ?size|pixelgr(?:ö|oe)(?:ß|ss)e"
    r"|schrittweite|(?:mess|abtast)schritt|(?:mess)?punktabstand|abtast(?:abstand|weite)"
    r"|pas(?: d['’ ]?(?:échantillonnage|acquisition))?"
)
_SIZE = r"(?:size|length|range|distance|extent|width)"
_UNIT = r"(?:units?|einheit(?:en)?|単位)"
_OF = r" (?:of |der |in )?"
_NAMES = {
    "dx": rf"d ?x|pixel ?width|delta ?x|x[ -]?(?:{_STEP}|resolution)|(?:{_STEP})(?: (?:in )?x)?",
    "dy": rf"d ?y|pixel ?height|delta ?y|y[ -]?(?:{_STEP}|resolution)|(?:{_STEP}) (?:in )?y",
    "sx": rf"width|breite|x[ -]?{_SIZE}|(?:scan|image|physical|lateral|trace|profile|traverse)"
    rf"(?:d|ing)?[ -]?{_SIZE}|(?:mess|tast)(?:länge|strecke)",
    "sy": rf"height|höhe|y[ -]?{_SIZE}",
    "x": rf"(?:distance|lateral|weg|längen|xy?)[ -]?{_UNIT}|{_UNIT}{_OF}(?:distances?|xy?)",
    "z": rf"(?:height|value|data|höhen|z)[ -]?{_UNIT}|{_UNIT}{_OF}(?:heights?|höhen?|z)",
    "xz": rf"(?:length )?{_UNIT}",
    "factor": r"1 ?(?:digits?|bit|rad|v|increment|z)|(?:1 ?)?(?:counts?|lsb)"
    r"|(?:z|height|data|value)(?:[ -]?(?:conversion|scaling|calibration))*[ -]?(?:factor|scale)"
    r"|counts? ?size|scal(?:e|ing) factor",
}
_DENSITY = re.compile(
    rf"(?:(?<!\d)(?P<number>{_NUMBER})\s*)?(?:points?|pts|samples?|punkte)\s*(?:/|per|pro|je)\s*"
    rf"(?P<unit>[a-zµμ]+)\W*(?P<after>{_NUMBER})?",
    re.IGNORECASE,
)
# The only title above a table of heights.
_ALONE = re.compile(
    r"[\s#%!\"]*(?:z|heights?|höhen?|高さ)\s*[\[(](?P<unit>[^\])]+)[\])][\s;,\"]*", re.IGNORECASE
)
_MOST_LINES = 100  # lines of a header


@dataclass(frozen=True)
class Header:
    """What a header states of points and units; each is None if it does not."""

    x_unit: str | None = None
    z_unit: str | None = None  # in the words of the file; of counts such as "0.5 um"
    step: tuple[float, float] | None = None  # along x and along y [m], the same if one is stated
    size: tuple[float, float] | None = None  # lengths along x and along y [m]

    def steps(self, points: int, lines: int = 1) -> tuple[float, float] | None:
        """Return the distances [m] of a column of points, or of so many pixels along x and y."""
        if self.step is not None or self.size is None:
            return self.step
        along, across = self.size
        return (along / points, across / lines) if lines > 1 else (along / (points - 1),) * 2


def read_header(lines: Sequence[Line]) -> Header:
    """Return what the first lines of a file state."""
    units: dict[str, str | None] = {}
    lengths: dict[str, tuple[float, str | None]] = {}
    factor = None
    for density in filter(None, (_DENSITY.search(text) for _, text in lines[:_MOST_LINES])):
        count = float((density["number"] or density["after"] or "0").replace(",", "."))
        if count > 0.0 and spelled(density["unit"], "length"):
            lengths["dx"] = 1.0 / count, density["unit"]
    for alone in filter(None, (_ALONE.fullmatch(text) for _, text in lines[:_MOST_LINES])):
        units["z"] = alone["unit"]
    texts = [re.sub(r'"\s*[,;]\s*"', "\t", text) for _, text in lines[:_MOST_LINES]]
    for pair in filter(None, map(_PAIR.fullmatch, texts)):
        low = pair["name"].lower()
        name = next((key for key, names in _NAMES.items() if re.fullmatch(names, low)), "")
        if pair["each"] in ("count", "digit", "lsb", "bit"):
            name = "factor"
        elif not name and pair["each"]:  # such as resolution, 100 um/sample
            name = "dx"
        word = pair["unit"] or pair["word"].strip('"') or pair["last"]
        unit, number = spelled(word, "length"), (pair["number"] or "").replace(",", ".")
        if name == "factor" and number and unit:
            factor = f"{float(number):g} {unit}"
        elif name[:1] in ("d", "s") and number and (unit or (name[0] == "d" and not word)):
            lengths.setdefault(name, (float(number), unit))
            if pair["second"]:
                lengths[f"{name[0]}y"] = float(pair["second"].replace(",", ".")), unit
        elif name in ("x", "z", "xz") and word and not number and (unit or name != "xz"):
            units.update(dict.fromkeys(name, unit or word))
    x_unit, z_unit = units.get("x"), units.get("z")
    if factor and spelled(z_unit, "length") is None:
        z_unit = factor
    step, size = (_both(lengths, kind, x_unit) for kind in "ds")
    return Header(x_unit, z_unit, step, size)


def _both(
    lengths: dict[str, tuple[float, str | None]], kind: str, x_unit: str | None
) -> tuple[float, float] | None:
    """Return the steps or sizes along x and along y [m], or None without a unit."""
    if f"{kind}x" not in lengths:
        return None
    first = lengths[f"{kind}x"]
    (dx, along), (dy, across) = first, lengths.get(f"{kind}y", first)
    along, across = along or x_unit, across or x_unit
    if not (spelled(along, "length") and spelled(across, "length") and min(dx, dy) > 0.0):
        return None
    return (quantity_in_si(dx, str(along), "length"), quantity_in_si(dy, str(across), "length"))


def titled_lines(lines: list[Line]) -> list[Line]:
    """Return the lines of a file of ERD or of Zygo with titles as other files have them."""
    start = lines[0][1].lstrip("\ufeff") if lines else ""
    if start.startswith("Zygo XYZ Data File"):
        return _zygo_as_table(lines)
    if not start.startswith("ERDFILE"):
        return lines
    end = next((at for at, (_, text) in enumerate(lines) if text.strip() == "END"), 1)
    words = [*(cell.strip() for cell in lines[1][1].split(",")), *[""] * 6]
    head = {text[:8].strip(): text[8:] for _, text in lines[2:end]}
    count = int(words[0]) if words[0].isdigit() else 1
    unit = head.get("XUNITS", "m").strip()

    def names(key: str, width: int) -> list[str]:
        text = head.get(key, "").ljust(count * width)
        return [text[at * width : (at + 1) * width].strip() for at in range(count)]

    titles = zip(names("LONGNAME", 32), names("UNITSNAM", 8), strict=True)
    above = "\t".join(f"{name or 'Elevation'} [{of}]" for name, of in titles)
    rows = [(number, "\t".join(text.split())) for number, text in lines[end + 1 :]]
    return [(lines[1][0], f"step: {words[5]} {unit}"), (lines[end][0], above), *rows]


def _zygo_as_table(lines: list[Line]) -> list[Line]:
    """Return points of Zygo's MetroPro and Mx: x and y in pixels of a size [m], heights in um.

    Empty lines of the header count; # ends it.
    """
    end = next((at for at, (_, text) in enumerate(lines) if text.strip() == "#"), 0)
    optics = next((text.split() for number, text in lines[:end] if number == 8), [])
    if len(optics) < 7 or not is_number(optics[6]) or float(optics[6]) <= 0.0:
        return lines
    pixels = f"[{optics[6]} m]"
    return [(lines[end][0], f"x {pixels}\ty {pixels}\tz [um]"), *lines[end + 1 :]]
