"""Flow through a gap and trapped water: time and memory beside the factors."""

from __future__ import annotations

import time

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.rough_contact import SPACING, isotropic_map, tread
from benchmarks.table import show

CLOSED = (0.1, 0.35)
"""Closed fractions of the gaps below a plane: open, and near percolation."""


def run(console: Console) -> None:
    """Print the table."""
    rows = []
    for points in (512, 2048):
        z = isotropic_map(points).z
        for closed in CLOSED:
            gap = np.maximum(np.quantile(z, 1.0 - closed) - z, 0.0)
            reset_peak()
            before = peak_since_reset()
            wall, processor = time.perf_counter(), time.process_time()
            flow = gs.gap_flow(gap, spacing=(SPACING, SPACING))
            rows.append(
                [
                    f"flow, {closed:g} closed",
                    f"{points} x {points}",
                    f"{time.perf_counter() - wall:.2f}",
                    f"{time.process_time() - processor:.2f}",
                    f"{peak_since_reset() - before:.0f}",
                    f"{flow.flow_factor[0]:.4g}",
                    "{:.3g} to {:.3g}".format(*flow.flow_factor_interval[0]),
                ]
            )
    reset_peak()
    before = peak_since_reset()
    wall, processor = time.perf_counter(), time.process_time()
    wet = gs.solve_rough_contact(
        tread(), isotropic_map(512), pressure=1.6e6, speed=0.3, periodic=True, tolerance=None,
        water=True,
    )  # fmt: skip
    rows.append(
        [
            "contact with trapped water",
            "512 x 512",
            f"{time.perf_counter() - wall:.2f}",
            f"{time.process_time() - processor:.2f}",
            f"{peak_since_reset() - before:.0f}",
            f"{wet.friction_from_dissipation:.4g}",
            f"+- {wet.friction_error:.2g}",
        ]
    )
    show(
        console,
        "Flow through gaps, and trapped water",
        ["what", "grid", "wall s", "CPU s", "MB", "factor, friction", "error"],
        rows,
        "Asked: 512 x 512 in 2 s, 2048 x 2048 in 60 s, trapped water on 512 x 512 in 30 s, on two "
        "idle cores.",
    )
