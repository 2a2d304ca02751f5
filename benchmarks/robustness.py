"""Three hundred random loads of real roads, solved cold: how many converge, at what cost."""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass
from itertools import pairwise

import load_grid
import numpy as np
import problems
from measure import Mesh, name
from rich.console import Console
from table import show

import gripscale as gs

MESHES: list[Mesh] = [(64, 12, 1), problems.DEFAULT]
SLOPES = [0.02, 0.1, 0.2, 0.35]
PRESSURES = [0.03, 0.1, 0.3, 1.0]


@dataclass(frozen=True)
class Solved:
    """One case of the grid with its CPU seconds."""

    case: load_grid.LoadCase
    result: gs.ScaleResult
    seconds: float


def run(console: Console) -> None:
    """Print what converges, per mesh and per kind of load."""
    grid = load_grid.cases()
    all_solved = {mesh: [_solve(case, mesh) for case in grid] for mesh in MESHES}
    rows = []
    for mesh, solved in all_solved.items():
        good = [s for s in solved if s.result.converged]
        seconds = [s.seconds for s in solved]
        counts = [s.result.newton_iterations for s in good]
        mismatch = [s.result.friction_mismatch for s in good]
        rows.append(
            [
                name(mesh),
                f"{len(good)}/{len(solved)}",
                f"{np.median(seconds):.2f}",
                f"{np.quantile(seconds, 0.95):.2f}",
                f"{max(seconds):.2f}",
                f"{np.median(counts):.0f}",
                f"{max(counts)}",
                *(f"{np.quantile(mismatch, q):.2%}" for q in (0.5, 0.9, 0.99, 1.0)),
            ]
        )
    show(
        console,
        "Random loads, cold: A/lambda 0.02-0.35, p/|E*| 0.03-1, loss factor 0.05-1, K/G 50-5000",
        [
            *("mesh", "converged", "CPU s median", "95 %", "most", "Newton median", "most"),
            *("mismatch median", "90 %", "99 %", "most"),
        ],
        rows,
        "Newton counts take all meshes of the ladder together and include the cheap iterations. "
        f"Mismatch: of the two friction measures. {_failures(all_solved)}",
    )
    _bins(console, all_solved[MESHES[-1]])


def _solve(case: load_grid.LoadCase, mesh: Mesh) -> Solved:
    start = time.process_time()
    result = gs.solve_scale(case.rubber, **case.arguments(), **problems.options(mesh))
    return Solved(case, result, time.process_time() - start)


def _failures(all_solved: dict[Mesh, list[Solved]]) -> str:
    endings = Counter(
        s.result.status.split(" at ")[0]
        for solved in all_solved.values()
        for s in solved
        if not s.result.converged
    )
    if not endings:
        return "None failed."
    return "Failed: " + ", ".join(f"{n} x {status}" for status, n in endings.items()) + "."


def _bins(console: Console, solved: list[Solved]) -> None:
    rows = []
    for low, high in pairwise(SLOPES):
        for least, most in pairwise(PRESSURES):
            inside = [
                s
                for s in solved
                if low <= s.case.slope < high and least <= s.case.pressure_ratio < most
            ]
            if not inside:
                continue
            good = [s for s in inside if s.result.converged]
            rows.append(
                [
                    f"{low:g} to {high:g}",
                    f"{least:g} to {most:g}",
                    f"{len(good)}/{len(inside)}",
                    f"{np.median([s.seconds for s in inside]):.2f}",
                    f"{max(s.seconds for s in inside):.2f}",
                    f"{np.median([s.result.newton_iterations for s in good]):.0f}",
                    f"{max(s.result.newton_iterations for s in good)}",
                    f"{np.median([s.result.friction_mismatch for s in good]):.2%}",
                    f"{max(s.result.friction_mismatch for s in good):.2%}",
                    _range([s.result.contact_fraction for s in good]),
                    _range([s.result.max_stretch for s in good]),
                ]
            )
    show(
        console,
        f"The same by slope and pressure, {name(MESHES[-1])}",
        [
            *("A/λ", "p/|E*|", "converged", "CPU s median", "most", "Newton median", "most"),
            *("mismatch median", "most", "area", "largest stretch"),
        ],
        rows,
        "Mean shear, half-plane friction over the modulus at the load time, is below one.",
    )


def _range(values: list[float]) -> str:
    return f"{min(values):.2f}-{max(values):.2f}"
