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

from gripscale.errors import FileError, InputError
from gripscale.surface.length_unit import length_unit
from gripscale.surface.missing_code import without_codes
from gripscale.surface.printed_grid import printed_grid
from gripscale.surface.profile import FEWEST_POINTS, TURNED_ROUND, FloatArray, Profile
from gripscale.textfile import TextTable, read_table
from gripscale.units import in_si

DISTANCE_TITLE = re.compile(r"^\W*(x\b|x_|dist|pos|length|lateral)", re.IGNORECASE)
HEIGHT_TITLE = re.compile(r"^\W*(z\b|z_|height|depth|elev|relative.height|profile)", re.IGNORECASE)


def read_text_profile(
    path: Path, *, x_unit: str | None, z_unit: str | None, sheet: str | int | None = None
) -> Profile:
    """Read a profile from a text or Excel file with a distance and a height column.

    Parameters
    ----------
    path : pathlib.Path
        The file, by the rules of `gripscale.textfile`.
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
    x_column, z_column = _columns(table)
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
        f"{table.titles or 'not at all'}"
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


def _on_grid(
    table: TextTable, column: int, x: FloatArray, z: FloatArray
) -> tuple[FloatArray, FloatArray, tuple[str, ...]]:
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
