"""Measured friction made up from a known law beside a stand-in for the hysteresis."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from gripscale.interface import GaussianStress, InterfacialShearStress
from gripscale.measured import MeasuredFriction, Predicted

TRUE = GaussianStress(5e6, 0.15, 0.02, 0.9, 293.15)
TRUTH = {"stress_0": 5e6, "width": 0.15, "speed_0": 0.02, "activation_energy": 0.9}
SPREAD = 0.02
PRESSURE = 3e5
SPEEDS = np.geomspace(1e-4, 1.0, 9)
TEMPERATURES = (278.15, 293.15, 313.15)


def hysteresis(speed: NDArray[np.float64], temperature: NDArray[np.float64]) -> Predicted:
    """Return a bell of friction and an area that falls with speed, both shifted by temperature."""
    moved = np.log10(speed) - 0.08 * (temperature - 293.15)
    return Predicted(
        0.1 + 0.3 * np.exp(-0.1 * (moved - 1.0) ** 2),
        0.03 * 10.0 ** (-0.08 * moved),
        np.full(speed.size, PRESSURE),
        temperature,
    )


def measurement(
    law: InterfacialShearStress = TRUE,
    seed: int | None = 0,
    *,
    stated: bool = True,
    speeds: NDArray[np.float64] = SPEEDS,
    temperatures: tuple[float, ...] = TEMPERATURES,
) -> tuple[MeasuredFriction, Predicted]:
    """Return friction measured at every speed and temperature, and the hysteresis beside it.

    With noise of `SPREAD` drawn from `seed`, none without one; the spread `stated` or not.
    """
    kelvin, speed = (grid.ravel() for grid in np.meshgrid(temperatures, speeds, indexing="ij"))
    order = np.argsort(speed, kind="stable")
    speed, kelvin = speed[order], kelvin[order]
    predicted = hysteresis(speed, kelvin)
    noise = 0.0 if seed is None else np.random.default_rng(seed).normal(0.0, SPREAD, speed.size)
    friction = predicted.friction + predicted.area_term(law, speed) + noise
    spread = np.full(speed.size, SPREAD) if stated else None
    return MeasuredFriction(speed, friction, spread, kelvin), predicted
