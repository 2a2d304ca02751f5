"""Eleven families of synthetic isotropic surfaces, each one period, to measure laws on.

A family is a way to make heights; a seed draws its parameters from the ranges in its function. All
have waves from 12.8 mm, the roll-off, down to 0.2 mm. What tests judge the laws by are other
families (tests/verification/known_surfaces.py).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.fft
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from gripscale.surface import HeightMap

Array = NDArray[np.float64]

LARGEST, SMALLEST = 12.8e-3, 0.2e-3
"""Wavelengths between which the surfaces are rough [m]."""
STEP = 0.5 * SMALLEST
SHAPE = (2048, 512)
"""Points along and across sliding: lines of sixteen largest waves, four of them wide."""
FINE = 4e-3
"""Largest wave of roughness on top of a form [m]."""


@dataclass(frozen=True)
class Draw:
    """Random numbers for one map, and the heights most families are made of."""

    random: np.random.Generator
    shape: tuple[int, int]
    step: float = STEP

    @property
    def lengths(self) -> tuple[float, float]:
        """Period along x and y [m]."""
        return self.shape[0] * self.step, self.shape[1] * self.step

    @cached_property
    def wavenumber(self) -> Array:
        """|q| over the spectrum [rad/m]."""
        along = np.fft.fftfreq(self.shape[0], self.step)
        across = np.fft.rfftfreq(self.shape[1], self.step)
        return np.asarray(2.0 * np.pi * np.hypot(along[:, None], across))

    def between(self, least: float, most: float) -> float:
        """Return a number, uniform between two."""
        return float(self.random.uniform(least, most))

    def gaussian(self, hurst: float, largest: float = LARGEST, smallest: float = SMALLEST) -> Array:
        """Return a self-affine Gaussian surface between two wavelengths, of rms height 1."""
        q, low, high = self.wavenumber, 2.0 * np.pi / largest, 2.0 * np.pi / smallest
        rough = (q >= low * (1.0 - 1e-9)) & (q <= high * (1.0 + 1e-9))
        amplitude = np.zeros_like(q)
        amplitude[rough] = q[rough] ** -(1.0 + hurst)
        heights = self.filtered(self.random.standard_normal(self.shape), amplitude)
        return np.asarray(heights / heights.std())

    def bells(self, number: float, width: float) -> Array:
        """Return Gaussian bells of exponential heights, `number` of them on 51.2 mm x 51.2 mm."""
        count = int(number * self.lengths[0] * self.lengths[1] / 51.2e-3**2)
        peaks = np.zeros(self.shape)
        middles = tuple(self.random.integers(0, points, count) for points in self.shape)
        peaks[middles] = self.random.exponential(1.0, count)
        return self.filtered(peaks, np.exp(-0.5 * (self.wavenumber * width) ** 2))

    def roughness(self, slope: float, hurst: float = 0.8, largest: float = FINE) -> Array:
        """Return a Gaussian surface of an rms slope."""
        return self.sloped(self.gaussian(hurst, largest), slope)

    def sloped(self, heights: Array, slope: float) -> Array:
        """Return heights scaled to an rms slope along x."""
        difference = np.roll(heights, -1, 0) - np.roll(heights, 1, 0)
        return np.asarray(heights * (slope * 2.0 * self.step / difference.std()))

    def filtered(self, heights: Array, factor: Array) -> Array:
        """Return heights with their waves multiplied by a factor."""
        spectrum = scipy.fft.rfft2(heights) * factor
        return np.asarray(scipy.fft.irfft2(spectrum, s=self.shape))


def family_map(family: str, seed: int, shape: tuple[int, int] = SHAPE) -> HeightMap:
    """Return the map of a family and seed; `shape` in points along and across sliding."""
    number = list(FAMILIES).index(family)
    draw = Draw(np.random.default_rng([seed, number]), shape)
    heights = FAMILIES[family](draw)
    x, y = (draw.step * np.arange(points, dtype=np.float64) for points in shape)
    return HeightMap(x, y, heights - heights.mean(), f"{family} {seed}")


def skewed(draw: Draw) -> Array:
    """Return flat tops over deep valleys: the inverted exponential of a Gaussian surface."""
    gaussian = draw.gaussian(draw.between(0.7, 0.9))
    return draw.sloped(-np.exp(draw.between(0.3, 0.9) * gaussian), draw.between(0.5, 1.5))


def peaky(draw: Draw) -> Array:
    """Return high peaks over flat valleys: the exponential of a Gaussian surface."""
    gaussian = draw.gaussian(draw.between(0.7, 0.9))
    return draw.sloped(np.exp(draw.between(0.2, 0.5) * gaussian), draw.between(0.3, 1.0))


def facets(draw: Draw) -> Array:
    """Return broken stones: the highest of tilted hexagons with falling sides, and roughness."""
    size = draw.between(5e-3, 10e-3)
    lengths = draw.lengths
    x, y = (draw.step * np.arange(points) for points in draw.shape)
    floor = -0.6 * size
    heights = np.full(draw.shape, floor)
    for _ in range(int(2.0 * lengths[0] * lengths[1] / size**2)):
        middle, radius = draw.random.random(2) * lengths, size * draw.between(0.35, 0.75)
        a = (x - middle[0] + 0.5 * lengths[0]) % lengths[0] - 0.5 * lengths[0]
        b = (y - middle[1] + 0.5 * lengths[1]) % lengths[1] - 0.5 * lengths[1]
        near = np.ix_(np.abs(a) < 1.3 * radius, np.abs(b) < 1.3 * radius)
        stone = _stone(draw, a[near[0]], b[near[1]], size, radius)
        heights[near] = np.maximum(heights[near], stone)
    hurst = draw.between(0.6, 0.9)
    return heights + draw.roughness(draw.between(0.1, 0.4), hurst, size / 3.0)


def _stone(draw: Draw, a: Array, b: Array, size: float, radius: float) -> Array:
    """Return the heights of a tilted hexagon whose sides fall with a slope of 1.2."""
    top, tilt = draw.random.normal(0.0, 0.15 * size), draw.random.normal(0.0, 0.15, 2)
    angles, distances = draw.random.uniform(0.0, 2.0 * np.pi, 6), draw.random.uniform(0.4, 1.0, 6)
    beyond = np.max(
        [
            np.cos(angle) * a + np.sin(angle) * b - 0.5 * radius * distance
            for angle, distance in zip(angles, distances, strict=True)
        ],
        axis=0,
    )
    return np.asarray(top + tilt[0] * a + tilt[1] * b - 1.2 * np.maximum(beyond, 0.0))


def mounded(draw: Draw) -> Array:
    """Return sharp crests between round valleys: minus the magnitude of a Gaussian surface."""
    gaussian = draw.gaussian(0.8)
    return draw.sloped(-np.abs(gaussian + draw.between(-0.5, 0.5)), draw.between(0.4, 1.0))


def bumps(draw: Draw) -> Array:
    """Return bells on a rough plane."""
    bells = draw.bells(draw.between(40.0, 120.0), draw.between(0.8e-3, 2e-3))
    return draw.sloped(bells, draw.between(0.3, 0.8)) + draw.roughness(draw.between(0.1, 0.4))


def pits(draw: Draw) -> Array:
    """Return a Gaussian surface with bells taken out of it."""
    hurst = draw.between(0.7, 0.9)
    bells = draw.bells(draw.between(60.0, 200.0), draw.between(0.5e-3, 1.5e-3))
    rough = draw.roughness(draw.between(0.2, 0.6), hurst, LARGEST)
    return draw.sloped(-bells, draw.between(0.3, 0.8)) + rough


def cells(draw: Draw) -> Array:
    """Return tops about random points that fall with a power of the distance, rough."""
    lengths = draw.lengths
    number = int(lengths[0] * lengths[1] / draw.between(4e-3, 9e-3) ** 2)
    middles = draw.random.random((number, 2)) * lengths
    x, y = (draw.step * np.arange(points) for points in draw.shape)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    nearest, _ = cKDTree(middles, boxsize=np.array(lengths)).query(points)
    distance = np.asarray(nearest).reshape(draw.shape)
    form = draw.sloped(-(distance ** draw.between(1.2, 3.0)), draw.between(0.3, 0.8))
    return form + draw.roughness(draw.between(0.1, 0.4))


def bimodal(draw: Draw) -> Array:
    """Return plateaus on two heights with rough tops: a clipped Gaussian surface."""
    gaussian = draw.gaussian(0.8, smallest=1.5e-3)
    form = np.tanh(draw.between(0.8, 2.0) * (gaussian + draw.between(-0.7, 0.7)))
    return draw.sloped(form, draw.between(0.3, 0.8)) + draw.roughness(draw.between(0.1, 0.4))


def cascade(draw: Draw) -> Array:
    """Return octaves of waves whose amplitude grows or falls with what longer waves are.

    The amplitude follows the heights of the longer octaves in part, places of its own in part.
    """
    hurst, strength, share = (
        draw.between(0.7, 0.9),
        draw.between(0.1, 0.5),
        draw.between(-0.5, 1.0),
    )
    heights, modulation, largest = np.zeros(draw.shape), np.zeros(draw.shape), LARGEST
    while largest > 1.5 * SMALLEST:
        octave, place = (draw.gaussian(hurst, largest, 0.5 * largest) for _ in range(2))
        heights += largest**hurst * np.exp(strength * modulation) * octave
        modulation += share * octave + np.sqrt(1.0 - share**2) * place
        largest *= 0.5
    return draw.sloped(heights, draw.between(0.5, 1.5))


def lognormal(draw: Draw) -> Array:
    """Return lognormal heights: the exponential of a Gaussian surface, rough where it is high."""
    gaussian = draw.gaussian(draw.between(0.7, 0.9))
    return draw.sloped(np.exp(draw.between(0.5, 0.9) * gaussian), draw.between(0.3, 1.0))


def exposed(draw: Draw) -> Array:
    """Return round stones, each of its own roughness, that stand out of a smooth binder."""
    lengths = draw.lengths
    x, y = (draw.step * np.arange(points) for points in draw.shape)
    size = draw.between(2e-3, 4e-3)
    heights, rough = np.zeros(draw.shape), np.full(draw.shape, draw.between(0.05, 0.2))
    for _ in range(int(draw.between(0.3, 1.2) * lengths[0] * lengths[1] / (2.0 * size) ** 2)):
        middle, radius = draw.random.random(2) * lengths, size * draw.between(0.6, 1.4)
        amplitude, out = np.exp(draw.random.normal(0.0, 0.5)), radius * draw.between(0.1, 0.9)
        a = (x - middle[0] + 0.5 * lengths[0]) % lengths[0] - 0.5 * lengths[0]
        b = (y - middle[1] + 0.5 * lengths[1]) % lengths[1] - 0.5 * lengths[1]
        near = np.ix_(np.abs(a) < radius, np.abs(b) < radius)
        inside = radius**2 - a[near[0]] ** 2 - b[near[1]] ** 2
        cap = out - radius + np.sqrt(np.maximum(inside, 0.0))
        rough[near] = np.where(cap > heights[near], amplitude, rough[near])
        heights[near] = np.maximum(heights[near], cap)
    fine = draw.roughness(draw.between(0.1, 0.4), draw.between(0.6, 0.9))
    return heights + rough * fine


FAMILIES: dict[str, Callable[[Draw], Array]] = {
    "skewed": skewed,
    "peaky": peaky,
    "facets": facets,
    "mounded": mounded,
    "bumps": bumps,
    "pits": pits,
    "cells": cells,
    "bimodal": bimodal,
    "cascade": cascade,
    "lognormal": lognormal,
    "exposed": exposed,
}
