"""A map from a text file: a table of heights, or points with their two distances and their height.

A table is an image: its rows run along y, its columns along x, and the steps are not in it. Points
(x, y, z) may come in any order; those left out, single or whole lines, and those that hold a code
such as -9999 are missing heights.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.errors import FileError, InputError
from gripscale.surface.height_map import HeightMap
from gripscale.surface.length_unit import length_unit
from gripscale.surface.missing_code import without_codes
from gripscale.surface.printed_grid import printed_grid
from gripscale.surface.profile import FEWEST_POINTS, FloatArray
from gripscale.surface.text_profile import DISTANCE_TITLE, HEIGHT_TITLE, column_unit
from gripscale.textfile import TextTable, read_table
from gripscale.units import in_si

_MOST_TIMES = 100
"""Points of a grid, in those of a file: with fewer on it, they are not on a grid."""

_ACROSS_TITLE = re.compile(r"^\W*(y\b|y_)", re.IGNORECASE)


def read_text_map(
    path: Path, *, x_unit: str | None, z_unit: str | None, step: tuple[float, float] | None
) -> HeightMap:
    """Read a map from a text file.

    Parameters
    ----------
    path : pathlib.Path
        The file, by the rules of `gripscale.textfile`.
    x_unit, z_unit : str or None
        Units of distance and height where the titles do not name them.
    step : (float, float) or None
        Steps of a table along x and y [m].

    Raises
    ------
    FileError
        If the file cannot be read or understood; the message names the line where it can.
    InputError
        If an argument is unknown or contradicts the file.
    """
    titles = (DISTANCE_TITLE, _ACROSS_TITLE, HEIGHT_TITLE)
    table = read_table(
        path,
        "rows of heights, or of x, y and z",
        kinds=("length",),
        named=lambda name: any(title.match(name) for title in titles),
    )
    columns = _columns(table)
    if columns is None:
        x, y, z = _table(table, z_unit, step)
    elif step is not None:
        raise InputError(f"step must be left out; {path} states where its points are")
    else:
        x, y, z = _points(table, columns, x_unit, z_unit)
    try:
        return HeightMap(x, y, z, name=path.stem, source=str(path))
    except InputError as error:
        raise FileError(f"{path}: {error}") from error


def _columns(table: TextTable) -> tuple[int, int, int] | None:
    """Return the columns of x, y and z, or None for a table of heights."""
    titled = [
        [i for i, name in enumerate(table.names) if title.match(name)]
        for title in (DISTANCE_TITLE, _ACROSS_TITLE, HEIGHT_TITLE)
    ]
    if all(len(found) == 1 for found in titled):
        x, y, z = (found[0] for found in titled)
        return x, y, z
    count = len(table.columns)
    if count == 3:
        return 0, 1, 2
    if count >= FEWEST_POINTS:
        return None
    line = "; a line of two columns is for gripscale.read_profile" if count == 2 else ""
    raise FileError(
        f"{table.path}, line {table.line_numbers[0]}: expected three columns, x, y and z, or a "
        f"table of heights with at least {FEWEST_POINTS}; got {count}{line}"
    )


def _table(
    table: TextTable, z_unit: str | None, step: tuple[float, float] | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    if step is None:
        raise FileError(
            f"{table.path}: a table of heights has no steps; give step, that along x and that "
            "along y [m], or reader 'instrument' for a header that states them"
        )
    z_unit = length_unit(table.path, "the table", None, "z_unit", z_unit)
    z = np.array(
        [
            table.numbers(column, f"a height in column {column + 1}", missing=True)
            for column in range(len(table.columns))
        ]
    )
    z, _ = without_codes(z)
    x, y = (d * np.arange(n) for n, d in zip(z.shape, step, strict=True))
    return x, y, in_si(z, z_unit, "length")


def _points(
    table: TextTable, columns: tuple[int, int, int], x_unit: str | None, z_unit: str | None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    units = [
        column_unit(table, column, name, given)
        for column, name, given in zip(
            columns, ("x_unit", "x_unit", "z_unit"), (x_unit, x_unit, z_unit), strict=True
        )
    ]
    (x, across_x), (y, across_y) = (_axis(table, column) for column in columns[:2])
    printed = table.numbers(columns[2], f"a number in column {columns[2] + 1}", missing=True)
    heights, _ = without_codes(printed)
    if x.size * y.size > _MOST_TIMES * len(heights):
        raise FileError(
            f"{table.path}: expected points on a grid; got {len(heights)} on one of {x.size} x "
            f"{y.size}"
        )
    place = across_x * y.size + across_y
    _check_single(table, place)
    z = np.full(x.size * y.size, np.nan)
    z[place] = heights
    x, y, z = (in_si(v, unit, "length") for v, unit in zip((x, y, z), units, strict=True))
    return x, y, z.reshape(x.size, y.size)


def _axis(table: TextTable, column: int) -> tuple[FloatArray, np.ndarray]:
    """Return all distances of the grid of a column, and which of them each row has."""
    printed = table.numbers(column, f"a distance in column {column + 1}")
    distances, which = np.unique(printed, return_inverse=True)
    if distances.size < FEWEST_POINTS:
        raise FileError(
            f"{table.path}: expected a map of at least {FEWEST_POINTS} points a way; got "
            f"{distances.size} distances in column {column + 1}"
        )
    grid = printed_grid(table, column, distances)
    return grid.points(distances), grid.place[which]


def _check_single(table: TextTable, place: np.ndarray) -> None:
    """Refuse a point that stands twice."""
    order = np.argsort(place, kind="stable")
    again = np.flatnonzero(np.diff(place[order]) == 0)
    if again.size:
        first, second = (table.line_numbers[order[again[0] + i]] for i in (0, 1))
        raise FileError(
            f"{table.path}, line {second}: expected each point once; got that of line {first} again"
        )
