"""The area term fitted to measured friction, where the truth is known.

The friction is synthetic: `measure` made it, from the hysteresis of a case, a law of the shear
stress and noise. The fit is given the friction and the hysteresis, and has to find the law.

Run as `python examples/area_term.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.charts.draw import FigureFolder
from gripscale.conditions import GaussianStress
from gripscale.experiment import Bench, MeasuredFriction, Store, solve_design
from gripscale.questions import measured_design, predicted_of

CASE = Path(__file__).parent / "measured_friction" / "case.toml"
TRUE = GaussianStress(
    stress_0=0.35e6,  # [Pa]
    width=0.15,
    speed_0=5e-3,  # [m/s]
    activation_energy=0.95,  # [eV]
    reference_temperature=293.15,  # [K]
)
SPREAD, SEED = 0.02, 20
FRICTION = "speed [m/s],temperature [C],friction,spread"


def measure(folder: str | Path) -> list[str]:
    """Return the lines of a table of friction at three temperatures and eight speeds.

    What was predicted is kept in `folder`.
    """
    speed, celsius = (
        grid.ravel()
        for grid in np.meshgrid(np.geomspace(1e-4, 1.0, 8), [5.0, 20.0, 40.0], indexing="ij")
    )
    points = MeasuredFriction(speed, np.zeros(speed.size), temperature=celsius + 273.15)
    case = read_case(CASE)
    design = measured_design(points, case.chain, case.rubber, case.surface, case.load)
    found = predicted_of(solve_design(design, Bench(Store(Path(folder) / "predictions"))))
    exact = found.friction + found.area_term(TRUE, points.speed)
    friction = np.random.default_rng(SEED).normal(exact, SPREAD)
    columns = points.speed, points.temperature - 273.15, friction
    rows = [f"{v:.4g},{c:.0f},{mu:.3f},{SPREAD}" for v, c, mu in zip(*columns, strict=True)]
    return [FRICTION, *rows]


def main(folder: str = "results/examples") -> None:
    """Fit the law and print it beside the truth."""
    target = Path(folder) / "area_term"
    target.mkdir(parents=True, exist_ok=True)
    fixed = {"reference_temperature": 293.15}
    result = gs.calibrate(
        read_case(CASE), model="chain", fixed=fixed, hold_out="temperature", folder=target
    )
    for fitted in result.estimates:
        name, value, true = fitted.name, fitted.value, getattr(TRUE, fitted.name)
        print(f"{name}: {value:.4g}, {fitted.low:.4g} to {fitted.high:.4g}; true {true:.4g}")
    for kelvin, rms in zip(
        result.data.left_out.values, result.data.rms_outside.values, strict=True
    ):
        print(f"{kelvin - 273.15:.0f} C from the others: rms {rms:.3f}")
    wrong = gs.calibrate(
        read_case(CASE), model="chain", law="constant", hold_out="temperature", folder=target
    )
    print(f"with a constant stress: rms up to {float(wrong.data.rms_outside.max()):.3f}")
    figures = FigureFolder(target)
    for name, figure in result.figures():
        figures.save(figure, name)


if __name__ == "__main__":
    main(*sys.argv[1:2])
