"""Autocorrelation of a map: how long its texture is, and which way it runs.

The autocorrelation of the heights z over their plane, without wrapping round, is

    f(t) = < z(r) z(r + t) > / < z^2 >,

each < > over the pairs of points that are there. The autocorrelation length Sal is the shortest way
from the middle to where f falls to 0.2, the texture aspect ratio Str that length over the longest;
both are straight ways on which f is larger (ISO 25178-2:2021). The texture direction Std is the
angle to x of the ridges: across the direction in which the power spectrum, summed from the middle
outwards and over some 15 degrees, is largest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from gripscale.core.arrays import Array
from gripscale.surface.cleaning import subtract_form
from gripscale.surface.profile import HeightMap
from gripscale.surface.resampling import fill_gaps

_FALLEN = 0.2  # autocorrelation to which lengths are measured
_WAYS = 180  # directions that are followed, one a degree

# Weights of neighbouring degrees, without which the strongest wave of a random texture decides.
_SMOOTHING = np.hanning(33)[1:-1]
# Share of the largest wavenumber within which the direction is sought: a square grid has more waves
# along its diagonals beyond it.
_LONGEST_PART = 0.5


class TextureLengths(NamedTuple):
    """Shortest and longest way from the middle of an autocorrelation to where it falls to 0.2."""

    shortest: float  # Sal [m]
    longest: float  # [m]; half the map where it does not fall that far

    @property
    def aspect_ratio(self) -> float:
        """Str [-]: 1 without a direction."""
        return self.shortest / self.longest


def texture_lengths(surface: HeightMap) -> TextureLengths:
    """Return the autocorrelation lengths of a map; NaN where it is flat."""
    from scipy.ndimage import map_coordinates  # slow to import

    z, (dx, dy) = _level(surface), surface.step
    nx, ny = z.shape
    # without wrapping round: with as many zeros beyond either end
    correlation = np.fft.irfft2(np.abs(np.fft.rfft2(z, [2 * nx, 2 * ny])) ** 2, [2 * nx, 2 * ny])
    if not correlation[0, 0] > 0.0:
        return TextureLengths(math.nan, math.nan)
    away = np.linspace(0.0, min((nx // 2 - 1) * dx, (ny // 2 - 1) * dy), 2 * max(nx, ny))
    pairs = np.outer(*(n - np.abs(np.fft.fftfreq(2 * n, 0.5 / n)) for n in (nx, ny)))
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = correlation / pairs * (z.size / correlation[0, 0])
    lengths = []
    for angle in np.linspace(0.0, np.pi, _WAYS, endpoint=False):
        at = np.array([away * np.cos(angle) / dx, away * np.sin(angle) / dy])
        values = map_coordinates(relative, at, order=1, mode="grid-wrap")
        first = int(np.argmax(values < _FALLEN)) or away.size - 1
        pair = slice(first, first - 2, -1)  # where it stays above, the last point
        lengths.append(np.interp(_FALLEN, values[pair], away[pair]))
    return TextureLengths(float(min(lengths)), float(max(lengths)))


def texture_direction(surface: HeightMap) -> float:
    """Return the angle of the ridges of a map to x, Std [rad] from 0 to pi; NaN where it is flat.

    Each wave of the spectrum counts in the degree of its direction.
    """
    z, (dx, dy) = _level(surface), surface.step
    window = np.outer(*(np.hanning(n + 2)[1:-1] for n in z.shape))
    power = np.abs(np.fft.fft2(z * window)) ** 2
    qx, qy = np.meshgrid(*map(np.fft.fftfreq, z.shape, (dx, dy)), indexing="ij")
    inside = np.hypot(qx, qy) < _LONGEST_PART * min(0.5 / dx, 0.5 / dy)
    inside[0, 0] = False
    if not power[inside].sum() > 0.0:
        return math.nan
    degree = np.rint(np.degrees(np.arctan2(qy[inside], qx[inside]))).astype(int) % _WAYS
    by_degree = np.fft.rfft(np.bincount(degree, power[inside], _WAYS))
    smooth = np.fft.irfft(by_degree * np.fft.rfft(_SMOOTHING, _WAYS), _WAYS)
    waves = math.radians(int(np.argmax(smooth)) - _SMOOTHING.size // 2)
    return (waves + 0.5 * math.pi) % math.pi


def _level(surface: HeightMap) -> Array:
    """Return the heights of a map over their plane [m], gaps filled."""
    return fill_gaps(subtract_form(surface, order=1)[0].z, surface.step)
