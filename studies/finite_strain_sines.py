"""Several sine waves at once: the finite-strain block, the half-space, and the chain of both.

    python -m studies.finite_strain_sines

Tread, 3 bar, 0.3 m/s, one period of 28.7 mm with whole numbers of each wave, six seeds of phases;
some minutes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import gripscale as gs
from gripscale.half_space import surface_of_sines
from studies.finite_strain_pairs import FiniteStrainPairs, solve_both_ways
from studies.shipped import tread

PERIOD = 28.678e-3
"""Largest wave [m]."""

PRESSURE, SPEED, FOOTPRINT = 3e5, 0.3, 0.1
SEEDS = range(6)


class Row(NamedTuple):
    """Numbers of waves in the period, and what a prototype found: block, half-space, chain."""

    numbers: tuple[int, ...]
    prototype: str


ROWS = (
    Row((1, 2), "0.090 to 0.109, 0.053 to 0.064; 0.089 to 0.107, 0.053 to 0.065; 0.068, 0.093"),
    Row((1, 4), "0.069 to 0.101, 0.056 to 0.086; 0.067 to 0.099, 0.056 to 0.087; 0.0625, 0.100"),
    Row((1, 2, 5), "0.054 to 0.080, 0.072 to 0.109; 0.052 to 0.078, 0.072 to 0.112; 0.045, 0.160"),
    Row(
        (1, 2, 5, 11),
        "0.035 to 0.051, 0.114 to 0.169; 0.034 to 0.050, 0.117 to 0.174; 0.042, 0.221",
    ),
)


def waves(numbers: tuple[int, ...]) -> gs.SineStack:
    """Return waves as steep as the shipped road's: A/lambda = 0.096 (lambda/28.7 mm)^-0.094."""
    wavelength = PERIOD / np.array(numbers, dtype=float)
    return gs.SineStack(wavelength, 0.096 * wavelength * (wavelength / 28.7e-3) ** -0.094)


def main() -> None:
    """Print a row for each set of waves."""
    rubber = tread()
    print(
        "| waves | prototype | block | half-space | block over half-space "
        "| chain: block, half-plane |"
    )
    print("|---|---|---|---|---|---|")
    for row in ROWS:
        stack = waves(row.numbers)
        lines = [surface_of_sines(stack, PERIOD, seed) for seed in SEEDS]
        pairs = solve_both_ways(rubber, lines, pressure=PRESSURE, speed=SPEED)
        ratio = [
            pairs.correction(name) for name in ("contact_fraction", "friction_from_dissipation")
        ]
        chains = [
            gs.solve_chain(
                rubber, stack, pressure=PRESSURE, speed=SPEED, footprint=FOOTPRINT, solver=solver
            )
            for solver in ("finite_strain", "half_plane")
        ]
        numbers = ", ".join(map(str, row.numbers))
        kept = f"{len(pairs.converged)} of {len(pairs.pairs)}"
        print(
            f"| {numbers} ({kept}) | {row.prototype} | {_span(pairs, 'block')} "
            f"| {_span(pairs, 'half_space')} | {ratio[0].factor:.3f}, {ratio[1].factor:.3f} | "
            + "; ".join(f"{one.contact_fraction:.4f}, {one.friction:.4f}" for one in chains)
            + " |",
            flush=True,
        )


def _span(pairs: FiniteStrainPairs, which: str) -> str:
    """Return smallest and largest area and friction of the pairs that count."""
    found = [getattr(pair, which) for pair in pairs.converged]
    both = np.array([(one.contact_fraction, one.friction_from_dissipation) for one in found])
    low, high = both.min(axis=0), both.max(axis=0)
    return f"{low[0]:.4f} to {high[0]:.4f}, {low[1]:.4f} to {high[1]:.4f}"


if __name__ == "__main__":
    main()
