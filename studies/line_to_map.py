"""The law from measured lines to the surface they lie on: docs/isotropic-maps.md, its numbers.

    python -m studies.line_to_map

Maps of eleven families (`studies.surface_families`) and sixteen lines of each are solved. A line is
cut off along itself, as a measured one is, the map in every direction. Maps and lines are refined
to the same tolerance, as a prediction is. On four points in the smallest wave the friction of lines
is 1 to 18 % low, that of their maps 0.5 to 14 %: the errors of the grid do not cancel in the ratio
and would become part of the law.

The law is fitted to pairs of lines, since two lines is what a measurement often has:

    ln(map / mean of the pair) = a_0 + a_1 t + a_2 (T / P)^(1/3) + a_3 S,

with upper height t, tail T, relative load P and softening S of the pair. A pair that meets a summit
has the larger friction and the larger tail: a law of the mean of all lines would count it twice.
Each seed has a rubber and three pressures, every other family the lower ones. The fourth rubber is
softened as measured. Half an hour of one core; solved maps are kept in the output folder, and a
stopped run goes on.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cache
from itertools import combinations, pairwise, product
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray
from scipy.optimize import nnls
from scipy.special import erfinv, stdtrit

import gripscale as gs
from gripscale.conditions.conditions import Conditions
from gripscale.core.status import Status
from gripscale.half_space.line_to_map import (
    FREEDOM,
    FULL_CONTACT_FRICTION,
    LineUnderLoad,
    RatioLaw,
    contact_fraction_ratio,
    friction_ratio,
    line_under_load,
)
from gripscale.half_space.sampling_error import PIECE, sampling_error
from gripscale.rubber import styrene_butadiene
from gripscale.rubber.softening import softening_of_sweeps
from gripscale.surface import HeightMap
from studies.shipped import tread
from studies.surface_families import FAMILIES, LARGEST, family_map
from studies.treads import compound, sweeps

Array = NDArray[np.float64]

CUT_OFF = 0.8e-3
"""Smallest wave of a contact [m]."""
PRESSURE, SPEED = 3e5, 0.3
"""The usual load [Pa, m/s]."""
PRESSURES = (3e3, 3e4, 3e5), (1e4, 1e5, 1e6)
"""Of every other family and seed [Pa]."""
RUBBERS = ("tread", "S100", "unfilled", "S100, softened")
"""Of the seeds in turn."""
SOFTENED = ", softened"
SPEEDS = (1e-3, 20.0)
"""Of the first map of each family, beside the usual one [m/s]."""
NEARLY_FULL = 0.7
"""Contact fraction of the lines above which a contact tells nothing of a small one."""
HIGH_PRESSURES = (3e6, 1e7, 3e7)
LINES = 16
TOLERANCE = 0.05
"""Estimated relative error of the grid of a map or a line."""
SOLVED = (Status.CONVERGED, Status.TOLERANCE_NOT_MET)
"""What counts of maps: some end on eight points in the smallest wave with errors of 8 %."""
QUANTITIES = ("area", "friction")
FIGURE = Path(__file__).resolve().parents[1] / "docs" / "figures" / "line_to_map.png"


@cache
def rubber_of(name: str) -> gs.Rubber:
    """Return the filled tread rubber, compound S100 or the unfilled rubber."""
    if name == "unfilled":
        return styrene_butadiene()
    return tread() if name == "tread" else compound(name.removesuffix(SOFTENED))


def conditions_of(name: str) -> Conditions | None:
    """Return softening as measured on the rubber; None without."""
    if not name.endswith(SOFTENED):
        return None
    measured = list(sweeps(name.removesuffix(SOFTENED)).values())
    return Conditions(softening=softening_of_sweeps(measured, measured_at=1e-3))


@dataclass(frozen=True)
class SolvedMap:
    """Contact of one map under one load, and of its lines; friction is by dissipation."""

    family: str
    seed: int
    rubber: str
    pressure: float
    speed: float
    area: float
    friction: float
    lines: list[list[float]]
    """Upper height, tail, relative load and softening of the lines that converged."""
    line_areas: list[float]
    line_frictions: list[float]
    line_errors: list[list[float]]
    """Standard errors of area and friction by the pieces of a line, and the pieces that carry."""

    @property
    def pairs(self) -> Array:
        """Columns that the law multiplies by its numbers, of all pairs of lines."""
        pairs = LineUnderLoad(*(self._pairs(values) for values in np.transpose(self.lines)))
        return np.column_stack([np.ones_like(pairs.upper_height), *pairs.columns])

    @property
    def line(self) -> LineUnderLoad:
        """Mean of the lines."""
        return LineUnderLoad(*np.mean(self.lines, axis=0))

    def small(self, quantity: str) -> Array:
        """Return ln(map / mean of a pair) without the part of full contact, for all pairs."""
        area = self._pairs(self.line_areas)
        if quantity == "area":
            shrunk = np.log(erfinv(min(self.area, 1.0 - 1e-12)) / erfinv(area))
            return np.asarray(shrunk / (1.0 - 0.5 * area))
        full = area**4
        ratio = np.log(self.friction / self._pairs(self.line_frictions))
        return np.asarray((ratio - full * np.log(FULL_CONTACT_FRICTION)) / (1.0 - full))

    def ratio(self, quantity: str) -> float:
        """Return ln(map / mean of its lines) of area or friction."""
        return float(np.log(getattr(self, quantity) / np.mean(self._lines(quantity))))

    def pair_errors(self, quantity: str) -> Array:
        """Return ln(mean of a pair / mean of all lines), for all pairs."""
        lines = self._lines(quantity)
        return np.log(self._pairs(lines) / np.mean(lines))

    def sampling_errors(self, quantity: str) -> Array:
        """Return the relative standard errors of the means of all pairs, as an answer finds them.

        From the pieces of both lines or, where too few of them carry, from the difference.
        """
        lines, number = np.array(self._lines(quantity)), QUANTITIES.index(quantity)
        errors = lines * np.array(self.line_errors)[:, number]
        total = 2.0 * self._pairs(lines)
        of_pieces = np.array([np.hypot(a, b) for a, b in combinations(errors, 2)]) / total
        apart = np.array([abs(a - b) for a, b in combinations(lines, 2)]) / total
        return np.where(np.isfinite(of_pieces), of_pieces, apart)

    def _lines(self, quantity: str) -> list[float]:
        return self.line_areas if quantity == "area" else self.line_frictions

    @staticmethod
    def _pairs(values: Sequence[float] | Array) -> Array:
        return np.array([0.5 * (a + b) for a, b in combinations(values, 2)])


def solve_map(
    rubber: str, surface: HeightMap, family: str, seed: int, pressure: float, speed: float
) -> SolvedMap | None:
    """Return the contact of a map and its lines; None where it was not solved."""
    options: dict[str, Any] = {
        "pressure": pressure,
        "speed": speed,
        "smallest_wavelength": CUT_OFF,
        "periodic": True,
        "tolerance": TOLERANCE,
        "workers": 1,
        "conditions": conditions_of(rubber),
    }
    material = rubber_of(rubber)
    columns = range(0, surface.z.shape[1], surface.z.shape[1] // LINES)
    lines = [gs.Profile(surface.x, surface.z[:, column]) for column in columns]
    load = {"largest_wavelength": LARGEST, "pressure": pressure, "speed": speed}
    whole = gs.solve_rough_contact(material, surface, **options)
    parts = [gs.solve_rough_contact(material, line, **options) for line in lines]
    usable = [(line, part) for line, part in zip(lines, parts, strict=True) if part.converged]
    if whole.status not in SOLVED or len(usable) < LINES // 2:
        print(f"left out: {surface.name}, {pressure:g} Pa: {whole.status}", flush=True)
        return None
    return SolvedMap(
        family,
        seed,
        rubber,
        pressure,
        speed,
        whole.contact_fraction,
        whole.friction_from_dissipation,
        [
            list(map(float, line_under_load(line, material, contact=part, **load)))
            for line, part in usable
        ],
        [part.contact_fraction for _, part in usable],
        [part.friction_from_dissipation for _, part in usable],
        [list(map(float, sampling_error(part, PIECE * LARGEST))) for _, part in usable],
    )


def solved_maps(path: Path, seeds: int) -> list[SolvedMap]:
    """Return the maps of all families and seeds, solving those that `path` does not hold yet.

    Each line of the file holds the contacts of one map. Those of lines that are nearly full are
    left out.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    kept: dict[tuple[str, int], list[SolvedMap]] = {}
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            entry: dict[str, Any] = json.loads(line)
            kept[entry["family"], entry["seed"]] = [SolvedMap(**c) for c in entry["contacts"]]
    for seed, (number, family) in product(range(seeds), enumerate(FAMILIES)):
        if (family, seed) in kept:
            continue
        surface, rubber = family_map(family, seed), RUBBERS[seed % len(RUBBERS)]
        solved = [
            solve_map(rubber, surface, family, seed, pressure, SPEED)
            for pressure in PRESSURES[(seed + number) % 2]
        ]
        kept[family, seed] = [contact for contact in solved if contact is not None]
        contacts = [asdict(contact) for contact in kept[family, seed]]
        with path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"family": family, "seed": seed, "contacts": contacts}) + "\n")
        for c in kept[family, seed]:
            print(f"{family} {seed}, {1e-5 * c.pressure:.2g} bar: {_ratios(c)}", flush=True)
    every = [contact for (_, seed), maps in kept.items() if seed < seeds for contact in maps]
    return [contact for contact in every if np.mean(contact.line_areas) < NEARLY_FULL]


