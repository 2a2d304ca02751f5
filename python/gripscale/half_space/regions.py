"""Regions of a periodic grid, joined along its axes, and pools of trapped water under a contact.

A region percolates along an axis if a path within it ends in the next period of that axis. Each
pool k keeps its volume V_k at a uniform pressure p_k over its open points chi_k: with p_c of the
contact,

    u = K (p_c + sum_k p_k chi_k),    sum of the gap over chi_k = V_k    or    p_k = 0, sum >= V_k.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

from gripscale.core.arrays import Array, Mask


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


_Index = NDArray[np.intp]
# Replaces values of the points of each pool by their mean.
Averaged = Callable[[NDArray[np.floating]], NDArray[np.floating]]


@dataclass(frozen=True)
class Pools:
    """Pools on the points of a grid, in one row."""

    label: _Index  # number of the pool of each point, from 1; 0 outside
    volume: Array  # sum of the gap of each pool with its water [m]; the first entry is of no pool
    filled: Mask  # which pools are full of water; the others have room left, and no pressure

    def under_pressure(self, active: Mask) -> Mask:
        """Return the open points of filled pools."""
        return np.asarray(self.filled[self.label] & ~active)

    def averaging(self, where: _Index, active: Mask) -> tuple[Averaged, Array]:
        """Return what averages values at points over their pools, and the pools' mean gaps [m]."""
        label = np.where(active[where], 0, self.label[where])
        count = np.maximum(np.bincount(label, minlength=self.volume.size), 1)
        pooled = np.flatnonzero(label)

        def averaged(values: NDArray[np.floating]) -> NDArray[np.floating]:
            means = np.bincount(label, values, self.volume.size) / count
            out = values.copy()
            out[pooled] = means[label[pooled]]
            return out

        return averaged, np.where(label > 0, (self.volume / count)[label], 0.0)

    def pressures(self, pressure: Array, active: Mask) -> Array:
        """Return the pressure of each pool [Pa], zero of one without open points."""
        opened = self.under_pressure(active)
        label = self.label[opened]
        count = np.maximum(np.bincount(label, minlength=self.volume.size), 1)
        return np.asarray(np.bincount(label, pressure[opened], self.volume.size) / count)

    def capacity(self, gap: Array, active: Mask) -> Array:
        """Return the sum of the open gap of each pool [m]."""
        room = np.where(active, 0.0, np.maximum(gap, 0.0))
        return np.asarray(np.bincount(self.label, room, self.volume.size))

    def refilled(self, pressure: Array, gap: Array, active: Mask) -> Pools:
        """Return the pools without suction, and filled where the gap is smaller than the water."""
        suction = self.pressures(pressure, active) < 0.0
        short = self.capacity(gap, active) < self.volume * (1.0 - 1e-9)
        filled = np.where(self.filled, ~suction, short)
        filled[0] = False
        return Pools(self.label, self.volume, filled)
