"""Predictions beside measured friction: docs/beside-measured-friction.md, its numbers and figures.

    python -m studies.measured_friction
    python -m studies.measured_friction solve

Dry friction: the points of `studies.dry_law`, five compounds on one road. Each compound is
predicted from the law of the other four. Soapy water: hysteresis friction of R00 to R60 at the
measured speeds, on lines with the spectrum of the asphalt (`studies.measured_road`), 3 bar, 20 C,
waves to 60 um, softened as a typical tread. Nothing is fitted to it. `solve` makes the predictions
anew, in two minutes, and keeps them in `studies/measured_friction.csv`.
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Mapping
from itertools import combinations
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.core import Array
from gripscale.rubber.softening import TYPICAL_TREAD
from studies import dry_law
from studies.measured_road import CUT_OFF, road_lines
from studies.shipped import DATA
from studies.treads import SERIES_R, compound

PREDICTIONS = Path(__file__).with_suffix(".csv")
FIGURES = Path(__file__).resolve().parents[1] / "docs" / "figures"
SOAPY_SPEEDS = (0.002, 0.01, 0.046)
"""Speeds at which friction in soapy water was measured [m/s]."""
SURFACES = ("granite", "asphalt")
MEASURED_STYLE: dict[str, Any] = {"linestyle": "", "marker": "o", "color": "black", "zorder": 3}


class Hysteresis(NamedTuple):
    """Hysteresis friction of an answer, and the ends of its 90 % interval."""

    friction: float
    low: float
    high: float


def solved(name: str) -> list[Hysteresis]:
    """Return the answers of a compound at the speeds of soapy water."""
    case = gs.Case(
        list(road_lines()),
        compound(name),
        pressure=dry_law.PRESSURE,
        speed=SOAPY_SPEEDS[0],
        smallest_wavelength=CUT_OFF,
        conditions=Conditions(softening=TYPICAL_TREAD),
        filled=True,
    )
    data = gs.vary(case, speed=list(SOAPY_SPEEDS)).to_dataset()
    names = ("answer_friction", "answer_friction_low", "answer_friction_high")
    rows = zip(*(data[each].values.tolist() for each in names), strict=True)
    return [Hysteresis(*row) for row in rows]


def write_predictions() -> None:
    """Solve all compounds and write their predictions."""
    with PREDICTIONS.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream, lineterminator="\n")
        writer.writerow(["compound", "speed [m/s]", *Hysteresis._fields])
        for name in SERIES_R:
            for speed, answer in zip(SOAPY_SPEEDS, solved(name), strict=True):
                writer.writerow([name, f"{speed:g}", *(f"{value:.5g}" for value in answer)])


def predictions() -> dict[tuple[str, float], Hysteresis]:
    """Return the predictions by compound and speed [m/s], as they were written."""
    with PREDICTIONS.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))[1:]
    return {(row[0], float(row[1])): Hysteresis(*map(float, row[2:])) for row in rows}


def soapy_water() -> dict[tuple[str, str, float], float]:
    """Return measured friction by surface, compound and speed [m/s]."""
    path = DATA / "friction" / "soapy_water_friction.csv"
    with path.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.reader(stream))[1:]
    return {(row[1], row[0], float(row[2])): float(row[3]) for row in rows}


class Shortfall(NamedTuple):
    """Measured friction in soapy water over the hysteresis that is predicted."""

    smallest: float
    largest: float
    inside: int  # measurements inside the interval of the prediction
    points: int


def shortfall(surface: str) -> Shortfall:
    """Return how far the hysteresis stays below the friction measured on a surface."""
    of = predictions()
    pairs = [(of[key[1:]], mu) for key, mu in soapy_water().items() if key[0] == surface]
    ratios = [mu / answer.friction for answer, mu in pairs]
    inside = sum(answer.low <= mu <= answer.high for answer, mu in pairs)
    return Shortfall(min(ratios), max(ratios), inside, len(pairs))


def order() -> tuple[int, int]:
    """Return how many pairs of compounds are predicted in the measured order, and of how many."""
    of, measured = predictions(), soapy_water()
    right = count = 0
    for surface in SURFACES:
        for speed in SOAPY_SPEEDS:
            there = [name for name in SERIES_R if (surface, name, speed) in measured]
            for a, b in combinations(there, 2):
                difference = measured[surface, a, speed] - measured[surface, b, speed]
                predicted = of[a, speed].friction - of[b, speed].friction
                right += int(difference * predicted > 0.0)
                count += 1
    return right, count


def other_compound(of: Mapping[str, dry_law.Points]) -> float:
    """Return the rms relative error of the friction of another compound at the same speed."""
    errors = []
    for a in of:
        for b in of:
            common = [
                (mu, other)
                for v, mu in zip(of[a].speed, of[a].measured, strict=True)
                for w, other in zip(of[b].speed, of[b].measured, strict=True)
                if a != b and abs(np.log(v / w)) < 0.05
            ]
            errors += [other / mu - 1.0 for mu, other in common]
    return float(np.sqrt(np.mean(np.square(errors))))


def draw_dry(of: Mapping[str, dry_law.Points]) -> Figure:
    """Draw each compound with the prediction from the other four, and all shear stresses."""
    figure = Figure(figsize=(9.0, 5.4), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(2, 3, sharex=True)
    for name, axes in zip(of, panels.flat, strict=False):
        law = dry_law.fitted({other: each for other, each in of.items() if other != name})
        _draw_compound(axes, name, of[name], law)
    panels[0, 0].legend(fontsize=8)
    stresses = panels[1, 2]
    for name, each in of.items():
        resin = name in dry_law.WITH_RESIN
        style = {"marker": "s" if resin else "o", "linestyle": "--" if resin else "-"}
        stresses.plot(1e3 * each.speed, 1e-6 * each.stress, label=name, markersize=4, **style)
    stresses.set(title="implied shear stress [MPa]", ylim=(0.0, 3.0))
    stresses.legend(fontsize=8, ncols=2)
    for axes in panels[1]:
        axes.set(xlabel="speed [mm/s]", xscale="log")
    for row in panels:
        row[0].set_ylabel("friction coefficient")
    return figure


def _draw_compound(axes: Axes, name: str, of: dry_law.Points, law: dry_law.Law) -> None:
    area = of.contact_fraction / dry_law.PRESSURE
    stress = law.log_stress(of.speed)
    low, middle, high = (
        of.hysteresis + np.exp(stress + sign * dry_law.NORMAL * law.scatter) * area
        for sign in (-1, 0, 1)
    )
    speed = 1e3 * of.speed
    axes.fill_between(speed, low, high, alpha=0.2, label="90 % interval")
    axes.plot(speed, middle, label="from the other four")
    axes.plot(speed, of.hysteresis, color="tab:red", label="hysteresis alone")
    axes.plot(speed, of.measured, label="measured", markersize=4, **MEASURED_STYLE)
    axes.set(title=name, ylim=(0.0, 4.0))


def draw_soapy() -> Figure:
    """Draw friction in soapy water beside the hysteresis that is predicted."""
    figure = Figure(figsize=(9.0, 3.2), layout="constrained")
    FigureCanvasAgg(figure)
    panels = figure.subplots(1, len(SOAPY_SPEEDS), sharey=True)
    of, measured = predictions(), soapy_water()
    at: Array = np.arange(len(SERIES_R), dtype=float)
    for speed, axes in zip(SOAPY_SPEEDS, panels, strict=True):
        answers = np.array([of[name, speed] for name in SERIES_R])
        errors = np.abs(answers[:, 1:].T - answers[:, 0])
        axes.errorbar(
            at, answers[:, 0], errors, marker="o", color="tab:red", capsize=3, label="hysteresis"
        )
        for surface, marker in zip(SURFACES, "s^", strict=True):
            values = [measured.get((surface, name, speed), np.nan) for name in SERIES_R]
            if np.isfinite(values).any():
                axes.plot(at, values, **MEASURED_STYLE | {"marker": marker}, label=surface)
        axes.set(
            title=f"{1e3 * speed:g} mm/s",
            xticks=at,
            xticklabels=SERIES_R,
            yscale="log",
            ylim=(0.05, 2.0),
        )
    panels[0].set_ylabel("friction coefficient")
    panels[1].legend(fontsize=8, loc="center right", bbox_to_anchor=(1.0, 0.53))
    return figure


def main() -> None:
    """Print what the page states and draw its figures."""
    if sys.argv[1:] == ["solve"]:
        write_predictions()
    of = dry_law.points()
    rows = dry_law.each_left_out(of, dry_law.COMPOUNDS)
    print("dry, each compound from the other four:")
    for name, row in rows.items():
        print(f"  {name}: {row.inside} of {row.points} inside, rms {row.rms:.1%}")
    print(
        f"  all: {sum(r.inside for r in rows.values())} of {sum(r.points for r in rows.values())}"
    )
    print(f"  another compound at the same speed: rms {other_compound(of):.1%}")
    shares = [float(value) for each in of.values() for value in each.hysteresis / each.measured]
    print(f"  hysteresis: {min(shares):.1%} to {max(shares):.1%} of dry friction")
    for surface in SURFACES:
        low, high, inside, points = shortfall(surface)
        print(
            f"soapy {surface}: measured {low:.1f} to {high:.1f} times the hysteresis, "
            f"{inside} of {points} inside the interval"
        )
    right, count = order()
    print(f"order of compounds in soapy water: {right} of {count} pairs")
    for (name, speed), (friction, low, high) in predictions().items():
        print(f"  {name} {1e3 * speed:g} mm/s: {friction:.3f} ({low:.3f} to {high:.3f})")
    draw_dry(of).savefig(FIGURES / "measured_friction.png", dpi=120)
    draw_soapy().savefig(FIGURES / "soapy_water.png", dpi=120)


if __name__ == "__main__":
    main()
