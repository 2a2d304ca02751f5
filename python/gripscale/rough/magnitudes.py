"""What the solver can hold: sizes whose products stay within single precision, 1e-38 to 1e38.

Its iterations are started and conditioned in single precision. The limits are far from any rubber
and any surface; beyond them a number has the wrong unit.
"""

from __future__ import annotations

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rough.half_space import HalfSpace
from gripscale.rough.heights import PeriodicHeights
from gripscale.rubber import Rubber

LEAST, MOST = 1e-12, 1e15
"""Of pressures [Pa] and lengths [m]."""


def half_space(rubber: Rubber, speed: float) -> HalfSpace:
    """Return the rubber at a speed [m/s], or raise `InputError`."""
    if not isinstance(rubber, Rubber):
        raise InputError(f"rubber must be a Rubber; got {type(rubber).__name__}")
    return HalfSpace(rubber, checks.not_negative("speed", speed, unit="m/s"))


def check_magnitudes(body: HalfSpace, heights: PeriodicHeights, pressure: float) -> None:
    """Raise `InputError` for what is too large or too small to be calculated with."""
    grid = heights.grid
    _within("the step of the surface", min(grid.spacing), "m")
    _within("the length of the surface", max(grid.lengths), "m")
    tallest = float(np.abs(heights.on(grid.shape)).max())
    if not tallest <= max(grid.lengths):
        raise InputError(
            "the heights of the surface must stay below its length, "
            f"{max(grid.lengths):.4g} m; got {tallest:.4g} m over the mean"
        )
    _within("pressure", pressure, "Pa")
    frequency = body.speed * float(grid.along.max())
    if frequency > MOST:
        raise InputError(
            f"speed must be at most {MOST / grid.along.max():.3g} m/s, {MOST:g} rad/s on the "
            f"smallest wave of this surface; got {body.speed:g} m/s"
        )
    modulus = np.abs(body.modulus(grid))
    for extreme in (modulus.min(), modulus.max()):
        _within("the modulus of the rubber", float(extreme), "Pa")


def _within(name: str, value: float, unit: str) -> None:
    if not LEAST <= value <= MOST:
        raise InputError(f"{name} must be from {LEAST:g} to {MOST:g} {unit}; got {value:g}")
