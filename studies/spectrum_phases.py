"""What the phases of a surface change: its contact over that of its spectrum with random phases.

    python -m studies.spectrum_phases

Maps of eleven families (`studies.surface_families`) are solved as they are; so is what a case makes
of their spectrum, without the factor. It is ln(map / spectrum) over 1 - A, A the contact fraction
with random phases: the mean of the means of the families, and the scatter of one surface about it.
Once over all families, once over those whose heights have a negative skewness, as those of the
shipped road: their tops are broad, their valleys deep. The road itself stands beside them and is
not fitted. Half an hour of one core; solved surfaces are kept in studies/spectrum_phases.csv, and
a stopped run goes on.
"""

from __future__ import annotations

import csv
import math
import warnings
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import scipy.stats
import xarray as xr

import gripscale as gs
from gripscale.questions.answer.direct_contact import continuation_factors
from gripscale.questions.answer.estimate import DIRECT, ESTIMATED, answer_of_samples
from gripscale.surface import areal_spectrum, map_spectrum, profile_spectrum
from studies.direct_samples import SMALL_STRAIN, direct_samples
from studies.line_to_map import (
    CUT_OFF,
    NEARLY_FULL,
    PRESSURES,
    RUBBERS,
    SOLVED,
    SPEED,
    TOLERANCE,
    rubber_of,
)
from studies.shipped import road
from studies.surface_families import FAMILIES, LARGEST, family_map

TABLE = Path(__file__).with_suffix(".csv")
SEEDS = 4
STATIONS = ("station 0", "station 1")


class Pair(NamedTuple):
    """Numbers of a surface, and of its spectrum with random phases."""

    family: str
    seed: int
    rubber: str
    pressure: float
    skewness: float
    contact_fraction: float
    friction: float
    spectrum_contact_fraction: float
    spectrum_friction: float

    def ratio(self, name: str) -> float:
        """Return ln(surface / spectrum) of "contact_fraction" or "friction" at small contact."""
        ratio = math.log(getattr(self, name) / getattr(self, f"spectrum_{name}"))
        return ratio / (1.0 - self.spectrum_contact_fraction)


def answered(case: gs.Case) -> xr.Dataset:
    """Return the answer of the surface that the lines of a case lie on, at small strain."""
    samples = direct_samples(case).expand_dims(model=[DIRECT])
    return answer_of_samples(samples, [SMALL_STRAIN, *continuation_factors(case, None)])


def small_strain(case: gs.Case) -> dict[str, float]:
    """Return area and friction of `answered`."""
    best = answered(case)
    return {name: float(best[f"answer_{name}"]) for name in ESTIMATED}


def spectrum_of(heights: gs.HeightMap | gs.Profile, phases: str = "random") -> gs.Spectrum:
    """Return the spectrum of one period of a map or of a line, with all its flanks."""
    if isinstance(heights, gs.HeightMap):
        steps: dict[str, Any] = dict(zip(("x_step", "y_step"), heights.step, strict=True))
        areal = map_spectrum(heights.z, taper="none", steepest=math.inf, **steps)
    else:
        areal = areal_spectrum(profile_spectrum(heights, steepest=math.inf))
    return gs.Spectrum(areal.wavenumber, areal.density, name=heights.name, phases=phases)


