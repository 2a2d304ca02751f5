"""Strain energies of the permanent network, all with the same small-strain shear modulus G.

    neo-Hookean    W = G/2 (I1 - 3)
    Mooney-Rivlin  W = G/2 ((1 - s) (I1 - 3) + s (I2 - 3))
    Yeoh           W = G/2 ((I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3)

Sources: M. Mooney, J. Appl. Phys. 11 (1940) 582; R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948)
379; O. H. Yeoh, Rubber Chem. Technol. 66 (1993) 754. The temporary networks stay neo-Hookean.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError

Array = NDArray[np.float64]


@dataclass(frozen=True)
class NeoHookean:
    """Gaussian network: energy in the first invariant alone."""

    def coefficients(self) -> tuple[str, float, float]:
        """Return the name and two coefficients that the kernel asks for."""
        return ("neo_hookean", 0.0, 0.0)

    def uniaxial_factor(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress over G (s - s^-2), incompressible, at `stretch` [-]."""
        return np.ones_like(np.asarray(stretch, dtype=float))


@dataclass(frozen=True)
class MooneyRivlin:
    """Energy linear in both invariants.

    Parameters
    ----------
    share : float
        Share s of the second invariant in the shear modulus, 0 to 1 [-].
    """

    share: float

    def __post_init__(self) -> None:
        share = checks.not_negative("share", self.share)
        if share > 1.0:
            raise InputError(f"share must be at most 1; got {share:g}")

    def coefficients(self) -> tuple[str, float, float]:
        """Return the name and two coefficients that the kernel asks for."""
        return ("mooney_rivlin", float(self.share), 0.0)

    def uniaxial_factor(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress over G (s - s^-2): (1 - s) + s/stretch (Rivlin 1948)."""
        value = np.asarray(stretch, dtype=float)
        return (1.0 - self.share) + self.share / value


@dataclass(frozen=True)
class Yeoh:
    """Cubic in the first invariant; `second` softens (negative) and `third` stiffens (positive).

    Parameters
    ----------
    second, third : float
        c2 and c3, the coefficients of (I1 - 3)^2 and (I1 - 3)^3 over G/2 [-].
    """

    second: float
    third: float

    def __post_init__(self) -> None:
        checks.number("second", self.second)
        checks.number("third", self.third)

    def coefficients(self) -> tuple[str, float, float]:
        """Return the name and two coefficients that the kernel asks for."""
        return ("yeoh", float(self.second), float(self.third))

    def uniaxial_factor(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress over G (s - s^-2): 1 + 2 c2 (I1-3) + 3 c3 (I1-3)^2."""
        value = np.asarray(stretch, dtype=float)
        strain = value**2 + 2.0 / value - 3.0
        return np.asarray(1.0 + 2.0 * self.second * strain + 3.0 * self.third * strain**2)


StrainEnergy = NeoHookean | MooneyRivlin | Yeoh
