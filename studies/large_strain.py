"""The factor of large strain of an answer: finite over small strain, on windows of profiles.

    python -m studies.large_strain solve
    python -m studies.large_strain
    python -m studies.large_strain mesh

Windows of four kinds of profile, under loads from 1 to 10 bar and speeds from 3 mm/s to 30 m/s,
log-uniform, on six rubbers:

- the two stations of the shipped road, with 50 and, three on each rubber, also with 100 waves
- lines with the spectrum of another road (`studies.measured_road`), a quarter as long
- stones with flanks of slope 2 on 8 mm
- lines of the eight families of `studies.surface_families`

Rubber is two treads as measured, two softened to 0.35 and 0.2 of their modulus, one of a tenth, and
an unfilled one. Every window is solved in the block and in the half-space. The ratios are kept in
`studies/large_strain.csv` as they come, and a further run solves what is missing: an hour of one
core. The law of `gripscale.half_space.line_to_map` is fitted to them in a second, by maximum
likelihood of normal logarithms, and judged by windows of rubbers and of profiles that are left out.
The windows that are farthest from it are solved again on twice the columns.
"""

from __future__ import annotations

import csv
import sys
import time
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale.core import Array, Mask
from gripscale.half_space import one_period, spread_windows
from gripscale.half_space.line_to_map import (
    AREA_SCATTER,
    FRICTION_SCATTER,
    finite_over_small,
    pressure_over_modulus,
)
from gripscale.half_space.model import QUICK
from gripscale.half_space.response import HalfSpace
from gripscale.rubber.measured_rubber import styrene_butadiene
from studies.measured_road import REDUCED, road_lines
from studies.shipped import road, tread
from studies.surface_families import FAMILIES, LARGEST, STEP, family_map
from studies.treads import compound

RATIOS = Path(__file__).with_suffix(".csv")
KINDS = {"road": 8, "other road": 3, "stones": 3, "families": 6}
"""Windows of each kind of profile, for every rubber."""
RUBBERS = {
    "tread": ("tread", 1.0),
    "S100": ("S100", 1.0),
    "S140 softened": ("S140", 0.35),
    "R40 softened": ("R40", 0.2),
    "tread of a tenth": ("tread", 0.1),
    "unfilled": ("unfilled", 1.0),
}
"""Which rubber, and the factor of its modulus."""
PRESSURES, SPEEDS = (1e5, 1e6), (3e-3, 30.0)
ROAD_WAVE = 28.7e-3
"""Largest wave of the shipped road [m]."""
WINDOW, WAVES = 1.1, 50
"""Length of a window in largest waves, and how many waves it keeps; a comparison keeps 100."""
FINER, FINER_WAVES, FINER_COUNT = "finer road", 100, 3
"""Kind of the windows of the road that are also solved with more waves, and how many a rubber."""
STONES = 8e-3
"""Period of the stones [m]."""
QUANTITIES = {"contact_fraction": "area", "friction": "friction"}
SCATTERS = {"contact_fraction": AREA_SCATTER, "friction": FRICTION_SCATTER}
NORMAL = 1.645
"""Half width of a 90 % interval in standard deviations."""
BINS = (0.0, 0.02, 0.05, 0.1, 0.2, 0.5, 2.0)
COLUMNS = (
    "number",
    "rubber",
    "kind",
    "profile",
    "largest wave [m]",
    "pressure [Pa]",
    "speed [m/s]",
    "pressure over modulus",
    "slope in contact",
    "area",
    "friction",
    "area ratio",
    "friction ratio",
    "columns",
    "seconds",
    "status",
)


@dataclass(frozen=True)
class Window:
    """One period of a profile, and which of its waves count."""

    name: str
    line: gs.Profile
    largest: float
    smallest: float


@dataclass(frozen=True)
class StrainCase:
    """A window of one kind of profile under a load."""

    number: int
    rubber: str
    kind: str
    index: int
    """Which window of this kind."""
    pressure: float
    speed: float


@lru_cache
def rubber(name: str) -> gs.Rubber:
    """Return one of `RUBBERS`."""
    of, factor = RUBBERS[name]
    whole = {"tread": tread, "unfilled": styrene_butadiene}.get(of, lambda: compound(of))()
    return replace(
        whole,
        equilibrium_modulus=factor * whole.equilibrium_modulus,
        moduli=factor * np.asarray(whole.moduli),
        admissible=None,
    )


@lru_cache
def _road_windows(other: bool, count: int) -> list[gs.Profile]:
    lines = road_lines() if other else (road(0), road(1))
    length = WINDOW * ROAD_WAVE * (REDUCED if other else 1.0)
    return spread_windows(lines, length, count)


