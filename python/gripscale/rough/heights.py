"""The surface as the contact sees it: periodic, without the waves that are too short."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy.fft

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rough.ends import joined
from gripscale.rough.grid import Array, ComplexArray, Grid, Mask, resampled
from gripscale.surface import HeightMap, Profile
from gripscale.surface.gaps import filled

DEFAULT_STEPS = 4
"""Steps of the surface in the smallest wave kept by default."""
FEWEST_STEPS = 2


@dataclass(frozen=True)
class PeriodicHeights:
    """A line or a map of heights that repeats, on its own grid."""

    grid: Grid
    origin: tuple[float, ...]
    """Position of the first point [m]."""
    spectrum: ComplexArray = field(repr=False)
    """`scipy.fft.rfftn` of the heights [m]."""
    measured: Mask = field(repr=False)
    smallest_wavelength: float
    """Where it is cut off [m]."""

    def on(self, shape: tuple[int, ...], cut_off: float | None = None) -> Array:
        """Return the heights [m] at the points of another grid.

        `cut_off` leaves out all waves shorter than it [m], whatever their direction.
        """
        shortest = max(cut_off or 0.0, self.smallest_wavelength)
        kept = self.grid.wavenumber <= 2.0 * np.pi / shortest * (1.0 + 1e-9)
        return resampled(np.where(kept, self.spectrum, 0.0), self.grid.shape, shape)

    def measured_on(self, shape: tuple[int, ...]) -> Mask:
        """Return where the nearest height was measured."""
        mask = self.measured
        for axis, (old, new) in enumerate(zip(self.grid.shape, shape, strict=True)):
            nearest = np.rint(np.arange(new) * (old / new)).astype(int) % old
            mask = np.take(mask, nearest, axis=axis)
        return mask


def periodic_heights(
    surface: Profile | HeightMap, *, smallest_wavelength: float | None, periodic: bool
) -> PeriodicHeights:
    """Return what `solve_rough_contact` solves for, see there."""
    if isinstance(surface, Profile):
        axes = [surface.x]
    elif isinstance(surface, HeightMap):
        axes = [surface.x, surface.y]
    else:
        raise InputError(f"surface must be a Profile or a HeightMap; got {type(surface).__name__}")
    steps = [float((a[-1] - a[0]) / (a.size - 1)) for a in axes]
    grid = Grid(surface.z.shape, tuple(d * a.size for d, a in zip(steps, axes, strict=True)))
    z = filled(surface.z, tuple(steps), periodic=periodic)
    if not periodic:
        z = joined(z)
    return PeriodicHeights(
        grid,
        tuple(float(a[0]) for a in axes),
        np.asarray(scipy.fft.rfftn(z - z.mean())),
        ~np.isnan(surface.z),
        _smallest(smallest_wavelength, max(steps), min(grid.lengths)),
    )


def _smallest(given: float | None, step: float, length: float) -> float:
    if FEWEST_STEPS * step > length:
        raise InputError(
            f"surface must be longer each way than {FEWEST_STEPS} of its steps, of which the "
            f"largest is {step:.4g} m; got {length:.4g} m"
        )
    if given is None:
        return min(DEFAULT_STEPS * step, length)
    smallest = checks.positive("smallest_wavelength", given, unit="m")
    if not FEWEST_STEPS * step * (1.0 - 1e-9) <= smallest <= length * (1.0 + 1e-9):
        raise InputError(
            f"smallest_wavelength must be from {FEWEST_STEPS * step:.4g} m, two steps of the "
            f"surface, to {length:.4g} m, its length; got {smallest:.4g} m"
        )
    return smallest