def _ratios(contact: SolvedMap) -> str:
    return ", ".join(f"{name} {np.exp(contact.ratio(name)):.3f}" for name in QUANTITIES)


@dataclass(frozen=True)
class FittedLaw:
    """The law of one quantity on some maps, and what it misses."""

    quantity: str
    law: RatioLaw
    """Its scatters are those of families the law was fitted without."""
    maps: list[SolvedMap]
    residuals: list[Array]
    """ln(map / lines) less the law, for all pairs of lines of each map."""
    held_out: list[Array]
    """The same by laws fitted without the map's family."""

    @classmethod
    def of(cls, maps: list[SolvedMap], quantity: str) -> FittedLaw:
        """Fit the law to the means of the lines of all maps; its scatter is that of pairs."""
        numbers = _coefficients(maps, quantity)
        without = {
            family: _coefficients([m for m in maps if m.family != family], quantity)
            for family in {m.family for m in maps}
        }
        held_out = [_residuals(m, quantity, without[m.family]) for m in maps]
        scatter = scatter_of(maps, quantity, held_out)
        law = RatioLaw(*np.append(numbers, scatter).tolist())
        residuals = [_residuals(m, quantity, numbers) for m in maps]
        return cls(quantity, law, maps, residuals, held_out)


def _coefficients(maps: Sequence[SolvedMap], quantity: str) -> Array:
    """Return the numbers of the law by least squares; each map counts the same."""
    columns = np.concatenate([m.pairs / len(m.pairs) ** 0.5 for m in maps])
    ratios = np.concatenate([m.small(quantity) / len(m.pairs) ** 0.5 for m in maps])
    return np.asarray(np.linalg.lstsq(columns, ratios, rcond=None)[0])


