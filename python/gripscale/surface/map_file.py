"""Read maps from files: text by gripscale itself, instrument formats by an extra."""

from __future__ import annotations

import os
from pathlib import Path

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.surface.height_map import HeightMap
from gripscale.surface.instrument_file import read_instrument_file
from gripscale.surface.read import TEXT_SUFFIXES, file_place, is_text
from gripscale.surface.text_map import read_text_map

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
            f"x_unit must be left out with step, which is in m; got {checks.shown(x_unit)}"
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
            f"step must be one distance [m], or that along x and y; got {checks.shown(step)}"
        )
    along, across = (checks.positive("step", value, unit="m") for value in pair)
    return along, across
