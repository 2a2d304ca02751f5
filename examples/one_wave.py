"""One wave, twice: the finite-strain block beside the small-strain half-plane.

Run as `python examples/one_wave.py [FOLDER [COLUMNS]]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts import save_figure
from gripscale.questions import block_figure
from gripscale.theory import solve_half_plane
from gripscale.wave.result import waves_to_dataset

WAVELENGTH, PRESSURE, SPEED = 5e-3, 1.25e6, 10.0  # [m], [Pa] at slope 1, [m/s]
SLOPES = (0.05, 0.3, 0.6, 0.9)  # largest slope of the wave, 2 pi amplitude / wavelength


def main(folder: str = "results/examples", columns: str = "128") -> None:
    """Solve waves of rising steepness with both models; print and draw them."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    rubber = gs.rubber.styrene_butadiene()
    rows = []
    print("slope  contact: block half-plane  friction: block half-plane  stretch")
    for slope in SLOPES:
        wave = {
            "wavelength": WAVELENGTH,
            "amplitude": slope * WAVELENGTH / (2 * np.pi),
            # The same part of the pressure that closes the contact, whatever the slope.
            "pressure": PRESSURE * slope,
            "speed": SPEED,
            "load_time": 1e-3,  # [s], how long the mean state has had to relax
        }
        block = gs.solve_scale(rubber, **wave, columns=int(columns), rows=int(columns) // 6)
        plane = solve_half_plane(rubber, **wave)
        rows.append([slope, block.friction, plane.friction])
        print(
            f"{slope:5.2f} {block.contact_fraction:15.3f} {plane.contact_fraction:10.3f}"
            f" {block.friction:16.4f} {plane.friction:10.4f}  {block.max_stretch:.2f}"
            f" {block.status}"
        )
    save_figure(block_figure(waves_to_dataset([block])), target, "one_wave_block")
    figure = Figure(figsize=(4.6, 3.2), layout="constrained")
    axes = figure.subplots()
    slope, block_friction, plane_friction = np.array(rows).T
    axes.plot(slope, block_friction / slope, "o-", label="block, finite strain")
    axes.plot(slope, plane_friction / slope, "s--", label="half-plane, small strain")
    axes.set(xlabel="largest slope [-]", ylabel="friction over slope [-]", ylim=(0, 0.5))
    axes.legend()
    print(save_figure(figure, target, "one_wave")[0])


if __name__ == "__main__":
    main(*sys.argv[1:3])
