"""Sliding in time: speed of a step, and how far its limit is from the steady state."""

from __future__ import annotations

import time

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.table import show
from tests.verification.families import worst
from tests.verification.transient_cases import CASES, SLOW, TransientCase

PASSAGES = 5
MESHES = [(32, 8), (64, 12), (96, 14), (128, 20)]
Compared = tuple[gs.ScaleResult, gs.TransientResult, float, float]
"""Steady state, run in time, CPU seconds of the run and of the steady state."""


def run(console: Console) -> None:
    """Print speed and error per mesh, every case on the finest, and a long memory."""
    rows = []
    for columns, lines in MESHES:
        found = [_compare(case, columns, lines) for case in CASES]
        cpu = sum(seconds for _, _, seconds, _ in found)
        steps = sum(len(moving.time) - 1 for _, moving, _, _ in found)
        iterations = sum(moving.newton_iterations for _, moving, _, _ in found)
        rows.append(
            [
                f"{columns}x{lines}",
                f"{steps}",
                f"{steps / cpu:.0f}",
                f"{iterations / steps:.1f}",
                f"{cpu / len(CASES):.2f}",
                f"{np.mean([seconds for *_, seconds in found]):.3f}",
                f"{worst(np.array([_friction_error(*each[:2]) for each in found])):.3%}",
                f"{worst(np.array([_area_error(*each[:2]) for each in found])):.4f}",
            ]
        )
    show(
        console,
        f"Sliding in time, {PASSAGES} passages from rest, eight cases",
        ["mesh", "steps", "steps/s", "Newton/step", "CPU s", "steady CPU s", "mu worst", "area"],
        rows,
        "Last moment against the steady solution of the same mesh. CPU s: of one run and of one "
        "steady solution, mean of the eight. CPU time, one thread.",
    )
    _each_case(console, found)
    _long_memory(console)


def _compare(case: TransientCase, columns: int, rows: int) -> Compared:
    start = time.process_time()
    steady = case.steady(columns=columns, rows=rows)
    middle = time.process_time()
    moving = case.run(case.stage(PASSAGES), columns=columns, rows=rows)
    if not (steady.converged and moving.converged):
        raise RuntimeError(f"{case} ended with {steady.status}, {moving.status}")
    return steady, moving, time.process_time() - middle, middle - start


def _friction_error(steady: gs.ScaleResult, moving: gs.TransientResult) -> float:
    return float(moving.friction[-1] / steady.friction - 1.0)


def _area_error(steady: gs.ScaleResult, moving: gs.TransientResult) -> float:
    return float(moving.contact_fraction[-1] - steady.contact_fraction)


def _each_case(console: Console, found: list[Compared]) -> None:
    rows = []
    for case, (steady, moving, _, _) in zip(CASES, found, strict=True):
        rows.append(
            [
                f"{case.slope:g}",
                f"{case.pressure_ratio:g}",
                ", ".join(f"{value:g}" for value in case.moduli),
                ", ".join(f"{value:g}" for value in case.passages),
                f"{steady.friction:.4f}",
                f"{_friction_error(steady, moving):+.3%}",
                f"{steady.contact_fraction:.4f}",
                f"{_area_error(steady, moving):+.4f}",
                f"{steady.min_stretch:.2f}-{steady.max_stretch:.2f}",
            ]
        )
    show(
        console,
        f"The same, case by case, {MESHES[-1][0]}x{MESHES[-1][1]}",
        ["A/λ", "p/|E*|", "E_i/E_inf", "tau v/λ", "mu", "error", "area", "error", "stretch"],
        rows,
        "mu, area: steady; error: the run's last moment.",
    )


def _long_memory(console: Console) -> None:
    """Compare a slow rubber with the steady state at the same load time."""
    grid = {"columns": 96, "rows": 14}
    rows = []
    for passages in (2, 5, 10):
        stage = SLOW.stage(passages)
        steady = SLOW.steady(load_time=stage.duration, **grid)
        moving = SLOW.run(stage, **grid)
        mean, least, largest = moving.cycle()["friction"]
        rows.append(
            [
                f"{passages}",
                f"{steady.friction:.5f}",
                f"{_friction_error(steady, moving):+.2%}",
                f"{mean / steady.friction - 1.0:+.2%}",
                f"{(largest - least) / mean:.2%}",
                f"{_area_error(steady, moving):+.4f}",
            ]
        )
    show(
        console,
        "A relaxation time of 50 passages: run in time against the steady state at the load time",
        ["passages", "steady mu", "last moment", "mean of last passage", "range", "area"],
        rows,
        f"{SLOW}.",
    )
