"""Read profiles and maps from files: text by gripscale itself, instrument formats by an extra.

Instrument formats are read by SurfaceTopography (the extra `gripscale[formats]`),
https://github.com/ContactEngineering/SurfaceTopography, doi:10.1088/2051-672X/ac860a.
"""

from __future__ import annotations

import io
import math
import os
import warnings
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from gripscale.core import Array, FileError, GripscaleError, InputError, checks, quantity_in_si
from gripscale.core.errors import about_file, unstated, using_extra
from gripscale.io import text_table
from gripscale.io.cells import SEPARATORS, cells_of, is_row, is_row_of
from gripscale.surface import height_grids
from gripscale.surface.profile import HeightMap, Profile, line_label
from gripscale.surface.text_files import NO_HEIGHT, length_unit, read_text_map, read_text_profile

# Deflate, the densest packing of all formats, packs at most 1032 bytes into one.
_MOST_POINTS_PER_BYTE = 1032


@dataclass(frozen=True)
class HeightField:
    """Heights [m] on a line (points, 1) or a map (points along x, points along y)."""

    heights: Array
    x: Array
    y: Array | None
    # Shortest wavelength [m] free of the instrument's artifacts, if the file states it.
    reliable: float | None = None


def read_instrument_file(
    path: Path,
    *,
    x_unit: str | None,
    z_unit: str | None,
    channel: str | int | None = None,
    step: tuple[float, float] | None = None,
) -> HeightField:
    """Read the heights of an instrument file; the arguments are those of `read_map`.

    Raises `FileError` if SurfaceTopography is not installed or cannot read the file, or the file
    has no heights or no lateral size; `InputError` if an argument is wrong or contradicts the file.
    """
    raw = text_table.read_bytes(path)
    if not raw.strip():
        raise FileError(f"{path}: expected a surface; got an empty file")
    if raw.startswith(_ARRAY):
        axis, *others, z = _array(path, raw, step)
        z_unit = length_unit(path, "the file", None, "z_unit", z_unit)
        z = quantity_in_si(z, z_unit, "length")
        return HeightField(z, axis, others[0] if others else None)
    units = height_grids.named_units(path, raw)
    if units is not None:
        if step is not None:
            raise InputError(f"step must be left out; {path} states the size of its surface")
        x_unit = length_unit(path, "the file", units.get("xyunits"), "x_unit", x_unit)
        z_unit = z_unit or (x_unit if height_grids.is_stl(path, raw) else None)
        z_unit = length_unit(path, "the file", units.get("zunits"), "z_unit", z_unit)
        along, across, field = height_grids.read_height_grid(path, raw)
        x, y = (quantity_in_si(axis, x_unit, "length") for axis in (along, across))
        return HeightField(quantity_in_si(field, z_unit, "length"), x, y)
    # Its readers warn about pictures, missing dates and the like, none of which is the caller's.
    with warnings.catch_warnings(action="ignore"):
        with using_extra("formats", f"{path}: its format", "SurfaceTopography", kind=FileError):
            from SurfaceTopography.IO import open_topography, readers
        # some formats have no first bytes of their own, so that others take their files
        suffix = path.suffix.lower().removeprefix(".")
        formats = [r.format() for r in readers if suffix in (r.file_extensions() or ())]
        try:
            without_magic = [r.format() for r in readers if getattr(r, "_magic", "") is None]
            opened = _opened(open_topography, raw, formats, without_magic)
            with closing(opened) as reader:
                topography = _topography(path, reader.channels, channel, step)
                points = topography.nb_grid_pts
                if math.prod(points) > _MOST_POINTS_PER_BYTE * len(raw):
                    raise FileError(
                        f"{path}: expected a surface; its header states "
                        f"{' x '.join(map(str, points))} points, which {len(raw)} bytes cannot hold"
                    )
                heights: Array = np.ma.filled(
                    np.ma.asarray(topography.heights(), dtype=float), np.nan
                )
                positions = topography.positions()
                unit = topography.unit
                reliable = topography.short_reliability_cutoff()
        except (FileError, InputError):
            raise
        except Exception as error:  # each of its forty readers fails in its own way
            raise FileError(
                f"{path}: expected a surface as text or in the format of an instrument; got "
                f"{len(raw)} bytes in none of these formats, or damaged: export it from the "
                "instrument as text, .x3p or .sur"
            ) from error
    x_unit = "m" if step else length_unit(path, "the file", unit, "x_unit", x_unit)
    z_unit = length_unit(path, "the file", unit, "z_unit", z_unit)
    if heights.ndim not in (1, 2) or min(heights.shape) == 0:
        raise FileError(f"{path}: expected a line or a map; got heights of shape {heights.shape}")
    heights = quantity_in_si(heights, z_unit, "length")
    if reliable is not None:
        reliable = quantity_in_si(reliable, x_unit, "length")
    if heights.ndim == 1:
        x = quantity_in_si(np.asarray(positions), x_unit, "length")
        return HeightField(heights[:, None], x, None, reliable)
    x, y = (quantity_in_si(np.asarray(axis, dtype=float), x_unit, "length") for axis in positions)
    return HeightField(heights, x[:, 0], y[0, :], reliable)


