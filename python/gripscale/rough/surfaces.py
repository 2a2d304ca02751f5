"""Surfaces to compare with: one period of a line, superposed sines, and random phases."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import scipy.fft

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rough.ends import joined
from gripscale.rough.heights import DEFAULT_STEPS, periodic_heights
from gripscale.surface import HeightMap, Profile, SineStack
from gripscale.surface.gaps import filled
from gripscale.surface.profile import FEWEST_POINTS

Surface = TypeVar("Surface", Profile, HeightMap)

POINTS_IN_WAVE = 8
MOST_POINTS = 10_000_000


def one_period(line: Profile, smallest_wavelength: float | None = None) -> Profile:
    """Return a line as `solve_rough_contact` sees it, for any model to take with `periodic=True`.

    Missing heights are filled, ends joined, and waves left out that are shorter than
    `smallest_wavelength` [m], by default four steps. The points are the fewest that carry the
    waves that are left, four in the smallest.

    Raises
    ------
    InputError
        As `solve_rough_contact` does for its surface.
    """
    checks.instance("line", line, Profile)
    heights = periodic_heights(line, smallest_wavelength=smallest_wavelength, periodic=False)
    period = heights.grid.lengths[0]
    waves = int(period / heights.smallest_wavelength * (1.0 + 1e-9))
    points = max(FEWEST_POINTS, DEFAULT_STEPS * waves)
    x = heights.origin[0] + np.linspace(0.0, period, points, endpoint=False)
    return Profile(x, heights.on((points,)), line.name, source=line.source)


def surface_of_sines(stack: SineStack, length: float, seed: int) -> Profile:
    """Return a periodic line of superposed sine waves, each with a random phase.

    Parameters
    ----------
    stack : SineStack
        The waves; each wavelength is changed to the nearest that fits `length` a whole number of
        times, its amplitude with it, so that slopes stay.
    length : float
        Period [m], at least the largest wavelength.
    seed : int
        Seed of the random phases.

    Raises
    ------
    InputError
        If an argument is out of its range, or there would be more than ten million points.
    """
    checks.instance("stack", stack, SineStack)
    period = checks.positive("length", length, unit="m")
    if period < stack.wavelength.max():
        raise InputError(
            f"length must be at least the largest wavelength, {stack.wavelength.max():g} m; "
            f"got {period:g} m"
        )
    counts = np.rint(period / stack.wavelength)
    points = max(64, POINTS_IN_WAVE * int(counts.max()))
    if points > MOST_POINTS:
        raise InputError(
            f"length over the smallest wavelength must be at most {MOST_POINTS // POINTS_IN_WAVE}; "
            f"got {int(counts.max())}"
        )
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    place = np.arange(points) / points
    amplitudes = stack.amplitude * (period / counts) / stack.wavelength
    z = np.zeros(points)
    for count, amplitude in zip(counts, amplitudes, strict=True):
        z += amplitude * np.cos(2.0 * np.pi * (count * place + random.random()))
    return Profile(place * period, z, name=f"{len(stack)} sine waves", source=f"seed {seed}")


def random_phases(surface: Surface, seed: int) -> Surface:
    """Return a periodic surface with the spectrum of `surface` and random phases.

    Missing heights are filled and ends joined as `solve_rough_contact` does. The height difference
    correlation of that filled surface stays; where the roughness sits, and the distribution of
    heights, do not. Steep lines that bridge gaps are in the spectrum of the filled surface: where
    steep flanks are missing it is rougher than the pairs of measured heights say.

    Raises
    ------
    InputError
        If `seed` is not a whole number that is not negative.
    """
    random = np.random.default_rng(checks.whole("seed", seed, least=0, most=2**32 - 1))
    if not isinstance(surface, Profile | HeightMap):
        raise InputError(f"surface must be a Profile or a HeightMap; got {type(surface).__name__}")
    steps = surface.step if isinstance(surface, HeightMap) else ()
    z = joined(filled(surface.z, steps))
    spectrum = scipy.fft.rfftn(random.standard_normal(z.shape))  # phases of a real surface
    size = np.abs(spectrum)
    spectrum *= np.abs(scipy.fft.rfftn(z)) / np.where(size > 0.0, size, 1.0)
    drawn = scipy.fft.irfftn(spectrum, s=z.shape)
    name, source = f"{surface.name}, random phases".lstrip(", "), f"seed {seed}"
    if isinstance(surface, Profile):
        return Profile(surface.x, drawn, name, source)
    return HeightMap(surface.x, surface.y, drawn, name, source)
