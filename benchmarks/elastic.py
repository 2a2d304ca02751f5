"""Elastic static contact: Westergaard's closed form, and finite strain against other codes."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import problems
from measure import HEADINGS, Mesh, name, root_mean_square, solve_all, worst
from rich.console import Console
from table import show

from gripscale import ScaleResult, theory

MESHES: list[Mesh] = [(32, 8, 1), (64, 12, 1), (96, 16, 1), (128, 20, 1), (192, 26, 1)]


def run(console: Console) -> None:
    """Print both tables."""
    closed_form = {r: float(theory.contact_fraction(r)) for r in problems.WESTERGAARD_RATIOS}
    _table(
        console,
        "Elastic contact, small slope, p/p* = 0.1 ... 0.9, against Westergaard",
        problems.westergaard,
        closed_form,
        "Errors of the contact fraction; asked: at most 0.005 on the default mesh, 128x20.",
    )
    _table(
        console,
        "Elastic contact, finite strain, A/lambda = 0.1, p/(4 pi G A/lambda) = 0.1 ... 0.9",
        problems.finite_strain,
        problems.FINITE_STRAIN,
        "Errors of the contact fraction; asked: at most 0.004. The reference is good to 0.0002.",
    )


def _table(
    console: Console,
    title: str,
    problem: Callable[[float, Mesh], ScaleResult],
    reference: dict[float, float],
    note: str,
) -> None:
    rows = []
    for mesh in MESHES:
        results, cost = solve_all([partial(problem, ratio, mesh) for ratio in reference])
        errors = [r.contact_fraction - f for r, f in zip(results, reference.values(), strict=True)]
        each = [f"{error:+.4f}" for error in errors]
        rows.append(
            [
                name(mesh),
                *cost.cells(),
                f"{worst(errors):.4f}",
                f"{root_mean_square(errors):.4f}",
                *each,
            ]
        )
    show(console, title, ["mesh", *HEADINGS, "worst", "rms", *map(str, reference)], rows, note)
