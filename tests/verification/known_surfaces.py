"""Surfaces whose contact is known, to judge what is said of a surface from two of its lines.

    python -m tests.verification.known_surfaces [--ridges] [--finer]

Five families of synthetic isotropic surfaces, none of them among those the law of
`gripscale.half_space.line_to_map` was fitted to (studies/surface_families.py). The truth is the
contact of the whole map; two lines of it are what a user has measured. Some minutes of one core;
truths are kept in results/known_surfaces.

Truths have four points in the smallest wave, by the dissipation. With eight points area changes by
-0.1, -0.1 and -0.5 %, friction by +0.6, +0.4 and +2.0 % (the first map of gauss, of stones and of
plateau, `--finer`).
"""

from __future__ import annotations

import argparse
import json
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import scipy.fft
import xarray as xr
from numpy.typing import NDArray

import gripscale as gs
from gripscale.experiment.task import Task
from gripscale.half_space import DirectContact, RoughContact
from gripscale.half_space.line_to_map import upper_height
from gripscale.model import Load
from gripscale.questions import Factor, LogNormalValue
from gripscale.questions.answer.best_estimate import ESTIMATED, best_estimate
from gripscale.questions.answer.samples import sample_numbers
from gripscale.surface import HeightMap, Measured, Profile, SineStack, Surface
from tests.samples import MEASURED_DMA, ROOT

Array = NDArray[np.float64]

LARGEST, SMALLEST = 12.8e-3, 0.4e-3
"""Largest wave of a surface, smallest wave of a contact [m]."""
STEP = 1e-4
"""Surfaces have waves down to two steps; a line crosses those too short for the contact."""
SHAPE = (2048, 512)
LENGTHS = (SHAPE[0] * STEP, SHAPE[1] * STEP)
SEEDS = range(8)
LOAD: dict[str, Any] = {
    "pressure": 3e5,
    "speed": 0.3,
    "smallest_wavelength": SMALLEST,
    "periodic": True,
    "workers": 1,
}
"""Keyword arguments of every solution [Pa, m/s, m]."""
TOLERANCE = 0.05
"""Relative error of the grid of a line."""
QUANTITIES = ("area", "friction")
TRUTHS = ROOT / "results" / "known_surfaces" / "truths.json"


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


def stone_tops(random: np.random.Generator) -> Array:
    """Return the highest of round, tilted caps over a floor, with roughness of a third of a cap."""
    size = random.uniform(5e-3, 10e-3)
    x, y = (STEP * np.arange(points) for points in SHAPE)
    floor = -0.6 * size
    heights = np.full(SHAPE, floor)
    for _ in range(int(2.0 * LENGTHS[0] * LENGTHS[1] / size**2)):
        radius = size * random.uniform(0.35, 0.75)
        a, b = (
            (axis - random.uniform(0.0, length) + 0.5 * length) % length - 0.5 * length
            for axis, length in zip((x, y), LENGTHS, strict=True)
        )
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


def ridged(random: np.random.Generator, ratio: float, way: str) -> Array:
    """Return Gaussian waves `ratio` times as long along the sliding direction as across, or back.

    The geometric mean of their largest lengths is `LARGEST`; the slope is that of the steep way.
    """
    stretch = (ratio, 1.0) if way == "along" else (1.0, ratio)
    heights = gaussian(random, 0.8, LARGEST / ratio**0.5, stretch=stretch)
    steep = random.uniform(0.5, 1.5)
    return sloped(heights, steep / ratio if way == "along" else steep)


Maker = Callable[[np.random.Generator], Array]
ISOTROPIC: dict[str, Maker] = {
    "gauss": gauss,
    "stones": stone_tops,
    "worn": worn,
    "plateau": plateau,
    "intermittent": intermittent,
}
RATIOS = (1.5, 2.0, 3.0, 6.0)
RIDGED: dict[str, Maker] = {
    f"{ratio:g}:1 {way}": partial(ridged, ratio=ratio, way=way)
    for ratio, way in product(RATIOS, ("along", "across"))
}


def surface(family: str, seed: int) -> HeightMap:
    """Return the map of a family and seed."""
    random = np.random.default_rng([seed, zlib.crc32(family.encode())])
    heights = (ISOTROPIC | RIDGED)[family](random)
    x, y = (STEP * np.arange(points, dtype=np.float64) for points in SHAPE)
    return HeightMap(x, y, heights - heights.mean(), f"{family} {seed}")


def two_lines(whole: HeightMap, seed: int) -> list[Profile]:
    """Return two lines at random places, a largest wave apart at least."""
    random, width = np.random.default_rng([seed, 2]), SHAPE[1]
    apart = round(LARGEST / STEP)
    first = int(random.integers(width))
    second = (first + int(random.integers(apart, width - apart))) % width
    return [Profile(whole.x, whole.z[:, column]) for column in (first, second)]


@cache
def tread() -> gs.Rubber:
    """Return the filled tread rubber."""
    return gs.fit_prony(gs.read_master_curve(MEASURED_DMA, reference_temperature=293.15))


def contact(part: Profile | HeightMap, tolerance: float | None) -> RoughContact:
    """Return the contact of a map or a line; it must converge."""
    solved = gs.solve_rough_contact(tread(), part, tolerance=tolerance, **LOAD)
    assert solved.converged, f"{part.name}: {solved.status}"
    return solved


