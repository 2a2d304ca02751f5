"""What temperature, softening and heat cost, beside how near they come to where they settle."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

from rich.console import Console

import gripscale as gs
from benchmarks.case import CASE
from benchmarks.rough_contact import road
from benchmarks.table import show
from gripscale.case_file import read_case
from gripscale.conditions import Conditions, GaussianStress, ThermalProperties, fixed_point
from gripscale.rubber import WLF
from gripscale.rubber.softening import Kraus

POINTS = 16384
"""Of the road in the direct contact."""
SHIFT = WLF(c1=8.86, c2=101.6)
SOFTENING = Kraus(0.3, 0.15, 0.02, 1e-3, "shear")
HEAT = ThermalProperties(conductivity=0.25, density=1150.0, specific_heat=1500.0)
EFFECTS = {
    "none": None,
    "temperature": Conditions(temperature=313.15),
    "softening": Conditions(softening=SOFTENING),
    "heat": Conditions(heat=HEAT),
    "everything": Conditions(
        temperature=313.15,
        softening=SOFTENING,
        heat=HEAT,
        shear_stress=GaussianStress(6e6, 0.1, 6e-3, 0.97, 293.15),
    ),
}
"""Shift, softening and area term are made up: no data of this tread are known."""
BOUNDS = ("RESULT_TOLERANCE", "STATE_TOLERANCE", "COARSE_TOLERANCE")
REPEATS = 3
TIGHT = 1e-6
"""Bounds of the passes that stand for the fixed point itself."""

Solve = Callable[[Conditions | None], Any]


def run(console: Console) -> None:
    """Print a table for the chain and one for the direct contact."""
    case = read_case(CASE)
    rubber = replace(case.rubber, shift=SHIFT)
    load: dict[str, Any] = {"pressure": 3e5, "speed": 0.3, "footprint": 0.1}
    line = road(POINTS)

    def chain(conditions: Conditions | None) -> gs.ChainResult:
        return gs.solve_chain(rubber, case.surface.sines, conditions=conditions, **load)

    def direct(conditions: Conditions | None) -> Any:
        return gs.solve_rough_contact(rubber, line, conditions=conditions, **load)

    for title, solve in (
        ("the chain, eight waves", chain),
        (f"the direct contact, {POINTS} points", direct),
    ):
        show(
            console,
            f"Rubber in its conditions: {title}, 3 bar, 0.3 m/s",
            ["effect", "CPU s", "ratio", "passes", "coarse", "A_r/A_0", "off", "mu", "off"],
            _rows(solve),
            f"CPU s: the least of {REPEATS}. Off: from where passes settle when held to {TIGHT:g}. "
            "Asked: everything in at most 4 times the time of none, 8 passes, and 0.1 % off.",
        )


def _rows(solve: Solve) -> Iterator[list[str]]:
    solve(None)  # imports
    plain = 0.0
    for name, conditions in EFFECTS.items():
        found, seconds = _timed(solve, conditions)
        plain = plain or seconds
        settled = _settled(solve, conditions)
        fine, coarse = _passes(found)
        yield [
            name,
            f"{seconds:.2f}",
            f"{seconds / plain:.2f}",
            f"{fine}",
            f"{coarse}",
            f"{found.contact_fraction:.5f}",
            f"{found.contact_fraction / settled.contact_fraction - 1.0:+.3%}",
            f"{found.friction:.5f}",
            f"{found.friction / settled.friction - 1.0:+.3%}",
        ]


def _timed(solve: Solve, conditions: Conditions | None) -> tuple[Any, float]:
    """Return the answer and the least processor seconds of some solutions."""
    seconds = []
    for _ in range(REPEATS):
        start = time.process_time()
        found = solve(conditions)
        seconds.append(time.process_time() - start)
    return found, min(seconds)


def _passes(found: Any) -> tuple[int, int]:
    """Return the passes on the mesh or grid asked for, and on the coarse one."""
    if isinstance(found, gs.ChainResult):
        details = found.scales[0].details
        return details.get("passes", 1), details.get("coarse_passes", 0)
    return found.passes, found.coarse_passes


def _settled(solve: Solve, conditions: Conditions | None) -> Any:
    """Solve with the passes held to the tight bounds."""
    with _bounds(TIGHT):
        found = solve(conditions)
    if not found.converged:
        raise RuntimeError(f"the fixed point was not found: {found}")
    return found


@contextmanager
def _bounds(value: float) -> Iterator[None]:
    kept = {name: getattr(fixed_point, name) for name in (*BOUNDS, "MOST_PASSES")}
    for name in BOUNDS:
        setattr(fixed_point, name, value)
    fixed_point.MOST_PASSES = 40
    try:
        yield
    finally:
        for name, before in kept.items():
            setattr(fixed_point, name, before)
