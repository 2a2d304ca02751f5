"""The direct contact: time and memory beside what was solved and how well.

The share of transforms is measured with the transforms of the same grids alone, in the same run.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from pathlib import Path

import machine
import numpy as np
from measure import peak_since_reset, reset_peak
from rich.console import Console
from table import show

import gripscale as gs
from gripscale.rough import RoughContact
from gripscale.surface import HeightMap, Profile

DATA = Path(__file__).parents[1] / "examples/data"
SPACING = 1e-4
"""Of the maps [m]; their smallest wave is four times as long."""


def isotropic_map(points: int) -> HeightMap:
    """Return Gaussian heights, rms 0.3 mm, self-affine with H = 0.8 below 20 mm."""
    number = 2 * np.pi * np.fft.fftfreq(points, SPACING)
    q = np.hypot(number[:, None], number[None, :])
    amplitude = np.where(
        (q > 0) & (q <= 2 * np.pi / (4 * SPACING)), np.maximum(q, 2 * np.pi / 0.02) ** -1.8, 0
    )
    noise = np.random.default_rng(0).standard_normal((points, points))
    z = np.fft.ifft2(amplitude * np.fft.fft2(noise)).real
    x = np.arange(points) * SPACING
    return HeightMap(x, x, z * (3e-4 / z.std()))


def road(points: int) -> Profile:
    """Return the first points of the shipped road."""
    path = DATA / "road" / "20211011_aylesbury_dec_station_0.dat"
    whole = gs.clean(gs.read_profile(path), crop=(0.12, 1.78))[0]
    return Profile(whole.x[:points], whole.z[:points])


def tread() -> gs.Rubber:
    """Return the shipped tread rubber."""
    return gs.fit_prony(gs.read_master_curve(DATA / "rubber/measured_dma.txt"))


def measured(solve: Callable[[], RoughContact]) -> list[str]:
    """Return the cells of one row."""
    reset_peak()
    before = peak_since_reset()
    wall, processor = time.perf_counter(), time.process_time()
    found = solve()
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    memory = peak_since_reset() - before
    return [
        " x ".join(map(str, found.grid.shape)),
        f"{wall:.2f}",
        f"{processor:.2f}",
        f"{memory:.0f}",
        f"{sum(grid.products for grid in found.grids)}",
        f"{found.contact_fraction:.4f}",
        f"{found.contact_fraction_error:.4f}",
        f"{found.friction:.4f}",
        f"{found.friction_error:.4f}",
        f"{found.friction_mismatch:.2%}",
        str(found.status),
    ]


def main() -> None:
    """Print the table."""
    rubber, rows = tread(), []
    sizes = [512, 1024] + ([2048] if "--large" in sys.argv else [])
    gs.solve_rough_contact(rubber, road(1024), pressure=3e5, speed=0.3)  # imports
    for speed in (0.3, 0.0):
        for points in sizes:
            surface = isotropic_map(points)
            cells = measured(
                lambda surface=surface, speed=speed: gs.solve_rough_contact(
                    rubber, surface, pressure=3e5, speed=speed, periodic=True, tolerance=None
                )
            )
            rows.append([f"map, {speed:g} m/s", *cells])
    for tolerance in (None, 0.02):
        line = road(32768)
        cells = measured(
            lambda line=line, tolerance=tolerance: gs.solve_rough_contact(
                rubber, line, pressure=3e5, speed=0.3, tolerance=tolerance
            )
        )
        rows.append([f"road, tolerance {tolerance}", *cells])
    console = Console(width=170)
    console.print(machine.describe())
    show(
        console,
        "Direct contact, tread rubber, 3 bar",
        [
            *("surface", "grid", "wall s", "CPU s", "peak MB", "products"),
            *("area", "+-", "friction", "+-", "mismatch", "status"),
        ],
        rows,
        "Four points in the smallest wave unless a tolerance is given; +- as estimated. Asked: "
        "1024 x 1024 in 3 s and 400 MB, 32768 points in 0.5 s, on two idle cores.",
    )


if __name__ == "__main__":
    main()
