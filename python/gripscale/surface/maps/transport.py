"""Moving values to a wanted distribution, over all of them or class by class of another value.

The optimal transport in one dimension keeps the order: the value of rank r goes to the wanted
quantile of rank r (C. Villani, Topics in Optimal Transportation (2003), sec. 2.2).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.surface.profile import FloatArray

_TAIL = np.geomspace(2e-5, 4e-3, 12)
RANKS = np.concatenate((_TAIL, np.linspace(5e-3, 1.0 - 5e-3, 500), 1.0 - _TAIL[::-1]))
"""Of the quantiles a distribution is kept as."""

CLASS_ENDS = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.94, 0.97, 0.99])
"""Ranks between the classes: finer at the top, which touches."""

CLASSES = CLASS_ENDS.size + 1

_NODES = 2**12
"""Between lowest and highest value, where ranks are counted: sorting a map would take ten times."""

_NARROWEST = 1e-30

ClassArray = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Distribution:
    """Quantiles at `RANKS`, one row for each class of the values beside (one row: of all)."""

    quantiles: FloatArray

    @staticmethod
    def of(values: FloatArray, beside: FloatArray | None = None) -> Distribution:
        """Return the distribution of values, by class of those `beside` if given."""
        if beside is None:
            return Distribution(_quantiles(values)[None, :])
        classes = height_class(beside)
        rows = [_quantiles(values[classes == number]) for number in range(CLASSES)]
        return Distribution(np.stack(rows))

    def correction(self, values: FloatArray, beside: FloatArray | None = None) -> FloatArray:
        """Return what has to be added to values (any shape) for them to have this distribution.

        Exact to the distance of the nodes, 1/4096 of their range.
        """
        nodes, places = _counted(values)
        cells = places
        if beside is not None:
            cells = places + np.int32(_NODES) * height_class(beside).astype(np.int32)
        counts = np.bincount(cells.reshape(-1), minlength=self.quantiles.shape[0] * _NODES)
        ranks = _ranks(counts.reshape(-1, _NODES))
        wanted = [np.interp(r, RANKS, q) for r, q in zip(ranks, self.quantiles, strict=True)]
        table = (np.stack(wanted) - nodes).astype(values.dtype)
        return np.asarray(table.reshape(-1)[cells])


def height_class(values: FloatArray) -> ClassArray:
    """Return the class of each value by its rank."""
    _, places = _counted(values)
    ranks = _ranks(np.bincount(places.reshape(-1), minlength=_NODES))
    return np.asarray(np.searchsorted(CLASS_ENDS, ranks).astype(np.uint8)[places])


def _quantiles(values: FloatArray) -> FloatArray:
    ordered = np.sort(values, axis=None)
    return np.interp(RANKS * ordered.size - 0.5, np.arange(ordered.size), ordered)


def _counted(values: FloatArray) -> tuple[FloatArray, NDArray[np.int32]]:
    """Return nodes from the lowest to the highest value, and the nearest to each value."""
    low, high = float(values.min()), float(values.max())
    scale = (_NODES - 1) / max(high - low, _NARROWEST)
    places = (values - low) * scale + 0.5
    return np.linspace(low, high, _NODES), np.asarray(places.astype(np.int32))


def _ranks(counts: NDArray[np.int64]) -> FloatArray:
    """Return the rank of the middle of each node's values, along the last axis."""
    total = np.maximum(counts.sum(axis=-1, keepdims=True), 1)
    return np.asarray((np.cumsum(counts, axis=-1) - 0.5 * counts) / total)
