"""Read profiles from files: text by gripscale itself, instrument formats by an extra."""

from __future__ import annotations

import os
from collections.abc import Collection
from pathlib import Path

import numpy as np

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.excel import EXCEL, read_sheets
from gripscale.surface.instrument_file import HeightField, read_instrument_file
from gripscale.surface.profile import Profile
from gripscale.surface.text_profile import read_text_profile
from gripscale.textfile import file_path
from gripscale.units import in_si

TEXT_SUFFIXES = ("", ".dat", ".txt", ".csv", ".tsv", ".prn")
_SHEETS_OF_AN_INSTRUMENT = {"Certificate", "DATA"}
"""Sheets of a Mitutoyo roughness tester's Excel file."""


def read_profile(
    path: str | os.PathLike[str],
    *,
    x_unit: str | None = None,
    z_unit: str | None = None,
    direction: str = "x",
    line: int | None = None,
    channel: str | int | None = None,
    sheet: str | int | None = None,
    reader: str = "auto",
) -> Profile:
    """Read one profile from a file.

    Parameters
    ----------
    path : path-like
        A text or Excel file with a distance and a height column (CAPTIF .dat, .txt, .csv, .tsv,
        .prn, .xlsx), or any line scan or map SurfaceTopography reads (needs `gripscale[formats]`).
    x_unit, z_unit : str, optional
        Units of distance and height ("m", "cm", "mm", "um", "nm", "pm", "in") where the file does
        not name them. Units are never guessed, and must not contradict the file.
    direction : {"x", "y"}, optional
        Direction of the profile in a map.
    line : int, optional
        Which line of a map, counted from 0 across `direction`; the middle one by default.
    channel : str or int, optional
        Name of the channel, or its number from 1, of an instrument file that has several of
        heights.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.
    reader : {"auto", "text", "instrument"}, optional
        How to read the file; "auto" goes by the suffix.

    Returns
    -------
    Profile
        Distances and heights [m]; missing heights are NaN.

    Raises
    ------
    FileError
        If the file is missing, unreadable or not understood; the message names path and place.
    InputError
        If an argument is wrong or contradicts the file.
    """
    checks.one_of("direction", direction, ("x", "y"))
    place = file_place(path, x_unit, z_unit, reader)
    if _is_text_or_sheet(place, reader):
        _check_line(place, line, 1)
        return read_text_profile(place, x_unit=x_unit, z_unit=z_unit, sheet=sheet)
    field = read_instrument_file(place, x_unit=x_unit, z_unit=z_unit, channel=channel)
    _check_direction(place, field, direction)
    lines = field.lines(direction)
    chosen = _check_line(place, line, lines)
    return field.profile(place, direction, lines // 2 if chosen is None else chosen)


def read_profiles(
    path: str | os.PathLike[str],
    *,
    x_unit: str | None = None,
    z_unit: str | None = None,
    direction: str = "x",
    channel: str | int | None = None,
    sheet: str | int | None = None,
    reader: str = "auto",
) -> list[Profile]:
    """Read every profile of a file: all lines of a map along a direction, or the only one.

    Lines of a map on which no height was measured are left out. Parameters and errors are those
    of `read_profile`.
    """
    checks.one_of("direction", direction, ("x", "y"))
    place = file_place(path, x_unit, z_unit, reader)
    if _is_text_or_sheet(place, reader):
        return [read_text_profile(place, x_unit=x_unit, z_unit=z_unit, sheet=sheet)]
    field = read_instrument_file(place, x_unit=x_unit, z_unit=z_unit, channel=channel)
    _check_direction(place, field, direction)
    measured = np.isfinite(field.heights).any(axis=0 if direction == "x" else 1)
    if not measured.any():
        raise FileError(f"{place}: expected heights; got {measured.size} lines, all missing")
    return [field.profile(place, direction, int(line)) for line in np.flatnonzero(measured)]


def file_place(
    path: str | os.PathLike[str], x_unit: str | None, z_unit: str | None, reader: str
) -> Path:
    """Return the path, the other arguments being checked."""
    checks.one_of("reader", reader, ("auto", "text", "instrument"))
    for name, unit in (("x_unit", x_unit), ("z_unit", z_unit)):
        if unit is not None:
            in_si(1.0, unit, "length", name)
    return file_path(path)


def is_text(path: Path, reader: str, suffixes: Collection[str] = TEXT_SUFFIXES) -> bool:
    """Return whether gripscale reads the file itself."""
    return reader == "text" or (reader == "auto" and path.suffix.lower() in suffixes)


def _is_text_or_sheet(path: Path, reader: str) -> bool:
    """Return the same of a profile, which may stand in an Excel file of no instrument, too."""
    if reader == "auto" and path.suffix.lower() in EXCEL:
        return not set(read_sheets(path)) >= _SHEETS_OF_AN_INSTRUMENT
    return is_text(path, reader)


def _check_direction(path: Path, field: HeightField, direction: str) -> None:
    if field.y is None and direction != "x":
        raise InputError(f"direction must be 'x' for {path}, which is a single line; got 'y'")


def _check_line(path: Path, line: int | None, lines: int) -> int | None:
    if line is None:
        return None
    return checks.whole(f"line of {path}", line, least=0, most=lines - 1)
