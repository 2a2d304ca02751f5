"""The Gaussian network, W = G/2 (I1 - 3)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.rubber.strain_energy.base import Array, StrainEnergy


@dataclass(frozen=True)
class NeoHookean(StrainEnergy):
    """Gaussian network: energy in the first invariant alone."""

    kind: ClassVar[str] = "neo_hookean"
    least_coefficients: ClassVar[tuple[float, ...]] = (0.0,)

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 and w2 = 0."""
        return np.ones_like(first), np.zeros_like(second)
