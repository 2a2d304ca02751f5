"""A rubber seal on a rough wall: how much leaks, and where the last passage closes.

Run as `python examples/seal_leak.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import gripscale as gs
from gripscale.charts import save_figure

RUBBER = gs.Rubber(6e6, [4e6, 4e6], [1e-2, 1e-4])
"""A seal of nitrile rubber, near 60 Shore A; at rest only its relaxed modulus counts."""
SEAL = {"length": 1e-3, "width": 0.1, "pressure_difference": 1e5, "viscosity": 1e-3}
"""A lip 1 mm long around a shaft, against water at 1 bar."""
STEP, POINTS, ROUGHNESS = 1e-6, 192, 1.5e-6  # [m], -, [m]


def ground_wall(seed: int = 4) -> gs.HeightMap:
    """Return a periodic Gaussian wall: H = 0.8 below 60 um, waves to 6 um."""
    x = STEP * np.arange(POINTS)
    q = 2.0 * np.pi * np.fft.fftfreq(POINTS, STEP)
    number = np.hypot(q[:, None], q)
    corner, last = 2.0 * np.pi / 60e-6, 2.0 * np.pi / 6e-6
    amplitude = np.where((number > 0.0) & (number <= last), np.maximum(number, corner) ** -1.8, 0.0)
    noise = np.random.default_rng(seed).standard_normal((POINTS, POINTS))
    z = np.fft.ifft2(amplitude * np.fft.fft2(noise)).real
    return gs.HeightMap(x, x, z * (ROUGHNESS / z.std()))


def main(folder: str = "results/examples") -> None:
    """Print leak rates over the contact pressure; draw the flow where it is nearly closed."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    wall, drawn = ground_wall(), None
    print("contact pressure   area    mean gap   leak rate [uL/s]")
    for pressure in (1e5, 2e5, 3e5, 4e5, 5e5, 6e5):
        contact = gs.solve_rough_contact(
            RUBBER, wall, pressure=pressure, speed=0.0, periodic=True, tolerance=None
        )
        flow = gs.gap_flow(contact)
        leak = flow.leak_rate(**SEAL)[0]
        print(
            f"{pressure / 1e6:8.1f} MPa    {contact.contact_fraction:8.3f} "
            f"{flow.mean_gap * 1e6:8.2f} um   {leak * 1e9:.3g}"
        )
        drawn = flow if flow.percolates[0] else drawn
    if drawn is not None:
        print(drawn)
        print(save_figure(drawn.plot(), target, "seal_leak")[0])


if __name__ == "__main__":
    main(*sys.argv[1:2])