def solved(family: str, seed: int) -> Pair | None:
    """Return a map and its spectrum, or a station and its; None for a map that is not solved."""
    number = [*FAMILIES, *STATIONS].index(family)
    rubber = "tread" if family in STATIONS else RUBBERS[seed % 3]
    pressure = PRESSURES[(seed + number) % 2][(seed // 2 + number) % 3]
    load: dict[str, Any] = {"pressure": pressure, "speed": SPEED}
    if family in STATIONS:
        line = road(STATIONS.index(family))
        load |= {"pressure": PRESSURES[0][2 - seed % 2], "smallest_wavelength": 1e-4}
        own = small_strain(gs.Case(line, rubber_of(rubber), **load))
        known, heights = spectrum_of(line), line.z
    else:
        whole = family_map(family, seed)
        load["smallest_wavelength"] = CUT_OFF
        options: dict[str, Any] = {"periodic": True, "tolerance": TOLERANCE, "workers": 1}
        contact = gs.solve_rough_contact(rubber_of(rubber), whole, **load, **options)
        if contact.status not in SOLVED:
            return None
        numbers = (contact.contact_fraction, contact.friction_from_dissipation)
        own, known = dict(zip(ESTIMATED, numbers, strict=True)), spectrum_of(whole)
        heights = whole.z
        load["footprint"] = LARGEST
    of_spectrum = small_strain(gs.Case(known, rubber_of(rubber), **load))
    return Pair(
        family,
        seed,
        rubber,
        load["pressure"],
        float(scipy.stats.skew(heights, nan_policy="omit", axis=None)),
        *(own[name] for name in ("contact_fraction", "friction")),
        *(of_spectrum[name] for name in ("contact_fraction", "friction")),
    )


def pairs(path: Path = TABLE, seeds: int = SEEDS) -> list[Pair]:
    """Return all pairs, solving those that the table does not hold yet."""
    kept = []
    if path.exists():
        with path.open(encoding="utf-8") as file:
            kept = [
                Pair(row[0], int(row[1]), row[2], *map(float, row[3:]))
                for row in list(csv.reader(file))[1:]
            ]
    else:
        path.write_text(",".join(Pair._fields) + "\n", encoding="utf-8")
    done = {(pair.family, pair.seed) for pair in kept}
    for seed, family in product(range(seeds), [*FAMILIES, *STATIONS]):
        if (family, seed) in done or (family in STATIONS and seed > 1):
            continue
        pair = solved(family, seed)
        if pair is None:
            continue
        kept.append(pair)
        with path.open("a", encoding="utf-8") as file:
            cells = [f"{value:.6g}" if isinstance(value, float) else str(value) for value in pair]
            file.write(",".join(cells) + "\n")
        print(
            f"{family} {seed}: {', '.join(f'{pair.ratio(n):+.2f}' for n in ESTIMATED)}", flush=True
        )
    return kept


def by_family(solved_pairs: Sequence[Pair]) -> dict[str, list[Pair]]:
    """Return the pairs of each family that are not nearly in full contact."""
    free = [pair for pair in solved_pairs if pair.spectrum_contact_fraction < NEARLY_FULL]
    names = dict.fromkeys(pair.family for pair in free)
    return {name: [pair for pair in free if pair.family == name] for name in names}


def factor(families: Sequence[Sequence[Pair]], name: str) -> tuple[float, float, float]:
    """Return mean, scatter of one surface and its degrees of freedom, over families.

    The latter are those of a variance that differs as that of the families does, as of
    `studies.line_to_map`.
    """
    ratios = [np.array([pair.ratio(name) for pair in members]) for members in families]
    mean = float(np.mean([each.mean() for each in ratios]))
    squares = np.array([np.mean((each - mean) ** 2) for each in ratios])
    scatter = math.sqrt(squares.sum() / (squares.size - 1))
    return mean, scatter, float(2.0 * squares.size * squares.mean() ** 2 / squares.var(ddof=1))


def lines() -> Iterator[str]:
    """Yield what families and stations show, and the factors."""
    groups = by_family(pairs())
    yield "| surfaces | skewness | pressure [bar] | ln area | ln friction |"
    yield "|---|---|---|---|---|"
    for name, members in groups.items():
        numbers = [", ".join(f"{p.ratio(each):+.2f}" for p in members) for each in ESTIMATED]
        bars = ", ".join(f"{1e-5 * pair.pressure:g}" for pair in members)
        yield f"| {name} | {skewness(members):+.2f} | {bars} | {' | '.join(numbers)} |"
    fitted = [members for name, members in groups.items() if name in FAMILIES]
    worn = [members for members in fitted if skewness(members) < 0.0]
    for phases, families in (("real", fitted), ("worn", worn)):
        for name in ESTIMATED:
            mean, scatter, freedom = factor(families, name)
            yield (
                f"{phases}, {name}, {len(families)} families: mean {mean:+.2f}, scatter "
                f"{scatter:.2f}, {freedom:.0f} degrees of freedom"
            )


def skewness(members: Sequence[Pair]) -> float:
    """Return the mean skewness of the heights of a family."""
    return float(np.mean([pair.skewness for pair in members]))


if __name__ == "__main__":
    with warnings.catch_warnings(action="ignore"):
        for text in lines():
            print(text)
