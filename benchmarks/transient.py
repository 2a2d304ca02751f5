"""Sliding in time: speed of a step, and how far its limit is from the steady state."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from measure import worst
from rich.console import Console
from table import show

import gripscale as gs
from gripscale.figures.style import BLUE, GREEN, GREY, WIDE, save_figure, sheet, styled

WAVELENGTH = 1e-3
SPEED = 1.0
PASSAGE = WAVELENGTH / SPEED
RELAXED = 3e6
PASSAGES = 5
MESHES = [(32, 8), (64, 12), (96, 14), (128, 20)]
FIGURE_MESH = (96, 14)

CASES = [
    (0.01, 0.02, [2.0], [0.1]),
    (0.01, 0.01, [9.0], [0.05]),
    (0.05, 0.1, [1.0, 1.0], [0.03, 0.3]),
    (0.1, 0.1, [2.0], [0.1]),
    (0.1, 0.3, [4.0], [0.2]),
    (0.2, 0.1, [2.0, 1.0], [0.05, 0.2]),
    (0.2, 0.3, [2.0], [0.2]),
    (0.3, 0.2, [1.0], [0.1]),
]
"""A/lambda, p/|E*(w_1)|, moduli over E_inf, relaxation times over the passage time."""

Case = tuple[float, float, list[float], list[float]]


def run(console: Console, figure: Path) -> None:
    """Print speed and error per mesh, every case on the finest, and draw a start, stop, return."""
    rows = []
    for mesh in MESHES:
        finest = [_compare(case, mesh) for case in CASES]
        cpu = sum(entry[-2] for entry in finest)
        steps = sum(len(entry[1].time) - 1 for entry in finest)
        iterations = sum(entry[1].newton_iterations for entry in finest)
        rows.append(
            [
                f"{mesh[0]}x{mesh[1]}",
                f"{steps}",
                f"{steps / cpu:.0f}",
                f"{iterations / steps:.1f}",
                f"{cpu / len(CASES):.2f}",
                f"{np.mean([entry[-1] for entry in finest]):.3f}",
                f"{worst([_friction_error(*entry[:2]) for entry in finest]):.3%}",
                f"{worst([_area_error(*entry[:2]) for entry in finest]):.4f}",
            ]
        )
    show(
        console,
        f"Sliding in time, {PASSAGES} passages from rest, eight cases",
        ["mesh", "steps", "steps/s", "Newton/step", "CPU s", "steady CPU s", "mu worst", "area"],
        rows,
        "Last moment against the steady solution of the same mesh; asked: 0.5 % and 0.005. CPU s: "
        "of one run and of one steady solution, mean of the eight. CPU time, one thread.",
    )
    _each_case(console, finest)
    _long_memory(console)
    _draw_programme(console, figure)


def _rubber(moduli: list[float], passages: list[float]) -> gs.Rubber:
    return gs.Rubber(
        RELAXED,
        [ratio * RELAXED for ratio in moduli],
        [passage * PASSAGE for passage in passages],
        bulk_modulus=1e9,
    )


def _load(case: Case) -> tuple[gs.Rubber, dict[str, float], float]:
    slope, ratio, moduli, passages = case
    rubber = _rubber(moduli, passages)
    modulus = abs(complex(rubber.complex_modulus(2.0 * np.pi / PASSAGE)))
    return rubber, {"wavelength": WAVELENGTH, "amplitude": slope * WAVELENGTH}, ratio * modulus


def _compare(
    case: Case, mesh: tuple[int, int]
) -> tuple[gs.ScaleResult, gs.TransientResult, float, float]:
    """Return the steady state, the run in time, and CPU seconds of the run and the steady state."""
    rubber, wave, pressure = _load(case)
    grid = {"columns": mesh[0], "rows": mesh[1]}
    start = time.process_time()
    steady = gs.solve_scale(rubber, **wave, pressure=pressure, speed=SPEED, **grid)
    middle = time.process_time()
    stages = [gs.Stage(PASSAGES * PASSAGE, SPEED, pressure)]
    moving = gs.solve_transient(rubber, **wave, stages=stages, **grid)
    if not (steady.converged and moving.converged):
        raise RuntimeError(f"case {case} ended with {steady.status}, {moving.status}")
    return steady, moving, time.process_time() - middle, middle - start


def _friction_error(steady: gs.ScaleResult, moving: gs.TransientResult) -> float:
    return float(moving.friction[-1] / steady.friction - 1.0)


def _area_error(steady: gs.ScaleResult, moving: gs.TransientResult) -> float:
    return float(moving.contact_fraction[-1] - steady.contact_fraction)


def _each_case(
    console: Console, entries: list[tuple[gs.ScaleResult, gs.TransientResult, float, float]]
) -> None:
    rows = []
    for (slope, ratio, moduli, passages), (steady, moving, _, _) in zip(
        CASES, entries, strict=True
    ):
        rows.append(
            [
                f"{slope:g}",
                f"{ratio:g}",
                ", ".join(f"{value:g}" for value in moduli),
                ", ".join(f"{value:g}" for value in passages),
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
    """Relaxation time of 50 passages: compare with the steady state at the same load time."""
    rubber, wave, pressure = _load((0.1, 0.1, [2.0, 3.0], [0.1, 50.0]))
    grid = {"columns": FIGURE_MESH[0], "rows": FIGURE_MESH[1]}
    rows = []
    for passages in (2, 5, 10):
        duration = passages * PASSAGE
        steady = gs.solve_scale(
            rubber, **wave, pressure=pressure, speed=SPEED, load_time=duration, **grid
        )
        stages = [gs.Stage(duration, SPEED, pressure)]
        moving = gs.solve_transient(rubber, **wave, stages=stages, **grid)
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
        "A/lambda = 0.1, p/|E*| = 0.1, E_i/E_inf = 2, 3, tau v/lambda = 0.1, 50.",
    )


def _draw_programme(console: Console, figure: Path) -> None:
    rubber, wave, pressure = _load((0.1, 0.1, [2.0], [0.1]))
    grid = {"columns": FIGURE_MESH[0], "rows": FIGURE_MESH[1]}
    stages = [
        gs.Stage(1.5 * PASSAGE, SPEED, pressure),
        gs.Stage(0.3 * PASSAGE, 0.0, pressure),
        gs.Stage(1.0 * PASSAGE, SPEED, pressure),
        gs.Stage(1.5 * PASSAGE, -SPEED, pressure),
    ]
    moving = gs.solve_transient(rubber, **wave, stages=stages, **grid)
    steady = gs.solve_scale(rubber, **wave, pressure=pressure, speed=SPEED, **grid)
    figure.parent.mkdir(parents=True, exist_ok=True)
    for path in save_figure(_draw(moving, steady), figure.parent, figure.stem):
        if path.suffix == ".pdf":
            path.unlink()
    console.print(f"Figure: {figure}\n")


@styled
def _draw(moving: gs.TransientResult, steady: gs.ScaleResult) -> object:
    page, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    distance = moving.distance / moving.wavelength
    back = moving.speed < 0.0
    for panel, values, levels in (
        (axes[0][0], moving.friction, [steady.friction, -steady.friction]),
        (axes[0][1], moving.contact_fraction, [steady.contact_fraction]),
    ):
        for place, level in enumerate(levels):
            label = "steady state" if place == 0 else None
            panel.axhline(level, color=GREY, ls=":", lw=1.2, label=label)
        panel.plot(distance[~back], values[~back], color=BLUE, label="forth, with a stop at 1.5")
        turn = int(np.argmax(back)) - 1
        panel.plot(distance[turn:], values[turn:], color=GREEN, label="back")
        panel.set_xlabel("sliding distance over wavelength [-]")
    axes[0][0].set_ylabel("friction coefficient [-]")
    axes[0][1].set_ylabel("contact fraction [-]")
    axes[0][0].legend(loc=(0.02, 0.2))
    return page
