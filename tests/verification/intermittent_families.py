"""Seven families of surfaces whose fine roughness or heights vary from place to place.

No law was fitted to them. They are made in other ways than those of studies/surface_families.py:
amplitudes follow envelopes in place of heights, summits are worn or buried, heights have the tails
of other distributions.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from tests.verification.known_families import (
    LARGEST,
    LENGTHS,
    SHAPE,
    STEP,
    cut_softly,
    gaussian,
    sloped,
)

Array = NDArray[np.float64]


def octaves(random: np.random.Generator, hurst: float) -> list[Array]:
    """Return the octaves of a self-affine surface, the longest first."""
    ends = [LARGEST * 0.5**n for n in range(7)]
    return [
        largest**hurst * gaussian(random, hurst, largest, smallest)
        for largest, smallest in pairwise(ends)
    ]


def turbulent(random: np.random.Generator) -> Array:
    """Octaves whose amplitude follows the magnitude of the next longer one, up or down."""
    parts = octaves(random, random.uniform(0.7, 0.95))
    strength, heights, amplitude = random.uniform(0.3, 0.9), parts[0].copy(), 1.0
    for longer, octave in pairwise(parts):
        amplitude = amplitude * (np.abs(longer) / np.abs(longer).mean()) ** strength
        heights += amplitude * octave
    return sloped(heights, random.uniform(0.4, 1.2))


def bursts(random: np.random.Generator) -> Array:
    """Octaves under one envelope that is lognormal, and grows with the longest octave."""
    parts = octaves(random, random.uniform(0.7, 0.95))
    share = random.uniform(0.0, 1.0)
    field = share * gaussian(random, 0.8, LARGEST, 0.25 * LARGEST)
    place = share * parts[0] / parts[0].std() + (1.0 - share) * field
    envelope = np.exp(random.uniform(0.3, 0.8) * place)
    return sloped(parts[0] + envelope * np.sum(parts[1:], axis=0), random.uniform(0.4, 1.2))


def chi_square(random: np.random.Generator) -> Array:
    """The sum of the squares of a few Gaussian surfaces, and fine roughness."""
    hurst = random.uniform(0.7, 0.9)
    squares = [gaussian(random, hurst) ** 2 for _ in range(int(random.integers(2, 5)))]
    fine = sloped(gaussian(random, 0.8, 2e-3), random.uniform(0.05, 0.2))
    return sloped(np.sum(squares, axis=0), random.uniform(0.4, 1.2)) + fine


def student(random: np.random.Generator) -> Array:
    """Heights with the tails of Student's t: a Gaussian surface over the rms of others."""
    freedom, hurst = int(random.integers(5, 12)), random.uniform(0.7, 0.9)
    squares = [gaussian(random, 0.8, LARGEST, 1.6e-3) ** 2 for _ in range(freedom)]
    return sloped(gaussian(random, hurst) / np.sqrt(np.mean(squares, axis=0)), 0.8)


def worn_bursts(random: np.random.Generator) -> Array:
    """Bursts with worn tops, and fine roughness."""
    heights = bursts(random)
    top = float(np.quantile(heights, random.uniform(0.6, 0.95)))
    flat = cut_softly(heights, top, random.uniform(0.1, 0.4) * float(heights.std()))
    return flat + sloped(gaussian(random, 0.8, 2e-3), random.uniform(0.05, 0.2))


def caps(random: np.random.Generator, radii: Array, out: Array) -> tuple[Array, Array]:
    """Return the highest of spherical caps over a plane at zero, and which places they cover."""
    x, y = (STEP * np.arange(points) for points in SHAPE)
    heights = np.zeros(SHAPE)
    for radius, height in zip(radii, out, strict=True):
        a, b = (
            (axis - random.uniform(0.0, length) + 0.5 * length) % length - 0.5 * length
            for axis, length in zip((x, y), LENGTHS, strict=True)
        )
        near = np.ix_(np.abs(a) < radius, np.abs(b) < radius)
        inside = np.maximum(radius**2 - a[near[0]] ** 2 - b[near[1]] ** 2, 0.0)
        heights[near] = np.maximum(heights[near], height - radius + np.sqrt(inside))
    return heights, heights > 0.0


def buried(random: np.random.Generator) -> Array:
    """Polished stones of one size that lie in a rough binder of uneven height, in part or whole."""
    radius = random.uniform(3e-3, 6e-3)
    count = int(random.uniform(0.5, 1.5) * LENGTHS[0] * LENGTHS[1] / (np.pi * radius**2))
    out = radius * np.minimum(random.uniform(0.0, 0.5) + 0.2 * random.standard_normal(count), 1.2)
    stones, bare = caps(random, np.full(count, radius), np.maximum(out, 1e-5))
    binder = sloped(gaussian(random, 0.8, LARGEST, 1.6e-3), random.uniform(0.05, 0.2))
    fine = sloped(gaussian(random, 0.8, 3e-3), 1.0)
    smooth, rough = random.uniform(0.03, 0.2), random.uniform(0.2, 0.6)
    return np.maximum(stones, binder) + np.where(bare & (stones > binder), smooth, rough) * fine


def boulders(random: np.random.Generator) -> Array:
    """Stones of sizes from a power law on a plane, the larger the rougher or the smoother."""
    least, power = random.uniform(0.8e-3, 1.5e-3), random.uniform(1.5, 2.5)
    sizes = least * (1.0 - random.uniform(0.0, 0.99, 4000)) ** (-1.0 / power)
    area = np.cumsum(np.pi * sizes**2) / (LENGTHS[0] * LENGTHS[1])
    radii = np.minimum(sizes[area < random.uniform(0.3, 0.9)], 6e-3)
    heights, _ = caps(random, radii, radii * random.uniform(0.3, 1.0))
    relative = np.maximum(heights / heights.std(), 0.1) ** random.uniform(-0.4, 0.4)
    return heights + relative * sloped(gaussian(random, 0.8, 3e-3), random.uniform(0.1, 0.4))


INTERMITTENT: dict[str, Callable[[np.random.Generator], Array]] = {
    "turbulent": turbulent,
    "bursts": bursts,
    "chi-square": chi_square,
    "student": student,
    "worn bursts": worn_bursts,
    "buried": buried,
    "boulders": boulders,
}
