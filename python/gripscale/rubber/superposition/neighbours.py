"""How far two neighbouring sweeps are apart on log f: a start for all of them, and how they meet.

Each sweep is taken as straight lines between its rows in log-log axes, and the difference of the
two is read at the rows of both within the overlap. The start is the largest likelihood of the
difference where the scatter of each modulus is unknown: the least sum of the logarithms of its mean
squares.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from gripscale.rubber.superposition.rows import Array, Rows
from gripscale.units import ZERO_CELSIUS

_STEP = 0.02
"""Steps of the shifts that are tried [decades]."""
_BACK = 0.5
"""How far a colder sweep may seem to be faster [decades]: by scatter on a plateau."""
_LEAST_SHARE = 0.1
"""Least overlap that is tried, over the shorter of the two sweeps."""

Points = tuple[Array, Array]
"""x of shape (rows,) rising, y of shape (moduli, rows)."""


@dataclass(frozen=True)
class Overlap:
    """How two neighbouring sweeps meet, once shifted."""

    colder: float
    """Temperature of the colder sweep [K]."""
    warmer: float
    """Temperature of the warmer one [K]."""
    decades: float
    """Width of the overlap [decades of frequency]; below zero the width of the gap."""
    rows: int
    """Rows of both within the overlap."""
    storage: float
    """Root mean square distance of log10 E' in the overlap [decades]; NaN without one."""
    loss: float
    """The same of log10 E''."""
    loss_factor: float
    """The same of log10 E''/E'."""

    def __str__(self) -> str:
        """Return the overlap in words."""
        pair = f"{self.colder - ZERO_CELSIUS:.1f} and {self.warmer - ZERO_CELSIUS:.1f} °C"
        return f"{pair}: {self.decades:.2f} decades"


def start(rows: Rows, lifted: bool) -> tuple[Array, Array]:
    """Return log10 a and log10 b of each sweep against the warmest, pair by pair."""
    noise = np.array([_roughness(rows, at) for at in range(len(rows.y))])
    steps = [
        _apart(rows.of(colder), rows.of(colder + 1), noise, rows.lifts if lifted else None)
        for colder in range(rows.sweeps - 1)
    ]
    pairs = np.array([*steps, (0.0, 0.0)])
    total = np.cumsum(pairs[::-1], axis=0)[::-1]
    return total[:, 0], total[:, 1]


def no_common_modulus(cold: Points, warm: Points, noise: float) -> bool:
    """Return whether E' of two sweeps, their first modulus, has no value in common."""
    return bool(warm[1][0].max() + 3.0 * noise < cold[1][0].min())


def difference(cold: Points, warm: Points) -> Array:
    """Return y of the colder sweep less the warmer at the rows of both in the overlap.

    Shape (moduli, rows).
    """
    low, high = max(cold[0][0], warm[0][0]), min(cold[0][-1], warm[0][-1])
    x = np.concatenate([cold[0], warm[0]])
    x = x[(x >= low - 1e-12) & (x <= high + 1e-12)]
    return np.array(
        [
            np.interp(x, cold[0], one) - np.interp(x, warm[0], other)
            for one, other in zip(cold[1], warm[1], strict=True)
        ]
    )


def overlap_width(cold: Array, warm: Array) -> float:
    """Return the width of the overlap of two rising x [decades]; below zero that of the gap."""
    return float(min(cold[-1], warm[-1]) - max(cold[0], warm[0]))


def _apart(cold: Points, warm: Points, noise: Array, lifts: Array | None) -> tuple[float, float]:
    """Return by how much the colder sweep is to be shifted against the warmer one."""
    spans = np.ptp(cold[0]), np.ptp(warm[0])
    furthest = cold[0][-1] - warm[0][0]
    least = _LEAST_SHARE * min(spans)
    shifts = np.arange(-_BACK, max(warm[0][-1] - cold[0][0] - least, 0.0) + _STEP, _STEP)
    best, least_cost = (0.0, 0.0), math.inf
    for shift in shifts[shifts > -furthest]:
        apart = difference((cold[0] + shift, cold[1]), warm)
        if apart.shape[1] < 2:
            continue
        lift = 0.0 if lifts is None else _lift(apart, noise, lifts)
        left = apart + (0.0 if lifts is None else lift * lifts[:, None])
        cost = float(np.log((left**2).mean(axis=1) + noise**2).sum())
        if cost < least_cost:
            best, least_cost = (float(shift), lift), cost
    return best


def _lift(apart: Array, noise: Array, lifts: Array) -> float:
    weight = lifts / noise**2
    return -float(weight @ apart.mean(axis=1) / weight.sum()) if weight.any() else 0.0


def _roughness(rows: Rows, modulus: int) -> float:
    """Return the scatter of a modulus from row to row [decades], at least 0.002 (half a per cent).

    From the distance of each row to the straight line between its neighbours.
    """
    found = []
    for sweep in range(rows.sweeps):
        x, y = rows.of(sweep)
        if len(x) < 3:
            continue
        run = np.maximum(x[2:] - x[:-2], 1e-12)
        share = (x[1:-1] - x[:-2]) / run
        middle = y[modulus, 1:-1] - (1.0 - share) * y[modulus, :-2] - share * y[modulus, 2:]
        found.append(middle / np.sqrt(1.0 + share**2 + (1.0 - share) ** 2))
    return max(float(1.4826 * np.median(np.abs(np.concatenate(found)))), 2e-3) if found else 2e-3
