"""Three hundred random loads, solved cold: time and Newton iterations by slope and pressure."""

from __future__ import annotations

import time
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.measure import name
from benchmarks.table import show
from gripscale.wave import Mesh
from tests.verification.load_grid import LoadCase, cases

MESHES = [Mesh(64, 12), Mesh()]
SLOPES = [0.02, 0.1, 0.2, 0.35]
PRESSURES = [0.03, 0.1, 0.3, 1.0]
HEADINGS = ["converged", "s median", "95 %", "most", "Newton median", "most"]
HEADINGS += ["mismatch median", "most", "area", "largest stretch"]


@dataclass(frozen=True)
class Solved:
    """One load of the grid with its CPU seconds."""

    case: LoadCase
    result: gs.ScaleResult
    seconds: float


def run(console: Console) -> None:
    """Print what converges, per mesh and per kind of load."""
    grid = cases()
    rows, solved = [], []
    for mesh in MESHES:
        solved = [_solve(case, mesh) for case in grid]
        rows.append([name(mesh), *_cells(solved)])
    show(
        console,
        "Random loads, cold: A/lambda 0.02-0.35, p/|E*| 0.03-1, loss factor 0.05-1, K/G 50-5000",
        ["mesh", *HEADINGS],
        rows,
        "CPU seconds. Mismatch: of the two friction measures.",
    )
    rows = []
    for low, high in pairwise(SLOPES):
        for least, most in pairwise(PRESSURES):
            inside = [
                s
                for s in solved
                if low <= s.case.slope < high and least <= s.case.pressure_ratio < most
            ]
            rows.append([f"{low:g} to {high:g}", f"{least:g} to {most:g}", *_cells(inside)])
    show(
        console,
        f"The same by slope and pressure, {name(MESHES[-1])}",
        ["A/λ", "p/|E*|", *HEADINGS],
        rows,
        "Mean shear, half-plane friction over the modulus at the load time, is below one.",
    )


def _solve(case: LoadCase, mesh: Mesh) -> Solved:
    start = time.process_time()
    result = gs.solve_scale(case.rubber, **case.arguments(), columns=mesh.columns, rows=mesh.rows)
    return Solved(case, result, time.process_time() - start)


def _cells(solved: list[Solved]) -> list[str]:
    seconds = [s.seconds for s in solved]
    good = [s.result for s in solved if s.result.converged]
    counts = [result.newton_iterations for result in good]
    mismatch = [result.friction_mismatch for result in good]
    return [
        f"{len(good)}/{len(solved)}",
        *(f"{value:.2f}" for value in (*np.quantile(seconds, (0.5, 0.95)), max(seconds))),
        *(f"{value:.0f}" for value in (np.median(counts), max(counts))),
        *(f"{value:.2%}" for value in (np.median(mismatch), max(mismatch))),
        _range([result.contact_fraction for result in good]),
        _range([result.max_stretch for result in good]),
    ]


def _range(values: list[float]) -> str:
    return f"{min(values):.2f}-{max(values):.2f}"
