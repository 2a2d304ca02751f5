"""A shear stress that tells the temperature in the contact of any model's answer.

With tau_f = s T, s = 1 Pa/K, the area term is

    mu = s T A_r/(A_0 p)        so that        T = mu p A_0/(s A_r)

the mean over the real contact area. Laws are fitted to answers made with it: an answer then does
not depend on the law, and serves all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class TemperatureProbe:
    """A shear stress of 1 Pa for each kelvin; none where the temperature is not known."""

    kind: ClassVar[str] = "temperature_probe"

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return T in K as a stress [Pa], shape of the speeds [m/s] and temperatures [K]."""
        kelvin = 0.0 if temperature is None else np.asarray(temperature, dtype=float)
        return np.asarray(np.zeros(np.shape(speed)) + kelvin)


def probed_temperature(friction: float, contact_fraction: float, pressure: float) -> float:
    """Return the temperature in the contact [K] of the probe's friction [-], NaN if not known."""
    kelvin = friction * pressure / contact_fraction if contact_fraction > 0.0 else 0.0
    return kelvin if kelvin > 0.0 else float("nan")
