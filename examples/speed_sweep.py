"""Contact area and friction over the speed: each speed starts from the solution before it.

Run as `python examples/speed_sweep.py [FOLDER [COLUMNS]]`. For whole stacks of waves, on all cores,
with results kept on disk, see `gripscale study` and `gripscale.questions.Study`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts import save_figure

WAVELENGTH, AMPLITUDE, PRESSURE = 1e-3, 0.06e-3, 1e6  # [m], [m], [Pa]
SPEEDS = np.geomspace(1e-6, 1e4, 41)  # [m/s]


def sweep(rubber: gs.Rubber, columns: int) -> list[gs.ScaleResult]:
    """Return the wave at all speeds; raise the status of one that did not converge."""
    found: list[gs.ScaleResult] = []
    for speed in SPEEDS:
        wave = gs.solve_scale(
            rubber,
            wavelength=WAVELENGTH,
            amplitude=AMPLITUDE,
            pressure=PRESSURE,
            speed=float(speed),
            columns=columns,
            rows=columns // 6,
            start=found[-1] if found else None,
        )
        if not wave.converged:
            raise gs.ConvergenceError(f"{speed:g} m/s: {wave.status}")
        found.append(wave)
    return found


def main(folder: str = "results/examples", columns: str = "128") -> None:
    """Sweep, say where friction is largest, draw."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    waves = sweep(gs.rubber.styrene_butadiene(), int(columns))
    best = max(waves, key=lambda wave: wave.friction)
    print(f"friction is largest, {best.friction:.3f}, at {best.speed:.3g} m/s")
    print(f"contact {waves[0].contact_fraction:.3f} slow, {waves[-1].contact_fraction:.3f} fast")
    print(f"{np.mean([wave.newton_iterations for wave in waves]):.1f} Newton iterations a speed")
    figure = Figure(figsize=(7, 3), layout="constrained")
    for axes, name in zip(figure.subplots(1, 2), ("friction", "contact_fraction"), strict=True):
        axes.semilogx(SPEEDS, [getattr(wave, name) for wave in waves], ".-")
        axes.set(xlabel="speed [m/s]", ylabel=f"{name.replace('_', ' ')} [-]", ylim=(0, None))
    print(save_figure(figure, Path(folder), "speed_sweep")[0])


if __name__ == "__main__":
    main(*sys.argv[1:3])
