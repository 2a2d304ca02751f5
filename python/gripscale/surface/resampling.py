"""Heights at unequal steps, put on equal ones by straight lines between neighbours.

    z(x) = z_i + (z_(i+1) - z_i) (x - x_i) / (x_(i+1) - x_i),   x_i <= x <= x_(i+1)

Its error is at most h^2 max|z''| / 8 over a distance h of neighbours (C. de Boor, A Practical Guide
to Splines (1978), ch. III): of a sine of wavelength L, 5 (h/L)^2 of its amplitude.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import FileError, InputError
from gripscale.io.text_table import TextTable
from gripscale.surface.profile import (
    CARRIED_STEPS,
    FEWEST_POINTS,
    MOST_POINTS,
    TURNED_ROUND,
    FloatArray,
    Grid,
    Profile,
    even_grid,
    uneven_step,
)

LONGEST_BRIDGE = 2.0
"""Longest distance of neighbours that is bridged by default, in usual distances or new steps."""


def resample(
    x: ArrayLike,
    z: ArrayLike,
    step: float,
    *,
    bridge: float | None = None,
    name: str = "",
    source: str = "",
) -> Profile:
    """Return a profile with equal steps from heights at unequal ones.

    Heights are taken between neighbours, not averaged: with a step longer than those measured,
    roughness shorter than two new steps is folded into longer wavelengths.

    Parameters
    ----------
    x : array_like, shape (points,)
        Distance along the line [m], rising throughout or falling throughout.
    z : array_like, shape (points,)
        Height [m]; NaN where it is missing.
    step : float
        Distance of neighbours in the profile [m].
    bridge : float, optional
        Longest distance of neighbours to draw a line over [m]; over a longer one heights are
        missing. Twice the step or twice the median distance by default, whichever is longer.
    name, source : str, optional
        As those of a profile.

    Returns
    -------
    Profile
        From the first distance on, missing where a height is missing on either side. Its
        shortest reliable wavelength is four of the usual distances, if those are the longer ones.

    Raises
    ------
    InputError
        If x or z is not a list of numbers, their lengths differ, x neither rises nor falls
        throughout, `step` or `bridge` is not above zero, or the step gives too few or too many
        points.
    """
    place, height = _rising(x, z)
    even = checks.positive("step", step, unit="m")
    points = int(np.floor((place[-1] - place[0]) / even * (1.0 + 1e-12))) + 1
    if not FEWEST_POINTS <= points <= MOST_POINTS:
        raise InputError(
            f"step must give {FEWEST_POINTS} to {MOST_POINTS} points over "
            f"{place[-1] - place[0]:g} m; {even:g} m gives {points}"
        )
    usual = float(np.median(np.diff(place)))
    longest = LONGEST_BRIDGE * max(usual, even)
    if bridge is not None:
        longest = checks.positive("bridge", bridge, unit="m")
    new = place[0] + even * np.arange(points)
    notes = [
        f"put on steps of {even * 1e3:.4g} mm by straight lines; {usual * 1e3:.4g} mm were usual"
    ]
    if np.asarray(x, dtype=float)[0] > place[0]:
        notes.insert(0, TURNED_ROUND)
    return Profile(
        new,
        _between(place, height, new, longest),
        name,
        source,
        reliable=CARRIED_STEPS * max(usual, even),
        notes=tuple(notes),
    )


def _rising(x: ArrayLike, z: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return distances in rising order and their heights."""
    place = checks.vector("x", x, unit="m")
    height = checks.vector("z", z, unit="m", missing=True)
    if place.size != height.size or place.size < FEWEST_POINTS:
        raise InputError(
            f"x and z must have the same length, at least {FEWEST_POINTS}; "
            f"got {place.size} and {height.size}"
        )
    if place[0] > place[-1]:
        place, height = place[::-1], height[::-1]
    steps = np.diff(place)
    if (steps <= 0.0).any():
        at = int(np.argmax(steps <= 0.0))
        raise InputError(
            f"x must rise or fall from point to point throughout; got {place[at]:.9g} m and "
            f"{place[at + 1]:.9g} m side by side"
        )
    return place, height


