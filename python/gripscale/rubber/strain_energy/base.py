"""A strain energy W(I1, I2) of the permanent network, with small-strain shear modulus G.

A law states the slopes of 2 W/G, w1 by I1 and w2 by I2, with w1 + w2 = 1 at rest. Incompressible:

    uniaxial stretch s   P = dW/ds = G (s - s^-2) (w1 + w2/s),   I1 = s^2 + 2/s, I2 = 2 s + s^-2
    simple shear g       T = dW/dg = G g (w1 + w2),              I1 = I2 = 3 + g^2

Source: R. S. Rivlin, Phil. Trans. R. Soc. A 241 (1948) 379, doi:10.1098/rsta.1948.0024.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks

Array = NDArray[np.float64]


@dataclass(frozen=True)
class StrainEnergy(ABC):
    """A law of the permanent network; its dataclass fields are its parameters, all numbers.

    A fit takes G times the law as linear in coefficients c_k [Pa]. Here they are G and G times each
    parameter; a law for which that is not so replaces `basis` and `from_coefficients`.
    """

    kind: ClassVar[str]
    """What case files, fits and the kernel call the law."""

    least_coefficients: ClassVar[tuple[float, ...]]
    """Lower bounds of c_k [Pa]; the first is raised to where a rubber begins."""

    def __post_init__(self) -> None:
        for name, value in self.parameters().items():
            object.__setattr__(self, name, checks.number(name, value))

    @abstractmethod
    def slopes(self, first: Array, second: Array) -> tuple[Array, Array]:
        """Return w1 and w2 [-] at I1 - 3 and I2 - 3, all of one shape."""

    @classmethod
    def basis(cls, stretch: Array) -> list[Array]:
        """Return the uniaxial factor per unit of each c_k over G [-], each like `stretch` [-]."""
        units = np.eye(len(fields(cls)) + 1)[:, 1:]
        plain, *others = (cls._of(unit).uniaxial_factor(stretch) for unit in units)
        return [plain, *(other - plain for other in others)]

    @classmethod
    def from_coefficients(cls, found: Sequence[float]) -> tuple[float, Self]:
        """Return G [Pa] and the law of coefficients c_k [Pa]."""
        shear, *others = found
        return shear, cls._of(other / shear for other in others)

    @classmethod
    def _of(cls, values: Iterable[float]) -> Self:
        names = (field.name for field in fields(cls))
        return cls(**dict(zip(names, values, strict=True)))

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
