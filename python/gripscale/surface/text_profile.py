"""A profile from a text file: two columns with units, or the CAPTIF laser profilometer's layout.

The CAPTIF stationary laser profilometer writes point number, distance and height, parted by tabs,
below a line "*****DATA*****" and a title line that names millimetres. Its point numbers are not
consecutive (they jump and repeat where scans are joined), while the distance column runs on at a
constant step printed to three decimals: the step is therefore taken from the distance column.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.errors import FileError, InputError
from gripscale.surface.profile import FEWEST_POINTS, FloatArray, Profile, uneven_step
from gripscale.surface.text_table import (
    TextTable,
    parse_number,
    printed_resolution,
    read_table,
)
from gripscale.surface.units import metres_per, unit_in_title

_DISTANCE_TITLE = re.compile(r"^\W*(x\b|x_|dist|pos|length|lateral)", re.IGNORECASE)
_HEIGHT_TITLE = re.compile(r"^\W*(z\b|z_|height|depth|elev|relative.height|profile)", re.IGNORECASE)


def read_text_profile(path: Path, *, x_unit: str | None, z_unit: str | None) -> Profile:
    """Read a profile from a text file with a distance and a height column.

    Parameters
    ----------
    path : pathlib.Path
        The file: cells parted by tab, semicolon, comma or blanks; decimal point or comma.
    x_unit, z_unit : str or None
        Units of distance and height where the column titles do not name them.

    Returns
    -------
    Profile
        Distances [m] at the mean step of the distance column, heights [m].

    Raises
    ------
    FileError
        If the file cannot be read or understood; the message names the line.
    InputError
        If a unit is unknown or contradicts the file.
    """
    table = read_table(path)
    x_column, z_column = _columns(path, table)
    x_size = _metres(path, table, x_column, "x_unit", x_unit)
    z_size = _metres(path, table, z_column, "z_unit", z_unit)
    x = _numbers(path, table, x_column)
    z = _numbers(path, table, z_column)
    _check_complete(path, table, x, z)
    x = _equidistant(path, table, x_column, x)
    try:
        return Profile(x * x_size, z * z_size, name=path.stem, source=str(path))
    except InputError as error:
        raise FileError(f"{path}: {error}") from error


def _columns(path: Path, table: TextTable) -> tuple[int, int]:
    """Return which column is distance and which is height."""
    columns = len(table.rows[0])
    distance = [i for i, title in enumerate(table.titles) if _DISTANCE_TITLE.match(title)]
    height = [i for i, title in enumerate(table.titles) if _HEIGHT_TITLE.match(title)]
    if len(distance) == 1 and len(height) == 1:
        return distance[0], height[0]
    if columns == 2:
        return 0, 1
    raise FileError(
        f"{path}, line {table.line_numbers[0]}: expected two columns, distance and height, or "
        f"titles that name them; got {columns} columns titled {table.titles or 'not at all'}"
    )


def _metres(path: Path, table: TextTable, column: int, name: str, given: str | None) -> float:
    """Return the size in metres of a column's unit, named by its title or else by the caller."""
    size = None if given is None else metres_per(given, name)
    found, unknown = unit_in_title(table.titles[column]) if table.titles else (None, None)
    if unknown and size is None:
        raise FileError(
            f"{path}: column {column + 1} is in {unknown!r}, which is no known unit of length"
        )
    if found is None and size is None:
        raise FileError(
            f"{path}: column {column + 1} names no unit; write it in the title, such as "
            f"'x [mm]', or give {name}"
        )
    if found is not None and size is not None and metres_per(found) != size:
        raise InputError(f"{name} is {given!r}, but {path} says {found!r}; give one of them")
    return size if size is not None else metres_per(str(found))


def _numbers(path: Path, table: TextTable, column: int) -> FloatArray:
    values = [parse_number(row[column]) for row in table.rows]
    for number, row, value in zip(table.line_numbers, table.rows, values, strict=True):
        if value is None:
            raise FileError(
                f"{path}, line {number}: expected a number in column {column + 1}; "
                f"got {row[column]!r}"
            )
    return np.array(values, dtype=float)


def _check_complete(path: Path, table: TextTable, x: FloatArray, z: FloatArray) -> None:
    if x.size < FEWEST_POINTS:
        raise FileError(f"{path}: expected at least {FEWEST_POINTS} points; got {x.size}")
    if np.isnan(x).any():
        number = table.line_numbers[int(np.argmax(np.isnan(x)))]
        raise FileError(f"{path}, line {number}: expected a distance; got a missing value")
    if np.isnan(z).all():
        raise FileError(f"{path}: expected heights; got {z.size} points, all missing")


def _equidistant(path: Path, table: TextTable, column: int, x: FloatArray) -> FloatArray:
    """Undo the rounding of printed distances: x_i = x_0 + i (x_N - x_0)/N.

    A distance printed to a resolution q stands within q/2 of the true one, so both the point and
    the line through the end points are uncertain: departures up to q are rounding. Anything
    beyond is a step that truly differs, which is an error.
    """
    even = np.linspace(x[0], x[-1], x.size)
    step = (x[-1] - x[0]) / (x.size - 1)
    resolution = printed_resolution([row[column] for row in table.rows])
    rounded = np.abs(x - even).max() <= 1.01 * resolution and resolution <= 0.5 * step
    if rounded and (np.diff(x) > 0.0).all():
        return even
    at = uneven_step(x)
    if at is not None:
        first, second = table.line_numbers[at], table.line_numbers[at + 1]
        raise FileError(
            f"{path}, line {second}: expected distances that increase in equal steps of "
            f"{step:.6g}; got {x[at]:.9g} (line {first}) then {x[at + 1]:.9g}"
        )
    return x
