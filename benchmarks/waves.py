"""One wave on every mesh: time, memory and iterations beside its error, for four kinds of wave."""

from __future__ import annotations

from collections.abc import Callable

from rich.console import Console

from benchmarks.measure import HEADINGS, name, solve_all, unknowns
from benchmarks.table import show
from gripscale.wave import Mesh
from tests.verification.families import (
    Family,
    finite_strain,
    large_strain,
    root_mean_square,
    westergaard,
    worst,
    zener,
)

MESHES = [
    *(Mesh(columns, rows) for columns, rows in ((32, 8), (64, 12), (96, 16), (128, 20), (192, 26))),
    *(Mesh(columns, rows, element_order=2) for columns, rows in ((32, 6), (48, 8), (64, 10))),
    Mesh(96, 13, element_order=2),
]
FAMILIES: list[Callable[[], Family]] = [
    westergaard,
    finite_strain,
    zener,
    lambda: large_strain(Mesh(256, 32), Mesh(128, 16, element_order=2)),
]


def run(console: Console) -> None:
    """Print a table for each kind of wave."""
    for make in FAMILIES:
        _table(console, make())


def _table(console: Console, family: Family) -> None:
    rows = []
    for mesh in MESHES:
        results, cost = solve_all(family, mesh)
        errors = [family.area_errors(results)]
        cells = [name(mesh), f"{unknowns(mesh)}", *cost.cells()]
        cells += [f"{measure(errors[0]):.4f}" for measure in (worst, root_mean_square)]
        if family.friction is not None:
            for friction in ("friction", "friction_from_dissipation"):
                off = family.friction_errors(results, friction)
                cells += [f"{measure(off):.2%}" for measure in (worst, root_mean_square)]
            cells.append(f"{max(result.friction_mismatch for result in results):.2%}")
        rows.append(cells)
    headings = ["mesh", "unknowns", *HEADINGS, "area worst", "area rms"]
    if family.friction is not None:
        headings += ["mu worst", "mu rms", "diss. worst", "diss. rms", "mismatch"]
    show(
        console,
        f"{family.name}: {len(family.problems)} waves",
        headings,
        rows,
        "Errors of the contact fraction, relative errors of the friction coefficient from traction "
        "(mu) and from dissipation (diss.). Newton iterations: all meshes of the sequence "
        "together, cheap ones included.",
    )
