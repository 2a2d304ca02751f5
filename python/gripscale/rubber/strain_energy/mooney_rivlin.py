"""Mooney and Rivlin's network, W = G/2 ((1 - s) (I1 - 3) + s (I2 - 3)).

Sources: M. Mooney, J. Appl. Phys. 11 (1940) 582, doi:10.1063/1.1712836; R. S. Rivlin, Phil. Trans.
R. Soc. A 241 (1948) 379, doi:10.1098/rsta.1948.0024.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from gripscale.errors import InputError
from gripscale.rubber.strain_energy.base import Array, StrainEnergy


@dataclass(frozen=True)
class MooneyRivlin(StrainEnergy):
    """Energy linear in both invariants.

    Parameters
    ----------
    share : float
        Share s of the second invariant in the shear modulus, 0 to 1 [-].
    """

    share: float

    kind: ClassVar[str] = "mooney_rivlin"
    least_coefficients: ClassVar[tuple[float, ...]] = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.0 <= self.share <= 1.0:
            raise InputError(f"share must be from 0 to 1; got {self.share:g}")

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 - s and w2 = s."""
        return np.full_like(first, 1.0 - self.share), np.full_like(second, self.share)

    @classmethod
    def basis(cls, stretch: Array) -> list[Array]:
        """Return the factors of c = G (1 - s), G s."""
        return [cls(share).uniaxial_factor(stretch) for share in (0.0, 1.0)]

    @classmethod
    def from_coefficients(cls, found: Sequence[float]) -> tuple[float, MooneyRivlin]:
        """Return G = c1 + c2 and the law of s = c2/G."""
        shear = sum(found)
        return shear, cls(found[1] / shear)
