"""Sixteen families of isotropic surfaces that no law was fitted to, and eight with ridges.

They are made in other ways than those of studies/surface_families.py: seven have amplitudes that
follow envelopes in place of heights, summits worn or buried, or the tails of other distributions. A
seed draws the numbers of a surface from the ranges in its function. Waves go down to two steps.
Vertical sides of stones and pores are `EDGE` wide, so that the heights resolve them.
"""

import zlib
from collections.abc import Callable
from functools import partial
from itertools import pairwise, product

import numpy as np
import scipy.fft
import scipy.ndimage
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from gripscale.surface import HeightMap

Array = NDArray[np.float64]

LARGEST, STEP = 12.8e-3, 1e-4
"""Largest wave of a surface and step of its heights [m]."""
SHAPE = (2048, 512)
LENGTHS = (SHAPE[0] * STEP, SHAPE[1] * STEP)
EDGE = 1.5e-4
"""Standard deviation of the Gaussian that rounds a vertical side [m]."""


def gaussian(
    random: np.random.Generator,
    hurst: float,
    largest: float = LARGEST,
    smallest: float = 2.0 * STEP,
    stretch: tuple[float, float] = (1.0, 1.0),
) -> Array:
    """Return a self-affine Gaussian surface of rms height 1, its waves stretched along x and y."""
    along = np.fft.fftfreq(SHAPE[0], STEP)[:, None] * stretch[0]
    across = np.fft.rfftfreq(SHAPE[1], STEP) * stretch[1]
    number = np.hypot(along, across)
    rough = (number > 0.999 / largest) & (number < 1.001 / smallest)
    amplitude = np.where(rough, np.maximum(number, 1.0 / largest) ** -(1.0 + hurst), 0.0)
    noise = scipy.fft.rfft2(random.standard_normal(SHAPE))
    heights = scipy.fft.irfft2(amplitude * noise, s=SHAPE)
    return np.asarray(heights / heights.std())


def sloped(heights: Array, slope: float) -> Array:
    """Return heights scaled to an rms slope along x."""
    return np.asarray(heights * (slope / np.gradient(heights, STEP, axis=0).std()))


def around(random: np.random.Generator) -> tuple[Array, Array]:
    """Return the periodic distances along x and y from a random place [m]."""
    x, y = (
        (STEP * np.arange(points) - random.uniform(0.0, length) + 0.5 * length) % length
        - 0.5 * length
        for points, length in zip(SHAPE, LENGTHS, strict=True)
    )
    return x, y


def stone_tops(random: np.random.Generator) -> Array:
    """Return the highest of round, tilted caps over a floor, with roughness of a third of a cap."""
    size = random.uniform(5e-3, 10e-3)
    floor = -0.6 * size
    heights = np.full(SHAPE, floor)
    for _ in range(int(2.0 * LENGTHS[0] * LENGTHS[1] / size**2)):
        radius = size * random.uniform(0.35, 0.75)
        a, b = around(random)
        near = np.ix_(np.abs(a) < 1.3 * radius, np.abs(b) < 1.3 * radius)
        a, b = a[near[0]], b[near[1]]
        top, tilt = random.normal(0.0, 0.15 * size), random.normal(0.0, 0.15, 2)
        cap = top + tilt[0] * a + tilt[1] * b - 0.35 * (a**2 + b**2) ** 2 / radius**3
        heights[near] = np.maximum(heights[near], cap)
    hurst = random.uniform(0.6, 0.9)
    return heights + sloped(gaussian(random, hurst, size / 3.0), random.uniform(0.1, 0.4))


def cut_softly(heights: Array, top: float, width: float) -> Array:
    """Return heights with all above `top` worn down, over a transition of a width."""
    return np.asarray(-np.logaddexp(0.0, -(heights - top) / width) * width)


def gauss(random: np.random.Generator) -> Array:
    return sloped(gaussian(random, random.uniform(0.6, 0.95)), random.uniform(0.5, 1.5))


def worn(random: np.random.Generator) -> Array:
    """Stones with their tops ground down, and fine roughness."""
    heights = stone_tops(random)
    top = float(np.quantile(heights, random.uniform(0.6, 0.9)))
    flat = cut_softly(heights, top, random.uniform(0.08, 0.4) * float(heights.std()))
    return flat + sloped(gaussian(random, 0.8, 2e-3), random.uniform(0.05, 0.2))


def plateau(random: np.random.Generator) -> Array:
    """A Gaussian surface with its upper part ground down, and fine roughness."""
    heights = gaussian(random, random.uniform(0.7, 0.9))
    flat = cut_softly(heights, random.uniform(0.0, 1.0), random.uniform(0.1, 0.4))
    fine = sloped(gaussian(random, 0.8, 2e-3), random.uniform(0.05, 0.3))
    return sloped(flat, random.uniform(0.4, 1.2)) + fine


