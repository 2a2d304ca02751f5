"""Read profiles from files: text by gripscale itself, instrument formats by an extra."""

from __future__ import annotations

import io
import math
import os
import warnings
from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import in_si
from gripscale.io.text_table import EXCEL, file_path, read_bytes, read_sheets
from gripscale.surface.profile import HeightMap, Profile, line_label
from gripscale.surface.text_files import length_unit, read_text_map, read_text_profile

# Instrument formats, read by SurfaceTopography (the extra `gripscale[formats]`).
#
# SurfaceTopography: https://github.com/ContactEngineering/SurfaceTopography,
# doi:10.1088/2051-672X/ac860a.

MOST_POINTS_PER_BYTE = 1032
"""Deflate, the densest packing of all formats, makes at most 1032 bytes of one."""


@dataclass(frozen=True)
class HeightField:
    """Heights [m] on a line (points, 1) or a map (points along x, points along y)."""

    heights: Array
    x: Array
    y: Array | None
    reliable: float | None = None
    """Shortest wavelength [m] free of the instrument's artifacts, where the file tells."""

    def lines(self, direction: str) -> int:
        """Return how many profiles the field has along a direction."""
        return int(self.heights.shape[1 if direction == "x" else 0])

    def profile(self, path: Path, direction: str, line: int) -> Profile:
        """Return one line along a direction as a profile."""
        along = self.x if direction == "x" else self.y
        heights = self.heights[:, line] if direction == "x" else self.heights[line, :]
        name, source = path.stem, str(path)
        if self.y is not None:
            name, source = (line_label(text, line, direction) for text in (name, source))
        try:
            return Profile(np.asarray(along), heights, name, source, self.reliable)
        except InputError as error:
            raise FileError(f"{source}: {error}") from error


def read_instrument_file(
    path: Path,
    *,
    x_unit: str | None,
    z_unit: str | None,
    channel: str | int | None = None,
    step: tuple[float, float] | None = None,
) -> HeightField:
    """Read the heights of an instrument file.

    Parameters
    ----------
    path : pathlib.Path
        A line scan or a map in any format SurfaceTopography reads.
    x_unit, z_unit : str or None
        Units of distance and height, needed only where the file names none.
    channel : str, int or None
        Name of the channel, or its number from 1, where several hold heights.
    step : (float, float) or None
        Steps along x and y [m], needed only where the file has none.

    Raises
    ------
    FileError
        If SurfaceTopography is not installed or cannot read the file, or the file has no heights
        or no lateral size.
    InputError
        If an argument is wrong or contradicts the file.
    """
    raw = read_bytes(path)
    if not raw.strip():
        raise FileError(f"{path}: expected a surface; got an empty file")
    open_topography = _open_topography(path)
    # Its readers warn about pictures, missing dates and the like, none of which is the caller's.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = open_topography(io.BytesIO(raw))
            try:
                topography = _topography(path, reader, channel, step)
                _check_count(path, topography.nb_grid_pts, len(raw))
                heights: Array = np.ma.filled(
                    np.ma.asarray(topography.heights(), dtype=float), np.nan
                )
                positions = topography.positions()
                unit = topography.unit
                reliable = topography.short_reliability_cutoff()
            finally:
                reader.close()
        except (FileError, InputError):
            raise
        except Exception as error:  # each of its forty readers fails in its own way
            raise FileError(
                f"{path}: expected a surface in a known instrument format; "
                f"SurfaceTopography cannot read it ({type(error).__name__})"
            ) from error
    x_unit = "m" if step else length_unit(path, "the file", unit, "x_unit", x_unit)
    z_unit = length_unit(path, "the file", unit, "z_unit", z_unit)
    field = _height_field(path, heights, positions, x_unit, z_unit)
    return field if reliable is None else replace(field, reliable=in_si(reliable, x_unit, "length"))


def _topography(
    path: Path, reader: Any, channel: str | int | None, step: tuple[float, float] | None
) -> Any:
    """Return the heights of one channel, with its lateral size."""
    chosen = _channel(path, reader.channels, channel)
    if chosen.physical_sizes is not None:
        if step is not None:
            raise InputError(f"step must be left out; {path} states the size of its surface")
        return chosen.topography()
    if step is None:
        raise FileError(f"{path}: expected a lateral size; the file gives none")
    sizes = tuple(n * d for n, d in zip(chosen.nb_grid_pts, step, strict=False))
    return chosen.topography(physical_sizes=sizes)


def _check_count(path: Path, points: tuple[int, ...], length: int) -> None:
    """Refuse a header with more points than any packing gets into the bytes of the file."""
    if math.prod(points) > MOST_POINTS_PER_BYTE * length:
        raise FileError(
            f"{path}: expected a surface; its header states {' x '.join(map(str, points))} points, "
            f"which {length} bytes cannot hold"
        )


