"""The even grid that the distances in a column of a text file stand on, rows left out or not."""

from __future__ import annotations

import numpy as np

from gripscale.errors import FileError
from gripscale.surface.grid import FloatArray, Grid, even_grid, uneven_step
from gripscale.textfile import TextTable

MOST_LEFT_OUT = 0.5
"""Share of the points of a grid that a file may leave out: beyond it, it is hardly a grid."""


def printed_grid(
    table: TextTable, column: int, distances: FloatArray, lines: list[int] | None = None
) -> Grid:
    """Return the grid of increasing `distances` as printed in a column.

    `lines` are the lines of a profile they stand in; a map repeats its distances in many.

    Raises
    ------
    FileError
        If the steps are not equal, or more than half the points are left out.
    """
    grid = even_grid(distances, table.resolution(column))
    hint = "" if lines is None else "; gripscale.surface.resample makes steps equal"
    if grid is None:
        at = uneven_step(distances)
        one, other = (f"{distances[i]:.9g}" for i in (at, at + 1))
        if lines is None:
            place, found = f"{table.path}", f"{one} then {other}"
        else:
            place = f"{table.path}, line {lines[at + 1]}"
            found = f"{one} (line {lines[at]}) then {other}"
        raise FileError(
            f"{place}: expected distances in column {column + 1} that increase in equal steps; "
            f"got {found}, where {np.median(np.diff(distances)):.6g} is usual{hint}"
        )
    if grid.left_out > MOST_LEFT_OUT * grid.size:
        raise FileError(
            f"{table.path}: expected a distance in column {column + 1} at half the points of an "
            f"even grid or more; got {grid.place.size} of {grid.size} in steps of "
            f"{grid.step:.6g}{hint}"
        )
    return grid