def _residuals(solved: SolvedMap, quantity: str, numbers: Array) -> Array:
    return np.asarray(solved.small(quantity) - solved.pairs @ numbers)


def scatter_of(
    maps: Sequence[SolvedMap], quantity: str, missed: Sequence[Array]
) -> tuple[float, float]:
    """Return the scatter at high load, and what few summits add, from what a law misses.

    The sampling error that an answer finds by itself is taken off in squares. The most likely
    variances of normal residuals: squares weighted by the variance itself.
    """
    sampling = np.array([np.mean(m.sampling_errors(quantity) ** 2) for m in maps])
    squares = np.array([np.mean(part**2) for part in missed]) - sampling
    summits = np.array([np.mean(m.pairs[:, 2] ** 2) for m in maps])
    columns, variance = np.column_stack([np.ones_like(summits), summits]), np.ones_like(summits)
    for _ in range(20):
        parts, _ = nnls(columns / variance[:, None], squares / variance)
        variance = np.maximum(columns @ parts + sampling, 1e-12)
    high, low = np.sqrt(parts)
    return float(high), float(low)


def freedom_of(fitted: FittedLaw) -> float:
    """Return the degrees of freedom of a variance that scatters as that of the families does.

    Squares of what the laws without a family miss, over their variance, have a mean of one. The
    error of this mean over the families is that of a variance with 2/(relative error)^2.
    """
    squares: dict[str, list[float]] = {}
    for m, missed in zip(fitted.maps, fitted.held_out, strict=True):
        variance = fitted.law.scatter**2 + (fitted.law.tail_scatter * m.pairs[:, 2]) ** 2
        variance += m.sampling_errors(fitted.quantity) ** 2
        squares.setdefault(m.family, []).append(float(np.mean(missed**2 / variance)))
    means = np.array([np.mean(each) for each in squares.values()])
    return float(2.0 * means.size * means.mean() ** 2 / means.var(ddof=1))


