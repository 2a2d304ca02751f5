"""A rubber from its master curve, then three strain energies for large stretches.

Run as `python examples/own_rubber.py [FOLDER [MASTER_CURVE]]`.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts import save_figure
from gripscale.questions import master_curve_figure
from gripscale.rubber import MooneyRivlin, NeoHookean, Yeoh, fit_prony_report, uniaxial_stress

DATA = Path(__file__).parent / "data" / "rubber" / "measured_dma.txt"
ENERGIES = (NeoHookean(), MooneyRivlin(share=0.4), Yeoh(second=-0.05, third=0.004))
LARGEST, RATE = 2.5, 1.0  # stretch [-], its rate [1/s]


def main(folder: str = "results/examples", file: str = str(DATA)) -> None:
    """Fit, report, stretch and release."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    master = gs.read_master_curve(file, reference_temperature=293.15)
    rubber, fit = fit_prony_report(master)
    print(fit.summary())
    save_figure(master_curve_figure(rubber, master, fit), target, "own_rubber_master_curve")

    rise = np.linspace(1.0, LARGEST, 200)
    stretch = np.concatenate([rise, rise[-2::-1]])
    time = np.arange(len(stretch)) * (LARGEST - 1.0) / RATE / 199
    figure = Figure(figsize=(4.6, 3.4), layout="constrained")
    axes = figure.subplots()
    for energy in ENERGIES:
        stress = uniaxial_stress(replace(rubber, strain_energy=energy), time=time, stretch=stretch)
        lost = np.trapezoid(stress, stretch)
        name = type(energy).__name__
        print(f"{name}: {stress.max() / 1e6:.2f} MPa at {LARGEST}, {lost / 1e6:.2f} MJ/m^3 lost")
        axes.plot(stretch, stress / 1e6, label=name)
    axes.set(xlabel="stretch [-]", ylabel="nominal stress [MPa]")
    axes.legend()
    print(save_figure(figure, target, "own_rubber_loops")[0])


if __name__ == "__main__":
    main(*sys.argv[1:3])
