"""The direct contact: time and memory beside what was solved, and the share of its transforms.

Every transform of a solve is timed where it is called, in the same run: what a solve takes over
that is what the bookkeeping costs. `benchmarks.large_maps` has larger maps.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
import scipy.fft
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.table import show
from gripscale._kernel import Line
from gripscale.half_space import response
from gripscale.surface import HeightMap, Profile, self_affine_profile

DATA = Path(__file__).parents[1] / "examples/data"
MAPS = ((512, 0.3, None), (1024, 0.3, None), (1024, 0.3, 0.02), (1024, 0.0, None))
"""Points a side, speed [m/s] and tolerance."""
SPACING = 1e-4
"""Of the maps [m]; their smallest wave is four times as long."""


def isotropic_map(points: int) -> HeightMap:
    """Return Gaussian heights, rms 0.3 mm, self-affine with H = 0.8 below 20 mm."""
    across, along = scipy.fft.fftfreq(points, SPACING), scipy.fft.rfftfreq(points, SPACING)
    q = 2 * np.pi * np.hypot(across[:, None], along)
    waves = scipy.fft.rfft2(np.random.default_rng(0).standard_normal((points, points)))
    waves *= np.where(q <= 2 * np.pi / (4 * SPACING), np.maximum(q, 2 * np.pi / 0.02) ** -1.8, 0)
    del q
    waves[0, 0] = 0.0
    z = scipy.fft.irfft2(waves, (points, points), overwrite_x=True)
    x = SPACING * np.arange(points, dtype=float)
    return HeightMap(x, x, z * float(3e-4 / z.std()))


def road(points: int) -> Profile:
    """Return the first points of the shipped road."""
    path = DATA / "road" / "20211011_aylesbury_dec_station_0.dat"
    whole = gs.clean(gs.read_profile(path), crop=(0.12, 1.78))[0]
    return Profile(whole.x[:points], whole.z[:points])


def tread() -> gs.Rubber:
    """Return the shipped tread rubber."""
    return gs.fit_prony(gs.read_master_curve(DATA / "rubber/measured_dma.txt"))


def lossy() -> gs.Rubber:
    """Return a rubber with a loss angle of 1.0 at all frequencies."""
    times = np.geomspace(1e-9, 1e1, 41)
    return gs.Rubber(1e5, 2e5 * (times / 1e-3) ** (-2.0 / np.pi), times, bulk_modulus=1e13)


def self_affine() -> Profile:
    """Return a line of 65,536 points, H = 0.8 below 20 mm."""
    return self_affine_profile(0.8, 0.02, 1e-3, 1.6384, 2.5e-5, seed=1)


def run(console: Console) -> None:
    """Print the table."""
    rubber, rows = tread(), []
    gs.solve_rough_contact(rubber, road(1024), pressure=3e5, speed=0.3)  # imports
    for points, speed, tolerance in MAPS:
        cells = _measured(
            rubber, isotropic_map(points), pressure=3e5, speed=speed, periodic=True,
            tolerance=tolerance, most_points=2**24,
        )  # fmt: skip
        rows.append([f"map, {speed:g} m/s, {tolerance or 'none'}", *cells])
    for tolerance in (None, 0.02):
        cells = _measured(rubber, road(32768), pressure=3e5, speed=0.3, tolerance=tolerance)
        rows.append([f"road, {tolerance or 'none'}", *cells])
    surfaces: dict[str, Profile | HeightMap] = {"line": self_affine(), "map": isotropic_map(512)}
    for kind, surface in surfaces.items():
        cells = _measured(lossy(), surface, pressure=2e5, speed=0.3, periodic=True, tolerance=None)
        rows.append([f"{kind}, loss angle 1.0, none", *cells])
    show(
        console,
        "Direct contact, tread rubber, 3 bar",
        [
            *("surface, tolerance", "grid", "wall s", "CPU s", "/ FFT", "MB", "products"),
            *("area", "+-", "friction", "+-", "status"),
        ],
        rows,
        "Four points in the smallest wave unless a tolerance is given; +- as estimated. Asked: "
        "1024 x 1024 in 2 s, 32768 points in 0.5 s, on two idle cores, and 1.5 "
        "times the transforms (/ FFT).",
    )


def _measured(rubber: gs.Rubber, surface: Profile | HeightMap, **options: Any) -> list[str]:
    """Solve; return the cells of one row."""
    reset_peak()
    before = peak_since_reset()
    with _timed_transforms() as transforms:
        wall, processor = time.perf_counter(), time.process_time()
        found = gs.solve_rough_contact(rubber, surface, **options)
        wall, processor = time.perf_counter() - wall, time.process_time() - processor
    memory = peak_since_reset() - before
    return [
        " x ".join(map(str, found.grid.shape)),
        f"{wall:.2f}",
        f"{processor:.2f}",
        f"{processor / sum(transforms):.2f}",
        f"{memory:.0f}",
        f"{sum(grid.products for grid in found.grids)}",
        f"{found.contact_fraction:.4f}",
        f"{found.contact_fraction_error:.4f}",
        f"{found.friction:.4f}",
        f"{found.friction_error:.4f}",
        str(found.status),
    ]


@contextmanager
def _timed_transforms() -> Iterator[list[float]]:
    """Give the processor seconds of every transform and every linear system of a line within."""
    seconds: list[float] = []

    def timed(transform: Callable[..., Any]) -> Callable[..., Any]:
        def call(*values: Any, **options: Any) -> Any:
            start = time.process_time()
            out = transform(*values, **options)
            seconds.append(time.process_time() - start)
            return out

        return call

    with ExitStack() as ending:
        for name in ("rfftn", "irfftn", "ifft", "irfft"):
            ending.enter_context(patch.object(scipy.fft, name, timed(getattr(scipy.fft, name))))

        def timed_line(points: int) -> SimpleNamespace:
            line = Line(points)
            return SimpleNamespace(filtered=timed(line.filtered), close_gap=timed(line.close_gap))

        ending.enter_context(patch.object(response, "Line", timed_line))
        yield seconds
