"""Cost against unknowns: one full Newton iteration, one cheap one, one wave; and the ceiling."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.table import show
from gripscale.figures.palette import BLUE, GREEN, GREY, WIDE
from gripscale.figures.style import save_figure, sheet, styled
from tests.verification.families import WAVELENGTH, tread

COLUMNS = [34, 50, 66, 98, 130, 194, 258, 386]
"""Twice an odd number: such a mesh is alone in its sequence, and a warm start stays on it."""
ROW_EXPONENT = 0.585
SHORTEST, LONGEST = 0.25, 2.0
"""Seconds over which a measurement is repeated; the median counts."""
PAIRS = 15
CEILING = 6e10
"""Flops per second of a dense product in numpy on one thread where this was drawn first."""
LOAD_CHANGES = [1.0005, 0.9995, 1.001, 0.999, 1.0002, 0.9998]
"""Tried in turn until two iterations do, a full one and a cheap one: no node changes sides then."""
CONVERGED, ONE_ITERATION, TWO_ITERATIONS = 1e-8, 1e-4, 1e-9
PRESSURES = {"sliding": (5e6, 0.3), "static": (2e6, 0.0)}
"""Pressure [Pa] and speed [m/s]."""


@dataclass(frozen=True)
class Cost:
    """Processor seconds of the parts of one wave on one mesh."""

    columns: int
    rows: int
    megabytes: float
    cold: float
    iterations: int
    full: float
    cheap: float
    outcome: float

    @property
    def unknowns(self) -> int:
        """Displacement unknowns."""
        return 2 * self.columns * self.rows

    @property
    def flops(self) -> float:
        """Flops of the block elimination in one full iteration, 14/3 n^3 a row."""
        return 14.0 / 3.0 * (2 * self.columns) ** 3 * self.rows


def run(console: Console, figure: Path) -> None:
    """Print and draw the costs, and compare the elimination with dense products and LU."""
    costs = {kind: [_cost(kind, columns) for columns in COLUMNS] for kind in PRESSURES}
    for kind, found in costs.items():
        rows = [
            [
                f"{cost.columns}x{cost.rows}",
                f"{cost.unknowns}",
                f"{cost.megabytes:.0f}",
                f"{cost.cold:.3f}",
                f"{cost.iterations}",
                f"{1e3 * cost.full:.1f}",
                f"{1e3 * cost.cheap:.1f}",
                f"{1e3 * cost.outcome:.1f}",
                f"{cost.flops / 1e9:.2f}",
                f"{cost.flops / cost.full / 1e9:.1f}",
            ]
            for cost in found
        ]
        rows.append(
            [
                "exponent, by unknowns",
                "",
                "",
                f"{_exponent(found, 'cold'):.2f}",
                "",
                *(f"{_exponent(found, part):.2f}" for part in ("full", "cheap", "outcome")),
                "",
                "",
            ]
        )
        show(
            console,
            f"Cost against unknowns, {kind}: tread rubber, A/lambda = 0.16",
            [
                *("mesh", "unknowns", "peak MB", "cold CPU s", "Newton"),
                *("full ms", "cheap ms", "outcome ms", "elimination GFlop", "GFlop/s"),
            ],
            rows,
            "Cold: the load raised on this mesh alone, without the sequence that the default "
            "mesh has. Full: one iteration with a fresh factorisation, assembly and contact "
            "included; cheap: one with the block kept; outcome: friction, edges, stretches and the "
            "handing over of the fields. GFlop/s: the elimination's flops over the time of all of "
            "a full iteration. Exponent: by unknowns, least squares over the last four meshes.",
        )
    _ceiling(console)
    figure.parent.mkdir(parents=True, exist_ok=True)
    for path in save_figure(_draw(costs), figure.parent, figure.stem):
        if path.suffix == ".pdf":
            path.unlink()
    console.print(f"Figure: {figure}\n")


def _rows(columns: int) -> int:
    return round(20 * (columns / 128) ** ROW_EXPONENT)


def _cost(kind: str, columns: int) -> Cost:
    pressure, speed = PRESSURES[kind]

    def solve(
        factor: float, tolerance: float, start: gs.ScaleResult | None = None
    ) -> gs.ScaleResult:
        return gs.solve_scale(
            tread(),
            wavelength=WAVELENGTH,
            amplitude=0.16 * WAVELENGTH,
            pressure=factor * pressure,
            speed=speed,
            load_time=5e-3,
            columns=columns,
            rows=_rows(columns),
            residual_tolerance=tolerance,
            start=start,
        )

    reset_peak()
    cold_seconds, cold = _timed(lambda: solve(1.0, CONVERGED))
    megabytes = peak_since_reset()
    none, _ = _timed(lambda: solve(1.0, CONVERGED, cold))
    for change in LOAD_CHANGES:
        first = solve(change, ONE_ITERATION, cold)
        second = solve(change, TWO_ITERATIONS, cold)
        if (first.newton_iterations, second.newton_iterations) == (1, 2):
            break
    else:
        raise RuntimeError(f"no load change takes one and two iterations on {columns} columns")
    ones, pairs = [], []
    while len(pairs) < PAIRS and sum(ones) < LONGEST:
        one, _ = _timed(lambda: solve(change, ONE_ITERATION, cold), once=True)
        two, _ = _timed(lambda: solve(change, TWO_ITERATIONS, cold), once=True)
        ones.append(one)
        pairs.append(two - one)
    return Cost(
        columns,
        _rows(columns),
        megabytes,
        cold_seconds,
        cold.newton_iterations,
        float(np.median(ones)) - none,
        float(np.median(pairs)),
        none,
    )


def _timed(
    call: Callable[[], gs.ScaleResult], *, once: bool = False
) -> tuple[float, gs.ScaleResult]:
    """Return the median CPU seconds of repeated calls, and the last result."""
    seconds: list[float] = []
    while len(seconds) < 5 or sum(seconds) < SHORTEST:
        start = time.process_time()
        result = call()
        seconds.append(time.process_time() - start)
        if once or sum(seconds) > LONGEST:
            break
    return float(np.median(seconds)), result


def _exponent(costs: list[Cost], part: str) -> float:
    last = costs[-4:]
    values = [getattr(cost, part) for cost in last]
    return float(np.polyfit(np.log([c.unknowns for c in last]), np.log(values), 1)[0])


def _ceiling(console: Console) -> None:
    """Print what a dense product and a dense LU with n right-hand sides reach here."""
    program = Path(__file__).with_name("ceiling.py")
    one_thread = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, str(program)], env=one_thread, check=True, capture_output=True, text=True
    )
    show(
        console,
        "The practical ceiling: numpy (OpenBLAS), one thread",
        ["n", "product GFlop/s", "LU and n right-hand sides GFlop/s"],
        [line.split() for line in done.stdout.splitlines()],
        "2 n^3 and 8/3 n^3 flops. The elimination needs both per row: 14/3 n^3.",
    )


@styled
def _draw(costs: dict[str, list[Cost]]) -> object:
    page, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    for panel, kind in zip(axes[0], costs, strict=True):
        found = costs[kind]
        unknowns = [cost.unknowns for cost in found]
        for part, label, colour in (
            ("cold", "one wave, cold", BLUE),
            ("full", "full Newton iteration", GREEN),
        ):
            values = [getattr(cost, part) for cost in found]
            text = f"{label}, exponent {_exponent(found, part):.1f}"
            panel.plot(unknowns, values, color=colour, marker="o", label=text)
        limit = [cost.flops / CEILING for cost in found]
        label = f"elimination at {CEILING / 1e9:.0f} GFlop/s"
        panel.plot(unknowns, limit, color=GREY, ls=":", label=label)
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xlabel(f"unknowns, {kind}")
        panel.set_ylabel("processor time [s]")
        low, high = panel.get_ylim()
        panel.set_ylim(low, 30.0 * high)
        panel.legend(loc="upper left")
    return page
