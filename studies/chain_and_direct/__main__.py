"""The command: tables and figure of docs/chain-and-direct-contact.md.

    python -m studies.chain_and_direct --output results/chain_and_direct

About twenty minutes of one processor; finished numbers are kept in the folder.
"""

from __future__ import annotations

import argparse
from itertools import product
from pathlib import Path

import gripscale as gs
from gripscale.theory import HalfPlane
from studies.chain_and_direct.draw import draw
from studies.chain_and_direct.judge import Errors, errors, held_out, mean, rms, worst
from studies.chain_and_direct.surfaces import rubbers, surfaces
from studies.chain_and_direct.table import Key, Numbers, numbers
from studies.chain_and_direct.variants import CUT_OFF, VARIANTS, Variant

PRESSURE = 3e5
SPEEDS = ("0.003", "0.03", "0.3", "3", "30")
"""Pa and m/s."""

SOLVERS = HalfPlane(points=256), HalfPlane(points=2048)
"""Within 1 % of each other in the totals; the second where too few points touch for the first."""

COMPARED = (
    "as printed, 7 waves",
    "pressure classes, cut-off, 7 waves",
    "pressure classes, cut-off, upper half, 7 waves",
)
"""Variants shown surface by surface."""


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(prog="chain_and_direct", description=__doc__)
    parser.add_argument("--output", type=Path, default=Path("results/chain_and_direct"))
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    studied, rubber = surfaces(), rubbers()
    cases: list[Key] = list(product(studied, rubber, SPEEDS))

    def directly(key: Key) -> Numbers:
        contact = gs.solve_rough_contact(
            rubber[key[1]],
            studied[key[0]].profile,
            pressure=PRESSURE,
            speed=float(key[2]),
            smallest_wavelength=CUT_OFF,
            tolerance=0.05,
        )
        if not contact.converged:
            raise gs.ConvergenceError(f"direct contact of {key}: {contact.status}")
        return Numbers(contact.contact_fraction, contact.friction_from_dissipation)

    def chained(variant: Variant, waves: int) -> dict[Key, Numbers]:
        stacks = {
            name: variant.stack(one.profile, rubber["tread"], waves)
            for name, one in studied.items()
        }

        def solve(key: Key) -> Numbers:
            found = small_strain_chain(
                rubber[key[1]], stacks[key[0]], float(key[2]), variant.pressure_classes
            )
            return Numbers(found.contact_fraction, found.friction_from_dissipation)

        return numbers(
            folder / f"{variant.stack.__name__}_{variant.pressure_classes}_{waves}.csv",
            cases,
            solve,
        )

    direct = numbers(folder / "direct.csv", cases, directly)
    found: dict[str, Errors] = {}
    for variant in VARIANTS:
        for waves in variant.waves:
            name = f"{variant.name}, {waves} waves"
            found[name] = errors(chained(variant, waves), direct)
            print(_row(name, found[name]), flush=True)
    family = {name: one.family for name, one in studied.items()}
    several = {name: e for name, e in found.items() if not name.endswith(("2 waves", "3 waves"))}
    for label, candidates in (("of all", found), ("of four waves or more", several)):
        out, chosen = held_out(candidates, family)
        print(_row(f"chosen on the other families, {label}", out))
        for one, name in chosen.items():
            print(f"| {one} | {name} |")
    for name in studied:
        print(_by_surface(name, found))
    draw(found, list(studied), folder / "chain_and_direct_contact.png")


def small_strain_chain(
    rubber: gs.Rubber, stack: gs.SineStack, speed: float, classes: int
) -> gs.ChainResult:
    """Return the chain of half-plane waves at 3 bar and a speed [m/s]."""

    def solved(solver: HalfPlane) -> gs.ChainResult:
        return gs.solve_chain(
            rubber,
            stack,
            pressure=PRESSURE,
            speed=speed,
            footprint=0.1,
            solver=solver,
            pressure_classes=classes,
        )

    coarse, fine = SOLVERS
    try:
        return solved(coarse)
    except gs.ConvergenceError:
        return solved(fine)


def _row(name: str, found: Errors) -> str:
    a, b, c = rms(found), mean(found), worst(found)
    parts = [f"{a[i]:.2f} | {b[i]:+.2f} | {c[i]:.2f}" for i in (0, 1)]
    return f"| {name} | {' | '.join(parts)} |"


def _by_surface(surface: str, found: dict[str, Errors]) -> str:
    def of(errors_: Errors) -> str:
        keys = [key for key in errors_ if key[0] == surface]
        return " | ".join(f"{value:+.2f}" for value in mean({key: errors_[key] for key in keys}))

    return f"| {surface} | {' | '.join(of(found[name]) for name in COMPARED)} |"


if __name__ == "__main__":
    main()
