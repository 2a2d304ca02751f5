"""One scale: a rubber block pressed on, and slid over, one rigid sine wave."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ScaleResult:
    """Contact and friction of one wave, with the evidence for them.

    All lengths in m, pressures in Pa, speeds in m/s, angular frequencies in rad/s.
    """

    wavelength: float
    amplitude: float
    pressure_received: float
    """Mean pressure this wave was given [Pa]."""
    speed: float
    load_time: float
    contact_fraction: float
    """Contact length projected on the mean plane over the wavelength [-]."""
    friction: float
    """Friction coefficient from the contact traction [-]."""
    friction_from_dissipation: float
    """Friction coefficient from the energy lost in the rubber per sliding distance [-]."""
    status: str
    """`converged`, or why the solution is not to be trusted."""
    newton_iterations: int
    residual: float
    """Residual force relative to the applied force [-]."""
    min_stretch: float
    max_stretch: float
    x: Array = field(repr=False)
    """Deformed abscissa of the surface nodes in the frame of the wave (crest at 0) [m]."""
    pressure: Array = field(repr=False)
    """Contact pressure at `x` [Pa], zero out of contact."""
    model: str = "finite_strain"
    """`finite_strain` (the FE block) or `half_plane` (small-strain reference)."""
    deformed_mesh: tuple[Array, Array] | None = field(default=None, repr=False)
    """Deformed node positions (x, z) [m], each (layers, columns + 1), or None."""
    details: dict[str, Any] = field(default_factory=dict, repr=False)
    """Further counts of the solver (load steps, mesh, indentation ...)."""

    @property
    def contact_length(self) -> float:
        """Contact length projected on the mean plane [m]."""
        return self.contact_fraction * self.wavelength

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == "converged"

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures: the discretisation's own error."""
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0
