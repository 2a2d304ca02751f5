"""A condition of your own: the rubber warms on the way from the largest wave to the smallest.

`rubber_at` is asked for the rubber of every wave, with what was solved so far. This one warms it by
a fixed amount for each unit of friction already made, and shifts all relaxation times by
a factor 10 each `per_decade` kelvin: a toy, no thermal model.

A condition of the package is one such class in a file of its own; a case file that shall switch it
on needs a key in `python/gripscale/case_file/rubber_tables.py`. All else stays as it is. Run as
`python examples/toy_condition.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass, replace
from pathlib import Path

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.chain import Chain, ChainResult, solve_chain
from gripscale.questions import Study
from gripscale.wave import FiniteStrainBlock, Mesh, Sine

CASE = Path(__file__).parent / "three_waves" / "case.toml"
COARSE = FiniteStrainBlock(Mesh(columns=32, rows=8))


@dataclass(frozen=True)
class Warming:
    """Relaxation times shortened by the friction of the waves above; frozen, so it can be kept."""

    kelvin: float = 100.0
    """For a friction coefficient of one."""
    per_decade: float = 20.0
    """Kelvin that make all relaxation times ten times shorter."""

    def __call__(self, wave: Sine, so_far: ChainResult) -> gs.Rubber:
        """Return the rubber as it is on `wave`."""
        warmer = self.kelvin * (so_far.friction if so_far.scales else 0.0)
        times = so_far.rubber.relaxation_times * 10.0 ** (-warmer / self.per_decade)
        return replace(so_far.rubber, relaxation_times=times, admissible=None)


def main(folder: str = "results/examples") -> None:
    """Predict with and without it; then vary the speed in a study with it."""
    case = read_case(CASE)
    inputs = case.rubber, case.surface.sines
    load = {"pressure": 3e5, "speed": 3.0, "footprint": 0.1}  # [Pa], [m/s], [m]
    plain = solve_chain(*inputs, **load, solver=COARSE)
    warm = solve_chain(*inputs, **load, solver=COARSE, rubber_at=Warming())
    for cold, hot in zip(plain.scales, warm.scales, strict=True):
        print(f"{cold.wavelength * 1e3:.0f} mm: friction {cold.friction:.4f}, {hot.friction:.4f}")
    study = Study(case, {"speed": [0.3, 3.0]}, model=Chain(COARSE, rubber_at=Warming()))
    result = study.run(Path(folder) / "toy_condition")
    for speed, friction in zip(result.speed.values, result.total_friction.values, strict=True):
        print(f"{speed:g} m/s: friction {friction:.4f}")


if __name__ == "__main__":
    main(*sys.argv[1:2])