def _load_sensitivity(fitted: FittedLaw) -> float:
    """Return what the law misses of d ln(map/lines) / d ln(area of the lines), rms over loads."""
    missed = [float(residual.mean()) for residual in fitted.residuals]
    slopes = [
        (missed[i] - missed[i - 1]) / np.log(np.mean(m.line_areas) / np.mean(before.line_areas))
        for i, (before, m) in enumerate(pairwise(fitted.maps), start=1)
        if (before.family, before.seed) == (m.family, m.seed)
    ]
    return float(np.sqrt(np.mean(np.square(slopes))))


def _rms(parts: list[Array]) -> float:
    return float(np.sqrt(np.mean(np.concatenate(parts) ** 2)))


def family_table(fitted: FittedLaw) -> Iterator[str]:
    """Yield a table by family: ratios, what the law misses, and a law without the family."""
    yield (
        "| family | maps | t | ln(map/lines) | less the law | pairs, rms "
        "| less a law without it | pairs, rms |"
    )
    yield "|---|---|---|---|---|---|---|---|"
    for family in FAMILIES:
        chosen = [i for i, m in enumerate(fitted.maps) if m.family == family]
        if not chosen:
            continue
        members = [fitted.maps[i] for i in chosen]
        residuals, held_out = (
            [parts[i] for i in chosen] for parts in (fitted.residuals, fitted.held_out)
        )
        cells = (
            family,
            str(len(members)),
            _mean_and_scatter([float(m.line.upper_height) for m in members], ""),
            _mean_and_scatter([m.ratio(fitted.quantity) for m in members]),
            _mean_and_scatter([float(r.mean()) for r in residuals]),
            f"{_rms(residuals):.3f}",
            _mean_and_scatter([float(r.mean()) for r in held_out]),
            f"{_rms(held_out):.3f}",
        )
        yield f"| {' | '.join(cells)} |"


def _mean_and_scatter(values: list[float], sign: str = "+") -> str:
    scatter = np.std(values, ddof=1) if len(values) > 1 else np.nan
    return f"{np.mean(values):{sign}.2f} ± {scatter:.2f}"


