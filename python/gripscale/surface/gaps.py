"""Heights where none were measured: those of a membrane over the gap.

    (z[i-1, j] - 2 z[i, j] + z[i+1, j]) / dx^2 + (z[i, j-1] - 2 z[i, j] + z[i, j+1]) / dy^2 = 0

at every missing point, the measured heights around it held, without slope across the border of the
surface: Laplace's equation in five points (R. J. LeVeque, Finite Difference Methods for Ordinary
and Partial Differential Equations (2007), ch. 3, doi:10.1137/1.9780898717839). On a line that is
linear interpolation, the nearest height held at the ends. By the maximum principle no filled height
lies above the highest or below the lowest around its gap: a gap makes no asperity of its own.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gripscale.surface.profile import FloatArray

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