_ARRAY = b"\x93NUMPY"


def _array(path: Path, raw: bytes, step: tuple[float, float] | None) -> list[Array]:
    """Return x, y of a map [m], and the heights of an array of NumPy."""
    try:
        array = np.load(io.BytesIO(raw), allow_pickle=False)
    except (ValueError, EOFError, OSError, MemoryError) as error:
        raise FileError(f"{path}: expected an array of heights; got a damaged file") from error
    if array.ndim not in (1, 2) or array.size == 0 or array.dtype.kind not in "biuf":
        got = f"numbers of the type {array.dtype} and shape {array.shape}"
        raise FileError(f"{path}: expected an array of one or two dimensions; got {got}")
    if step is None:
        raise _without_size(path, array.shape)
    axes = [d * np.arange(n, dtype=float) for n, d in zip(array.shape, step, strict=False)]
    return [*axes, np.asarray(array, dtype=float).reshape(len(axes[0]), -1)]


def _without_size(path: Path, points: Sequence[int]) -> GripscaleError:
    return unstated(
        f"{path}: expected a lateral size; the file gives none: give ",
        "step",
        f", for an array of {' x '.join(map(str, points))} heights whose first index runs along x, "
        "the way of sliding",
        kind=FileError,
    )


def _opened(
    open_topography: Callable[..., Any], raw: bytes, formats: list[str], others: list[str]
) -> Any:
    """Return the reader of one of the formats, or else the one that takes the content.

    Of the `others`, whose files have no first bytes of their own, one that finds heights goes
    before a reader that finds none.
    """
    for name in formats:
        with suppress(Exception):
            return open_topography(io.BytesIO(raw), format=name)
    reader = open_topography(io.BytesIO(raw))
    for name in () if reader.channels else others:
        with suppress(Exception):
            other = open_topography(io.BytesIO(raw), format=name)
            if other.channels:
                return other
    return reader


def _topography(
    path: Path, channels: list[Any], wanted: str | int | None, step: tuple[float, float] | None
) -> Any:
    """Return the heights of the only channel, or of the `wanted` one, with its lateral size."""
    of_heights = [channel for channel in channels if channel.is_height_channel]
    if wanted is None:  # deflections and errors of a scan are lengths, too
        of_heights = [c for c in of_heights if not NO_HEIGHT.search(str(c.name))] or of_heights
    names = ", ".join(f"{channel.index + 1} {channel.name!r}" for channel in of_heights)
    if not of_heights:
        others = ", ".join(repr(channel.name) for channel in channels)
        raise FileError(f"{path}: expected a channel of heights; got {others or 'none'}")
    if wanted is not None:
        of_heights = [c for c in of_heights if wanted in (c.name, c.index + 1)]
        if not of_heights:
            raise InputError(
                f"channel of {path} must be one of {names}, counted from 1; got "
                f"{checks.short_repr(wanted)}"
            )
    if len(of_heights) > 1:
        words = f"{path}: expected one channel of heights; got {names}; give "
        refusal = unstated(words, "channel", kind=FileError)
        refusal.choices = tuple(c.name for c in of_heights)
        raise refusal
    channel = of_heights[0]
    if channel.physical_sizes is not None:
        if step is not None:
            raise InputError(f"step must be left out; {path} states the size of its surface")
        return channel.topography()
    if step is None:
        raise _without_size(path, channel.nb_grid_pts)
    sizes = tuple(n * d for n, d in zip(channel.nb_grid_pts, step, strict=False))
    return channel.topography(physical_sizes=sizes)


