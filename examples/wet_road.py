"""The top of a stone in the rain: water that is trapped, and water that cannot leave in time.

Run as `python examples/wet_road.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import gripscale as gs
from gripscale.charts import chart, draw, save_figure
from gripscale.charts.style import BLUE, GREEN, ORANGE
from gripscale.flow import wet_friction

DATA = Path(__file__).parent / "data"
ROAD, DMA = DATA / "road" / "20211011_aylesbury_dec_station_0.dat", DATA / "rubber/measured_dma.txt"
PRESSURE, STONE = 3e6, 8e-3
"""On the top of a stone, which carries ten times the nominal pressure [Pa], and its length [m]."""
LARGEST, STEP, POINTS = 4e-3, 6.25e-5, 128
"""Largest wave of the top, and the sampling of its map [m]."""
POLISHED = 0.06
"""Heights of the polished top over those of the shipped road, whose waves it has."""
FILM, SPEEDS = 0.2e-3, [0.1, 0.3, 1.0, 3.0, 10.0]


def top_of_stone(seed: int = 1) -> gs.HeightMap:
    """Return a periodic Gaussian map with the polished waves of the shipped road."""
    road, _ = gs.clean(gs.read_profile(ROAD), crop=(0.12, 1.78))
    fit = gs.fit_self_affine(gs.height_difference(road))
    q = 2.0 * np.pi * np.fft.fftfreq(POINTS, STEP)
    number = np.hypot(q[:, None], q)
    band = (number >= 2.0 * np.pi / LARGEST) & (number <= 2.0 * np.pi / (4.0 * STEP))
    amplitude = np.where(band, np.maximum(number, 1.0) ** -(1.0 + fit.hurst), 0.0)
    noise = np.random.default_rng(seed).standard_normal((POINTS, POINTS))
    z = np.fft.ifft2(amplitude * np.fft.fft2(noise)).real
    rms = fit.xi_perpendicular / np.sqrt(2.0) * min(LARGEST / fit.xi_parallel, 1.0) ** fit.hurst
    x = STEP * np.arange(POINTS)
    return gs.HeightMap(x, x, z * (POLISHED * rms / z.std()))


def main(folder: str = "results/examples") -> None:
    """Print what trapped water carries; draw friction over speed under two films."""
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    top, rubber = top_of_stone(), gs.fit_prony(gs.read_master_curve(DMA))
    options = {"pressure": PRESSURE, "periodic": True, "tolerance": None}
    flooded = gs.solve_rough_contact(rubber, top, speed=SPEEDS[0], water=True, **options)
    print(*flooded.notes)
    print(f"With it the friction is {flooded.friction_from_dissipation:.3g}.")
    data = wet_friction(rubber, top, speeds=SPEEDS, film=FILM, length=STONE, **options)
    print("Asperities carry", np.round(data.asperity_share.values, 3), data.notes)
    trapped = flooded.friction_from_dissipation
    speed = chart.PlotAxis("speed [m/s]", log=True)
    dry, wet, share = (data[name].values for name in ("dry_friction", "friction", "asperity_share"))
    panels = [
        chart.Panel(
            speed,
            chart.PlotAxis("friction $\\mu$ [-]", low=0.0),
            [
                chart.Series(SPEEDS, dry, GREEN, "dry", marker="o"),
                chart.Series(SPEEDS, wet, BLUE, "film of 0.2 mm", marker="o"),
                chart.Series(SPEEDS[:1], [trapped], ORANGE, "trapped water", dash="", marker="s"),
            ],
        ),
        chart.Panel(
            speed,
            chart.PlotAxis("share of load on asperities [-]", low=0.0, high=1.0),
            [chart.Series(SPEEDS, share, BLUE, marker="o")],
        ),
    ]
    print(save_figure(draw.Sheet(panels).on_paper(), target, "wet_road")[0])


if __name__ == "__main__":
    main(*sys.argv[1:2])
