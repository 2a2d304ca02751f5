"""Yeoh's network, W = G/2 ((I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3).

Source: O. H. Yeoh, Rubber Chem. Technol. 66 (1993) 754, doi:10.5254/1.3538343.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.rubber.strain_energy.base import Array, StrainEnergy


@dataclass(frozen=True)
class Yeoh(StrainEnergy):
    """Cubic in the first invariant; `second` softens (negative) and `third` stiffens (positive).

    Parameters
    ----------
    second, third : float
        c2 and c3, the coefficients of (I1 - 3)^2 and (I1 - 3)^3 over G/2 [-].

    Raises
    ------
    InputError
        If one is not a finite number.
    """

    second: float
    third: float

    kind: ClassVar[str] = "yeoh"
    least_coefficients: ClassVar[tuple[float, ...]] = (0.0, -np.inf, 0.0)

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 + 2 c2 (I1 - 3) + 3 c3 (I1 - 3)^2 and w2 = 0 [-] at I1 - 3 and I2 - 3."""
        w1 = 1.0 + 2.0 * self.second * first + 3.0 * self.third * first**2
        return w1, np.zeros_like(second)