# Points or a table of heights as text; some instruments write .asc, too.
POINT_SUFFIXES = (".xyz", ".asc")
# Sheets of a Mitutoyo roughness tester's Excel file.
_SHEETS_OF_AN_INSTRUMENT = {"Certificate", "DATA"}


def read_profile(
    path: str | os.PathLike[str],
    *,
    x_unit: str | None = None,
    z_unit: str | None = None,
    direction: str = "x",
    line: int | None = None,
    channel: str | int | None = None,
    sheet: str | int | None = None,
    step: float | None = None,
    reader: str = "auto",
    z_axis: str | None = None,
) -> Profile:
    """Read one profile from a file.

    Distances and heights are in m, missing heights NaN. Raises `FileError` if the file is missing,
    unreadable or not understood; the message names path and place. Raises `InputError` if an
    argument is wrong or contradicts the file.

        >>> round(gs.read_profile("road.txt").length, 4)
        0.2

    Parameters
    ----------
    path : path-like
        A text or Excel file with a distance and a height column (CAPTIF .dat, .txt, .csv, .tsv,
        .prn, .xlsx), or any line scan or map SurfaceTopography reads (needs `gripscale[formats]`).
    x_unit, z_unit : str, optional
        Units of distance and height ("m", "mm", "um", "in", "ft", ...) where the file does
        not name them. Units are never guessed, and must not contradict the file.
    direction : {"x", "y"}, optional
        Direction of the profile in a map.
    line : int, optional
        Which line of a map, counted from 0 across `direction`; the middle one by default.
    channel : str or int, optional
        Name of the channel, or its number from 1, of an instrument file that has several of
        heights; of a text with several columns of heights, title or number of the column.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.
    step : float, optional
        Distance between points [m], of a file with one column of heights or an array.
    reader : {"auto", "text", "instrument"}, optional
        How to read the file; "auto" goes by its content.
    z_axis : {"up", "down"}, optional
        Which way the numbers of the height column count; "down" turns depths over. By default up,
        with a doubt where the title says depth.
    """
    checks.one_of("direction", direction, ("x", "y"))
    file = _checked_path(path, x_unit, z_unit, reader)
    steps = _steps(step, x_unit)
    as_text = is_text_surface(file, reader)
    points = file.suffix.lower() in POINT_SUFFIXES and is_text_surface(file)
    if points and _holds_three_columns(file):
        surface = read_map(file, x_unit=x_unit, z_unit=z_unit, step=steps)
        field = HeightField(surface.z, surface.x, surface.y)
    elif as_text:
        spacing = None if steps is None else steps[0]
        options: dict[str, Any] = {"x_unit": x_unit, "z_unit": z_unit}
        options |= {"sheet": sheet, "channel": channel}
        profile = text_table.read_once(
            ("profile", file, repr((spacing, options))),
            lambda: read_text_profile(file, **options, step=spacing),
        )
        checks.whole(f"line of {file}", line or 0, least=0, most=0)
        return upwards(profile, z_axis)
    else:
        field = read_instrument_file(
            file, x_unit=x_unit, z_unit=z_unit, channel=channel, step=steps
        )
    if field.y is None and direction != "x":
        raise InputError(f"direction must be 'x' for {file}, which is a single line; got 'y'")
    lines = field.heights.shape[1 if direction == "x" else 0]
    number = lines // 2
    if line is not None:
        number = checks.whole(f"line of {file}", line, least=0, most=lines - 1)
    along = field.x if direction == "x" else field.y
    heights = field.heights[:, number] if direction == "x" else field.heights[number, :]
    name, source = file.stem, str(file)
    if field.y is not None:
        name, source = (line_label(text, number, direction) for text in (name, source))
    with about_file(source):
        whole = Profile(np.asarray(along), heights, name, source, field.reliable)
    return upwards(whole, z_axis)


_AnySurface = TypeVar("_AnySurface", Profile, HeightMap)


def upwards(surface: _AnySurface, z_axis: str | None) -> _AnySurface:
    """Return a surface as read, turned over if its heights count "down"; None is not stated."""
    if z_axis is None:
        return surface
    down = checks.one_of("z_axis", z_axis, ("up", "down")) == "down"
    return replace(surface, z=-surface.z if down else surface.z, doubts=())


