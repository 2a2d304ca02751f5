"""Maps on a grid in text with a header: the surface data format, and the grid of ESRI.

The surface data format (.sdf), ISO 25178-71:

aISO-1.0            version
    NumPoints   = 512   points along x of each profile
    NumProfiles = 256   profiles along y
    Xscale      = 1e-6  distance of points [m], Yscale that of profiles
    Zscale      = 1e-9  height of one count [m]
    *                   the heights follow, profile by profile, in lines of any length
    *                   end

Names are taken in any case, with =, a colon or blanks before their value. BAD is a missing height.

A grid of ESRI (.asc) holds the rows from north to south, each from west to east, below

    ncols 400, nrows 300                   counts of columns and rows
    xllcorner 350000, yllcorner 5600000    place of the lower left corner, which does not count
    cellsize 0.2, or dx and dy             distance of points, in a unit that it does not state
    NODATA_value -9999                     stands for a missing height
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import FileError

_COUNTS, _SCALES = ("NumPoints", "NumProfiles"), ("Xscale", "Yscale", "Zscale")
_LONGEST_HEADER = 2**16
_PAIR = re.compile(r"^\s*([A-Za-z]\w*)\s*[=:\s]\s*(.*?)\s*$")
_BINARY = (b"bISO", b"bBCR")
_MOST_POINTS = 10**9
"""Points along an axis beyond which a header is taken as damaged."""


def is_sdf_text(path: Path, raw: bytes) -> bool:
    """Return whether a file is read here: by its suffix, unless it is the binary form."""
    return path.suffix.lower() == ".sdf" and not raw.startswith(_BINARY)


def read_sdf_text(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights [m] of shape (points along x, profiles), NaN where missing.

    Raises `FileError` if the header lacks a number, or there are not as many heights as it states.
    """
    head = raw[:_LONGEST_HEADER].decode("latin-1")
    header, start = _header(head)
    numbers: dict[str, float] = {}
    for name in (*_COUNTS, *_SCALES):
        text = header.get(name.lower(), "")
        try:
            numbers[name] = float(text)
        except ValueError as error:
            raise FileError(
                f"{path}: expected a map in SDF with the number {name} in its header; got "
                f"{checks.short_repr(text) if text else 'none'}"
            ) from error
    for name in _COUNTS:
        value = numbers[name]
        if not (1 <= value <= _MOST_POINTS and value == int(value)):
            raise FileError(f"{path}: expected a whole number as {name}; got {value:g}")
    points, profiles = (int(numbers[name]) for name in _COUNTS)
    for name in _SCALES:
        if not numbers[name] > 0.0:
            raise FileError(f"{path}: expected {name} above zero [m]; got {header[name.lower()]}")
    cells = raw[start:].replace(b"*", b" ").replace(b"BAD", b"nan").split()
    if len(cells) != points * profiles:
        raise FileError(
            f"{path}: expected {points} x {profiles} heights by its header; got {len(cells)}"
        )
    try:
        counts = np.array(cells).astype(float)
    except ValueError as error:
        raise FileError(
            f"{path}: expected numbers as heights ({checks.shortened(str(error))})"
        ) from error
    heights = numbers["Zscale"] * counts.reshape(profiles, points).T
    x, y = (
        numbers[name] * np.arange(size, dtype=float)
        for name, size in (("Xscale", points), ("Yscale", profiles))
    )
    return np.asarray(x, float), np.asarray(y, float), np.asarray(heights, float)


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


_ESRI = re.compile(rb"\s*ncols\s", re.IGNORECASE)
_ESRI_PAIR = re.compile(r"\s*([A-Za-z_]\w*)[ \t=:]+(\S+)\s*")


def is_esri_grid(raw: bytes) -> bool:
    """Return whether a file is a grid of ESRI in text."""
    return _ESRI.match(raw) is not None


def read_esri_grid(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights of shape (columns, rows) in the units of the file, NaN where missing.

    Raises `FileError` if the header lacks a number, or there are not as many heights as it states.
    """
    lines = raw.decode("latin-1").splitlines()
    header: dict[str, str] = {}
    while lines and (pair := _ESRI_PAIR.fullmatch(lines[0])):
        header[pair[1].lower()] = pair[2].replace(",", ".")
        lines.pop(0)
    names = ("ncols", "nrows", *(("dx", "dy") if "dx" in header else ("cellsize", "cellsize")))
    try:
        columns, rows, dx, dy = (float(header.get(name, "none")) for name in names)
        missing = float(header.get("nodata_value", -9999.0))
        heights = np.array(" ".join(lines).replace(",", ".").split()).astype(float)
    except ValueError as error:
        raise FileError(
            f"{path}: expected an ESRI grid of numbers, with ncols, nrows and cellsize ({error})"
        ) from error
    if min(columns, rows, dx, dy) <= 0.0 or heights.size != columns * rows:
        raise FileError(
            f"{path}: expected {columns:g} x {rows:g} heights in steps of {dx:g} by its header; "
            f"got {heights.size}"
        )
    z = np.where(heights == missing, np.nan, heights).reshape(int(rows), int(columns))
    return dx * np.arange(columns), dy * np.arange(rows), z[::-1].T
