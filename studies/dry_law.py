"""The shear stress of treads on a dry road, from measured friction and computed contact.

    python -m studies.dry_law

    tau(v) = (mu measured - mu of hysteresis) p_0 A_0/A_r

Contact and hysteresis are the answers for lines with the spectrum of the road
(`studies.measured_road`), 3 bar, 20 C, waves to 60 um, with the heat of the hysteresis and of the
interface by the stress that the last run has: solve twice after a change. S100, S120 and S140 have
their strain sweeps, R20 and R40 the typical tread. The law is a bell by least squares, every
compound with an offset of its own:

    ln tau = ln tau_0 - c log10(v/v_0)^2

The scatter is that of a further compound (offsets) and of its single points about its curve, with
Student's t for few compounds. Four minutes on two free cores; the points are kept in
`studies/dry_law.csv`, to which laws are fitted in a second:

    python -m studies.dry_law solve
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from scipy import stats

import gripscale as gs
from gripscale.conditions import Conditions, TableStress
from gripscale.core import Array
from gripscale.rubber.softening import TYPICAL_TREAD, SofteningLaw, softening_of_sweeps
from studies.measured_road import CUT_OFF, road_lines
from studies.treads import SERIES_S, compound, dry_friction, sweeps

POINTS = Path(__file__).with_suffix(".csv")
PRESSURE = 3e5
WITH_RESIN = ("R20", "R40")
COMPOUNDS = (*SERIES_S, *WITH_RESIN)
NORMAL = float(stats.norm.ppf(0.95))


class Points(NamedTuple):
    """Of a compound over the speed; arrays of shape (speeds,)."""

    speed: Array  # [m/s]
    measured: Array  # friction
    contact_fraction: Array
    hysteresis: Array  # friction

    @property
    def stress(self) -> Array:
        """Interfacial shear stress [Pa]."""
        return (self.measured - self.hysteresis) * PRESSURE / self.contact_fraction


class Law(NamedTuple):
    """A bell in log10 of the speed, and how far a further compound is from it."""

    stress_0: float  # [Pa]
    width: float
    speed_0: float  # [m/s]
    between: float  # standard deviation of ln tau of a further compound, its level
    within: float  # and of a point about the curve of its compound

    def log_stress(self, speed: Array) -> Array:
        """Return ln tau."""
        return np.asarray(np.log(self.stress_0) - self.width * np.log10(speed / self.speed_0) ** 2)

    @property
    def scatter(self) -> float:
        """Standard deviation of ln tau of a point of a further compound."""
        return float(np.hypot(self.between, self.within))


def solved(name: str) -> Points:
    """Return measured friction, and the answer at its speeds."""
    law: SofteningLaw = TYPICAL_TREAD
    if name in SERIES_S:
        law = softening_of_sweeps(list(sweeps(name).values()), measured_at=1e-3)
    speed, measured = dry_friction(name)
    stress = points()[name].stress
    case = gs.Case(
        list(road_lines()),
        compound(name),
        pressure=PRESSURE,
        speed=float(speed[0]),
        smallest_wavelength=CUT_OFF,
        conditions=Conditions(
            softening=law, shear_stress=TableStress(speed.tolist(), stress.tolist())
        ),
        filled=True,
    )
    data = gs.vary(case, speed=speed.tolist()).to_dataset()
    names = "answer_contact_fraction", "answer_hysteresis_friction"
    area, friction = (data[name].values for name in names)
    return Points(speed, measured, area, friction)


def write_points(of: Mapping[str, Points]) -> None:
    """Write the points of all compounds."""
    rows = ["compound,speed [m/s],friction measured,contact fraction,hysteresis friction"]
    for name, each in of.items():
        columns = zip(*each, strict=True)
        rows += [",".join([name, *(f"{v:.5g}" for v in row)]) for row in columns]
    POINTS.write_text("\n".join(rows) + "\n", encoding="utf-8")


def points() -> dict[str, Points]:
    """Return the points of all compounds, as they were written."""
    rows = [row.split(",") for row in POINTS.read_text(encoding="utf-8").splitlines()[1:]]
    return {
        name: Points(*np.array([row[1:] for row in rows if row[0] == name], dtype=float).T)
        for name in COMPOUNDS
    }


def fitted(of: Mapping[str, Points]) -> Law:
    """Return the law of some compounds."""
    names = list(of)
    log_v = np.log10(np.concatenate([of[name].speed for name in names]))
    values = np.log(np.concatenate([of[name].stress for name in names]))
    member = np.repeat(np.eye(len(names)), [of[name].speed.size for name in names], axis=0)
    system = np.column_stack([member, log_v, log_v**2])
    solution, *_ = np.linalg.lstsq(system, values, rcond=None)
    offsets, (slope, curvature) = solution[:-2], solution[-2:]
    top = -slope / (2.0 * curvature)
    count = len(names)
    wider = np.sqrt(1.0 + 1.0 / count) * stats.t.ppf(0.95, count - 1) / NORMAL
    rest = values - system @ solution
    return Law(
        float(np.exp(offsets.mean() + slope * top + curvature * top**2)),
        float(-curvature),
        float(10.0**top),
        float(wider * offsets.std(ddof=1)),
        float(np.sqrt(rest @ rest / (values.size - solution.size))),
    )


class LeftOut(NamedTuple):
    """How a law meets the points of a compound that it was not fitted to."""

    inside: int  # points inside the 90 % interval
    points: int
    rms: float  # of the friction, relative
    mean: float  # of ln tau


def judged(law: Law, of: Points) -> LeftOut:
    """Return how the friction of a law meets the points of a compound."""
    stress = law.log_stress(of.speed)
    miss = np.log(of.stress) - stress
    area = of.contact_fraction / PRESSURE
    friction = of.hysteresis + np.exp(stress) * area
    low, high = (
        of.hysteresis + np.exp(stress + sign * NORMAL * law.scatter) * area for sign in (-1, 1)
    )
    inside = int(((low <= of.measured) & (of.measured <= high)).sum())
    rms = float(np.sqrt(np.mean((friction / of.measured - 1.0) ** 2)))
    return LeftOut(inside, of.speed.size, rms, float(miss.mean()))


def each_left_out(of: Mapping[str, Points], names: Sequence[str]) -> dict[str, LeftOut]:
    """Return how the law of all other compounds of `names` meets each of them."""
    return {
        name: judged(fitted({other: of[other] for other in names if other != name}), of[name])
        for name in names
    }


def main() -> None:
    """Print points, laws and what each compound that was left out says."""
    if sys.argv[1:] == ["solve"]:
        write_points({name: solved(name) for name in COMPOUNDS})
    of = points()
    print("| compound | mm/s | mu measured | hysteresis | A/A_0 | tau MPa |")
    print("|---|---|---|---|---|---|")
    for name, each in of.items():
        for v, mu, area, hysteresis, tau in zip(*each, each.stress, strict=True):
            print(
                f"| {name} | {1e3 * v:.3g} | {mu:.3f} | {hysteresis:.3f} | {area:.3f} "
                f"| {1e-6 * tau:.2f} |"
            )
    for names in (SERIES_S, COMPOUNDS):
        law = fitted({name: of[name] for name in names})
        print(
            f"{', '.join(names)}: STRESS_0 = {law.stress_0:.3g}, WIDTH = {law.width:.3f}, "
            f"SPEED_0 = {law.speed_0:.3g}, SCATTER = {law.scatter:.2f} "
            f"(compounds {law.between:.3f}, points {law.within:.3f})"
        )
        rows = each_left_out(of, names)
        for name, row in rows.items():
            print(
                f"  without {name}: {row.inside} of {row.points} inside, rms {row.rms:.1%}, "
                f"mean ln tau {row.mean:+.2f}"
            )
        inside, count = sum(r.inside for r in rows.values()), sum(r.points for r in rows.values())
        total = np.sqrt(sum(r.points * r.rms**2 for r in rows.values()) / count)
        print(f"  all: {inside} of {count}, {inside / count:.0%}, rms {total:.1%}")
    law = fitted({name: of[name] for name in SERIES_S})
    for name in WITH_RESIN:
        row = judged(law, of[name])
        print(f"{name} by the law without resin: {row.inside} of {row.points}, {row.mean:+.2f}")


if __name__ == "__main__":
    main()
