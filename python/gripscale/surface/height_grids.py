"""Maps on a grid below a header of pairs: surface data format, grid of ESRI, field of Gwyddion.

| format | points along x, y | steps | heights |
|---|---|---|---|
| .sdf (ISO 25178) | NumPoints, NumProfiles | Xscale, Yscale [m] | counts of Zscale [m], between * |
| .asc, ESRI | ncols, nrows | cellsize, or dx and dy | north to south; NODATA_value is missing |
| .gsf, Gwyddion | XRes, YRes | XReal, YReal over them | 4-byte numbers behind 1 to 4 empty bytes |

Names are taken in any case, with =, a colon or blanks before their value. BAD is a missing height.
The field is that of http://gwyddion.net/documentation/user-guide-en/gsf.html.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from gripscale.core import Array, FileError, checks
from gripscale.core.wording import shortened

_LONGEST_HEADER = 2**16
_PAIR = re.compile(r"^\s*([A-Za-z_]\w*)\s*[=:\s]\s*(.*?)\s*$")
_ESRI = re.compile(rb"\s*ncols[\s=:]", re.IGNORECASE)
_BINARY, _TEXT = (b"bISO", b"bBCR"), (b"aISO", b"aBCR")
_MOST_POINTS = 10**9  # points along an axis beyond which a header is taken as damaged


def is_esri_grid(raw: bytes) -> bool:
    """Return whether a file is a grid of ESRI in text, by its first word."""
    return _ESRI.match(raw) is not None


def is_sdf_text(path: Path, raw: bytes) -> bool:
    """Return whether a file is in the surface data format as text: by its first word or suffix."""
    return raw.lstrip().startswith(_TEXT) or (
        path.suffix.lower() == ".sdf" and not raw.startswith(_BINARY)
    )


def simple_field_header(raw: bytes) -> dict[str, str]:
    """Return the header of a simple field of Gwyddion by name in small letters; else empty."""
    if not raw.startswith(b"Gwyddion Simple Field"):
        return {}
    return _header(raw.partition(b"\0")[0].decode("utf-8", errors="replace"))[0]


def _simple_field(path: Path, raw: bytes, header: dict[str, str]) -> tuple[Array, Array, Array]:
    """Return x, y and heights as `read_height_grid`, in the units of the header."""
    end = raw.index(b"\0") if b"\0" in raw else len(raw)
    try:
        points, rows = int(header["xres"]), int(header["yres"])
        dx, dy = float(header["xreal"]) / points, float(header["yreal"]) / rows
        z = np.frombuffer(raw, "<f4", points * rows, end + 4 - end % 4)
    except (KeyError, ValueError, ZeroDivisionError) as error:
        raise FileError(
            f"{path}: expected a simple field of Gwyddion with XRes, YRes, XReal, YReal and as "
            f"many heights; got {len(raw)} bytes with {', '.join(header)}"
        ) from error
    counts = np.array(z, dtype=float).reshape(rows, points)
    return dx * np.arange(points, dtype=float), dy * np.arange(rows, dtype=float), counts.T


def read_height_grid(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights of shape (points along x, profiles), NaN where missing.

    They are in m of the surface data format, in the units of the file of other grids. Raises
    `FileError` if the header lacks a number, or there are not as many heights as it states.
    """
    if field := simple_field_header(raw):
        return _simple_field(path, raw, field)
    header, start = _header(raw[:_LONGEST_HEADER].decode("latin-1"))
    esri = is_esri_grid(raw)

    def number(name: str, default: str = "") -> float:
        text = header.get(name.lower(), default)
        try:
            value = float(text.replace(",", "."))
        except ValueError as error:
            raise FileError(
                f"{path}: expected a map with the number {name} in its header; got "
                f"{checks.short_repr(text) if text else 'none'}"
            ) from error
        if not default and not 0.0 < value < math.inf:
            raise FileError(f"{path}: expected {name} finite and above zero; got {shortened(text)}")
        return value

    along, across = ("ncols", "nrows") if esri else ("NumPoints", "NumProfiles")
    for name in (along, across):
        if not (number(name) <= _MOST_POINTS and number(name) == int(number(name))):
            raise FileError(f"{path}: expected a whole number as {name}; got {number(name):g}")
    points, profiles = int(number(along)), int(number(across))
    by_axis = ("dx", "dy") if "dx" in header else ("cellsize", "cellsize")
    dx, dy = map(number, by_axis if esri else ("Xscale", "Yscale"))
    heights = raw[start:] if esri else raw[start:].partition(b"*")[0]  # a trailer may follow
    cells = heights.replace(b"BAD", b"nan").replace(b",", b".").split()
    if len(cells) != points * profiles:
        raise FileError(
            f"{path}: expected {points} x {profiles} heights by its header; got {len(cells)}"
        )
    try:
        counts = np.array(cells).astype(float).reshape(profiles, points)
    except ValueError as error:
        raise FileError(
            f"{path}: expected numbers as heights ({checks.shortened(str(error))})"
        ) from error
    if esri:
        counts = np.where(counts == number("NODATA_value", "-9999"), np.nan, counts)[::-1]
    else:
        counts *= number("Zscale")
    return dx * np.arange(points, dtype=float), dy * np.arange(profiles, dtype=float), counts.T


def _header(head: str) -> tuple[dict[str, str], int]:
    """Return the pairs of the header by name in small letters, and where the heights begin."""
    header: dict[str, str] = {}
    start = 0
    for line in head.splitlines(keepends=True):
        pair = _PAIR.match(line)
        if pair:
            header[pair[1].lower()] = pair[2]
        elif header and line.strip():
            return header, start + (len(line) if line.strip() == "*" else 0)
        start += len(line)
    return header, start
