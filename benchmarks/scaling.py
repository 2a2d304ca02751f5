"""Cost against unknowns: one wave from cold on ever finer meshes, by one thread and by all."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.table import show
from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.paper import save_figure
from gripscale.charts.style import BLUE, GREEN, WIDE
from gripscale.core.parallel import cores
from tests.verification.families import WAVELENGTH, tread

MESHES = [
    (128, 20),
    (192, 24),
    (256, 30),
    (384, 32),
    (512, 34),
    (768, 37),
    (1024, 40),
    (2048, 60),
    (4096, 60),
]
"""Columns and rows."""
PRESSURES = {"sliding": (5e6, 0.3), "static": (2e6, 0.0)}
"""Pressure [Pa] and speed [m/s]."""
SHORTEST = 0.5
"""Seconds over which a solution is repeated, by one thread and by all in turn."""
FEWEST = 3
"""Repetitions at least: others may be at work on the machine, and the least time counts."""


@dataclass(frozen=True)
class Cost:
    """Least seconds, memory [MB] and iterations of one wave with its whole mesh sequence."""

    columns: int
    rows: int
    megabytes: float
    seconds: float
    wall: float
    """Seconds on the clock by one thread."""
    shared_seconds: float
    shared_wall: float
    """The same two by one thread per core."""
    newton: int
    products: int

    @property
    def unknowns(self) -> int:
        """Displacement unknowns."""
        return 2 * self.columns * self.rows


def run(console: Console, figure: Path) -> None:
    """Print and draw the costs."""
    costs = {kind: [_cost(kind, columns, rows) for columns, rows in MESHES] for kind in PRESSURES}
    for kind, found in costs.items():
        rows = [
            [
                f"{cost.columns}x{cost.rows}",
                f"{cost.unknowns}",
                f"{cost.megabytes:.0f}",
                f"{cost.seconds:.3f}",
                f"{cost.newton}",
                f"{cost.products}",
                f"{1e6 * cost.seconds / cost.unknowns:.1f}",
                f"{cost.wall:.3f}",
                f"{cost.shared_seconds:.3f}",
                f"{cost.shared_wall:.3f}",
                f"{cost.wall / cost.shared_wall:.2f}",
            ]
            for cost in found
        ]
        rows.append(["exponent, by unknowns", "", "", f"{_exponent(found):.2f}", *[""] * 7])
        show(
            console,
            f"Cost against unknowns, {kind}: tread rubber, A/lambda = 0.16",
            [
                *["mesh", "unknowns", "peak MB", "CPU s", "Newton", "products", "us an unknown"],
                *["wall s", f"CPU s, {cores()}", f"wall s, {cores()}", "faster by"],
            ],
            rows,
            "One wave from cold, all meshes of the sequence together. Products: with the Jacobian, "
            "by GMRES. Peak: above the start. Exponent: by unknowns, least squares over all. Least "
            f"of {FEWEST} times or more, by one thread and by {cores()} in turn, their results the "
            "same to the last bit.",
        )
    figure.parent.mkdir(parents=True, exist_ok=True)
    for path in save_figure(_draw(costs), figure.parent, figure.stem):
        if path.suffix == ".pdf":
            path.unlink()
    console.print(f"Figure: {figure}\n")


def _cost(kind: str, columns: int, rows: int) -> Cost:
    reset_peak()
    before = peak_since_reset()
    alone, seconds, wall = _timed(kind, columns, rows, 1)
    shared_seconds, shared_wall, spent, times = math.inf, math.inf, wall, 1
    while times < FEWEST or spent < SHORTEST:
        together, *shared = _timed(kind, columns, rows, cores())
        if not _same(together, alone):
            raise RuntimeError(f"{kind}, {columns} columns: {cores()} threads give other bits")
        shared_seconds, shared_wall = min(shared_seconds, shared[0]), min(shared_wall, shared[1])
        _, *single = _timed(kind, columns, rows, 1)
        seconds, wall = min(seconds, single[0]), min(wall, single[1])
        spent, times = spent + single[1], times + 1
    return Cost(
        columns,
        rows,
        peak_since_reset() - before,
        seconds,
        wall,
        shared_seconds,
        shared_wall,
        alone.newton_iterations,
        alone.solution.jacobian_products,
    )


def _timed(kind: str, columns: int, rows: int, workers: int) -> tuple[gs.ScaleResult, float, float]:
    """Return the wave with its seconds of processors and on the clock."""
    pressure, speed = PRESSURES[kind]
    start = time.process_time(), time.perf_counter()
    result = gs.solve_scale(
        tread(),
        wavelength=WAVELENGTH,
        amplitude=0.16 * WAVELENGTH,
        pressure=pressure,
        speed=speed,
        load_time=5e-3,
        columns=columns,
        rows=rows,
        workers=workers,
    )
    if not result.converged:
        raise RuntimeError(f"{kind}, {columns} columns: {result.status}")
    return result, time.process_time() - start[0], time.perf_counter() - start[1]


def _same(one: gs.ScaleResult, other: gs.ScaleResult) -> bool:
    """Whether contact, friction and all surface nodes are the same to the last bit."""
    names = ("contact_fraction", "friction", "friction_from_dissipation", "residual")
    return all(getattr(one, name) == getattr(other, name) for name in names) and all(
        np.array_equal(getattr(one, name), getattr(other, name)) for name in ("x", "pressure")
    )


def _exponent(costs: list[Cost]) -> float:
    unknowns = np.log([cost.unknowns for cost in costs])
    return float(np.polyfit(unknowns, np.log([cost.seconds for cost in costs]), 1)[0])


def _draw(costs: dict[str, list[Cost]]) -> Figure:
    panel = Panel(
        PlotAxis("unknowns", log=True),
        PlotAxis("one wave from cold, processor time [s]", log=True),
        [
            Series([cost.unknowns for cost in rows], [cost.seconds for cost in rows], colour,
                   f"{kind}, exponent {_exponent(rows):.2f}", marker="o")
            for (kind, rows), colour in zip(costs.items(), (BLUE, GREEN), strict=True)
        ],
        legend="upper left",
    )  # fmt: skip
    return Sheet([panel], 1, WIDE / 2, legend="", gap=0.02).on_paper()
