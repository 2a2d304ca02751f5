"""One wave, the chain of eight, and twenty speeds: cold, warm, and on two threads."""

from __future__ import annotations

import resource
import time
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from typing import Any

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.case import CASE
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.table import show
from gripscale.case_file import read_case

TOLERANCE = 0.01
SPEEDS = [float(v) for v in np.geomspace(0.003, 30.0, 20)]
THREADS = 2
REPEATS = 3
CHANGE = 1.1
WARM_AIM, COLD_AIM, CHAIN_AIM, SWEEP_AIM, MEMORY_AIM = 0.1, 0.5, 2.0, 30.0, 500.0


def run(console: Console) -> None:
    """Print the times beside their aims, with the accuracy they were reached at."""
    _one_wave(console)
    _chain_and_sweep(console)


@cache
def _case() -> tuple[gs.Rubber, gs.SineStack, dict[str, Any]]:
    case = read_case(CASE)
    loads = {"pressure": case.load.pressure, "footprint": case.load.footprint}
    return case.rubber, case.surface.sines, loads


def _one_wave(console: Console) -> None:
    """Every wave of the case: cold, and warm from the same wave at a speed 10 % lower."""
    rubber, sines, loads = _case()
    here = gs.solve_chain(rubber, sines, speed=0.3, **loads)
    rows = []
    for title, options in (
        (f"tolerance {TOLERANCE:g}", {"tolerance": TOLERANCE}),
        ("128x20", {}),
    ):
        cold_seconds, warm_seconds, cold_counts, warm_counts, meshes = [], [], [], [], []
        errors, fractions = [], []
        for scale in here.scales:
            wave: dict[str, Any] = {
                "wavelength": scale.wavelength,
                "amplitude": scale.amplitude,
                "pressure": scale.pressure_received,
                "load_time": scale.load_time,
                **options,
            }
            near = gs.solve_scale(rubber, speed=scale.speed / CHANGE, **wave)
            cold, seconds, _ = _timed(rubber, wave, scale.speed, None)
            warm, warm_time, _ = _timed(rubber, wave, scale.speed, near)
            fine = gs.solve_scale(
                rubber,
                speed=scale.speed,
                **{key: value for key, value in wave.items() if key != "tolerance"},
                columns=256,
                rows=30,
            )
            cold_seconds.append(seconds)
            warm_seconds.append(warm_time)
            cold_counts.append(cold.newton_iterations)
            warm_counts.append(warm.newton_iterations)
            meshes.append(cold.details["columns"])
            errors.append(abs(cold.friction / fine.friction - 1.0))
            fractions.append(abs(cold.contact_fraction - fine.contact_fraction))
        rows.append(
            [
                title,
                f"{min(meshes)}-{max(meshes)}" if min(meshes) != max(meshes) else f"{meshes[0]}",
                *(f"{f(cold_seconds):.3f}" for f in (np.median, max)),
                f"{np.median(cold_counts):.0f}",
                *(f"{f(warm_seconds):.3f}" for f in (np.median, max)),
                f"{np.median(warm_counts):.0f}",
                f"{max(errors):.2%}",
                f"{max(fractions):.4f}",
            ]
        )
    show(
        console,
        "One wave of the shipped case, 0.3 m/s: cold, and warm from a speed 10 % lower",
        [
            *("", "columns", "cold median", "cold most", "Newton", "warm median", "warm most"),
            *("Newton", "mu worst", "area worst"),
        ],
        rows,
        f"CPU seconds, one thread, over the eight waves; aims at 1 %: {COLD_AIM} s cold, "
        f"{WARM_AIM} s warm. Errors: the cold solution against 256x30.",
    )


def _timed(
    rubber: gs.Rubber, wave: dict[str, Any], speed: float, start: gs.ScaleResult | None
) -> tuple[gs.ScaleResult, float, float]:
    """Solve a few times; return the result and the least CPU and wall seconds."""
    cpu, wall = [], []
    for _ in range(REPEATS):
        marks = time.process_time(), time.perf_counter()
        result = gs.solve_scale(rubber, speed=speed, **wave, start=start)
        cpu.append(time.process_time() - marks[0])
        wall.append(time.perf_counter() - marks[1])
        if not result.converged:
            raise RuntimeError(f"benchmark case did not converge: {result.status}; {result}")
    return result, min(cpu), min(wall)


def _chain_and_sweep(console: Console) -> None:
    rubber, sines, loads = _case()
    rows = []
    for title, options in (
        ("128x20", {}),
        (f"tolerance {TOLERANCE:g}", {"tolerance": TOLERANCE}),
    ):

        def chain(speed: float, options: dict[str, Any] = options) -> gs.ChainResult:
            return gs.solve_chain(rubber, sines, speed=speed, **loads, **options)

        for label, speeds, aim in (
            ("eight waves, 0.3 m/s", [0.3], CHAIN_AIM),
            ("20 speeds x 8 waves, two threads", SPEEDS, SWEEP_AIM),
        ):
            reset_peak()
            wall, cpu = time.perf_counter(), _cpu()
            with ThreadPoolExecutor(THREADS) as pool:
                found = list(pool.map(chain, speeds))
            wall, cpu = time.perf_counter() - wall, _cpu() - cpu
            scales = [scale for prediction in found for scale in prediction.scales]
            good = sum(scale.converged for scale in scales)
            rows.append(
                [
                    f"{label}, {title}",
                    f"{good}/{len(scales)}",
                    f"{wall:.1f}",
                    f"{cpu:.1f}",
                    f"{aim:.0f}",
                    f"{peak_since_reset():.0f}",
                    f"{max(s.friction_error / s.friction for s in scales):.2%}",
                    f"{max(s.contact_fraction_error for s in scales):.4f}",
                ]
            )
    show(
        console,
        "Chains of the shipped case",
        ["", "converged", "wall s", "CPU s", "aim, wall s", "process MB", "mu est.", "area est."],
        rows,
        f"Speeds from {SPEEDS[0]:g} to {SPEEDS[-1]:g} m/s, each chain cold. Memory: peak of the "
        f"whole Python process; aim {MEMORY_AIM:.0f} MB. Last columns: largest error estimates.",
    )


def _cpu() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime
