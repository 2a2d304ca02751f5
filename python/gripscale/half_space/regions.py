"""Regions of a periodic grid: connected points, and whether a region reaches its own image.

A region percolates along an axis if a path within it ends in the next period of that axis. Points
are connected to their neighbours along the axes, not along diagonals.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from gripscale.core.arrays import Mask


@dataclass(frozen=True)
class Regions:
    """Connected regions of a mask."""

    labels: NDArray[np.intp]  # number of the region of each point, from 1; 0 outside the mask
    percolates: Mask  # whether each region percolates, shape (regions, axes)

    def where(self, chosen: Mask) -> Mask:
        """Return the points of the regions that are `chosen`, one truth for each region."""
        return np.asarray(np.append(False, chosen)[self.labels])


def periodic_regions(mask: Mask) -> Regions:
    """Return the regions of a mask on a periodic line or map."""
    if mask.ndim == 1:  # `scipy.ndimage` is slow to import
        starts = mask & ~np.append(False, mask[:-1])
        labels, count = np.cumsum(starts) * mask, int(starts.sum())
    else:
        labels, count = scipy.ndimage.label(mask)
    parts = _Parts(count + 1, mask.ndim)
    for axis in range(mask.ndim):
        first, last = (np.take(labels, end, axis=axis).reshape(-1) for end in (0, -1))
        joined = (first > 0) & (last > 0)
        pairs = np.unique(np.stack([last[joined], first[joined]], axis=1), axis=0)
        for before, after in pairs.tolist():
            parts.join(before, after, axis)
    roots = np.array([parts.root(part)[0] for part in range(count + 1)])
    whole, number = np.unique(roots, return_inverse=True)
    percolates = np.zeros((whole.size, mask.ndim), dtype=bool)
    np.logical_or.at(percolates, number, parts.percolates)
    return Regions(number[labels], percolates[1:])


class _Parts:
    """Parts of one period, joined across its ends: disjoint sets with the periods between parts."""

    def __init__(self, count: int, axes: int) -> None:
        self._parent = list(range(count))
        self._period = np.zeros((count, axes), dtype=int)
        self.percolates = np.zeros((count, axes), dtype=bool)

    def root(self, part: int) -> tuple[int, NDArray[np.intp]]:
        """Return the root of a part, and the period of the part counted from that of the root."""
        period = self._period[part].copy()
        while self._parent[part] != part:
            part = self._parent[part]
            period += self._period[part]
        return part, period

    def join(self, before: int, after: int, axis: int) -> None:
        """Join the part `before` the end of the period along an axis with that `after` it."""
        lower, from_lower = self.root(before)
        upper, from_upper = self.root(after)
        from_lower[axis] += 1
        if lower == upper:
            self.percolates[lower] |= from_lower != from_upper
        else:
            self._parent[upper] = lower
            self._period[upper] = from_lower - from_upper
