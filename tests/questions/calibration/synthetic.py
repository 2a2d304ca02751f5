"""Measured friction made up from a known law beside a stand-in for the hysteresis."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.conditions import GaussianStress, InterfacialShearStress
from gripscale.experiment import MeasuredFriction
from gripscale.questions import Calibration, Predicted, fit_area_term

Array = NDArray[np.float64]

TRUTH = {"stress_0": 5e6, "width": 0.15, "speed_0": 0.02, "activation_energy": 0.9}
REFERENCE = {"reference_temperature": 293.15}
TRUE = GaussianStress(**TRUTH, **REFERENCE)
SPEEDS = np.geomspace(1e-4, 1.0, 9)
TEMPERATURES = (278.15, 293.15, 313.15)


def hysteresis(speed: Array, temperature: Array) -> Predicted:
    """Return a bell of friction and an area that falls with speed, both shifted by temperature."""
    moved = np.log10(speed) - 0.08 * (temperature - 293.15)
    friction = 0.1 + 0.3 * np.exp(-0.1 * (moved - 1.0) ** 2)
    return Predicted(
        friction, 0.03 * 10.0 ** (-0.08 * moved), np.full(speed.size, 3e5), temperature
    )


def measurement(
    law: InterfacialShearStress = TRUE,
    seed: int | None = 0,
    *,
    stated: bool = True,
    speeds: Array = SPEEDS,
    temperatures: tuple[float, ...] = TEMPERATURES,
) -> tuple[MeasuredFriction, Predicted]:
    """Return friction measured at every speed and temperature, and the hysteresis beside it.

    With noise drawn from `seed`, none without one; its spread, 0.01 and 0.06 in turn, is `stated`
    or else 0.02 throughout and not.
    """
    speed, kelvin = (grid.ravel() for grid in np.meshgrid(speeds, temperatures, indexing="ij"))
    predicted = hysteresis(speed, kelvin)
    spread = (
        np.where(np.arange(speed.size) % 2, 0.06, 0.01) if stated else np.full(speed.size, 0.02)
    )
    noise = 0.0 if seed is None else np.random.default_rng(seed).normal(0.0, spread)
    friction = predicted.friction + predicted.area_term(law, speed) + noise
    return MeasuredFriction(speed, friction, spread if stated else None, kelvin), predicted


def fitted(measured: MeasuredFriction, predicted: Predicted, **options: Any) -> Calibration:
    """Return the fit of a law to the measurement."""
    return Calibration(fit_area_term(measured, predicted, **options))
