"""Pools of trapped water under a contact: each keeps its volume at a uniform pressure.

With the pressure p_c of the contact, that of pool k p_k over its open points chi_k, and its volume
V_k,

    u = K (p_c + sum_k p_k chi_k),    sum of the gap over chi_k = V_k    or    p_k = 0, sum >= V_k.

A point of a pool is in contact where the pressure there exceeds that of the pool, which would lift
the rubber otherwise. Volumes are sums of the gap over points [m].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.core.arrays import Array, Mask

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
        """Return what replaces values at the points `where` by the means of their pools.

        And the mean gap of the pool of each point [m], zero in contact.
        """
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
