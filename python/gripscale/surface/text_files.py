"""A profile from a text file: two columns with units, or the CAPTIF laser profilometer's layout.

The CAPTIF stationary laser profilometer writes point number, distance and height, parted by tabs,
below a line "*****DATA*****" and a title line that names millimetres. Its point numbers are not
consecutive (they jump and repeat where scans are joined), while the distance column runs on at a
constant step printed to three decimals: the step is therefore taken from the distance column.

Rows may run either way, and those without a height may be left out or hold a code such as -9999:
they become missing heights.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import in_si, spelled
from gripscale.io.text_table import TextTable, read_table
from gripscale.surface.profile import FEWEST_POINTS, TURNED_ROUND, HeightMap, Profile
from gripscale.surface.resampling import printed_grid

# Numbers that stand for missing heights in text files, such as -9999, told from heights.
#
# One is taken for such a code only where it is one in use and lies ten times farther from all other
# heights than they lie from each other: no texture has a height like that.

_NINES = [10.0**digits - 1.0 for digits in range(3, 10)]
_WORDS = [2.0**bits - less for bits in (15, 16, 31, 32) for less in (0.0, 1.0)]
CODES = np.array([*_NINES, *_WORDS])
"""Codes in use, but for their sign: nines, and the ends of the whole numbers instruments store."""

BEYOND = 1e30
"""Height, in any unit of length, from which on a number is no height but a code."""

ALONE = 10.0
"""Distance of a code from all heights, in the largest difference of two of them."""


def without_codes(heights: Array) -> tuple[Array, float | None]:
    """Return heights, NaN where one is a code for a missing height, and the code if there is one.

    Parameters
    ----------
    heights : array, of any shape
        Heights as printed, NaN where missing.
    """
    suspect = np.isin(np.abs(heights), CODES) | (np.abs(heights) >= BEYOND)
    codes = np.unique(heights[suspect])
    rest = heights[np.isfinite(heights) & ~suspect]
    if codes.size != 1 or rest.size == 0:
        return heights, None
    code = float(codes[0])
    if np.abs(rest - code).min() <= ALONE * np.ptp(rest):
        return heights, None
    return np.where(suspect, np.nan, heights), code


# The unit of length of a measurement: stated by its file or given by the caller, never guessed.


def length_unit(
    path: Path, part: str, stated: object, name: str, given: str | None, *, how: str = "give"
) -> str:
    """Return the unit of a `part` of a file.

    Parameters
    ----------
    path : pathlib.Path
        The file, and `part` ("column 1") of it, for messages.
    stated : object
        What the file says the unit is.
    name, given : str, str or None
        The argument with the caller's unit.
    how : str
        How to make up for a missing unit, before `name`.

    Raises
    ------
    FileError
        If neither the file nor the caller names a unit of length.
    InputError
        If the caller's unit is unknown or contradicts the file.
    """
    found = spelled(stated, "length")
    if given is not None:
        if found is not None and in_si(1.0, found, "length") != in_si(1.0, given, "length", name):
            raise InputError(f"{name} is {given!r}, but {path} says {found!r}; give one of them")
        return given
    if found is not None:
        return found
    if stated:
        raise FileError(
            f"{path}: {part} is in {checks.short_repr(stated)}, which is no known unit of "
            f"length; give {name}"
        )
    raise FileError(f"{path}: {part} names no unit of length; {how} {name}")


DISTANCE_TITLE = re.compile(r"^\W*(x\b|x_|dist|pos|length|lateral)", re.IGNORECASE)
HEIGHT_TITLE = re.compile(r"^\W*(z\b|z_|height|depth|elev|relative.height|profile)", re.IGNORECASE)


def read_text_profile(
    path: Path, *, x_unit: str | None, z_unit: str | None, sheet: str | int | None = None
) -> Profile:
    """Read a profile from a text or Excel file with a distance and a height column.

    Parameters
    ----------
    path : pathlib.Path
        The file, by the rules of `gripscale.io.text_table`.
    x_unit, z_unit : str or None
        Units of distance and height where the column titles do not name them.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.

    Returns
    -------
    Profile
        Distances [m] at the mean step of the distance column, heights [m]; `notes` say where rows
        were turned round or left out.

    Raises
    ------
    FileError
        If the file cannot be read or understood; the message names the line.
    InputError
        If a unit is unknown or contradicts the file.
    """
    table = read_table(
        path,
        "rows with two columns of numbers",
        kinds=("length",),
        named=lambda name: bool(DISTANCE_TITLE.match(name) or HEIGHT_TITLE.match(name)),
        sheet=sheet,
    )
    x_column, z_column = _profile_columns(table)
    x_unit = column_unit(table, x_column, "x_unit", x_unit)
    z_unit = column_unit(table, z_column, "z_unit", z_unit)
    x = table.numbers(x_column, f"a distance in column {x_column + 1}")
    z = table.numbers(z_column, f"a number in column {z_column + 1}", missing=True)
    _check_complete(path, z)
    z, code = without_codes(z)
    x, z, notes = _on_grid(table, x_column, x, z)
    if code is not None:
        notes += (f"heights of {code:g} {z_unit} stand for missing ones",)
    x, z = in_si(x, x_unit, "length"), in_si(z, z_unit, "length")
    try:
        return Profile(x, z, name=path.stem, source=str(path), notes=notes)
    except InputError as error:
        raise FileError(f"{path}: {error}") from error


def _profile_columns(table: TextTable) -> tuple[int, int]:
    """Return which column is distance and which is height."""
    distance = [i for i, name in enumerate(table.names) if DISTANCE_TITLE.match(name)]
    height = [i for i, name in enumerate(table.names) if HEIGHT_TITLE.match(name)]
    if len(distance) == 1 and len(height) == 1:
        return distance[0], height[0]
    if len(table.columns) == 2:
        return 0, 1
    raise FileError(
        f"{table.path}, line {table.line_numbers[0]}: expected two columns, distance and height, "
        f"or titles that name them; got {len(table.columns)} columns titled "
        f"{table.titles or 'not at all'}"
    )


def column_unit(table: TextTable, column: int, name: str, given: str | None) -> str:
    """Return the unit of a column: that of its title, or the one given for argument `name`."""
    part, stated = f"column {column + 1}", table.columns[column].unit
    how = "write it in the title, such as 'x [mm]', or give"
    return length_unit(table.path, part, stated, name, given, how=how)


def _check_complete(path: Path, z: Array) -> None:
    if z.size < FEWEST_POINTS:
        raise FileError(f"{path}: expected at least {FEWEST_POINTS} points; got {z.size}")
    if np.isnan(z).all():
        raise FileError(f"{path}: expected heights; got {z.size} points, all missing")


def _on_grid(
    table: TextTable, column: int, x: Array, z: Array
) -> tuple[Array, Array, tuple[str, ...]]:
    """Return distances and heights of all points of the even grid, and what was changed for it."""
    lines, notes = table.line_numbers, []
    if x[0] > x[-1]:
        x, z, lines = x[::-1], z[::-1], lines[::-1]
        notes.append(TURNED_ROUND)
    grid = printed_grid(table, column, x, lines)
    if grid.left_out:
        rows = "1 row" if grid.left_out == 1 else f"{grid.left_out} rows"
        notes.append(
            f"{rows} of the even grid not in the file, of {grid.size}: taken as missing heights"
        )
    return grid.points(x), grid.spread(z), tuple(notes)


# A map from a text file: a table of heights, or points with their two distances and their height.
#
# A table is an image: its rows run along y, its columns along x, and the steps are not in it.
# Points (x, y, z) may come in any order; those left out, single or whole lines, and those that hold
# a code such as -9999 are missing heights.

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
        The file, by the rules of `gripscale.io.text_table`.
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
    columns = _map_columns(table)
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


def _map_columns(table: TextTable) -> tuple[int, int, int] | None:
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
) -> tuple[Array, Array, Array]:
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
) -> tuple[Array, Array, Array]:
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


def _axis(table: TextTable, column: int) -> tuple[Array, np.ndarray]:
    """Return all distances of the grid of a column, and which of them each row has."""
    printed = table.numbers(column, f"a distance in column {column + 1}")
    distances, which = np.unique(printed, return_inverse=True)
    if distances.size < FEWEST_POINTS:
        raise FileError(
            f"{table.path}: expected a map of at least {FEWEST_POINTS} points a way; got "
            f"{distances.size} distances in column {column + 1}"
        )
    grid = printed_grid(table, column, distances)
    return grid.points(distances), grid.number[which]


def _check_single(table: TextTable, place: np.ndarray) -> None:
    """Refuse a point that stands twice."""
    order = np.argsort(place, kind="stable")
    again = np.flatnonzero(np.diff(place[order]) == 0)
    if again.size:
        first, second = (table.line_numbers[order[again[0] + i]] for i in (0, 1))
        raise FileError(
            f"{table.path}, line {second}: expected each point once; got that of line {first} again"
        )