def window(kind: str, index: int) -> Window:
    """Return a window of a kind; of the roads there are as many as are solved, else any number."""
    if kind == FINER:
        coarse = window("road", index)
        return replace(coarse, smallest=coarse.smallest * WAVES / FINER_WAVES)
    if kind in ("road", "other road"):
        other = kind == "other road"
        largest = ROAD_WAVE * (REDUCED if other else 1.0)
        line = _road_windows(other, len(RUBBERS) * KINDS[kind])[index]
        name = f"{line.name} from {line.x[0]:.3f} m"
        return Window(name, line, largest, WINDOW * largest / WAVES)
    if kind == "stones":
        line = stones(index)
        return Window(line.name, line, STONES, 0.1e-3)
    family = list(FAMILIES)[index % len(FAMILIES)]
    heights = family_map(family, index // len(FAMILIES)).z[:, 0]
    points = round(WINDOW * LARGEST / STEP)
    x: Array = STEP * np.arange(points, dtype=np.float64)
    line = one_period(gs.Profile(x, heights[:points], family))
    name = f"{family} {index // len(FAMILIES)}"
    return Window(name, line, LARGEST, WINDOW * LARGEST / WAVES)


def stones(seed: int) -> gs.Profile:
    """Return two or three stones of different height and width, their edges rounded by 0.05 mm."""
    random, points = np.random.default_rng([seed, 71]), 640
    x: Array = STONES * np.arange(points, dtype=np.float64) / points
    z, number = np.zeros(points), random.integers(2, 4)
    for stone in range(number):
        middle = STONES * (stone + random.uniform(0.3, 0.7)) / number
        height, half_width = random.uniform(0.3e-3, 0.5e-3), 0.5 * random.uniform(0.1e-3, 1.5e-3)
        outside = np.maximum(np.abs(x - middle) - half_width, 0.0)
        z = np.maximum(z, height - 2.0 * outside)
    wave = 2.0 * np.pi * np.fft.rfftfreq(points, STONES / points)
    z = np.fft.irfft(np.fft.rfft(z) * np.exp(-0.5 * (wave * 0.05e-3) ** 2), points)
    return gs.Profile(x, np.asarray(z, dtype=np.float64), f"stones {seed}")


def cases() -> list[StrainCase]:
    """Return all cases, in an order that spreads over rubbers and kinds."""
    random = np.random.default_rng(2026)
    out: list[StrainCase] = []
    for at, name in enumerate(RUBBERS):
        for kind, count in KINDS.items():
            for each in range(count):
                pressure, speed = (
                    float(np.exp(random.uniform(*np.log(ends)))) for ends in (PRESSURES, SPEEDS)
                )
                # windows of a road alternate between the rubbers
                index = at + len(RUBBERS) * each if "road" in kind else at * count + each
                out.append(StrainCase(len(out), name, kind, index, pressure, speed))
    of_road = [case for case in out if case.kind == "road"]
    finer = [case for case in of_road if case.index < FINER_COUNT * len(RUBBERS)]
    shuffled = [out[at] for at in random.permutation(len(out))]
    more = [replace(case, kind=FINER, number=len(out) + at) for at, case in enumerate(finer)]
    return shuffled + [more[at] for at in random.permutation(len(more))]


def solved(case: StrainCase, **options: Any) -> dict[str, Any]:
    """Return a row of the table; `options` are further arguments of `solve_profile`."""
    begin = time.monotonic()
    at, solid = window(case.kind, case.index), rubber(case.rubber)
    load = {"pressure": case.pressure, "speed": case.speed}
    common: dict[str, Any] = {**load, "smallest_wavelength": at.smallest, "periodic": True}
    small = gs.solve_rough_contact(solid, at.line, tolerance=0.01, workers=1, **common)
    given: dict[str, Any] = {"settings": QUICK, "time_limit": 120.0, "workers": 1} | options
    block = gs.solve_profile(solid, at.line, **common, **given)
    pressed = pressure_over_modulus(HalfSpace(solid, case.speed), case.pressure, at.largest)
    areas, frictions = (
        (getattr(block, name), getattr(small, name))
        for name in ("contact_fraction", "friction_from_dissipation")
    )
    status = str(block.status) if small.converged else f"half-space: {small.status}"
    numbers = (
        *(at.largest, case.pressure, case.speed, pressed),
        *(small.slope_in_contact, areas[1], frictions[1]),
        *(areas[0] / areas[1], frictions[0] / frictions[1]),
    )
    columns = block.details["columns"]
    seconds = f"{time.monotonic() - begin:.1f}"
    shown = [f"{float(number):.5g}" for number in numbers]
    row = (case.number, case.rubber, case.kind, at.name, *shown, columns, seconds, status)
    return dict(zip(COLUMNS, row, strict=True))


def solve_missing() -> None:
    """Solve what the table does not have, and append it."""
    new = not RATIOS.exists()
    there = set() if new else {int(row["number"]) for row in rows()}
    with RATIOS.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        if new:
            writer.writeheader()
        for case in cases():
            if case.number not in there:
                writer.writerow(solved(case))
                file.flush()


def rows() -> Iterator[dict[str, str]]:
    """Yield the rows of the table."""
    with RATIOS.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


class Points(NamedTuple):
    """Windows that converged; arrays of shape (windows,)."""

    rubber: NDArray[np.str_]
    kind: NDArray[np.str_]  # windows of the road with more waves are windows of the road
    pressed: Array  # pressure over modulus [-]
    area: Array  # at small strain [-]
    log_ratio: Mapping[str, Array]  # of finite over small strain, by the number of an answer
    number: Array

    def size(self, quantity: str) -> Array:
        """Return what mean and scatter of the logarithm are proportional to."""
        _, scatter = finite_over_small(quantity, self.pressed, self.area)
        return np.asarray(scatter / SCATTERS[quantity])

    def inside(self, quantity: str, law: Law, which: Mask) -> Mask:
        """Return which of some windows lie inside the 90 % interval of a law."""
        size = self.size(quantity)[which]
        miss = self.log_ratio[quantity][which] - law.mean * size
        return np.asarray(np.abs(miss) < NORMAL * law.scatter * size)


class Law(NamedTuple):
    """Mean and standard deviation of the logarithm, over its size."""

    mean: float
    scatter: float

    @classmethod
    def of(cls, points: Points, quantity: str, which: Mask) -> Law:
        """Return the law of some windows; of the scatter, the size cancels in the likelihood."""
        scaled = (points.log_ratio[quantity] / points.size(quantity))[which]
        return cls(float(scaled.mean()), float(scaled.std(ddof=1)))


def points() -> Points:
    """Return the windows of the table that converged."""
    good = [row for row in rows() if row["status"] == "converged"]

    def column(name: str) -> Array:
        return np.array([float(row[name]) for row in good])

    ratios = {name: np.log(column(f"{word} ratio")) for name, word in QUANTITIES.items()}
    kinds = np.array([row["kind"].replace(FINER, "road") for row in good])
    pressed, area = column("pressure over modulus"), column("area")
    solids = np.array([row["rubber"] for row in good])
    return Points(solids, kinds, pressed, area, ratios, column("number"))


def left_out(of: Points, quantity: str, by: NDArray[np.str_]) -> dict[str, Mask]:
    """Return which windows of each group lie inside the interval of a law of the other groups."""
    groups = [str(group) for group in np.unique(by)]
    return {
        group: of.inside(quantity, Law.of(of, quantity, by != group), by == group)
        for group in groups
    }


def main() -> None:
    """Print the law, and how many windows that are left out it holds."""
    of, every = points(), Counter(row["status"] for row in rows())
    print(f"{every['converged']} windows of {every.total()}: {dict(every)}")
    for name in QUANTITIES:
        every_window = of.area > 0.0
        law = Law.of(of, name, every_window)
        print(
            f"{name}: mean {law.mean:.3f}, scatter {law.scatter:.3f}, "
            f"{of.inside(name, law, every_window).mean():.0%} inside"
        )
        for by in (of.rubber, of.kind):
            held = left_out(of, name, by)
            together = np.concatenate([*held.values()]).mean()
            each = ", ".join(f"{group} {inside.mean():.0%}" for group, inside in held.items())
            print(f"  left out: {together:.0%} ({each})")
        for edges in pairwise(BINS):
            there = (of.pressed >= edges[0]) & (of.pressed < edges[1])
            ratios = np.expm1(of.log_ratio[name][there])
            print(
                f"  p/|E*| {edges[0]:g} to {edges[1]:g}, {there.sum()} windows: "
                f"{ratios.mean():+.1%}, {ratios.min():+.1%} to {ratios.max():+.1%}"
            )


def on_finer_meshes(count: int = 6) -> None:
    """Print the windows that are farthest from the law, on the mesh of the table and finer."""
    of, by_number = points(), {case.number: case for case in cases()}
    far = np.zeros(of.area.size)
    for name in QUANTITIES:
        law = Law.of(of, name, of.area > 0.0)
        far = np.maximum(far, np.abs(of.log_ratio[name] / of.size(name) - law.mean) / law.scatter)
    table = {int(row["number"]): row for row in rows()}
    for number in of.number[np.argsort(-far)][:count].astype(int):
        coarse = table[number]
        finer = solved(by_number[number], columns=2 * int(coarse["columns"]), time_limit=600.0)
        for row in (coarse, finer):
            print(", ".join(f"{name} {row[name]}" for name in COLUMNS), flush=True)


if __name__ == "__main__":
    {"": main, "solve": solve_missing, "mesh": on_finer_meshes}["".join(sys.argv[1:])]()
