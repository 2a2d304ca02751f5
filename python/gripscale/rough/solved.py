"""Contact and friction of a whole surface, with the evidence for them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from gripscale.conditions.by_scale import RubberByScale
from gripscale.conditions.conditions import Conditions
from gripscale.conditions.state_by_scale import StateByScale
from gripscale.cut_off_exponents import CutOffExponents
from gripscale.rough.grid import Array, Grid, Mask
from gripscale.rough.grids import GridRecord
from gripscale.rough.half_space import HalfSpace
from gripscale.rough.last_octave import last_octave
from gripscale.rough.outcome import lost_by_harmonic
from gripscale.rough.patches import patch_points
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import NONE, Extrapolation, of_spectrum
from gripscale.wave.status import Status

STEEP = 0.5
"""Rms slope in the contact beyond which small strain is no longer fair."""


@dataclass(frozen=True)
class SolvedContact:
    """Contact and friction of a whole surface (m, Pa, m/s); arrays have the shape of the grid."""

    rubber: Rubber = field(repr=False)
    nominal_pressure: float
    speed: float
    smallest_wavelength: float
    """Of the surface as it was solved [m]."""
    contact_fraction: float
    """Real over nominal contact area, corrected for the grid [-]."""
    friction: float
    """Friction coefficient from the contact traction [-]."""
    friction_from_dissipation: float
    """Friction coefficient from the energy lost in the rubber per sliding distance [-]."""
    contact_fraction_error: float
    """Estimated error of the grid [-]; NaN if there is only one."""
    friction_error: float
    """Estimated error of the grid [-]; NaN if there is only one."""
    status: Status
    """`converged`, or why the numbers are not to be trusted."""
    residuals: dict[str, float]
    """`pressure`: missing over rms pressure; `gap`: largest left in contact or overlap outside it,
    over the rms height; `load`: relative error of the mean pressure."""
    full_contact: bool
    """Whether nothing is out of contact; the answer then is in closed form."""
    grid: Grid = field(repr=False)
    origin: tuple[float, ...] = field(repr=False)
    height: Array = field(repr=False)
    """Of the surface as it was solved, mean zero [m]."""
    pressure: Array = field(repr=False)
    """Contact pressure [Pa], zero out of contact."""
    gap: Array = field(repr=False)
    """Between rubber and surface [m], zero in contact."""
    measured: Mask = field(repr=False)
    """Where heights were measured and not interpolated."""
    grids: list[GridRecord] = field(repr=False)
    """Numbers of every grid that was solved, in order."""
    by_scale: RubberByScale | None = field(default=None, repr=False)
    """The rubber at each scale, where conditions made it another; None: `rubber` at all."""
    scales: StateByScale | None = field(default=None, repr=False)
    """Temperature, strain and what is left of the moduli at each scale, if asked for."""
    passes: int = 1
    """Solutions until rubber, strains and heat agreed."""
    coarse_passes: int = 0
    """Beside them solutions on grids that only resolve the surface."""
    surface_warming: Array | None = field(default=None, repr=False)
    """Of the rubber's surface above its temperature before the contact [K]; None without heat."""

    conditions: Conditions | None = None
    """What changed the rubber on the way, and the area term."""

    @property
    def adhesive_friction(self) -> float:
        """Friction coefficient of the area term [-], NaN where none was asked for or at rest."""
        if self.conditions is None:
            return math.nan
        kelvin = self.conditions.temperature_of(self.rubber)
        if kelvin is not None and self.surface_warming is not None:
            kelvin += float(np.average(self.surface_warming, weights=self.pressure))
        return self.conditions.adhesive_friction(
            self.contact_fraction, self.nominal_pressure, self.speed, kelvin
        )

    @property
    def total_friction(self) -> float:
        """Hysteresis and area term together [-], NaN where no area term was asked for."""
        return self.friction + self.adhesive_friction

    @property
    def converged(self) -> bool:
        """Whether the solution may be used."""
        return self.status == Status.CONVERGED

    @property
    def x(self) -> Array:
        """Positions along the way of sliding [m], shape (nx,)."""
        return self._positions(0)

    @property
    def y(self) -> Array:
        """Positions across it [m], shape (ny,); empty for a line."""
        return self._positions(1) if len(self.grid.shape) > 1 else np.empty(0)

    @property
    def active(self) -> Mask:
        """Where the rubber touches."""
        return np.asarray(self.pressure > 0.0)

    @property
    def friction_mismatch(self) -> float:
        """Relative difference of the two friction measures, zero at rest."""
        if self.speed == 0.0:
            return 0.0
        scale = max(abs(self.friction), abs(self.friction_from_dissipation))
        difference = abs(self.friction - self.friction_from_dissipation)
        return difference / scale if scale > 0.0 else 0.0

    @property
    def extrapolation(self) -> Extrapolation:
        """What of the friction is lost in harmonics beyond the rubber's measured frequencies.

        Heat moves them: each harmonic counts at a_T of its scale times its frequency.
        """
        if self.speed == 0.0:
            return NONE
        omega = np.broadcast_to(self.grid.along * self.speed, self.grid.spectrum_shape)
        if self.by_scale is not None:
            omega = omega * self.by_scale.shift(self.grid.wavenumber)
        return of_spectrum(self.rubber, omega, self.lost_by_harmonic())

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """How it changes with the cut-off length: of contacts solved with it and with twice it."""
        return last_octave(self.grids, moving=self.speed > 0.0)

    @property
    def slope_in_contact(self) -> float:
        """Rms of the surface's slope along x where the rubber touches [-]."""
        slope = self.grid.slope(self.height)[self.active]
        return float(np.sqrt(np.mean(slope**2)))

    @property
    def missing_share(self) -> float:
        """Share of the contact that lies on heights which were missing and interpolated [-]."""
        return float(1.0 - self.measured[self.active].mean())

    @property
    def patches(self) -> Array:
        """Size of each contact patch, largest first: length [m] on a line, area [m^2] on a map."""
        return np.asarray(patch_points(self.active) * math.prod(self.grid.spacing))

    @property
    def notes(self) -> list[str]:
        """Sentences on what to be careful about; empty if nothing."""
        out = []
        if self.slope_in_contact > STEEP:
            out.append(
                f"The rms slope in the contact is {self.slope_in_contact:.2f}, above {STEEP:g}: "
                "small strain is no longer fair."
            )
        if self.missing_share > 0.05:
            out.append(f"{self.missing_share:.0%} of the contact lies on interpolated heights.")
        return out

    def pressure_quantiles(self, shares: ArrayLike) -> Array:
        """Return the pressures [Pa] that the given shares [-] of the contact do not exceed."""
        return np.asarray(np.quantile(self.pressure[self.active], np.asarray(shares, dtype=float)))

    def lost_by_harmonic(self) -> Array:
        """Return the friction each harmonic adds [-], over the half spectrum of the grid."""
        body = HalfSpace(self.rubber, self.speed, by_scale=self.by_scale)
        return lost_by_harmonic(body.compliance(self.grid), self.grid, self.pressure)

    def _positions(self, axis: int) -> Array:
        place = self.grid.spacing[axis] * np.arange(self.grid.shape[axis], dtype=float)
        return np.asarray(self.origin[axis] + place)