def summary(fitted: FittedLaw) -> Iterator[str]:
    """Yield the law, its scatter, and the correlations of what it misses."""
    law = fitted.law
    of_maps = np.array([residual.mean() for residual in fitted.residuals])
    yield (
        f"ln(map/lines) = {law.constant:+.3f} {law.slope:+.3f} t {law.tail:+.3f} (T/P)^(1/3) "
        f"{law.softening:+.3f} S"
    )
    ends = np.max([m.line.columns for m in fitted.maps], axis=0)
    yield f"largest t, (T/P)^(1/3) and S: {', '.join(f'{end:.1f}' for end in ends)}"
    yield (
        f"estimates from pairs of lines: rms {_rms(fitted.residuals):.3f} about the law, "
        f"{_rms(fitted.held_out):.3f} about laws without the family, of which the choice of lines "
        f"{_rms([m.pair_errors(fitted.quantity) for m in fitted.maps]):.3f} and by an answer "
        f"{_rms([m.sampling_errors(fitted.quantity) for m in fitted.maps]):.3f}; scatter "
        f"{law.scatter:.3f} at high load and {law.tail_scatter:.3f} (T/P)^(1/3), "
        f"{freedom_of(fitted):.0f} degrees of freedom"
    )
    yield f"missed of the change with the lines' area on one map: {_load_sensitivity(fitted):.3f}"
    ratios = np.array([m.ratio(fitted.quantity) for m in fitted.maps])
    share = 1.0 - np.var(of_maps) / np.var(ratios)
    yield f"share of the variance of ln(map/lines) that the law explains: {share:.2f}"
    for pressure in sorted(sum(PRESSURES, ())):
        pressed = [m.pressure == pressure for m in fitted.maps]
        missed = of_maps[pressed]
        yield f"{1e-5 * pressure:g} bar, {missed.size} maps: {_mean_and_scatter(missed.tolist())}"
    influences: dict[str, Callable[[SolvedMap], float]] = {
        "pressure": lambda m: m.pressure,
        "contact fraction of the lines": lambda m: float(np.mean(m.line_areas)),
    }
    for name, value in influences.items():
        logarithms = np.log([value(m) for m in fitted.maps])
        if np.ptp(logarithms) == 0.0:  # a single seed has a single load
            continue
        correlation = np.corrcoef(logarithms, of_maps)[0, 1]
        slope = np.polyfit(logarithms, of_maps, 1)[0]
        yield (
            f"residual over ln({name}): correlation {correlation:+.2f}, slope {slope:+.3f}, "
            f"times the standard deviation {slope * logarithms.std():+.3f}"
        )


COLOURS = dict(
    zip(
        FAMILIES,
        (
            "#0072b2",
            "#d55e00",
            "#7f7f7f",
            "#009e73",
            "#cc79a7",
            "#56b4e9",
            "#b8860b",
            "#5b3a8c",
            "#e41a1c",
            "#000000",
            "#66a61e",
        ),
        strict=True,
    )
)


def draw(laws: Sequence[FittedLaw], path: Path) -> None:
    """Draw the ratios of area and friction over those of the law, with the band of 90 % of maps."""
    figure = Figure(figsize=(9.5, 4.4), layout="constrained")
    FigureCanvasAgg(figure)
    for column, fitted in enumerate(laws):
        panel = figure.add_subplot(1, len(laws), column + 1)
        for family, colour in COLOURS.items():
            members = [m for m in fitted.maps if m.family == family]
            panel.plot(
                [fitted.law.at(m.line) for m in members],
                [np.exp(m.small(fitted.quantity).mean()) for m in members],
                "o",
                ms=3.5,
                mew=0.0,
                alpha=0.7,
                color=colour,
                label=family if column == 0 else None,
            )
        ends = [fitted.law.at(m.line) for m in fitted.maps]
        ratio = np.geomspace(0.95 * min(ends), 1.05 * max(ends), 2)
        factor = np.exp(stdtrit(FREEDOM, 0.95) * fitted.law.scatter)  # at high load
        panel.plot(ratio, ratio, color="black", lw=1.4, label="law" if column == 0 else None)
        band = "90 % band" if column == 0 else None
        panel.fill_between(
            ratio, ratio / factor, ratio * factor, color="0.5", alpha=0.2, lw=0.0, label=band
        )
        panel.set_xlabel("by the law")
        title = {"area": "contact area", "friction": "friction"}[fitted.quantity]
        panel.set_title(f"{title}: map over its lines", fontsize=10)
        ticks = [0.2, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0]
        panel.loglog()
        panel.minorticks_off()
        panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        panel.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        panel.set_xlim(ratio[0], ratio[-1])
        panel.set_ylim(ratio[0] / factor, ratio[-1] * factor)
        panel.grid(lw=0.4, alpha=0.4)
    figure.legend(loc="outside right center", frameon=False, fontsize=9)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=100, pil_kwargs={"optimize": True})