def intermittent(random: np.random.Generator) -> Array:
    """Long waves, and short ones whose amplitude changes from place to place."""
    form = sloped(gaussian(random, 0.8, LARGEST, 2e-3), random.uniform(0.2, 0.6))
    envelope = np.exp(random.uniform(0.4, 1.0) * gaussian(random, 0.8, 0.5 * LARGEST, 1e-3))
    fine = sloped(gaussian(random, 0.8, 2e-3), random.uniform(0.2, 0.6))
    return np.asarray(form + envelope * fine)


def voronoi(random: np.random.Generator) -> Array:
    """Tilted flat stones side by side, with vertical sides: a mosaic."""
    size = random.uniform(4e-3, 9e-3)
    count = int(LENGTHS[0] * LENGTHS[1] / size**2)
    middles = random.random((count, 2)) * LENGTHS
    x, y = (STEP * np.arange(points) for points in SHAPE)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    stone = cKDTree(middles, boxsize=np.array(LENGTHS)).query(points)[1].reshape(SHAPE)
    a, b = (
        (points[:, axis].reshape(SHAPE) - middles[stone, axis] + 0.5 * length) % length
        - 0.5 * length
        for axis, length in enumerate(LENGTHS)
    )
    level = random.normal(0.0, random.uniform(0.05, 0.12) * size, count)
    tilt = random.normal(0.0, random.uniform(0.05, 0.15), (count, 2))
    mosaic = level[stone] + tilt[stone, 0] * a + tilt[stone, 1] * b
    return rounded(mosaic) + sloped(gaussian(random, 0.8, 3e-3), random.uniform(0.1, 0.4))


def porous(random: np.random.Generator) -> Array:
    """A rough plane with pores whose walls are vertical."""
    form = gaussian(random, 0.8, 10e-3, 2e-3)
    pores = form < np.quantile(form, random.uniform(0.15, 0.4))
    depth = random.uniform(1e-3, 3e-3)
    plane = sloped(gaussian(random, random.uniform(0.7, 0.9)), random.uniform(0.2, 0.6))
    return plane - depth * rounded(pores.astype(float))


def patchwork(random: np.random.Generator) -> Array:
    """Patches of smooth and of rough faces, centimetres wide."""
    form = sloped(gaussian(random, 0.8, LARGEST, 2e-3), random.uniform(0.1, 0.3))
    patch = gaussian(random, 0.8, LARGEST, 6e-3) > random.uniform(-0.5, 0.5)
    smooth, rough = random.uniform(0.03, 0.15), random.uniform(0.3, 0.8)
    amplitude = rounded(np.where(patch, rough, smooth), 5e-4)
    return np.asarray(form + amplitude * sloped(gaussian(random, 0.8, 3e-3), 1.0))


def two_scale(random: np.random.Generator) -> Array:
    """Long waves and short ones with nothing between."""
    form = sloped(gaussian(random, 0.8, LARGEST, 5e-3), random.uniform(0.1, 0.4))
    return form + sloped(gaussian(random, 0.8, 1e-3), random.uniform(0.1, 0.5))


def rounded(heights: Array, width: float = EDGE) -> Array:
    """Return heights smoothed by a Gaussian of a standard deviation [m]."""
    return np.asarray(scipy.ndimage.gaussian_filter(heights, width / STEP, mode="wrap"))


def ridged(random: np.random.Generator, ratio: float, way: str) -> Array:
    """Gaussian waves `ratio` times as long along the sliding direction as across, or back.

    The geometric mean of their largest lengths is `LARGEST`; the slope is that of the steep way.
    """
    stretch = (ratio, 1.0) if way == "along" else (1.0, ratio)
    heights = gaussian(random, 0.8, LARGEST / ratio**0.5, stretch=stretch)
    steep = random.uniform(0.5, 1.5)
    return sloped(heights, steep / ratio if way == "along" else steep)


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
    heights = np.zeros(SHAPE)
    for radius, height in zip(radii, out, strict=True):
        a, b = around(random)
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


FAMILIES: dict[str, Callable[[np.random.Generator], Array]] = {
    "gauss": gauss,
    "stones": stone_tops,
    "worn": worn,
    "plateau": plateau,
    "intermittent": intermittent,
    "mosaic": voronoi,
    "porous": porous,
    "patchwork": patchwork,
    "two scales": two_scale,
}
INTERMITTENT: dict[str, Callable[[np.random.Generator], Array]] = {
    "turbulent": turbulent,
    "bursts": bursts,
    "chi-square": chi_square,
    "student": student,
    "worn bursts": worn_bursts,
    "buried": buried,
    "boulders": boulders,
}
"""Whose fine roughness or heights vary from place to place."""
RATIOS = (1.5, 2.0, 3.0, 6.0)
RIDGED = {
    f"{ratio:g}:1 {way}": partial(ridged, ratio=ratio, way=way)
    for ratio, way in product(RATIOS, ("along", "across"))
}


def surface(family: str, seed: int) -> HeightMap:
    """Return the map of a family and seed."""
    random = np.random.default_rng([seed, zlib.crc32(family.encode())])
    heights = (FAMILIES | INTERMITTENT | RIDGED)[family](random)
    x, y = (STEP * np.arange(points, dtype=np.float64) for points in SHAPE)
    return HeightMap(x, y, heights - heights.mean(), f"{family} {seed}")
