"""Finding rows of a master curve that do not belong to it.

A row is an outlier if its storage or its loss modulus leaves the local trend of its neighbours by
more than `threshold` times the typical scatter, both

- in the data themselves (log-log straight line through the neighbours), and
- in the data divided by a Maxwell fit (so that curvature of a smooth spectrum is no outlier).

The line is the median of pairwise slopes (P. K. Sen, J. Am. Stat. Assoc. 63 (1968) 1379,
doi:10.1080/01621459.1968.10480934); the scatter is 1.4826 times the median distance from it.
The fit alone would not do: measured E' and E'' are often not Kramers-Kronig consistent, and the
joint fit then misses both by more than their scatter.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.rubber.maxwell_fit import Spectrum

Array = NDArray[np.float64]

_NEIGHBOURS = 8
_PASSES = 10
LEAST_SCATTER = 0.02
"""Scatter below this (2 %, a good laboratory) is not believed."""
_FEWEST_ROWS = _NEIGHBOURS + 3


@dataclass(frozen=True)
class Screening:
    """Which rows are kept, and how far each is from its neighbours."""

    kept: NDArray[np.bool_]
    storage_deviation: Array
    """Log deviation of E' from the local trend [-], shape (rows,)."""
    loss_deviation: Array
    """The same of E''."""
    storage_scatter: float
    """Robust relative scatter of E' about its local trend [-]."""
    loss_scatter: float

    @property
    def believed_scatter(self) -> tuple[float, float]:
        """Scatter of E' and E'' [-], at least what a good laboratory has."""
        return max(self.storage_scatter, LEAST_SCATTER), max(self.loss_scatter, LEAST_SCATTER)


def screen(
    omega: Array,
    storage: Array,
    loss: Array,
    fit: Callable[[NDArray[np.bool_]], Spectrum],
    threshold: float,
) -> Screening:
    """Return which rows belong to the curve; `fit` is the Maxwell fit to a choice of rows.

    `omega` [rad/s] ascending, `storage` and `loss` [Pa], all of shape (rows,).
    """
    kept = np.ones(len(omega), dtype=bool)
    position = np.log(omega)
    for _ in range(_PASSES):
        spectrum = fit(kept)
        raw = [
            _deviation(position, np.log(storage), kept),
            _deviation(position, np.log(loss), kept),
        ]
        relative = [
            _deviation(position, _log_ratio(storage, spectrum.storage(omega)), kept),
            _deviation(position, _log_ratio(loss, spectrum.loss(omega)), kept),
        ]
        scores = [
            np.minimum(np.abs(a) / _scatter(a[kept]), np.abs(b) / _scatter(b[kept]))
            for a, b in zip(raw, relative, strict=True)
        ]
        new = np.maximum(scores[0], scores[1]) <= threshold
        if len(omega) < _FEWEST_ROWS or new.sum() < _FEWEST_ROWS or (new == kept).all():
            break
        kept = new
    return Screening(kept, raw[0], raw[1], _spread(raw[0][kept]), _spread(raw[1][kept]))


def _deviation(position: Array, value: Array, kept: NDArray[np.bool_]) -> Array:
    """Return each value minus the straight line through its nearest kept neighbours."""
    result = np.empty_like(value)
    members = np.flatnonzero(kept)
    for row in range(len(value)):
        near = _nearest(members[members != row], row)
        run, rise = position[near] - position[row], value[near]
        result[row] = value[row] - np.median(rise - _median_slope(run, rise) * run)
    return result


def _median_slope(run: Array, rise: Array) -> float:
    """Return the median of all slopes between two points; 0 if all stand at one place."""
    across = run[:, None] - run
    apart = across > 0.0
    return float(np.median((rise[:, None] - rise)[apart] / across[apart])) if apart.any() else 0.0


def _log_ratio(measured: Array, fitted: Array) -> Array:
    """Return log(measured/fitted); a fit may have no loss at all where it is far off."""
    return np.asarray(np.log(measured) - np.log(np.maximum(fitted, checks.LEAST)))


def _nearest(members: NDArray[np.intp], row: int) -> NDArray[np.intp]:
    """Return up to eight members around `row`: half on each side, more where one side ends."""
    split = int(np.searchsorted(members, row))
    start = min(max(split - _NEIGHBOURS // 2, 0), max(len(members) - _NEIGHBOURS, 0))
    return members[start : start + _NEIGHBOURS]


def _spread(deviation: Array) -> float:
    return float(1.4826 * np.median(np.abs(deviation)))


def _scatter(deviation: Array) -> float:
    return max(_spread(deviation), LEAST_SCATTER)
