"""Isotropic maps that represent the surface on which a profile was measured.

The amplitudes of a Gaussian map are those of the areal spectrum, its phases are random. Heights are
brought to the measured distribution by rank, the spectrum back, in turns: the iterated amplitude
adjusted Fourier transform (T. Schreiber & A. Schmitz, Phys. Rev. Lett. 77 (1996) 635,
doi:10.1103/PhysRevLett.77.635), on a map. Maps with the statistics of the lines in every direction
start from a Gaussian map (`studies.isotropic_maps.line_statistics`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.surface.profile import HeightMap, Profile, profile_list
from gripscale.surface.spectrum import areal_spectrum, profile_spectrum
from studies.isotropic_maps.line_statistics import (
    LineMatching,
    MeasuredLine,
    Square,
    Waves,
    periodic_lines,
)

TURNS = 50
"""Turns of heights and spectrum; the last one sets the heights, so that these are exact."""


def map_amplitudes(profiles: Sequence[Profile], square: Square) -> Array:
    """Return the rms of each wave of an isotropic map (`rfft2`) with the profiles' spectrum [m]."""
    spectrum = areal_spectrum(profile_spectrum(list(profiles)))
    q = np.where(square.resolved, square.wavenumber, np.inf)
    density = np.where(square.resolved, spectrum.at(np.where(np.isinf(q), 1.0, q)), 0.0)
    return np.asarray(np.sqrt(density) * (2.0 * np.pi / square.length) * square.points**2)


def with_heights(
    square: Square, waves: Waves, amplitudes: Array, lines: Sequence[MeasuredLine]
) -> Array:
    """Return heights [m] with exactly the distribution of the lines, nearly these amplitudes."""
    measured = np.sort(np.concatenate([line.heights for line in lines]))
    ranks = (np.arange(square.points**2) + 0.5) / square.points**2
    target = np.interp(ranks * measured.size - 0.5, np.arange(measured.size), measured)
    for _ in range(TURNS):
        heights = np.empty(target.size)
        heights[np.argsort(square.heights(waves), axis=None)] = target
        waves = square.spectrum(heights.reshape(square.points, -1))
        size = np.abs(waves)
        waves *= amplitudes / np.where(size > 0.0, size, 1.0)
    return heights.reshape(square.points, -1)


CONSTRUCTIONS = {
    "spectrum": "spectrum of the lines, random phases",
    "heights": "spectrum and heights of the lines",
    "lines": "statistics of pieces of the lines in every direction",
}
"""Constructions, and the properties of the measured lines that each keeps."""

STEPS_IN_WAVE = 4
"""Steps of a map in its smallest wave."""

FEWEST_POINTS, MOST_POINTS = 128, 4096
MULTIPLE = 16
"""The coarsest of the nested squares has an eighth of the points each way, an even number."""


def isotropic_maps(
    profile: Profile | Sequence[Profile],
    *,
    smallest_wavelength: float,
    construction: str = "lines",
    points: int = 512,
    seeds: Iterable[int] = range(6),
    on_batch: Callable[[int, float], None] | None = None,
) -> Iterator[HeightMap]:
    """Yield synthetic isotropic maps made from measured profiles, one for each seed.

    A profile does not determine the surface it was measured on. "spectrum" and "heights" keep
    neither flat tops nor the place of the roughness. "lines" brings the lines of the map in every
    direction to the distributions of what some hundred filters answer on the measured lines, by
    class of height (`studies.isotropic_maps.line_statistics`): half a minute a map of 512 x 512
    points on one core, and some seconds before the first.

    Raises `InputError` if an argument is out of its range, when the first map is asked for.

    Parameters
    ----------
    profile : Profile or sequence of Profile
        Cleaned profiles of one surface, with the same step (within 0.1 %), together at least four
        times as long as a map. Missing heights are interpolated linearly.
    smallest_wavelength : float
        Smallest wave of interest [m], at least four steps of the profile; a map is `points / 4` of
        them long. It includes waves half as long: lines of a map that is cut off lack the shorter
        waves that they would cross at an angle.
    construction : str
        "lines", "heights" or "spectrum".
    points : int
        Points of the map each way, a multiple of 16 from 128 to 4096.
    seeds : iterable of int
        Seeds of the random numbers: the same seed gives the same map.
    on_batch : callable, optional
        Called repeatedly with the seed and the share of its map that is done.

    Yields
    ------
    HeightMap
        One period; its name begins with "synthetic".
    """
    profiles = profile_list(profile)
    number = checks.whole("points", points, least=FEWEST_POINTS, most=MOST_POINTS)
    if number % MULTIPLE:
        raise InputError(f"points must be a multiple of {MULTIPLE}; got {number}")
    smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    least = STEPS_IN_WAVE * max(p.step for p in profiles)
    if smallest < least * (1.0 - 1e-9):
        raise InputError(
            f"smallest_wavelength must be at least {STEPS_IN_WAVE} steps of the profile, "
            f"{least:.4g} m; got {smallest:.4g} m"
        )
    checks.one_of("construction", construction, CONSTRUCTIONS)
    seed_list = seed_numbers(seeds)
    square = Square(number, number * smallest / STEPS_IN_WAVE)
    lines = periodic_lines(profiles, square.length)
    amplitudes = map_amplitudes(profiles, square)
    matching = LineMatching.of(lines, square) if construction == "lines" else None
    x = np.asarray(square.step * np.arange(square.points), dtype=np.float64)
    names = ", ".join(p.name or "unnamed profile" for p in profiles)
    report = on_batch or (lambda seed, share: None)
    for seed in seed_list:
        random = np.random.default_rng(seed)
        # the half spectrum of a Gaussian map with these amplitudes in the mean
        waves = np.asarray(amplitudes * square.spectrum(square.noise(random)) / square.points)
        if construction == "heights":
            heights = with_heights(square, waves, amplitudes, lines)
        elif matching is not None:
            heights = square.heights(matching.draw(waves, random, partial(report, seed)))
        else:
            heights = square.heights(waves)
        report(seed, 1.0)
        yield HeightMap(
            x,
            x,
            heights.astype(float),
            name=f"synthetic isotropic map ({construction}) of {names}",
            source=f"synthetic: {CONSTRUCTIONS[construction]}; seed {seed}",
        )


def seed_numbers(seeds: Iterable[int]) -> list[int]:
    """Return seeds as a list; raise `InputError` unless they are whole numbers, one at least."""
    single = isinstance(seeds, np.ndarray) and not seeds.ndim
    if single or not isinstance(seeds, Iterable) or isinstance(seeds, str | bytes):
        raise InputError(f"seeds must be a list of whole numbers; got {checks.short_repr(seeds)}")
    return [checks.whole("seeds", seed, least=0, most=2**32 - 1) for seed in seeds]
