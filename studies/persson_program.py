"""Persson's theory with softening beside the values of the original program.

    python -m studies.persson_program

Measured treads and road, 20 C; the moduli are those measured, the surface ends with its last wave.
The softening is the mean of f and of g over the four sweeps of a compound, taken as tension. They
are ratios to the smallest strain, as the publisher has them, and end at 25 %: there the last of a
sweep is held. Ends of 23.6 or 32 % change areas by 2.3 %, friction by 3 %. Seconds.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

import gripscale as gs
from gripscale.conditions import Conditions
from gripscale.rubber.softening import SofteningTable
from studies.treads import SERIES_S, measured_moduli, road_spectrum, sweeps, table

SPEEDS = (1e-3, 1e-2, 1e-1, 1.0)
"""Speeds of the table [m/s]."""
RUNS = (("S100", 3), ("S120", 3), ("S140", 3), ("S100", 5))
"""Compounds with the pressures [bar] the program was run at."""
GAMMA = 0.57
STRAINS = np.geomspace(1.34e-4, 0.25, 61)
"""Strains of the mean sweep [-]; the least is that of the shortest sweep."""


class Compared(NamedTuple):
    """Area and friction of the program, and those of the theory here."""

    name: str
    bar: int
    speed: float
    program_area: float
    area: float
    program_friction: float
    friction: float


def single_sweep(strain: list[float], storage: list[float], loss: list[float]) -> SofteningTable:
    """Return the softening of one sweep, as tension, over that of the smallest strain."""
    return SofteningTable([strain], [storage], [loss], float(STRAINS[0]), "tension")


def mean_sweep(name: str) -> SofteningTable:
    """Return the mean of the ratios of a compound's sweeps, at any temperature."""
    laws = [
        single_sweep(s.strain.tolist(), s.storage.tolist(), s.loss.tolist())
        for s in sweeps(name).values()
    ]
    ratios = [law.factors(STRAINS) for law in laws]
    storage, loss = (
        np.mean([getattr(r, which) for r in ratios], axis=0).tolist()
        for which in ("storage", "loss")
    )
    return single_sweep(STRAINS.tolist(), storage, loss)


def program(name: str, bar: int, speed: float) -> tuple[float, float]:
    """Return area and friction of the program, between its speeds in the logarithms."""
    rows = np.log(table(f"{name}_program_{bar}bar")).T
    friction, area = (float(np.exp(np.interp(np.log(speed), rows[0], row))) for row in rows[1:])
    return area, friction


def theory(
    name: str, bar: int, speed: float, *, softened: bool = True, gamma: float = GAMMA
) -> tuple[float, float]:
    """Return area and friction of the theory here."""
    contact = gs.theory.persson(
        measured_moduli(name),
        road_spectrum(),
        pressure=1e5 * bar,
        speed=speed,
        gamma=gamma,
        conditions=Conditions(softening=mean_sweep(name) if softened else None),
    )
    return contact.contact_fraction, contact.friction


def compared() -> Iterator[Compared]:
    """Yield every compound and pressure at every speed."""
    for name, bar in RUNS:
        for speed in SPEEDS:
            (theirs, friction), ours = program(name, bar, speed), theory(name, bar, speed)
            yield Compared(name, bar, speed, theirs, ours[0], friction, ours[1])


def main() -> None:
    """Print the table, and the factor of the friction."""
    rows = list(compared())
    print("| compound, pressure | speed | area: program, here | ratio | friction: program, here |")
    print("|---|---|---|---|---|")
    for row in rows:
        print(
            f"| {row.name}, {row.bar} bar | {row.speed:g} m/s | {row.program_area:.4f}, "
            f"{row.area:.4f} | {row.area / row.program_area:.3f} | {row.program_friction:.3f}, "
            f"{row.friction:.3f} |"
        )
    factor = np.array([row.program_friction / row.friction for row in rows])
    span = f"{factor.min():.3f} to {factor.max():.3f}"
    print(f"friction, program over here: {factor.mean():.3f} +- {factor.std():.3f}, {span}")
    for name in SERIES_S:
        cold = [theory(name, 3, speed, softened=False) for speed in SPEEDS]
        print(name, "not softened:", ", ".join(f"{a:.4f}, {mu:.3f}" for a, mu in cold))
    whole, none = (
        np.array([theory(row.name, row.bar, row.speed, gamma=gamma)[1] for row in rows])
        for gamma in (1.0, 0.0)
    )
    gamma = (np.array([row.program_friction for row in rows]) - none) / (whole - none)
    print(f"gamma with the friction of the program: {gamma.mean():.3f} +- {gamma.std():.3f}")


if __name__ == "__main__":
    main()
