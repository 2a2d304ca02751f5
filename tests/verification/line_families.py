"""Families of lines whose last octaves are withheld: what the bands are measured on and judged by.

A seed draws the numbers of a line from the ranges in the function of its family. Bands were chosen
on the families of `FITTED` and judged on those of `JUDGES`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.fft

import gripscale as gs
from gripscale.core.arrays import Array

LENGTH, STEP = 0.6144, 50e-6
LARGEST = 12.8e-3
"""Largest wave of the Gaussian parts [m]; the shortest are of two steps."""


@dataclass(frozen=True)
class Draw:
    """Random numbers for one line, and what most families are made of."""

    random: np.random.Generator
    length: float = LENGTH
    step: float = STEP

    @cached_property
    def x(self) -> Array:
        """Positions [m]."""
        return np.asarray(self.step * np.arange(round(self.length / self.step), dtype=float))

    @cached_property
    def wavenumber(self) -> Array:
        """Wavenumbers of the line [rad/m]."""
        return np.asarray(2.0 * np.pi * scipy.fft.rfftfreq(self.x.size, self.step))

    def between(self, least: float, most: float) -> float:
        """Return a number, uniform between two."""
        return float(self.random.uniform(least, most))

    def gaussian(self, hurst: float, longest: float = LARGEST, shortest: float = 0.0) -> Array:
        """Return a self-affine Gaussian line between two wavelengths [m], of rms height 1."""
        q = self.wavenumber
        rough = (q >= 2.0 * np.pi / longest) & (q * shortest <= 2.0 * np.pi)
        amplitude = np.where(rough, np.maximum(q, q[1]) ** (-0.5 - hurst), 0.0)
        return self.filtered(self.random.standard_normal(self.x.size), amplitude, 1.0)

    def texture(self, slope: float, longest: float = 3e-3, shortest: float = 0.0) -> Array:
        """Return Gaussian waves, H = 0.8, with an rms slope [-]."""
        return self.sloped(self.gaussian(0.8, longest, shortest), slope)

    def sloped(self, z: Array, slope: float) -> Array:
        """Return heights scaled to an rms slope [-] over two steps."""
        difference = np.roll(z, -1) - np.roll(z, 1)
        return np.asarray(z * (slope * 2.0 * self.step / difference.std()))

    def rounded(self, z: Array, width: float) -> Array:
        """Return heights averaged with a Gaussian of a standard deviation [m]."""
        return self.filtered(z, np.exp(-0.5 * (self.wavenumber * width) ** 2))

    def filtered(self, z: Array, factor: Array, rms: float | None = None) -> Array:
        """Return heights with their waves multiplied by a factor, scaled to a stated rms."""
        out = np.asarray(scipy.fft.irfft(scipy.fft.rfft(z) * factor, z.size))
        return out if rms is None else out * (rms / out.std())

    def distance(self, middle: float) -> Array:
        """Return the periodic distance from a position [m], with its sign."""
        half = 0.5 * self.length
        return np.asarray((self.x - middle + half) % self.length - half)


def family_line(family: str, seed: int) -> gs.Profile:
    """Return the line of a family and seed."""
    draw = Draw(np.random.default_rng([seed, list(FAMILIES).index(family)]))
    z = FAMILIES[family](draw)
    return gs.Profile(draw.x, z - z.mean(), f"{family} {seed}")


def gaussian(draw: Draw) -> Array:
    """Return a self-affine Gaussian line, H = 0.6 to 1."""
    return draw.sloped(draw.gaussian(draw.between(0.6, 1.0)), draw.between(0.4, 1.0))


def tiles(draw: Draw) -> Array:
    """Return stones with sharp edges: tilted tiles beside each other at random heights, rough."""
    ends = np.sort(draw.random.random(int(draw.length / draw.between(4e-3, 8e-3)))) * draw.length
    stone = np.searchsorted(ends, draw.x) % ends.size
    height = draw.random.normal(0.0, draw.between(0.4e-3, 1e-3), ends.size)
    tilt = draw.random.normal(0.0, 0.15, ends.size)
    middle = 0.5 * (ends + np.roll(ends, 1))
    tops = height[stone] + tilt[stone] * np.clip(draw.distance(0.0) - middle[stone], -8e-3, 8e-3)
    return np.asarray(tops + draw.texture(draw.between(0.1, 0.4)))


def rounded_tiles(draw: Draw) -> Array:
    """Return the tiles with edges worn round over 0.1 to 0.4 mm, and their roughness."""
    smooth = draw.rounded(tiles(draw), draw.between(0.1e-3, 0.4e-3))
    return np.asarray(smooth + draw.texture(draw.between(0.1, 0.4)))


def caps(draw: Draw) -> Array:
    """Return the highest of overlapping tilted caps, with fine roughness."""
    z = np.full(draw.x.size, -3e-3)
    for middle in draw.random.random(int(draw.length / 6e-3)) * draw.length:
        radius, tilt = draw.between(3e-3, 8e-3), draw.random.normal(0.0, 0.25)
        u, top = draw.distance(middle), draw.random.normal(0.0, 0.7e-3)
        cap = 0.6 * (np.sqrt(np.maximum(radius**2 - u**2, 0.0)) - radius) + tilt * u + top
        z = np.where(np.abs(u) < radius, np.maximum(z, cap), z)
    return np.asarray(z + draw.texture(draw.between(0.1, 0.3)))


def cascade(draw: Draw) -> Array:
    """Return a lognormal cascade: the amplitude of an octave is that above times a random one."""
    variance, hurst = draw.between(0.03, 0.1), draw.between(0.7, 0.9)
    z, log = np.zeros(draw.x.size), np.zeros(draw.x.size)
    for octave in range(7):
        wave = LARGEST / 2**octave
        smooth = draw.rounded(draw.random.standard_normal(draw.x.size), 0.25 * wave)
        log += np.sqrt(variance) * smooth / smooth.std()
        z += 2.0 ** (-hurst * octave) * np.exp(log) * draw.gaussian(1.0, wave, 0.5 * wave)
    return draw.sloped(z, draw.between(0.4, 1.0))


def two_scales(draw: Draw) -> Array:
    """Return a wavy line on which fine roughness sets in at 1 mm."""
    wavy = draw.sloped(draw.gaussian(0.8, shortest=3e-3), draw.between(0.2, 0.4))
    return np.asarray(wavy + draw.texture(draw.between(0.3, 0.6), 1e-3))


def rolled_off(draw: Draw) -> Array:
    """Return a self-affine Gaussian line that is smooth below 0.8 mm."""
    return draw.sloped(draw.gaussian(draw.between(0.7, 0.9), shortest=0.8e-3), 0.5)


def polished(draw: Draw) -> Array:
    """Return a Gaussian line with its summits worn to a tenth, and weak scratches on them."""
    z = draw.sloped(draw.gaussian(0.8), draw.between(0.4, 0.8))
    level = z.mean() + draw.between(0.0, 0.8) * z.std()
    return np.where(z > level, level + 0.1 * (z - level), z) + draw.texture(0.03, 1e-3)


def porous(draw: Draw) -> Array:
    """Return a rough plane with round pores of steep walls."""
    z = np.zeros(draw.x.size)
    for middle in draw.random.random(int(draw.length / draw.between(4e-3, 8e-3))) * draw.length:
        radius = draw.between(0.5e-3, 2e-3)
        within = np.maximum(radius**2 - draw.distance(middle) ** 2, 0.0)
        z = np.minimum(z, -2.0 * np.sqrt(within))
    return np.asarray(z + draw.texture(draw.between(0.15, 0.4), 6e-3))


def cones(draw: Draw) -> Array:
    """Return the highest of many cones, with fine roughness."""
    z = np.full(draw.x.size, -3e-3)
    for middle in draw.random.random(int(draw.length / 3e-3)) * draw.length:
        top, flank = draw.random.normal(0.0, 0.5e-3), draw.between(0.3, 1.0)
        z = np.maximum(z, top - flank * np.abs(draw.distance(middle)))
    return np.asarray(z + draw.texture(draw.between(0.02, 0.1)))


def spheres(draw: Draw) -> Array:
    """Return the highest of many smooth grains, with fine roughness."""
    z = np.full(draw.x.size, -2e-3)
    for middle in draw.random.random(int(draw.length / 2e-3)) * draw.length:
        radius, top = draw.between(1e-3, 3e-3), draw.random.normal(0.0, 0.4e-3)
        u = draw.distance(middle)
        grain = top - radius + np.sqrt(np.maximum(radius**2 - u**2, 0.0))
        z = np.where(np.abs(u) < radius, np.maximum(z, grain), z)
    return np.asarray(z + draw.texture(draw.between(0.05, 0.2)))


def broken_power_law(draw: Draw) -> Array:
    """Return a Gaussian line whose Hurst exponent changes at 0.4 to 1.6 mm, by up to 0.4."""
    upper, change = draw.between(0.6, 0.9), draw.between(-0.4, 0.4)
    q, turn = draw.wavenumber, 2.0 * np.pi / (0.4e-3 * 2.0 ** draw.between(0.0, 2.0))
    factor = np.maximum(q / turn, 1.0) ** -change
    return draw.sloped(draw.filtered(draw.gaussian(upper), factor), draw.between(0.4, 0.8))


def skewed(draw: Draw) -> Array:
    """Return sharp summits over flat valleys: the exponential of a Gaussian line."""
    return draw.sloped(np.exp(draw.between(0.3, 0.6) * draw.gaussian(0.75)), draw.between(0.4, 1.0))


def mounded(draw: Draw) -> Array:
    """Return sharp crests between round valleys: minus the magnitude of a Gaussian line, rough."""
    crests = -np.abs(draw.gaussian(0.9, shortest=1e-3) + draw.between(-0.5, 0.5))
    rough = draw.texture(draw.between(0.1, 0.4), 6e-3)
    return draw.sloped(crests, draw.between(0.3, 0.6)) + rough


def bells(draw: Draw) -> Array:
    """Return round bumps of exponential heights on a rough plane."""
    peaks = np.zeros(draw.x.size)
    middles = draw.random.integers(0, draw.x.size, int(draw.length / draw.between(3e-3, 8e-3)))
    peaks[middles] = draw.random.exponential(1.0, middles.size)
    bumps = draw.rounded(peaks, draw.between(0.5e-3, 1.5e-3))
    return draw.sloped(bumps, draw.between(0.2, 0.5)) + draw.texture(draw.between(0.05, 0.3), 6e-3)


def terraces(draw: Draw) -> Array:
    """Return plateaus on two heights with slanted sides and rough tops."""
    level = draw.gaussian(0.9, shortest=2e-3) + draw.between(-0.5, 0.5)
    form = draw.sloped(np.tanh(draw.between(1.0, 4.0) * level), draw.between(0.3, 0.6))
    return np.asarray(form + draw.texture(draw.between(0.1, 0.4), 6e-3))


def scratches(draw: Draw) -> Array:
    """Return a ground surface: the lowest of many V-shaped grooves of all widths."""
    z = draw.sloped(draw.gaussian(0.9), draw.between(0.1, 0.3))
    for middle in draw.random.random(int(draw.length / 0.6e-3)) * draw.length:
        width = 1e-4 * draw.random.pareto(1.2) + 1e-4
        z -= np.maximum(min(width, 3e-3) - np.abs(draw.distance(middle)), 0.0) * 0.5
    return z


def facets(draw: Draw) -> Array:
    """Return a crushed surface: a random polyline of 0.5 to 8 mm long faces, rough."""
    ends = np.cumsum(np.exp(draw.random.uniform(np.log(0.5e-3), np.log(8e-3), 2000)))
    ends = np.concatenate([[0.0], ends[ends < draw.length - 1e-3], [draw.length]])
    heights = draw.random.normal(0.0, draw.between(0.3e-3, 0.6e-3), ends.size)
    heights[-1] = heights[0]
    form = np.interp(draw.x, ends, heights)
    return np.asarray(form + draw.texture(draw.between(0.1, 0.4)))


def stones_in_matrix(draw: Draw) -> Array:
    """Return stones in a matrix: smooth and rough Gaussian texture by turns on one wavy form."""
    form = draw.sloped(draw.gaussian(0.9, shortest=2e-3), draw.between(0.2, 0.4))
    share = draw.gaussian(0.9, shortest=3e-3) > draw.between(-0.5, 0.5)
    stone, matrix = draw.gaussian(0.95, 4e-3), draw.gaussian(0.6, 4e-3)
    textures = (draw.sloped(stone, draw.between(0.1, 0.3)), draw.sloped(matrix, 0.5))
    return np.asarray(form + np.where(share, *textures))


FAMILIES: dict[str, Callable[[Draw], Array]] = {
    family.__name__: family
    for family in (
        *(gaussian, tiles, rounded_tiles, caps, cascade, two_scales, rolled_off, polished, porous),
        *(cones, spheres, broken_power_law, skewed, mounded, bells, terraces, scratches, facets),
        stones_in_matrix,
    )
}
"""In the order that their seeds are made of."""
JUDGES = ("mounded", "bells", "terraces", "scratches", "facets", "stones_in_matrix")
FITTED = tuple(name for name in FAMILIES if name not in JUDGES)
