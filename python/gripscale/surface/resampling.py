"""Heights where none were measured: equal steps and filled gaps.

Between unequal steps by straight lines between neighbours; in gaps by a membrane, Laplace's
equation in five points, so that a gap makes no asperity of its own: docs/derivations.md.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, FileError, InputError, Quantity, checks
from gripscale.io.text_table import TextTable
from gripscale.surface import profile

# Longest distance of neighbours that is bridged by default, in usual distances or new steps.
_LONGEST_BRIDGE = 2.0


def resample(
    x: ArrayLike,
    z: ArrayLike,
    step: Quantity,
    *,
    bridge: float | None = None,
    name: str = "",
    source: str = "",
) -> profile.Profile:
    """Return a profile with equal steps from heights at unequal ones.

    Heights are interpolated between neighbours, not averaged: with a step longer than the measured
    ones, roughness shorter than two new steps is folded into longer wavelengths.

    The profile begins at the first distance. A height is missing where one is missing on either
    side. Its shortest reliable wavelength is four new steps or four median distances, the longer
    ones. Raises `InputError` if x or z is not a list of numbers, their lengths differ, x neither
    rises nor falls throughout, `step` or `bridge` is not above zero, or the step gives too few or
    too many points.

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
        Name and source of the profile.
    """
    old, height = checks.vector("x", x, unit="m"), checks.vector("z", z, unit="m", missing=True)
    checks.same_length(profile.FEWEST_POINTS, x=old, z=height)
    falling = old[0] > old[-1]
    if falling:
        old, height = old[::-1], height[::-1]
    distances = np.diff(old)
    if (distances <= 0.0).any():
        at = int(np.argmax(distances <= 0.0))
        raise InputError(
            f"x must rise or fall from point to point throughout; got {old[at]:.9g} m and "
            f"{old[at + 1]:.9g} m side by side"
        )
    even = checks.positive("step", step, unit="m")
    points = int(np.floor((old[-1] - old[0]) / even * (1.0 + 1e-12))) + 1
    if not profile.FEWEST_POINTS <= points <= profile.MOST_PROFILE_POINTS:
        raise InputError(
            f"step must give {profile.FEWEST_POINTS} to {profile.MOST_PROFILE_POINTS} points over "
            f"{old[-1] - old[0]:g} m; {even:g} m gives {points}"
        )
    usual = float(np.median(distances))
    longest = _LONGEST_BRIDGE * max(usual, even)
    if bridge is not None:
        longest = checks.positive("bridge", bridge, unit="m")
    new = old[0] + even * np.arange(points)
    before = np.clip(np.searchsorted(old, new, side="right") - 1, 0, old.size - 2)
    low, high = height[before], height[before + 1]
    share = np.clip((new - old[before]) / (old[before + 1] - old[before]), 0.0, 1.0)
    # at a measured point only its own height counts: a missing neighbour would make it missing
    between = np.where(share == 1.0, high, low + share * (high - low))
    between = np.where(share == 0.0, low, between)
    apart = old[before + 1] - old[before] > longest * (1.0 + 1e-9)
    between = np.where(apart & (share > 0.0) & (share < 1.0), np.nan, between)
    note = f"put on steps of {even * 1e3:.4g} mm by straight lines; {usual * 1e3:.4g} mm were usual"
    notes = (profile.TURNED_ROUND, note) if falling else (note,)
    reliable = profile.RESOLVED_STEPS * max(usual, even)
    return profile.Profile(new, between, name, source, reliable, notes)


_MOST_LEFT_OUT = 0.5  # largest share of the points of a grid that a file may leave out


def printed_grid(
    table: TextTable, column: int, distances: Array, lines: list[int] | None = None
) -> profile.EvenGrid:
    """Return the even grid of increasing `distances` printed in a column, some rows left out.

    `lines` are the line numbers of a profile's rows; a map repeats its distances in many lines.
    """
    grid = profile.even_grid(distances, table.resolution(column))
    if grid is not None and grid.left_out <= _MOST_LEFT_OUT * grid.size:
        return grid
    where, steps, at = str(table.path), np.diff(distances), profile.uneven_step(distances)
    first, second = (f"{distances[i]:.9g}" for i in (at, at + 1))
    if grid is None and lines is not None:
        where, first = f"{where}, line {lines[at + 1]}", f"{first} (line {lines[at]})"
    if grid is not None:
        problem = (
            f"a distance in column {column + 1} at half the points of an even grid or more; got "
            f"{grid.number.size} of {grid.size} in steps of {grid.step:.6g}"
            f"{'' if lines else ': scattered points are to be put on a grid first'}"
        )
    elif lines is not None and steps[at] == 0.0:
        again = int((steps == 0.0).sum())
        rows = "this row" if again == 1 else f"the {again} rows that repeat the one above"
        problem = f"each distance in column {column + 1} once; got {first} again: take out {rows}"
    else:
        problem = (
            f"distances in column {column + 1} that increase in equal steps; got {first} then "
            f"{second}, where {np.median(steps):.6g} is usual"
        )
    refusal = FileError(f"{where}: expected {problem}")
    refusal.see = "" if lines is None else "docs/inputs.md#a-measured-profile"
    raise refusal


def without_line(rows: Array) -> Array:
    """Return rows of heights at equal steps, each without its least-squares line."""
    x = np.linspace(-1.0, 1.0, rows.shape[-1])
    slope = rows @ x / (x @ x)
    return np.asarray(rows - rows.mean(axis=-1, keepdims=True) - slope[..., None] * x)


def fill_gaps(z: Array, steps: tuple[float, ...] = (), *, periodic: bool = False) -> Array:
    """Return heights [m], shape (points,) or (nx, ny), with all gaps (NaN) filled.

    Of the `steps` of a map along x and y only the ratio counts. The first point follows the last if
    `periodic`.
    """
    missing = np.isnan(z)
    if not missing.any():
        return z
    if z.ndim == 1:
        index, valid = np.arange(z.size, dtype=float), ~missing
        period = float(z.size) if periodic else None
        line: Array = np.interp(index, index[valid], z[valid], period=period)
        return line
    from scipy.sparse import coo_array
    from scipy.sparse.linalg import splu

    steps = steps or (1.0, 1.0)
    gaps = np.argwhere(missing)
    count = len(gaps)
    number = np.full(z.shape, -1)
    number[missing] = np.arange(count)
    diagonal, pull = np.zeros(count), np.zeros(count)
    rows, columns, values = [np.arange(count)], [np.arange(count)], [diagonal]
    for axis, step in enumerate(steps):
        weight = (steps[0] / step) ** 2
        for side in (-1, 1):
            neighbour = gaps.copy()
            neighbour[:, axis] += side
            if periodic:
                neighbour[:, axis] %= z.shape[axis]
            row = np.flatnonzero((neighbour[:, axis] >= 0) & (neighbour[:, axis] < z.shape[axis]))
            at = tuple(neighbour[row].T)
            diagonal[row] += weight
            unknown = number[at]
            free = unknown >= 0
            pull[row[~free]] += weight * z[at][~free]
            rows.append(row[free])
            columns.append(unknown[free])
            values.append(np.full(int(free.sum()), -weight))
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    # symmetric and positive definite: ordered as such, its pivots are on the diagonal
    factors = splu(
        coo_array(entries, shape=(count, count)).tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )
    result = z.copy()
    result[missing] = factors.solve(pull)
    return result


def fill_gaps_smoothly(z: Array) -> Array:
    """Return heights [m], shape (points,), with gaps (NaN) filled by cubics without a kink.

    The cubics are monotone (F. N. Fritsch & R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238,
    doi:10.1137/0717021), so that a gap makes no asperity here either; `fill_gaps` draws a straight
    line. At the ends the nearest height holds.
    """
    from scipy.interpolate import PchipInterpolator

    valid = np.flatnonzero(np.isfinite(z))
    if valid.size < 2 or valid.size == z.size:
        return fill_gaps(z)
    at = np.clip(np.arange(z.size), valid[0], valid[-1])
    return np.where(np.isnan(z), PchipInterpolator(valid, z[valid])(at), z)
