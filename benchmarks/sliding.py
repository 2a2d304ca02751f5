"""Steady sliding of a Zener solid at small slope against the half-plane reference table."""

from __future__ import annotations

from functools import partial

import problems
from measure import HEADINGS, Mesh, name, root_mean_square, solve_all, worst
from rich.console import Console
from table import show

MESHES: list[Mesh] = [(64, 12, 1), (96, 16, 1), (128, 20, 1), (192, 26, 1)]
HEAVY_MESH_COLUMNS = 192
EVERY = 3


def run(console: Console) -> None:
    """Print the rows with noticeable friction per mesh, then those next to none."""
    rows = []
    for mesh in MESHES:
        table = problems.zener_rows()
        if mesh[0] >= HEAVY_MESH_COLUMNS:
            table = table[::EVERY]
        results, cost = solve_all([partial(problems.zener, row, mesh) for row in table])
        expected = [row["mu_over_kDelta_n1024"] for row in table]
        friction = [
            r.friction / problems.ZENER_SLOPE / mu - 1.0
            for r, mu in zip(results, expected, strict=True)
        ]
        dissipated = [
            r.friction_from_dissipation / problems.ZENER_SLOPE / mu - 1.0
            for r, mu in zip(results, expected, strict=True)
        ]
        fraction = [
            r.contact_fraction - row["contact_ratio_n1024"]
            for r, row in zip(results, table, strict=True)
        ]
        rows.append(
            [
                name(mesh),
                f"{len(table)}",
                *cost.cells(),
                f"{worst(friction):.2%}",
                f"{root_mean_square(friction):.2%}",
                f"{worst(dissipated):.2%}",
                f"{root_mean_square(dissipated):.2%}",
                f"{worst(fraction):.4f}",
                f"{root_mean_square(fraction):.4f}",
                f"{max(r.friction_mismatch for r in results):.2%}",
            ]
        )
    show(
        console,
        "Zener solid sliding over a wave of small slope, rows with mu/(kA) > 0.04",
        [
            "mesh",
            "rows",
            *HEADINGS,
            *("mu worst", "mu rms", "diss. worst", "diss. rms"),
            *("area worst", "area rms", "mismatch"),
        ],
        rows,
        "Friction from traction (mu) and from dissipation (diss.): relative error, asked at most "
        "2 %. Area: error of the contact fraction, asked "
        "at most 0.01; the table itself is good to 0.001. Mismatch: largest relative difference "
        "of friction from traction and from dissipation.",
    )
    _small_friction(console)


def _small_friction(console: Console) -> None:
    """Print what happens where friction nearly vanishes: nodes pin the contact."""
    limits = [(0.02, 0.04), (0.01, 0.02), (0.003, 0.01), (0.0, 0.003)]
    rows = []
    for low, high in limits:
        table = [r for r in problems.zener_table() if low < r["mu_over_kDelta_n1024"] <= high]
        results, _ = solve_all([partial(problems.zener, row, problems.DEFAULT) for row in table])
        expected = [row["mu_over_kDelta_n1024"] for row in table]
        scaled = [r.friction / problems.ZENER_SLOPE for r in results]
        dissipated = [r.friction_from_dissipation / problems.ZENER_SLOPE for r in results]
        rows.append(
            [
                f"{low:g} to {high:g}",
                f"{len(table)}",
                f"{worst([a - b for a, b in zip(scaled, expected, strict=True)]):.5f}",
                f"{worst([a / b - 1 for a, b in zip(scaled, expected, strict=True)]):.1%}",
                f"{worst([a - b for a, b in zip(dissipated, expected, strict=True)]):.5f}",
                f"{max(r.friction_mismatch for r in results):.1%}",
            ]
        )
    show(
        console,
        "The same where friction nearly vanishes, default mesh",
        ["mu/(kA)", "rows", "worst abs", "worst rel", "dissipation abs", "mismatch"],
        rows,
        "Errors of mu/(kA) from the contact traction (abs, rel) and from dissipation (abs). A "
        "nearly symmetric contact is held by its nodes; the two friction measures part and the "
        "reported mismatch shows it.",
    )