def other_speeds() -> Iterator[str]:
    """Yield how ln(map/lines) changes with the speed on the same maps, the first of each family."""
    first = {family: family_map(family, 0) for family in FAMILIES}

    def ratios(pressure: float, speed: float) -> Array:
        """Return ln(map/lines) of area and friction by family; NaN where not converged."""
        out = np.full((len(FAMILIES), len(QUANTITIES)), np.nan)
        for row, (family, surface) in enumerate(first.items()):
            solved = solve_map(RUBBERS[0], surface, family, 0, pressure, speed)
            if solved is not None:
                out[row] = [solved.ratio(quantity) for quantity in QUANTITIES]
        return out

    usual = ratios(PRESSURE, SPEED)
    yield f"\nchange of ln(map/lines) from {PRESSURE:g} Pa and {SPEED:g} m/s, mean and scatter"
    for speed in SPEEDS:
        change = ratios(PRESSURE, speed) - usual
        cells = [
            f"{name} {np.nanmean(column):+.3f} ± {np.nanstd(column, ddof=1):.3f}"
            for name, column in zip(QUANTITIES, change.T, strict=True)
        ]
        number = int(np.isfinite(change[:, 0]).sum())
        yield f"{speed:g} m/s: {', '.join(cells)} ({number} maps)"


def near_full_contact() -> Iterator[str]:
    """Yield what the forms towards full contact miss, on the first map of each family."""
    forms = contact_fraction_ratio, friction_ratio
    yield "\nln(map/lines) less that of the forms towards full contact, mean and scatter"
    for pressure in HIGH_PRESSURES:
        areas, missed = [], []
        for family in FAMILIES:
            solved = solve_map(RUBBERS[0], family_map(family, 0), family, 0, pressure, SPEED)
            if solved is None:
                continue
            area = float(np.mean(solved.line_areas))
            areas.append(area)
            missed.append(
                [
                    solved.ratio(quantity) - np.log(form(solved.line, area).ratio)
                    for quantity, form in zip(QUANTITIES, forms, strict=True)
                ]
            )
        cells = [
            f"{name} {np.mean(column):+.3f} ± {np.std(column, ddof=1):.3f}"
            for name, column in zip(QUANTITIES, np.transpose(missed), strict=True)
        ]
        ends = f"{min(areas):.2f} to {max(areas):.2f}"
        yield f"{pressure:g} Pa, lines touch {ends}: {', '.join(cells)} ({len(areas)} maps)"


def main() -> None:
    """Solve what is not solved yet, print the tables, draw the figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("results/line_to_map"))
    parser.add_argument("--seeds", type=int, default=len(RUBBERS))
    parser.add_argument("--figure", type=Path, default=FIGURE)
    parser.add_argument("--loads", action="store_true", help="other speeds, and full contact, too")
    options = parser.parse_args()
    maps = solved_maps(options.output / "maps.jsonl", options.seeds)
    laws = [FittedLaw.of(maps, quantity) for quantity in QUANTITIES]
    for fitted in laws:
        print(f"\n{fitted.quantity}, {len(maps)} maps", *family_table(fitted), sep="\n")
        print(*summary(fitted), sep="\n", flush=True)
    draw(laws, options.figure)
    if options.loads:
        for line in (*other_speeds(), *near_full_contact()):
            print(line, flush=True)


if __name__ == "__main__":
    main()
