"""Isihara's network, W = G/2 ((1 - s) (I1 - 3) + s (I2 - 3) + c2 (I1 - 3)^2).

Source: A. Isihara, N. Hashitsume & M. Tatibana, J. Chem. Phys. 19 (1951) 1508.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.errors import InputError
from gripscale.rubber.strain_energy.base import Array, StrainEnergy


@dataclass(frozen=True)
class Isihara(StrainEnergy):
    """Linear in both invariants, with a quadratic term in the first.

    Parameters
    ----------
    share : float
        Share s of the second invariant in the shear modulus, 0 to 1 [-].
    second : float
        c2, the coefficient of (I1 - 3)^2 over G/2 [-].
    """

    share: float
    second: float

    kind: ClassVar[str] = "isihara"
    least_coefficients: ClassVar[tuple[float, ...]] = (0.0, 0.0, -np.inf)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.0 <= self.share <= 1.0:
            raise InputError(f"share must be from 0 to 1; got {self.share:g}")

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 - s + 2 c2 (I1 - 3) and w2 = s."""
        w1 = 1.0 - self.share + 2.0 * self.second * first
        return w1, np.full_like(second, self.share)

    @classmethod
    def basis(cls, stretch: Array) -> list[Array]:
        """Return the factors of c = G (1 - s), G s, G c2."""
        one, other = (cls(share, 0.0).uniaxial_factor(stretch) for share in (0.0, 1.0))
        return [one, other, cls(0.0, 1.0).uniaxial_factor(stretch) - one]

    @classmethod
    def from_coefficients(cls, found: Sequence[float]) -> tuple[float, Isihara]:
        """Return G = c1 + c2 and the law of s = c2/G and c3/G."""
        shear = found[0] + found[1]
        return shear, cls(found[1] / shear, found[2] / shear)
