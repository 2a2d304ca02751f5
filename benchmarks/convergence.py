"""Convergence under uniform refinement (rows = columns / 8): rates, and the figure for the docs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
import problems
from measure import HEADINGS, Mesh, name, rate, root_mean_square, solve_all
from rich.console import Console
from table import show

from gripscale import ScaleResult, theory
from gripscale.figures.style import BLUE, GREEN, GREY, ORANGE, WIDE, save_figure, sheet, styled

COLUMNS = [32, 48, 64, 96, 128, 192]
FINEST = 320
HALF_PLANE_POINTS = 4096
ZENER_ROWS = [
    {"E_glassy_over_E_relaxed": 10.0, "pbar_over_pstar_relaxed": float(p), "k_v_tau": 0.1}
    for p in np.geomspace(0.1, 0.8, 16)
]


@dataclass(frozen=True)
class Study:
    """Errors of one kind of wave, rms over several loads, per number of columns."""

    title: str
    columns: list[int]
    area: list[float]
    friction: list[float] | None
    """Relative errors; None where there is no friction."""
    cells: list[list[str]]


def run(console: Console, figure: Path) -> None:
    """Print the errors and fitted rates, and draw them."""
    studies = [_westergaard(), _zener(), _large_strain()]
    rows = []
    for study in studies:
        for place, columns in enumerate(study.columns):
            friction = "-" if study.friction is None else f"{study.friction[place]:.3%}"
            mesh = name(_mesh(columns))
            area = f"{study.area[place]:.5f}"
            rows.append([f"{study.title} {mesh}", *study.cells[place], area, friction])
        friction_rate = (
            "-" if study.friction is None else f"{rate(study.columns, study.friction):.2f}"
        )
        area_rate = f"{rate(study.columns, study.area):.2f}"
        rows.append([f"{study.title}: rate", "", "", "", area_rate, friction_rate])
        rows.append([""] * 6)
    show(
        console,
        "Convergence under uniform refinement",
        ["wave and mesh", *HEADINGS, "area rms", "mu rms"],
        rows[:-1],
        "Rate: r in error ~ columns^-r. Westergaard: nine loads, closed form. Zener: E_0/E_inf = "
        f"10, k v tau = 0.1, sixteen loads, against the half-plane model with {HALF_PLANE_POINTS} "
        "points. Large strain: tread rubber, A/lambda = 0.16, five loads of 2 to 9 MPa, against "
        f"{name(_mesh(FINEST))}.",
    )
    folder, stem = figure.parent, figure.stem
    folder.mkdir(parents=True, exist_ok=True)
    for path in save_figure(_draw(studies), folder, stem):
        if path.suffix == ".pdf":
            path.unlink()
    console.print(f"Figure: {figure}\n")


def _mesh(columns: int) -> Mesh:
    return columns, columns // 8, 1


def _study(
    title: str,
    columns: Sequence[int],
    calls: Sequence[Callable[[Mesh], ScaleResult]],
    area: Sequence[float],
    friction: Sequence[float] | None,
) -> Study:
    area_errors, friction_errors, cells = [], [], []
    for number in columns:
        results, cost = solve_all([partial(call, _mesh(number)) for call in calls])
        cells.append(cost.cells())
        area_errors.append(
            root_mean_square([r.contact_fraction - a for r, a in zip(results, area, strict=True)])
        )
        if friction is not None:
            friction_errors.append(
                root_mean_square(
                    [r.friction / m - 1 for r, m in zip(results, friction, strict=True)]
                )
            )
    return Study(title, list(columns), area_errors, friction_errors or None, cells)


def _westergaard() -> Study:
    ratios = problems.WESTERGAARD_RATIOS
    calls = [partial(problems.westergaard, ratio) for ratio in ratios]
    fractions = [float(theory.contact_fraction(ratio)) for ratio in ratios]
    return _study("Westergaard", COLUMNS, calls, fractions, None)


def _zener() -> Study:
    half_plane = [
        theory.solve_half_plane(**problems.zener_load(row), points=HALF_PLANE_POINTS)
        for row in ZENER_ROWS
    ]
    return _study(
        "Zener",
        COLUMNS,
        [partial(problems.zener, row) for row in ZENER_ROWS],
        [result.contact_fraction for result in half_plane],
        [result.friction for result in half_plane],
    )


def _large_strain() -> Study:
    calls = [partial(problems.large_strain, p) for p in problems.LARGE_STRAIN_PRESSURES]
    finest, _ = solve_all([partial(call, _mesh(FINEST)) for call in calls])
    return _study(
        "large strain",
        COLUMNS[:-1],  # 192 columns are too close to the finest mesh to judge them by it
        calls,
        [result.contact_fraction for result in finest],
        [result.friction for result in finest],
    )


@styled
def _draw(studies: list[Study]) -> object:
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    labels = ["error of the contact fraction [-]", "relative error of friction [-]"]
    for study, colour in zip(studies, (BLUE, GREEN, ORANGE), strict=True):
        for panel, errors in zip(axes[0], (study.area, study.friction), strict=True):
            if errors is not None:
                text = f"{study.title}, rate {rate(study.columns, errors):.1f}"
                panel.plot(study.columns, errors, color=colour, marker="o", label=text)
    for panel, label in zip(axes[0], labels, strict=True):
        panel.set_xscale("log")
        panel.set_yscale("log")
        panel.set_xticks(COLUMNS, [str(number) for number in COLUMNS])
        panel.minorticks_off()
        low, high = panel.get_ylim()
        start = 0.55 * high
        slope = [start * (COLUMNS[0] / number) ** 2 for number in COLUMNS]
        panel.plot(COLUMNS, slope, color=GREY, ls=":", lw=1.0, label="slope 2")
        panel.set_ylim(min(low, slope[-1]), high)
        panel.set_xlabel("columns (rows = columns / 8)")
        panel.set_ylabel(label)
        panel.legend()
    return figure
