"""What a law of the area term is fitted to: measured friction less the hysteresis, and its weight.

mu_i - mu_hysteresis,i = tau_f(v_i, T_i) A_r,i / (A_0 p_i)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.errors import InputError
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.predicted import Predicted

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Points:
    """Measured points with an answer of the model, arrays of shape (n,)."""

    speed: Array
    """[m/s]."""
    temperature: Array | None
    """In the contact [K]; None where nobody knows it."""
    difference: Array
    """Measured friction less that of the hysteresis [-]."""
    leverage: Array
    """A_r/(A_0 p) [1/Pa]."""
    spread: Array | None
    """Of the measured friction [-]; None where none is stated."""

    @property
    def temperature_range(self) -> float:
        """Largest less smallest temperature in the contact [K]; zero where it is not known."""
        return 0.0 if self.temperature is None else float(np.ptp(self.temperature))

    @property
    def stress(self) -> Array:
        """The shear stress each point asks for by itself [Pa]."""
        return self.difference / self.leverage

    def only(self, chosen: Mask) -> Points:
        """Return some of the points."""
        return Points(
            self.speed[chosen],
            None if self.temperature is None else self.temperature[chosen],
            self.difference[chosen],
            self.leverage[chosen],
            None if self.spread is None else self.spread[chosen],
        )


def points_of(measured: MeasuredFriction, predicted: Predicted) -> Points:
    """Return the points that have an answer, in the order of the measurement.

    Raises
    ------
    InputError
        If no point has an answer, a prediction has another number of points, spreads or
        temperatures are known of some points only, a spread is zero, or the hysteresis alone
        exceeds what was measured at more than half of the points.
    """
    if predicted.friction.size != measured.speed.size:
        raise InputError(
            f"the {measured.speed.size} points measured need as many predictions; "
            f"got {predicted.friction.size}"
        )
    known = predicted.known
    if not known.any():
        raise InputError(
            f"no measured point has a prediction; the first ended with {predicted.status[0]}"
        )
    difference = (measured.friction - predicted.friction)[known]
    _check_sign(difference)
    return Points(
        measured.speed[known],
        _all_or_none("temperature", predicted.temperature[known]),
        difference,
        predicted.leverage[known],
        _spread(measured.spread[known]),
    )


def _check_sign(difference: Array) -> None:
    below = difference < 0.0
    if 2 * below.sum() > difference.size:
        raise InputError(
            f"the hysteresis alone exceeds the measured friction at {below.sum()} of "
            f"{difference.size} points, by up to {-difference.min():.3g}: the shear stress of an "
            "area term would be negative; expected a hysteresis below what was measured"
        )


def _spread(spread: Array) -> Array | None:
    if (spread == 0.0).any():
        raise InputError(
            "spread must be above zero to weigh a point; got 0: leave it empty if unknown"
        )
    return _all_or_none("spread", spread)


def _all_or_none(name: str, values: Array) -> Array | None:
    """Return values known of all points, None if of none; else raise `InputError`."""
    missing = np.isnan(values)
    if missing.any() and not missing.all():
        raise InputError(
            f"{name} must be known of all points or of none; got it of {(~missing).sum()} of "
            f"{missing.size}"
        )
    return None if missing.all() else values
