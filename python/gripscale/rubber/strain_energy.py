"""A strain energy W(I1, I2) of the permanent network, with small-strain shear modulus G.

A law states the slopes of 2 W/G, w1 by I1 and w2 by I2, with w1 + w2 = 1 at rest. Incompressible:

    uniaxial stretch s   P = dW/ds = G (s - s^-2) (w1 + w2/s),   I1 = s^2 + 2/s, I2 = 2 s + s^-2
    simple shear g       T = dW/dg = G g (w1 + w2),              I1 = I2 = 3 + g^2

Source: R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379, doi:10.1098/rsta.1948.0024. The
temporary networks of the rubber stay neo-Hookean.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import fields
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, checked, checks


class StrainEnergy(Checked, ABC):
    """A law of the permanent network; its dataclass fields are its parameters, all numbers."""

    kind: ClassVar[str]
    """What case files, fits and the kernel call the law."""

    @abstractmethod
    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 and w2 [-] at I1 - 3 and I2 - 3, all of one shape."""

    def parameters(self) -> dict[str, float]:
        """Return the parameters by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    def uniaxial_factor(self, stretch: ArrayLike) -> Array:
        """Return the nominal stress over G (s - s^-2), incompressible, at `stretch` [-]."""
        s = np.asarray(stretch, dtype=float)
        w1, w2 = self.slopes(s**2 + 2.0 / s - 3.0, 2.0 * s + s**-2 - 3.0)
        return np.asarray(w1 + w2 / s)

    def shear_factor(self, shear: ArrayLike) -> Array:
        """Return the stress over G g in simple shear `shear` [-]."""
        strain = np.asarray(shear, dtype=float) ** 2
        w1, w2 = self.slopes(strain, strain)
        return np.asarray(w1 + w2)


class NeoHookean(StrainEnergy):
    """Gaussian network: energy in the first invariant alone.

    W = G/2 (I1 - 3)
    """

    kind: ClassVar[str] = "neo_hookean"

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 and w2 = 0."""
        return np.ones_like(first), np.zeros_like(second)


class MooneyRivlin(StrainEnergy):
    """Energy linear in both invariants.

    W = G/2 ((1 - s) (I1 - 3) + s (I2 - 3)). Sources: M. Mooney, J. Appl. Phys. 11 (1940) 582,
    doi:10.1063/1.1712836; R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379,
    doi:10.1098/rsta.1948.0024.
    """

    share: float = checked(checks.share)
    """Share s of the second invariant in the shear modulus, 0 to 1 [-]."""

    kind: ClassVar[str] = "mooney_rivlin"

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 - s and w2 = s."""
        return np.full_like(first, 1.0 - self.share), np.full_like(second, self.share)


class Yeoh(StrainEnergy):
    """Cubic in the first invariant; `second` softens (negative) and `third` stiffens (positive).

    W = G/2 ((I1 - 3) + c2 (I1 - 3)^2 + c3 (I1 - 3)^3). Source: O. H. Yeoh, Rubber Chem. Technol. 66
    (1993) 754, doi:10.5254/1.3538343.
    """

    second: float = checked(checks.number)
    """Coefficient c2 of (I1 - 3)^2 over G/2 [-]."""
    third: float = checked(checks.number)
    """Coefficient c3 of (I1 - 3)^3 over G/2 [-]."""

    kind: ClassVar[str] = "yeoh"

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 + 2 c2 (I1 - 3) + 3 c3 (I1 - 3)^2 and w2 = 0 [-] at I1 - 3 and I2 - 3."""
        w1 = 1.0 + 2.0 * self.second * first + 3.0 * self.third * first**2
        return w1, np.zeros_like(second)


class Isihara(StrainEnergy):
    """Linear in both invariants, with a quadratic term in the first.

    W = G/2 ((1 - s) (I1 - 3) + s (I2 - 3) + c2 (I1 - 3)^2). Source: A. Isihara, N. Hashitsume & M.
    Tatibana, J. Chem. Phys. 19 (1951) 1508.
    """

    share: float = checked(checks.share)
    """Share s of the second invariant in the shear modulus, 0 to 1 [-]."""
    second: float = checked(checks.number)
    """Coefficient c2 of (I1 - 3)^2 over G/2 [-]."""

    kind: ClassVar[str] = "isihara"

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 = 1 - s + 2 c2 (I1 - 3) and w2 = s."""
        w1 = 1.0 - self.share + 2.0 * self.second * first
        return w1, np.full_like(second, self.share)


class KrausEnergy(StrainEnergy):
    """Softening of filled rubber: the secant modulus of shear s is that of a strain sweep.

    w1 = w(s)/w(0), w = r + (1 - r)/(1 + sqrt(s^2 + a^2)/c), s^2 = I1 - 3. Source: G. Kraus, J.
    Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984) 75, with its exponent 1/2. Not linear in r and
    c, it cannot be fitted to uniaxial tests.
    """

    ratio: float = checked(checks.share)
    """Modulus r at large strain over that at none [-]."""
    critical: float = checked(checks.positive)
    """Shear strain c at which half of what breaks is broken [-]."""
    measured_at: float = checked(checks.positive)
    """Shear strain a below which little softens: that of the measured moduli [-]."""

    kind: ClassVar[str] = "kraus"

    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 at I1 - 3, and w2 = 0."""
        strains = (np.sqrt(i + self.measured_at**2) for i in (np.maximum(first, 0.0), 0.0))
        soft, rest = (self.ratio + (1.0 - self.ratio) / (1.0 + s / self.critical) for s in strains)
        return np.asarray(soft / rest), np.zeros_like(second)


STRAIN_ENERGIES: dict[str, type[StrainEnergy]] = {
    law.kind: law for law in (NeoHookean, MooneyRivlin, Yeoh, Isihara, KrausEnergy)
}
"""Every strain energy by its kind."""


def strain_energy(kind: str, **parameters: float) -> StrainEnergy:
    """Return the strain energy of a `kind`, such as `strain_energy("yeoh", second=..., third=...)`.

    Raises `InputError` if the kind is unknown, or has other parameters.
    """
    return checks.of_kind(STRAIN_ENERGIES, "strain_energy", {"kind": kind, **parameters})
