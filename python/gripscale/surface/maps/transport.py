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

_TABLE = 2**13
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
        """Return what has to be added to values (any shape) for them to have this distribution."""
        if beside is None:
            return _moved(values.reshape(-1), self.quantiles[0]).reshape(values.shape)
        classes = height_class(beside).reshape(-1)
        flat, added = values.reshape(-1), np.zeros(values.size, dtype=values.dtype)
        order = np.argsort(classes, kind="stable")
        parts = np.split(order, np.cumsum(np.bincount(classes, minlength=CLASSES))[:-1])
        for part, wanted in zip(parts, self.quantiles, strict=True):
            if part.size:
                added[part] = _moved(flat[part], wanted)
        return added.reshape(values.shape)


def height_class(values: FloatArray) -> ClassArray:
    """Return the class of each value by its rank."""
    ends = np.quantile(values, CLASS_ENDS)
    low, high = float(values.min()), float(values.max())
    table = np.searchsorted(ends, np.linspace(low, high, _TABLE)).astype(np.uint8)
    return np.asarray(table[_places(values, low, high)])


def _quantiles(values: FloatArray) -> FloatArray:
    ordered = np.sort(values, axis=None)
    return np.interp(RANKS * ordered.size - 0.5, np.arange(ordered.size), ordered)


def _moved(values: FloatArray, wanted: FloatArray) -> FloatArray:
    have = _quantiles(values)
    low, high = float(have[0]), float(have[-1])
    nodes = np.linspace(low, high, _TABLE)
    table = (np.interp(nodes, have, wanted) - nodes).astype(values.dtype)
    return np.asarray(table[_places(values, low, high)])


def _places(values: FloatArray, low: float, high: float) -> NDArray[np.int32]:
    """Return the nearest of `_TABLE` nodes from low to high, the ends beyond them."""
    scale = (_TABLE - 1) / max(high - low, _NARROWEST)
    places = np.clip((values - low) * scale, 0.0, _TABLE - 1.0)
    return np.asarray(places.astype(np.int32))
