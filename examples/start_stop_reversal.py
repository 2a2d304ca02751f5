"""Start, stop and reversal on one wave: friction in time.

Run as `python examples/start_stop_reversal.py [FOLDER [COLUMNS]]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts import save_figure

WAVELENGTH, AMPLITUDE, PRESSURE, SPEED = 1e-3, 0.06e-3, 4e5, 0.05  # [m], [m], [Pa], [m/s]
RUBBER = gs.Rubber(3e6, [3e6, 6e6], [1e-2, 1e-3])  # [Pa], [Pa], [s]


def main(folder: str = "results/examples", columns: str = "96") -> None:
    """Slide three waves forth, dwell, slide three waves back; compare with the steady state."""
    Path(folder).mkdir(parents=True, exist_ok=True)
    mesh = {"columns": int(columns), "rows": int(columns) // 6}
    wave = {"wavelength": WAVELENGTH, "amplitude": AMPLITUDE}
    passage = WAVELENGTH / SPEED
    stages = [
        gs.Stage(duration=3 * passage, speed=SPEED, pressure=PRESSURE),
        gs.Stage(duration=2 * passage, speed=0.0, pressure=PRESSURE),
        gs.Stage(duration=3 * passage, speed=-SPEED, pressure=PRESSURE),
    ]
    run = gs.solve_transient(RUBBER, **wave, stages=stages, **mesh)
    steady = gs.solve_scale(RUBBER, **wave, pressure=PRESSURE, speed=SPEED, **mesh)
    forth = run.friction[run.speed > 0.0]
    dwelling = run.contact_fraction[run.speed == 0.0]
    print(f"{run.status}, {len(run.time)} moments")
    print(f"friction forth {forth[-1]:.4f}, back {run.friction[-1]:.4f}, largest {forth.max():.4f}")
    print(f"friction of the steady state {steady.friction:.4f}")
    print(f"contact grows from {dwelling[0]:.3f} to {dwelling[-1]:.3f} while it dwells")
    figure = Figure(figsize=(7, 4), layout="constrained")
    panels = figure.subplots(2, 1, sharex=True)
    for axes, values, label in (
        (panels[0], run.friction, "friction [-]"),
        (panels[1], run.contact_fraction, "contact fraction [-]"),
    ):
        axes.plot(run.time * 1e3, values)
        axes.set_ylabel(label)
    for value in (steady.friction, -steady.friction):
        panels[0].axhline(value, color="grey", lw=0.8, ls="--")
    panels[1].axhline(steady.contact_fraction, color="grey", lw=0.8, ls="--")
    panels[1].set_xlabel("time [ms]")
    print(save_figure(figure, Path(folder), "start_stop_reversal")[0])


if __name__ == "__main__":
    main(*sys.argv[1:3])
