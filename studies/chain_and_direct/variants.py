"""Variants of the chain: which heights count, where the waves end, what is handed down."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

import gripscale as gs
from gripscale.surface import profile_spectrum

CUT_OFF = 0.4e-3
"""Shorter waves are left out of the direct contact [m]."""

LARGE = 2e-3
"""Waves of the contact that says which heights touch [m]."""

Stack = Callable[[gs.Profile, gs.Rubber, int], gs.SineStack]


@dataclass(frozen=True)
class Variant:
    """A way from a profile to sine waves, and how they are chained."""

    name: str
    stack: Stack
    pressure_classes: int
    waves: tuple[int, ...]


def as_printed(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of all heights, the last one at the cut-off."""
    return gs.fit_sines(_correlation(profile, 1.0), scales=waves, smallest_wavelength=CUT_OFF)


def to_cut_off(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of all heights that stand for the roughness down to the cut-off."""
    return gs.fit_sines(_correlation(profile, 1.0), scales=waves, cut_off=CUT_OFF)


def upper_as_printed(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of the upper half, the last one at the cut-off."""
    return gs.fit_sines(_correlation(profile, 0.5), scales=waves, smallest_wavelength=CUT_OFF)


def upper_half(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of the upper half that stand for the roughness down to the cut-off."""
    return gs.fit_sines(_correlation(profile, 0.5), scales=waves, cut_off=CUT_OFF)


def upper_third(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of the upper 30 %."""
    return gs.fit_sines(_correlation(profile, 0.3), scales=waves, cut_off=CUT_OFF)


def touching(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return waves of the heights that touch where only the large waves are there."""
    return gs.fit_sines(_correlation(_touched(profile, tread), 1.0), scales=waves, cut_off=CUT_OFF)


def spectral_bands(profile: gs.Profile, tread: gs.Rubber, waves: int) -> gs.SineStack:
    """Return a wave for each band of the spectrum, of the same height and slope variance.

    The first band holds half the variance, the others are as wide as each other in log q.
    """
    spectrum = profile_spectrum(profile)
    q, power = spectrum.wavenumber, spectrum.density * spectrum.width
    power = np.where(q <= 2.0 * np.pi / CUT_OFF, power, 0.0)
    half = q[np.searchsorted(np.cumsum(power), 0.5 * power.sum())]
    edges = np.append(0.0, np.geomspace(half, 2.0 * np.pi / CUT_OFF, waves))
    bands = [(q > low) & (q <= high) for low, high in pairwise(edges)]
    height = np.array([power[band].sum() for band in bands])
    slope = np.array([(q[band] ** 2 * power[band]).sum() for band in bands])
    return gs.SineStack(2.0 * np.pi * np.sqrt(height / slope), np.sqrt(2.0 * height))


VARIANTS = (
    Variant("as printed", as_printed, 1, (3, 4, 5, 7)),
    Variant("pressure classes", as_printed, 8, (3, 4, 7)),
    Variant("cut-off", to_cut_off, 1, (7,)),
    Variant("upper half", upper_as_printed, 1, (7,)),
    Variant("cut-off, upper half", upper_half, 1, (2, 4, 7)),
    Variant("pressure classes, cut-off, upper half", upper_half, 8, (2, 3, 4, 7)),
    Variant("pressure classes, cut-off", to_cut_off, 8, (4, 7)),
    Variant("pressure classes, spectral bands", spectral_bands, 8, (4,)),
    Variant("pressure classes, cut-off, upper 30 %", upper_third, 8, (4,)),
    Variant("pressure classes, cut-off, heights that touch", touching, 8, (4,)),
)


@lru_cache(maxsize=64)
def _correlation(profile: gs.Profile, share: float) -> gs.HeightDifference:
    return gs.height_difference(profile, top_height_fraction=share)


@lru_cache(maxsize=64)
def _touched(profile: gs.Profile, tread: gs.Rubber) -> gs.Profile:
    contact = gs.solve_rough_contact(
        tread, profile, pressure=3e5, speed=0.3, smallest_wavelength=LARGE, tolerance=0.1
    )
    points = contact.pressure.size
    nearest = np.rint(np.arange(profile.z.size) * (points / profile.z.size)).astype(int) % points
    return gs.Profile(profile.x, np.where(contact.pressure[nearest] > 0.0, profile.z, np.nan))
