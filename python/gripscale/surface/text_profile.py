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
from gripscale.surface.length_unit import length_unit
from gripscale.surface.profile import FEWEST_POINTS, FloatArray, Profile, uneven_step
from gripscale.textfile import TextTable, read_table
from gripscale.units import in_si

DISTANCE_TITLE = re.compile(r"^\W*(x\b|x_|dist|pos|length|lateral)", re.IGNORECASE)
HEIGHT_TITLE = re.compile(r"^\W*(z\b|z_|height|depth|elev|relative.height|profile)", re.IGNORECASE)


def read_text_profile(path: Path, *, x_unit: str | None, z_unit: str | None) -> Profile:
    """Read a profile from a text file with a distance and a height column.

    Parameters
    ----------
    path : pathlib.Path
        The file, by the rules of `gripscale.textfile`.
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
    table = read_table(
        path,
        "rows with two columns of numbers",
        kinds=("length",),
        named=lambda name: bool(DISTANCE_TITLE.match(name) or HEIGHT_TITLE.match(name)),
    )
    x_column, z_column = _columns(table)
    x_unit = column_unit(table, x_column, "x_unit", x_unit)
    z_unit = column_unit(table, z_column, "z_unit", z_unit)
    x = table.numbers(x_column, f"a distance in column {x_column + 1}")
    z = table.numbers(z_column, f"a number in column {z_column + 1}", missing=True)
    _check_complete(path, z)
    x = _equidistant(table, x_column, x)
    x, z = in_si(x, x_unit, "length"), in_si(z, z_unit, "length")
    try:
        return Profile(x, z, name=path.stem, source=str(path))
    except InputError as error:
        raise FileError(f"{path}: {error}") from error


def _columns(table: TextTable) -> tuple[int, int]:
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
        f"{table.names or 'not at all'}"
    )


def column_unit(table: TextTable, column: int, name: str, given: str | None) -> str:
    """Return the unit of a column: that of its title, or the one given for argument `name`."""
    part, stated = f"column {column + 1}", table.columns[column].unit
    how = "write it in the title, such as 'x [mm]', or give"
    return length_unit(table.path, part, stated, name, given, how=how)


def _check_complete(path: Path, z: FloatArray) -> None:
    if z.size < FEWEST_POINTS:
        raise FileError(f"{path}: expected at least {FEWEST_POINTS} points; got {z.size}")
    if np.isnan(z).all():
        raise FileError(f"{path}: expected heights; got {z.size} points, all missing")


def _equidistant(table: TextTable, column: int, x: FloatArray) -> FloatArray:
    even = unrounded(x, table.resolution(column))
    if even is not None:
        return even
    at, step = uneven_step(x), (x[-1] - x[0]) / (x.size - 1)
    if at is not None:
        first, second = table.line_numbers[at], table.line_numbers[at + 1]
        raise FileError(
            f"{table.path}, line {second}: expected distances that increase in equal steps of "
            f"{step:.6g}; got {x[at]:.9g} (line {first}) then {x[at + 1]:.9g}"
        )
    return x


def unrounded(x: FloatArray, resolution: float) -> FloatArray | None:
    """Undo the rounding of printed distances: x_i = x_0 + i (x_N - x_0)/N.

    A distance printed to a resolution q stands within q/2 of the true one, so both the point and
    the line through the end points are uncertain: departures up to q are rounding. Returns None
    where anything goes beyond: a step that truly differs, or too coarse a resolution.
    """
    even = np.linspace(x[0], x[-1], x.size)
    step = (x[-1] - x[0]) / (x.size - 1)
    rounded = np.abs(x - even).max() <= 1.01 * resolution and resolution <= 0.5 * step
    return even if rounded and (np.diff(x) > 0.0).all() else None
