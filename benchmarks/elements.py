"""Which element: bilinear with one pressure (order 1) or biquadratic with three (order 2)."""

from __future__ import annotations

from functools import partial

import problems
from measure import Cost, Mesh, name, root_mean_square, solve_all, unknowns
from rich.console import Console
from table import show

from gripscale import ScaleResult

MESHES: list[Mesh] = [
    (32, 8, 1),
    (64, 12, 1),
    (96, 16, 1),
    (128, 20, 1),
    (192, 26, 1),
    (32, 6, 2),
    (48, 8, 2),
    (64, 10, 2),
    (96, 13, 2),
]
REFERENCE_MESHES: list[Mesh] = [(256, 32, 1), (128, 16, 2)]
EVERY = 6


def run(console: Console) -> None:
    """Print error and seconds of both orders on three kinds of wave."""
    fine, gap = _references()
    rows = [_row(mesh, fine) for mesh in MESHES]
    show(
        console,
        "Choice of element: rms error beside CPU seconds for one wave",
        [
            "mesh",
            "unknowns",
            *("elastic s", "area"),
            *("Zener s", "mu", "area"),
            *("large strain s", "mu", "area"),
        ],
        rows,
        "Elastic: finite strain, five loads. Zener: small slope, every sixth row with mu/(kA) > "
        "0.04. Large strain: tread rubber, A/lambda = 0.16, 2 to 9 MPa, against the mean of "
        f"{' and '.join(map(name, REFERENCE_MESHES))}, which are {gap[0]:.2%} apart in friction "
        f"and {gap[1]:.4f} in contact fraction. Friction errors are relative.",
    )


def _references() -> tuple[list[tuple[float, float]], tuple[float, float]]:
    """Return friction and contact fraction of the fine meshes' mean, and how far they part."""
    both = [_large(mesh)[0] for mesh in REFERENCE_MESHES]
    pairs = list(zip(*both, strict=True))
    mean = [
        ((a.friction + b.friction) / 2, (a.contact_fraction + b.contact_fraction) / 2)
        for a, b in pairs
    ]
    apart = (
        max(abs(a.friction / b.friction - 1.0) for a, b in pairs),
        max(abs(a.contact_fraction - b.contact_fraction) for a, b in pairs),
    )
    return mean, apart


def _large(mesh: Mesh) -> tuple[list[ScaleResult], Cost]:
    return solve_all(
        [partial(problems.large_strain, p, mesh) for p in problems.LARGE_STRAIN_PRESSURES]
    )


def _row(mesh: Mesh, fine: list[tuple[float, float]]) -> list[str]:
    elastic, elastic_cost = solve_all(
        [partial(problems.finite_strain, ratio, mesh) for ratio in problems.FINITE_STRAIN]
    )
    table = problems.zener_rows()[::EVERY]
    sliding, sliding_cost = solve_all([partial(problems.zener, row, mesh) for row in table])
    steep, steep_cost = _large(mesh)
    return [
        name(mesh),
        f"{unknowns(mesh)}",
        f"{elastic_cost.seconds:.3f}",
        f"{_area(elastic, list(problems.FINITE_STRAIN.values())):.4f}",
        f"{sliding_cost.seconds:.3f}",
        f"{_friction(sliding, [r['mu_over_kDelta_n1024'] for r in table], problems.ZENER_SLOPE)}",
        f"{_area(sliding, [r['contact_ratio_n1024'] for r in table]):.4f}",
        f"{steep_cost.seconds:.3f}",
        f"{_friction(steep, [mu for mu, _ in fine])}",
        f"{_area(steep, [fraction for _, fraction in fine]):.4f}",
    ]


def _area(results: list[ScaleResult], expected: list[float]) -> float:
    return root_mean_square(
        [r.contact_fraction - f for r, f in zip(results, expected, strict=True)]
    )


def _friction(results: list[ScaleResult], expected: list[float], scale: float = 1.0) -> str:
    errors = [r.friction / scale / mu - 1.0 for r, mu in zip(results, expected, strict=True)]
    return f"{root_mean_square(errors):.2%}"
