"""A surface with the spectrum of a measured one, and random phases: what its phases are worth."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import scipy

from gripscale.core import checks
from gripscale.half_space.grid import joined, surface_axes
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import upper_envelope
from gripscale.surface.resampling import fill_gaps

_Measurement = TypeVar("_Measurement", Profile, HeightMap)


def random_phases(surface: _Measurement, seed: int) -> _Measurement:
    """Return a periodic surface with the spectrum of `surface` and random phases.

    Missing heights are filled, ends joined and steep flanks filled as `solve_rough_contact` does.
    The height difference correlation of the filled surface is kept; positions of the roughness and
    the distribution of heights are not. Lines that bridge gaps are part of the spectrum: where
    flanks are missing, the surface is rougher than the pairs of measured heights. Raises
    `InputError` if `seed` is not a whole number that is not negative.
    """
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    surface_axes(surface)
    steps = surface.step if isinstance(surface, HeightMap) else (surface.step,)
    z = upper_envelope(joined(fill_gaps(surface.z, steps)), steps)
    spectrum = scipy.fft.rfftn(random.standard_normal(z.shape))  # phases of a real surface
    size = np.abs(spectrum)
    spectrum *= np.abs(scipy.fft.rfftn(z)) / np.where(size > 0.0, size, 1.0)
    heights = scipy.fft.irfftn(spectrum, s=z.shape)
    name, source = f"{surface.name}, random phases".lstrip(", "), f"seed {seed}"
    if isinstance(surface, Profile):
        return Profile(surface.x, heights, name, source)
    return HeightMap(surface.x, surface.y, heights, name, source)
