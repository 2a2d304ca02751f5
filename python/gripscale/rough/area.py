"""Real contact area from the points in contact, corrected for the grid.

Line: a contact ends between its last closed and the first open point. Near the end of a smooth
contact the gap grows as (distance)^(3/2), so gap^(2/3) at the two nearest open points extrapolates
to zero there, as in `gripscale.theory.periodic_contact`.

Map: counted points overestimate the area by a share of the border. With n_s the number of
neighbouring pairs of points of which one is in contact and one is not,

    A/A_0 = (points in contact - (pi - 1 + ln 2)/24 n_s) / points

V. A. Yastrebov, G. Anciaux & J.-F. Molinari, Tribol. Int. 114 (2017) 161,
doi:10.1016/j.triboint.2017.04.023.

Either way every border is only known to a part of a step, here 0.5 on a line and 0.7 on a map (two
straight borders may both be half a step out), and the points of one straight stretch of border err
together: with m their numbers in each stretch, the error of the fraction is that part times
sqrt(sum m^2) over all points.
"""

from __future__ import annotations

import numpy as np

from gripscale.rough.grid import Array, Mask

_BORDER = (np.pi - 1.0 + np.log(2.0)) / 24.0
_KNOWN_TO = {1: 0.5, 2: 0.7}
"""Where a border is known to be, on lines and maps [steps]."""


def contact_fraction(active: Mask, gap: Array) -> float:
    """Return real over nominal contact area of a periodic line or map [-]."""
    if active.ndim == 1:
        return _fraction_of_line(active, gap)
    border = sum(int((active != np.roll(active, 1, axis=axis)).sum()) for axis in (0, 1))
    return float((active.sum() - _BORDER * border) / active.size)


def border_error(active: Mask) -> float:
    """Return the error of the contact fraction from borders that lie between points [-]."""
    squares = 0
    for axis in range(active.ndim):
        border = np.moveaxis(active != np.roll(active, 1, axis=axis), axis, 0)
        squares += int(border.sum()) if active.ndim == 1 else _squared_stretches(border)
    return float(_KNOWN_TO[active.ndim] * np.sqrt(squares) / active.size)


def _squared_stretches(border: Mask) -> int:
    """Return the sum of the squared lengths of stretches along the last axis."""
    closed = np.pad(border, ((0, 0), (1, 1))).astype(np.int8).reshape(-1)
    turns = np.flatnonzero(np.diff(closed))
    return int(((turns[1::2] - turns[::2]) ** 2).sum())


def _fraction_of_line(active: Mask, gap: Array) -> float:
    points = active.size
    total = float(active.sum())
    for side in (-1, 1):
        last = np.flatnonzero(active & ~np.roll(active, -side))
        near, far = (last + side) % points, (last + 2 * side) % points
        total += float((_beyond(gap[near], gap[far], active[far]) - 0.5).sum())
    return total / points


def _beyond(near: Array, far: Array, closed: Mask) -> Array:
    """Return how far the contact reaches beyond its last closed point [steps, 0 to 1]."""
    here, there = np.maximum(near, 0.0) ** (2.0 / 3.0), np.maximum(far, 0.0) ** (2.0 / 3.0)
    growth = there - here
    fair = ~closed & (growth > 0.0)
    return np.where(fair, np.clip(1.0 - here / np.where(fair, growth, 1.0), 0.0, 1.0), 0.5)