def _between(place: FloatArray, height: FloatArray, new: FloatArray, longest: float) -> FloatArray:
    """Return heights on the lines between neighbours at most `longest` apart, NaN elsewhere."""
    left = np.clip(np.searchsorted(place, new, side="right") - 1, 0, place.size - 2)
    share = (new - place[left]) / (place[left + 1] - place[left])
    # on a measured point its height alone counts, or a missing neighbour would take it away
    share = np.clip(share, 0.0, 1.0)
    one, other = height[left], height[left + 1]
    z = np.where(share == 0.0, one, np.where(share == 1.0, other, one + share * (other - one)))
    apart = place[left + 1] - place[left] > longest * (1.0 + 1e-9)
    return np.where(apart & (share > 0.0) & (share < 1.0), np.nan, z)


# The even grid that the distances in a column of a text file stand on, rows left out or not.

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


# Heights where none were measured: those of a membrane over the gap.
#
#     (z[i-1, j] - 2 z[i, j] + z[i+1, j]) / dx^2 + (z[i, j-1] - 2 z[i, j] + z[i, j+1]) / dy^2 = 0
#
# at every missing point, the measured heights around it held, without slope across the border of
# the surface: Laplace's equation in five points (R. J. LeVeque, Finite Difference Methods for
# Ordinary and Partial Differential Equations (2007), ch. 3, doi:10.1137/1.9780898717839). On a line
# that is linear interpolation, the nearest height held at the ends. By the maximum principle no
# filled height lies above the highest or below the lowest around its gap: a gap makes no asperity
# of its own.

Mask = NDArray[np.bool_]


def filled(z: FloatArray, steps: tuple[float, ...] = (), *, periodic: bool = False) -> FloatArray:
    """Return heights with none missing.

    Parameters
    ----------
    z : array, shape (points,) or (nx, ny)
        Heights [m], NaN where they are missing; some must be there.
    steps : tuple of float, optional
        Steps of a map along x and y [m]; equal by default, only their ratio counts.
    periodic : bool, optional
        Whether the first point follows the last.
    """
    missing = np.isnan(z)
    if not missing.any():
        return z
    if z.ndim == 1:
        place, known = np.arange(z.size, dtype=float), ~missing
        period = float(z.size) if periodic else None
        line: FloatArray = np.interp(place, place[known], z[known], period=period)
        return line
    result = z.copy()
    result[missing] = _membrane(z, missing, steps or (1.0, 1.0), periodic)
    return result


def _membrane(z: FloatArray, missing: Mask, steps: tuple[float, ...], periodic: bool) -> FloatArray:
    """Return the heights of the missing points, in the order of the array."""
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    places = np.argwhere(missing)
    count = len(places)
    number = np.full(z.shape, -1)
    number[missing] = np.arange(count)
    diagonal, pull = np.zeros(count), np.zeros(count)
    rows, columns, values = [np.arange(count)], [np.arange(count)], [diagonal]
    for axis, step in enumerate(steps):
        weight = (steps[0] / step) ** 2
        for side in (-1, 1):
            row, beside = _neighbours(places, z.shape, axis, side, periodic)
            diagonal[row] += weight
            unknown = number[beside]
            free = unknown >= 0
            pull[row[~free]] += weight * z[beside][~free]
            rows.append(row[free])
            columns.append(unknown[free])
            values.append(np.full(int(free.sum()), -weight))
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    matrix = coo_array(entries, shape=(count, count)).tocsc()
    # symmetric and positive definite: ordered as such, its pivots are on the diagonal
    factors = splu(
        matrix,
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    return np.asarray(factors.solve(pull))


def _neighbours(
    places: NDArray[np.intp], shape: tuple[int, ...], axis: int, side: int, periodic: bool
) -> tuple[NDArray[np.intp], tuple[NDArray[np.intp], ...]]:
    """Return which `places` have a neighbour on a side, and the indices of these neighbours."""
    beside = places.copy()
    beside[:, axis] += side
    if periodic:
        beside[:, axis] %= shape[axis]
    row = np.flatnonzero((beside[:, axis] >= 0) & (beside[:, axis] < shape[axis]))
    return row, tuple(beside[row].T)
