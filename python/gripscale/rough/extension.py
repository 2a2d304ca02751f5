"""The gap carried a little beyond the contact, where the pressure has to vanish.

The pressure p that closes a gap r at the points A in contact lifts the surface outside A by K p as
well. Were that known, S = 1/K of the whole displacement would be p at once. Of an elastic body

    (S u)(x)  ~  sum_y (u(x) - u(y)) / |x - y|^(d+1),    d = 1 on a line, 2 on a map

(the half Laplacian: M. Kwasnicki, Fract. Calc. Appl. Anal. 20 (2017) 7, def. 2.7,
doi:10.1515/fca-2017-0002), which is zero outside A: u there is the mean of the others with these
weights. Kept are the points of A at most two steps away along each axis; points outside A count
as u(x) itself and all that is farther as zero with a weight of 0.3, the best of 0 to 3 measured on
elastic and lossy rubbers.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy.sparse
from numpy.typing import NDArray

from gripscale.rough.grid import Mask

Index = NDArray[np.intp]

REACH = 1
"""Steps along each axis."""
FAR = 2.0
"""Weight of what is farther, that of a neighbour being one."""


@dataclass(frozen=True)
class Extension:
    """Points around a contact and what a gap is carried there by."""

    around: Index
    """As indices of the flattened grid."""
    weights: scipy.sparse.csr_array
    """From the points in contact, in single precision, shape (around, in contact)."""

    @classmethod
    def of(cls, active: Mask) -> Extension:
        """Return the extension from the points `active` of a periodic grid."""
        around = np.flatnonzero(_near(active) & ~active)
        touching = np.flatnonzero(active)
        order = np.full(active.size, -1, dtype=np.int32)
        order[touching] = np.arange(len(touching), dtype=np.int32)
        rows, columns, weights = [], [], []
        for step, other in _neighbours(around, active.shape):
            column = order[other]
            row = np.flatnonzero(column >= 0).astype(np.int32)
            rows.append(row)
            columns.append(column[row])
            weights.append(np.full(len(row), _weight(step), dtype=np.float32))
        row, weight = np.concatenate(rows), np.concatenate(weights)
        total = np.bincount(row, weight, len(around)) + FAR
        weight /= total[row].astype(np.float32)
        shape = len(around), len(touching)
        entries = weight, (row, np.concatenate(columns))
        return cls(around, scipy.sparse.csr_array(entries, shape=shape))


def _neighbours(around: Index, shape: tuple[int, ...]) -> Iterator[tuple[tuple[int, ...], Index]]:
    """Yield each step and where it leads from the points `around` of a periodic grid."""
    place = np.unravel_index(around, shape)
    steps = range(-REACH, REACH + 1)
    moved = [[(axis + by) % n for by in steps] for axis, n in zip(place, shape, strict=True)]
    for step in itertools.product(steps, repeat=len(shape)):
        if any(step):
            other = np.zeros_like(around)
            for n, axis, by in zip(shape, moved, step, strict=True):
                other = other * n + axis[by + REACH]
            yield step, other


def _near(active: Mask) -> Mask:
    """Return the points at most `REACH` steps along each axis from an active one."""
    near = active
    for axis in range(active.ndim):
        moved = [np.roll(near, by, axis) for by in range(-REACH, REACH + 1) if by]
        near = near | np.logical_or.reduce(moved)
    return near


def _weight(step: tuple[int, ...]) -> float:
    square = sum(by * by for by in step)
    return float(square ** (-0.5 * (len(step) + 1)))