def _checked_path(
    path: str | os.PathLike[str], x_unit: str | None, z_unit: str | None, reader: str
) -> Path:
    checks.one_of("reader", reader, ("auto", "text", "instrument"))
    for name, unit in (("x_unit", x_unit), ("z_unit", z_unit)):
        if unit is not None:
            quantity_in_si(1.0, unit, "length", name)
    return text_table.file_path(path)


def _steps(
    step: float | tuple[float, float] | None, x_unit: str | None
) -> tuple[float, float] | None:
    """Return the distances between points along x and y [m]; raise `InputError` for no lengths."""
    if step is None:
        return None
    pair = tuple(step) if isinstance(step, tuple | list) else (step, step)
    if len(pair) != 2:
        raise InputError(
            f"step must be one distance [m], or that along x and y; got {checks.short_repr(step)}"
        )
    x_step, y_step = (checks.positive("step", length, unit="m") for length in pair)
    if x_unit is not None:
        raise InputError(
            f"x_unit must be left out with step, which is in m; got {checks.short_repr(x_unit)}"
        )
    return x_step, y_step


def is_text_surface(path: Path, reader: str = "auto") -> bool:
    """Return whether gripscale reads a file as text: by its content, of .asc by its first line."""
    if reader != "auto":
        return reader == "text"
    if text_table.is_excel(path):
        return not set(text_table.read_sheets(path)) >= _SHEETS_OF_AN_INSTRUMENT
    raw, suffix = text_table.read_bytes(path), path.suffix.lower()
    if not text_table.is_text(raw) or height_grids.named_units(path, raw) is not None:
        return raw.startswith(text_table.OLD_OFFICE)  # which the reader of text names
    return suffix != ".asc" or is_row(text_table.read_text(path).lstrip().partition("\n")[0])


def _holds_three_columns(path: Path) -> bool:
    first = next((text for _, text in text_table.read_lines(path) if is_row(text)), "")
    cells = (cells_of(first, separator) for separator in SEPARATORS)
    return any(is_row_of(row) and len(row) > 2 for row in cells)


def read_map(
    path: str | os.PathLike[str],
    *,
    x_unit: str | None = None,
    z_unit: str | None = None,
    step: float | tuple[float, float] | None = None,
    channel: str | int | None = None,
    reader: str = "auto",
    z_axis: str | None = None,
) -> HeightMap:
    """Read a map of heights from a file.

    Distances and heights are in m, missing heights NaN. The rubber slides along x: `turned` gives
    the map for the other way. Raises `FileError` if the file is missing, unreadable, not understood
    or not a map; the message names path and place. Raises `InputError` if an argument is wrong or
    contradicts the file.

        >>> gs.read_map("map.txt", step=2e-4, z_unit="mm").z.shape
        (64, 64)

    Parameters
    ----------
    path : path-like
        A text or Excel file (.xyz, .dat, .txt, .csv, .tsv, .prn, .asc, .xlsx) with three columns x,
        y and z, or with a table of heights whose rows run along y and whose columns along x; an
        array (.npy), a grid of ESRI (.asc) or a field of Gwyddion (.gsf); triangles (.stl) that are
        a surface seen from above; or a map in any format SurfaceTopography reads, such as .al3d,
        .sur, .opd, .x3p, .sdf, .plu, .datx, .gwy, .npz (needs `gripscale[formats]`).
    x_unit, z_unit, channel, reader, z_axis
        As in `read_profile`.
    step : float or (float, float), optional
        Distance between points [m], along x and y if they differ, for a table or an array, whose
        file has none. The first index of an array (.npy, .npz) runs along x; the columns of a
        table of text do.
    """
    file = _checked_path(path, x_unit, z_unit, reader)
    options: dict[str, Any] = {"x_unit": x_unit, "z_unit": z_unit, "step": _steps(step, x_unit)}

    def read() -> HeightMap:
        if is_text_surface(file, reader):
            return read_text_map(file, **options)
        field = read_instrument_file(file, channel=channel, **options)
        if field.y is None:
            raise FileError(
                f"{file}: expected a map; got a line, which gripscale.read_profile reads"
            )
        with about_file(file):
            return HeightMap(field.x, field.y, field.heights, file.stem, str(file), field.reliable)

    key = "map", file, repr((reader, channel, options))
    return upwards(text_table.read_once(key, read), z_axis)
