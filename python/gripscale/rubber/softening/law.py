"""What every law of strain softening looks like.

    E'(w) -> f(e) E'(w),      E''(w) -> g(e) E''(w)

with e the amplitude of a uniaxial strain. A shear strain of amplitude s stores as much energy in an
incompressible solid as e = s / sqrt(3): G s^2 = E e^2.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

Deformation = Literal["tension", "shear"]
UNIAXIAL_OF_SHEAR = 1.0 / np.sqrt(3.0)


@dataclass(frozen=True)
class SofteningFactors:
    """What is left of both moduli at some strains, arrays of one shape."""

    storage: Array
    """f(e), of E' [-]."""
    loss: Array
    """g(e), of E'' [-]."""
    outside: NDArray[np.bool_]
    """Where the strain (or the temperature) lies beyond what was measured, the ends held."""


@runtime_checkable
class SofteningLaw(Protocol):
    """Factors of both moduli against the strain; a frozen dataclass of plain numbers."""

    @property
    def kind(self) -> str:
        """Word for it in case files and results."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        One at and below the strain at which the rubber's moduli were measured.
        """

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters as plain values."""