def _channel(path: Path, channels: list[Any], wanted: str | int | None) -> Any:
    """Return the one channel of heights, or the one of them that is `wanted`."""
    known = [channel for channel in channels if channel.is_height_channel]
    named = ", ".join(f"{channel.index + 1} {channel.name!r}" for channel in known)
    if not known:
        others = ", ".join(repr(channel.name) for channel in channels)
        raise FileError(f"{path}: expected a channel of heights; got {others or 'none'}")
    if wanted is not None:
        known = [channel for channel in known if wanted in (channel.name, channel.index + 1)]
        if not known:
            raise InputError(
                f"channel of {path} must be one of {named}, counted from 1; got "
                f"{checks.short_repr(wanted)}"
            )
    if len(known) > 1:
        raise FileError(f"{path}: expected one channel of heights; got {named}; give channel")
    return known[0]


def _open_topography(path: Path) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from SurfaceTopography import open_topography
    except ImportError as error:
        raise FileError(
            f"{path}: instrument formats need SurfaceTopography; "
            "install it with: pip install 'gripscale[formats]'"
        ) from error
    return open_topography


def _height_field(
    path: Path, heights: Array, positions: Any, x_unit: str, z_unit: str
) -> HeightField:
    if heights.ndim not in (1, 2) or min(heights.shape) == 0:
        raise FileError(f"{path}: expected a line or a map; got heights of shape {heights.shape}")
    heights = in_si(heights, z_unit, "length")
    if heights.ndim == 1:
        return HeightField(heights[:, None], in_si(np.asarray(positions), x_unit, "length"), None)
    x, y = (in_si(np.asarray(axis, dtype=float), x_unit, "length") for axis in positions)
    return HeightField(heights, x[:, 0], y[0, :])


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


# Read maps from files: text by gripscale itself, instrument formats by an extra.

MAP_TEXT_SUFFIXES = (*TEXT_SUFFIXES, ".xyz")


def read_map(
    path: str | os.PathLike[str],
    *,
    x_unit: str | None = None,
    z_unit: str | None = None,
    step: float | tuple[float, float] | None = None,
    channel: str | int | None = None,
    reader: str = "auto",
) -> HeightMap:
    """Read a map of heights from a file.

    Parameters
    ----------
    path : path-like
        A text file (.xyz, .dat, .txt, .csv, .tsv, .prn) with three columns x, y and z, or with a
        table of heights whose rows run along y and whose columns along x; or a map in any format
        SurfaceTopography reads, such as .al3d, .sur, .opd, .x3p, .sdf, .plu, .datx, .gwy, .npy
        (needs `gripscale[formats]`).
    x_unit, z_unit : str, optional
        Units of distance and height ("m", "cm", "mm", "um", "nm", "pm", "in") where the file does
        not name them. Units are never guessed, and must not contradict the file.
    step : float or (float, float), optional
        Distance between points [m], along x and y if they differ, of a table or an array, whose
        file has none.
    channel : str or int, optional
        Name of the channel, or its number from 1, of an instrument file that has several of
        heights.
    reader : {"auto", "text", "instrument"}, optional
        How to read the file; "auto" goes by the suffix.

    Returns
    -------
    HeightMap
        Distances and heights [m]; missing heights are NaN. The rubber slides along its x: turn it
        for the other way.

    Raises
    ------
    FileError
        If the file is missing, unreadable, not understood or not a map; the message names path and
        place.
    InputError
        If an argument is wrong or contradicts the file.
    """
    place = file_place(path, x_unit, z_unit, reader)
    steps = None if step is None else _steps(step)
    if steps is not None and x_unit is not None:
        raise InputError(
            f"x_unit must be left out with step, which is in m; got {checks.short_repr(x_unit)}"
        )
    if is_text(place, reader, MAP_TEXT_SUFFIXES):
        return read_text_map(place, x_unit=x_unit, z_unit=z_unit, step=steps)
    return _instrument_map(place, x_unit, z_unit, steps, channel)


def _instrument_map(
    path: Path,
    x_unit: str | None,
    z_unit: str | None,
    step: tuple[float, float] | None,
    channel: str | int | None,
) -> HeightMap:
    field = read_instrument_file(path, x_unit=x_unit, z_unit=z_unit, channel=channel, step=step)
    if field.y is None:
        raise FileError(f"{path}: expected a map; got a line, which gripscale.read_profile reads")
    try:
        return HeightMap(
            field.x, field.y, field.heights, path.stem, str(path), reliable=field.reliable
        )
    except InputError as error:
        raise FileError(f"{path}: {error}") from error


def _steps(step: float | tuple[float, float]) -> tuple[float, float]:
    pair = (step, step) if not isinstance(step, tuple | list) else tuple(step)
    if len(pair) != 2:
        raise InputError(
            f"step must be one distance [m], or that along x and y; got {checks.short_repr(step)}"
        )
    along, across = (checks.positive("step", value, unit="m") for value in pair)
    return along, across
