"""Maps in text files of the surface data format (.sdf), ISO 25178-71.

    aISO-1.0            version
    NumPoints   = 512   points along x of each profile
    NumProfiles = 256   profiles along y
    Xscale      = 1e-6  distance of points [m], Yscale that of profiles
    Zscale      = 1e-9  height of one count [m]
    *                   the heights follow, profile by profile, in lines of any length
    *                   end

Names are taken in any case, with =, a colon or blanks before their value. BAD is a missing height.
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
MOST_POINTS = 10**9


def is_sdf_text(path: Path, raw: bytes) -> bool:
    """Return whether a file is read here: by its suffix, unless it is the binary form."""
    return path.suffix.lower() == ".sdf" and not raw.startswith(_BINARY)


def read_sdf_text(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights [m] of shape (points along x, profiles), NaN where missing.

    Raises `FileError` if the header lacks a number, or there are not as many heights as it states.
    """
    head = raw[:_LONGEST_HEADER].decode("latin-1")
    header, start = _header(head)
    numbers = {name: _number(path, header, name) for name in (*_COUNTS, *_SCALES)}
    points, profiles = (_count(path, name, numbers[name]) for name in _COUNTS)
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


def _number(path: Path, header: dict[str, str], name: str) -> float:
    """Return a number of the header."""
    text = header.get(name.lower(), "")
    try:
        return float(text)
    except ValueError as error:
        raise FileError(
            f"{path}: expected a map in SDF with the number {name} in its header; got "
            f"{checks.short_repr(text) if text else 'none'}"
        ) from error


def _count(path: Path, name: str, value: float) -> int:
    if not (1 <= value <= MOST_POINTS and value == int(value)):
        raise FileError(f"{path}: expected a whole number as {name}; got {value:g}")
    return int(value)
