"""Eight families of periodic lines, from one wave to windows of a measured road.

All have `WAVES` waves at most in a period, so that a block of twelve columns a wave follows them.
"""

from __future__ import annotations

import numpy as np
import scipy.fft

from gripscale.core import Array
from gripscale.half_space import one_period
from gripscale.surface import Profile
from studies.shipped import road

LENGTH = 20e-3
"""Period [m]."""
WAVES, POINTS = 40, 512
PER_FAMILY = 6
SINES = np.geomspace(0.02, 0.14, PER_FAMILY)
"""Amplitudes over wavelength of the single waves [-]."""
STARTS = (0.1, 0.35, 0.6, 0.85, 1.1, 1.35)
"""Of the windows of the road along its station [m]."""


def line(family: str, number: int) -> Profile:
    """Return a line of a family; `number` draws its parameters."""
    x = np.arange(POINTS) * LENGTH / POINTS
    random = np.random.default_rng([number, list(FAMILIES).index(family)])
    heights = band(FAMILIES[family](number, random))
    return Profile(x, heights, f"{family} {number}")


def rms_slope(heights: Array) -> float:
    """Return the rms slope of one period [-]."""
    spectrum = scipy.fft.rfft(heights) / POINTS * _wavenumbers()
    return float(np.sqrt(2.0 * np.sum(np.abs(spectrum) ** 2)))


def band(heights: Array) -> Array:
    """Return heights without their mean and without waves beyond `WAVES`."""
    spectrum = scipy.fft.rfft(heights)
    spectrum[0], spectrum[WAVES + 1 :] = 0.0, 0.0
    return np.asarray(scipy.fft.irfft(spectrum, POINTS), dtype=np.float64)


def _wavenumbers() -> Array:
    return np.asarray(2.0 * np.pi / LENGTH * np.arange(POINTS // 2 + 1), dtype=np.float64)


def _sloped(heights: Array, slope: float) -> Array:
    filtered = band(heights)
    return np.asarray(filtered * (slope / rms_slope(filtered)))


def _waves(numbers: list[int], slopes: Array, random: np.random.Generator) -> Array:
    """Return sines of given numbers in the period and rms slopes, with random phases."""
    x = np.arange(POINTS) / POINTS
    out = np.zeros(POINTS)
    for count, slope in zip(numbers, slopes, strict=True):
        amplitude = slope * np.sqrt(2.0) * LENGTH / (2.0 * np.pi * count)
        out += amplitude * np.cos(2.0 * np.pi * (count * x + random.random()))
    return out


def _gaussian(random: np.random.Generator, hurst: float, first: int = 3) -> Array:
    number = np.arange(POINTS // 2 + 1)
    size = np.where((number >= first) & (number <= WAVES), np.maximum(number, 1.0), np.inf)
    phases = np.exp(2j * np.pi * random.random(number.size))
    heights = scipy.fft.irfft(size ** -(0.5 + hurst) * phases, POINTS)
    return np.asarray(heights / heights.std())


def _slope(number: int) -> float:
    """Return rms slopes from gentle to steep, in steps."""
    return float(np.geomspace(0.15, 0.8, PER_FAMILY)[number])


def sine(number: int, random: np.random.Generator) -> Array:
    """Return one wave, four times in the period."""
    slope = 2.0 * np.pi * SINES[number] / np.sqrt(2.0)
    return _waves([4], np.array([slope]), random)


def two_waves(number: int, random: np.random.Generator) -> Array:
    """Return a fine wave on a coarse one, 5 to 11 times shorter."""
    slopes = _slope(number) * np.array([random.uniform(0.4, 0.9), random.uniform(0.4, 0.9)])
    return _waves([3, int(random.integers(15, 34))], slopes, random)


def three_waves(number: int, random: np.random.Generator) -> Array:
    """Return three waves, each about four times shorter than the last."""
    slopes = _slope(number) * random.uniform(0.4, 0.8, 3)
    return _waves([2, int(random.integers(7, 10)), int(random.integers(28, 40))], slopes, random)


def self_affine(number: int, random: np.random.Generator) -> Array:
    """Return a Gaussian line of Hurst exponent 0.6 to 0.9."""
    return _sloped(_gaussian(random, random.uniform(0.6, 0.9)), _slope(number))


def worn(number: int, random: np.random.Generator) -> Array:
    """Return worn tops over deep valleys: the inverted exponential of a Gaussian line."""
    heights = -np.exp(random.uniform(0.4, 0.9) * _gaussian(random, 0.8))
    return _sloped(heights, 1.3 * _slope(number))


def mounded(number: int, random: np.random.Generator) -> Array:
    """Return sharp crests between round valleys: minus the magnitude of a Gaussian line."""
    return _sloped(-np.abs(_gaussian(random, 0.9)), _slope(number))


def cascade(number: int, random: np.random.Generator) -> Array:
    """Return octaves whose amplitudes are modulated by the coarser ones."""
    heights, strength = np.zeros(POINTS), np.ones(POINTS)
    for first in (2, 4, 8, 16, 32):
        x = np.arange(POINTS) / POINTS
        count = int(random.integers(first, min(2 * first, WAVES) + 1))
        wave = np.cos(2.0 * np.pi * (count * x + random.random()))
        heights += strength * wave * float(count) ** -0.8
        strength = strength * (1.0 + 0.6 * wave)
    return _sloped(heights, _slope(number))


def road_window(number: int, random: np.random.Generator) -> Array:
    """Return a window of the shipped road, of the heights as measured."""
    station = road(0)
    start = station.x[0] + STARTS[number]
    inside = (station.x >= start) & (station.x < start + LENGTH)
    window = one_period(Profile(station.x[inside], station.z[inside]))
    spectrum = scipy.fft.rfft(window.z) / len(window)
    spectrum[WAVES + 1 :] = 0.0
    return np.asarray(scipy.fft.irfft(spectrum[: POINTS // 2 + 1] * POINTS, POINTS))


FAMILIES = {
    "sine": sine,
    "two waves": two_waves,
    "three waves": three_waves,
    "self-affine": self_affine,
    "worn": worn,
    "mounded": mounded,
    "cascade": cascade,
    "road": road_window,
}
