"""Kraus' law of the Payne effect.

    G'(s)  = G'_inf + (G'_0 - G'_inf) / (1 + (s/s_c)^(2m))
    G''(s) = G''_inf + 2 (G''_m - G''_inf) (s/s_c)^m / (1 + (s/s_c)^(2m))

Source: G. Kraus, J. Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984) 75. The exponent m is about 0.5
for carbon black.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.softening.law import (
    UNIAXIAL_OF_SHEAR,
    Array,
    Deformation,
    SofteningFactors,
)


@dataclass(frozen=True)
class Kraus:
    """Kraus' law, its parameters as ratios, in the strain of the sweep they were fitted to.

    Parameters
    ----------
    storage_ratio : float
        G'_inf / G'_0 [-], above zero, at most one.
    loss_ratio : float
        G''_inf / G''_m [-], above zero, at most one.
    critical_strain : float
        s_c, where half of the storage modulus that breaks is broken [-].
    measured_at : float
        Strain amplitude at which the master curve was measured [-]: both factors are one there.
    exponent : float
        m [-].
    deformation : "tension" or "shear"
        Kind of both strains.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    kind: ClassVar[str] = "kraus"

    storage_ratio: float
    loss_ratio: float
    critical_strain: float
    measured_at: float
    deformation: Deformation
    exponent: float = 0.5

    def __post_init__(self) -> None:
        for name in ("storage_ratio", "loss_ratio", "critical_strain", "measured_at", "exponent"):
            object.__setattr__(self, name, checks.positive(name, getattr(self, name)))
        for name in ("storage_ratio", "loss_ratio"):
            if getattr(self, name) > 1.0:
                raise InputError(f"{name} must not exceed 1; got {getattr(self, name):g}")
        checks.one_of("deformation", self.deformation, ["tension", "shear"])

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-], at any temperature."""
        own = np.asarray(strain, dtype=float)
        if self.deformation == "shear":
            own = own / UNIAXIAL_OF_SHEAR
        own = np.maximum(own, self.measured_at)
        at = np.full(own.shape, self.measured_at)
        return SofteningFactors(
            storage=self._storage(own) / self._storage(at),
            loss=self._loss(own) / self._loss(at),
            outside=np.zeros(own.shape, dtype=bool),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **self.__dict__}

    def _storage(self, strain: Array) -> Array:
        left = 1.0 / (1.0 + (strain / self.critical_strain) ** (2.0 * self.exponent))
        return np.asarray(self.storage_ratio + (1.0 - self.storage_ratio) * left)

    def _loss(self, strain: Array) -> Array:
        power = (strain / self.critical_strain) ** self.exponent
        peak = 2.0 * power / (1.0 + power**2)
        return np.asarray(self.loss_ratio + (1.0 - self.loss_ratio) * peak)