def truth(whole: HeightMap, kept: Path = TRUTHS) -> dict[str, float]:
    """Return area and friction of a map; what is solved is kept by the heights it belongs to."""
    key = f"{whole.name}, heights {zlib.crc32(whole.z.tobytes()):08x}"
    truths = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    if key not in truths:
        solved = contact(whole, None)
        numbers = (solved.contact_fraction, solved.friction_from_dissipation)
        truths[key] = dict(zip(QUANTITIES, numbers, strict=True))
        kept.parent.mkdir(parents=True, exist_ok=True)
        kept.write_text(json.dumps(truths, indent=1), encoding="utf-8")
    return dict(truths[key])


class Estimate(NamedTuple):
    """A number of the surface, from lines."""

    value: float
    half_width: float
    """Of the interval with 90 % confidence, in ln(value)."""


SMALL_STRAIN = Factor("finite_strain", "none", LogNormalValue(1.0, 0.0), LogNormalValue(1.0, 0.0))
"""Truths and lines are solved at small strain both."""


def estimate(profiles: Sequence[Profile]) -> dict[str, Estimate]:
    """Return area and friction of the surface that lines lie on, as `gripscale compare` does."""
    waves = SineStack([LARGEST], [1e-3])
    load = Load(LOAD["pressure"], LOAD["speed"], 0.1)
    model = DirectContact(SMALLEST, TOLERANCE, periodic=True)
    samples = []
    for number, profile in enumerate(profiles):
        measured = Surface(waves, "", measured=Measured.of([profile]), end=SMALLEST)
        answer = model.predict(tread(), measured, load)
        numbers = sample_numbers(answer, Task(tread(), measured, load, model))
        samples.append(numbers.drop_dims("curve").assign_coords(subject=str(number)))
    lines = xr.concat(samples, "sample").expand_dims(rung=[DirectContact.name])
    best = best_estimate(lines, [SMALL_STRAIN], upper_height=upper_height(profiles, LARGEST))
    return {
        quantity: Estimate(
            float(best[f"best_{name}"]), float(np.arcsinh(best[f"best_{name}_half_width"]))
        )
        for quantity, name in zip(QUANTITIES, ESTIMATED, strict=True)
    }


@dataclass(frozen=True)
class Judged:
    """An estimate of a map and its truth."""

    family: str
    seed: int
    estimate: Estimate
    truth: float

    @property
    def miss(self) -> float:
        """ln(estimate / truth)."""
        return float(np.log(self.estimate.value / self.truth))

    @property
    def half_widths(self) -> float:
        """Magnitude of the miss, in half-widths."""
        return abs(self.miss) / self.estimate.half_width


def judged(families: Sequence[str], seeds: Sequence[int]) -> dict[str, list[Judged]]:
    """Return estimates and truths of all maps, by quantity."""
    results: dict[str, list[Judged]] = {name: [] for name in QUANTITIES}
    for family, seed in product(families, seeds):
        whole = surface(family, seed)
        true, estimates = truth(whole), estimate(two_lines(whole, seed))
        for name in QUANTITIES:
            results[name].append(Judged(family, seed, estimates[name], true[name]))
    return results


def bias(results: Sequence[Judged]) -> tuple[float, float]:
    """Return mean miss and mean half-width."""
    misses, widths = zip(*((r.miss, r.estimate.half_width) for r in results), strict=True)
    return float(np.mean(misses)), float(np.mean(widths))


def covered(results: Sequence[Judged]) -> int:
    """Return how many intervals hold the truth."""
    return sum(r.half_widths <= 1.0 for r in results)


def table(results: Sequence[Judged]) -> Iterator[str]:
    """Yield a row for each family and for all."""
    yield "| family | truth | ln(estimate/truth) | scatter | half-width | held | largest miss |"
    yield "|---|---|---|---|---|---|---|"
    families = list(dict.fromkeys(r.family for r in results))
    for family in [*families, "all"]:
        members = [r for r in results if family in (r.family, "all")]
        mean, width = bias(members)
        truths = [r.truth for r in members]
        yield (
            f"| {family} | {min(truths):.3f} to {max(truths):.3f} | {mean:+.3f} | "
            f"{np.std([r.miss for r in members], ddof=1):.3f} | {width:.3f} | "
            f"{covered(members)} of {len(members)} | {max(r.half_widths for r in members):.2f} |"
        )


def finer_grids() -> Iterator[str]:
    """Yield what eight points in the smallest wave change, on the first map of three families."""
    unreached = 1e-3  # that the grids are refined until they have their most points, four millions
    for family in ("gauss", "stones", "plateau"):
        solved = gs.solve_rough_contact(tread(), surface(family, 0), tolerance=unreached, **LOAD)
        coarse, fine = solved.grids[-2:]
        assert (coarse.points, fine.points) == (SHAPE[0], 2 * SHAPE[0])
        area = fine.contact_fraction / coarse.contact_fraction - 1.0
        friction = fine.friction_from_dissipation / coarse.friction_from_dissipation - 1.0
        yield f"{family}: area {area:+.1%}, friction {friction:+.1%}"


def main() -> None:
    """Print a table for area and friction."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ridges", action="store_true", help="four maps each of ridged surfaces")
    parser.add_argument("--finer", action="store_true", help="grids twice as fine, of three maps")
    options = parser.parse_args()
    if options.finer:
        for line in finer_grids():
            print(line, flush=True)
        return
    families, seeds = (RIDGED, range(4)) if options.ridges else (ISOTROPIC, SEEDS)
    for name, results in judged(list(families), seeds).items():
        print(name, *table(results), sep="\n", end="\n\n")


if __name__ == "__main__":
    main()
