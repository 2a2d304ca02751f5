"""Lines with the spectrum of the road on which dry friction was measured, and phases of another.

The road is known by its spectrum only. Its lines are those of the shipped road, a quarter as long:
so its finest wave, 0.15 mm, becomes 37 um, and its stones are as large as those of this road. Then
every wave is multiplied by what its octave lacks of the spectrum; positions and phases of the
roughness stay those of a measured road.

A measured line of the road, which is not public, has an area of 0.318 and a friction of 0.117 (S100
with its sweeps, half the rms slope as the strain, 10 mm/s, 3 bar, waves to 60 um). These lines have
0.314 and 0.100.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

import gripscale as gs
from gripscale.core import Array
from gripscale.surface import ArealSpectrum
from gripscale.surface.resampling import fill_gaps
from studies.shipped import road
from studies.treads import road_spectrum

CUT_OFF = 60e-6
"""Last wave that counts [m], that of the publisher."""
FINEST = 40e-6
"""Last wave of the lines [m]: a cut-off is no sharp end."""
REDUCED = 0.25
"""Length of the lines over that of the shipped road."""
BINS = 10
"""Bins a decade of wavenumber in which the spectrum is met."""


def spectrum_of_lines(surface: ArealSpectrum, wavenumber: Array) -> Array:
    """Return C_1 [m^3] of lines on a surface: 4 int C du, q^2 = k^2 + u^2, at `wavenumber` k."""
    u = np.append(0.0, np.geomspace(1e-3 * wavenumber[0], surface.wavenumber[-1], 4000))
    return np.array([4.0 * np.trapezoid(surface.at(np.hypot(k, u)), u) for k in wavenumber])


def with_spectrum(z: Array, step: float, surface: ArealSpectrum) -> Array:
    """Return heights of one period with the spectrum of lines on a surface; phases stay."""
    waves = np.fft.rfft(z - z.mean())
    q = 2.0 * np.pi * np.fft.rfftfreq(z.size, step)
    density = step / np.pi * np.abs(waves) ** 2 / z.size
    inside = (q > surface.wavenumber[0]) & (q < 2.0 * np.pi / FINEST)
    number = np.floor(BINS * np.log10(q[inside])).astype(int)
    bins = [number == each for each in np.unique(number)]
    middle = np.array([np.exp(np.log(q[inside][each]).mean()) for each in bins])
    mean = np.array([density[inside][each].mean() for each in bins])
    gain = np.sqrt(spectrum_of_lines(surface, middle) / mean)
    waves[inside] *= np.exp(np.interp(np.log(q[inside]), np.log(middle), np.log(gain)))
    waves[~inside] = 0.0
    return np.asarray(np.fft.irfft(waves, z.size))


@lru_cache
def road_lines() -> tuple[gs.Profile, ...]:
    """Return both lines, 0.41 m each."""
    surface, out = road_spectrum(whole=True), []
    for station in (0, 1):
        line = road(station)
        heights = fill_gaps(line.z)[: len(line) // 2 * 2]
        step = REDUCED * line.step
        z = with_spectrum(heights, step, surface)
        x: Array = step * np.arange(z.size, dtype=np.float64)
        out.append(gs.Profile(x, z, f"line {station}"))
    return tuple(out)
