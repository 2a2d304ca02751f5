"""Maps with the spectrum of measured lines, and with their spectrum and heights.

The amplitudes of a Gaussian map are the areal spectrum's, its phases random. Heights are brought to
the measured distribution by rank, the spectrum back, in turns: the iterated amplitude adjusted
Fourier transform (T. Schreiber & A. Schmitz, Phys. Rev. Lett. 77 (1996) 635,
doi:10.1103/PhysRevLett.77.635), on a map.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gripscale.surface.isotropy import areal_spectrum
from gripscale.surface.maps.measured import MeasuredLine
from gripscale.surface.maps.square import ComplexArray, Square
from gripscale.surface.periodogram import profile_spectrum
from gripscale.surface.profile import FloatArray, Profile
from gripscale.surface.spectrum import ArealSpectrum

TURNS = 50
"""Of heights and spectrum; the last brings the heights, so that these are exact."""


def map_amplitudes(profiles: Sequence[Profile], square: Square) -> FloatArray:
    """Return the rms of each wave of an isotropic map (`rfft2`) with the profiles' spectrum [m]."""
    spectrum: ArealSpectrum = areal_spectrum(profile_spectrum(list(profiles)))
    q = np.where(square.carried, square.wavenumber, np.inf)
    density = np.where(square.carried, spectrum.at(np.where(np.isinf(q), 1.0, q)), 0.0)
    return np.asarray(np.sqrt(density) * (2.0 * np.pi / square.length) * square.points**2)


def gaussian_waves(
    square: Square, amplitudes: FloatArray, random: np.random.Generator
) -> ComplexArray:
    """Return the half spectrum of a Gaussian map with these amplitudes in the mean."""
    return np.asarray(amplitudes * square.spectrum(square.noise(random)) / square.points)


def with_heights(
    square: Square, waves: ComplexArray, amplitudes: FloatArray, lines: Sequence[MeasuredLine]
) -> FloatArray:
    """Return heights [m] with exactly the distribution of the lines, nearly these amplitudes."""
    measured = np.sort(np.concatenate([line.heights for line in lines]))
    ranks = (np.arange(square.points**2) + 0.5) / square.points**2
    wanted = np.interp(ranks * measured.size - 0.5, np.arange(measured.size), measured)
    for _ in range(TURNS):
        heights = np.empty(wanted.size)
        heights[np.argsort(square.heights(waves), axis=None)] = wanted
        waves = square.spectrum(heights.reshape(square.points, -1))
        size = np.abs(waves)
        waves *= amplitudes / np.where(size > 0.0, size, 1.0)
    return heights.reshape(square.points, -1)
