"""Contact and friction of one wave, with the evidence for them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.rubber import Rubber, extrapolation
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.wave.harmonics import harmonics
from gripscale.wave.status import Status

Array = NDArray[np.float64]

LARGE_MISMATCH = 0.05
"""Relative difference of the two frictions above which a result is in doubt."""


@dataclass(frozen=True)
class WaveResult:
    """Contact and friction of one wave, or of one period of a profile, with the evidence for them.

    All lengths in m, pressures in Pa, speeds in m/s, angular frequencies in rad/s.
    """

    wavelength: float
    """Of the wave; of a profile the period [m]."""
    amplitude: float
    """Of the wave; of a profile half the range of heights [m]."""
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
    status: Status
    """`converged`, or why the solution is not to be trusted."""
    newton_iterations: int
    residual: float
    """Residual force relative to the applied force [-]."""
    min_stretch: float
    max_stretch: float
    x: Array = field(repr=False)
    """Deformed abscissa of the surface nodes in the frame of the wave [m].

    Zero is the crest of a sine, and the first height of a profile.
    """
    pressure: Array = field(repr=False)
    """Contact pressure at `x` [Pa], zero out of contact."""
    rubber: Rubber | None = field(default=None, repr=False, compare=False)
    """The rubber as it was on this wave."""
    model: str = "finite_strain"
    """Name of the solver: `finite_strain` (the block) or `half_plane` (small strain)."""
    deformed_mesh: tuple[Array, Array] | None = field(default=None, repr=False)
    """Deformed node positions (x, z) [m], each (layers, columns + 1), or None."""
    details: Mapping[str, Any] = field(default_factory=dict, repr=False)
    """Further numbers of the solver (load steps, mesh, indentation ...)."""
    contact_fraction_error: float = math.nan
    """Estimated discretisation error of the contact fraction [-], NaN if unknown."""
    friction_error: float = math.nan
    """Estimated discretisation error of the friction coefficient [-], NaN if unknown."""
    friction_bound: float = math.nan
    """Largest difference of the two frictions of a converged wave [-]; NaN at rest, or if unknown.

    A twentieth of the larger, or of 0.04 of the slope 2 pi amplitude/wavelength (root of two times
    the rms slope of a profile) where friction is less: so small a friction is known to no more.
    """
    loss_by_depth: tuple[Array, Array] | None = field(default=None, repr=False, compare=False)
    """Depths between the rows of elements at rest [m], shape (rows + 1,), and the part of
    `friction_from_dissipation` that each row loses [-], shape (rows,); None where it is not known.
    Not written to files."""
    solution: Any = field(default=None, repr=False, compare=False)
    """What the solver keeps to start another wave from; not written to files."""

    def __getstate__(self) -> dict[str, Any]:
        """Leave the solver's own solution behind when a result is pickled."""
        return {**self.__dict__, "solution": None}

    @property
    def contact_length(self) -> float:
        """Contact length projected on the mean plane [m]."""
        return self.contact_fraction * self.wavelength

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == Status.CONVERGED

    @property
    def why(self) -> str:
        """The status, with how the frictions disagree or how much of the pressure was reached."""
        if self.converged:
            return str(self.status)
        if self.status == Status.FRICTIONS_DISAGREE:
            return f"{self.status}, {self._frictions}"
        reached = self.details.get("load_reached", math.nan)
        if self.status == Status.CONTACT_TOO_NARROW and "expected_contact_width" in self.details:
            return (
                f"{self.status}: about {self.details['expected_contact_width']:.2g} m is expected, "
                f"the finest mesh follows {self.details['smallest_contact_width']:.2g} m; "
                "the pressure is too small for the block"
            )
        if "smallest_wave_carried" in self.details:
            return (
                f"{self.status} for {self.details['columns']} columns: found with waves down to "
                f"{self.details['smallest_wave_carried']:.2g} m alone; leave out shorter waves, or "
                "take more columns"
            )
        if not math.isfinite(reached) or reached == 1.0:
            return str(self.status)
        return f"{self.status} at {100.0 * reached:.3g} % of the pressure"

    @property
    def _frictions(self) -> str:
        slope = self.details.get("contact_slope")
        where = "" if slope is None else f" with contact on slopes up to {slope:.2g}"
        return (
            f"{self.friction:.3g} from traction and {self.friction_from_dissipation:.3g} from "
            f"dissipation{where}: more columns are needed"
        )

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures: the discretisation's own error."""
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0

    @property
    def slope(self) -> float:
        """Largest slope of a sine, 2 pi amplitude / wavelength [-].

        Of a profile that of the sine of its period and range: the profile itself is steeper.
        """
        return 2.0 * math.pi * self.amplitude / self.wavelength

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s], of the wave or the period."""
        return 2.0 * math.pi * self.speed / self.wavelength

    @property
    def modulus(self) -> float:
        """|E*| of the rubber at the fundamental excitation [Pa], NaN if it is not known."""
        return abs(self._complex_modulus())

    @property
    def loss_factor(self) -> float:
        """E''/E' of the rubber at the fundamental excitation [-], NaN if it is not known."""
        modulus = self._complex_modulus()
        return modulus.imag / modulus.real

    @property
    def outside_band(self) -> bool:
        """Whether more than 1 % of its friction rests on the rubber beyond what was measured."""
        return self.extrapolation.share > WORTH_SAYING

    @property
    def extrapolation(self) -> Extrapolation:
        """What of it rests on the rubber beyond what was measured; nothing at rest.

        A sine counts whole if its fundamental, or its harmonic as long as the contact,
        n = ceil(wavelength / contact length), is beyond the band. The friction of a profile is
        split by the harmonics of its pressure, |p_k|^2 Im(M)/|M|^2 each, as on a half-plane.
        """
        if self.speed == 0.0:
            return extrapolation.NONE
        if self.rubber is None:
            return extrapolation.UNKNOWN
        if "smallest_wavelength" in self.details:
            order = np.arange(1, len(self.x) // 2 + 1)
            omega = self.angular_frequency * order
            size = harmonics(self.x, self.pressure, self.wavelength, order)
            modulus = self.rubber.plane_strain_modulus(omega)
            lost = size**2 * modulus.imag / np.abs(modulus) ** 2
            return extrapolation.of_spectrum(self.rubber, omega, lost)
        harmonic = math.ceil(1.0 / self.contact_fraction) if self.contact_fraction > 0.0 else 1
        omega = self.angular_frequency * np.array([1.0, harmonic])
        return extrapolation.of_frequencies(self.rubber, omega)

    def _complex_modulus(self) -> complex:
        if self.rubber is None:
            return complex(math.nan, math.nan)
        return complex(self.rubber.complex_modulus(self.angular_frequency))


ScaleResult = WaveResult
"""Its name as `gripscale.ScaleResult`."""
