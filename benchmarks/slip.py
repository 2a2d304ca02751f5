"""Time of a slip curve: the friction it rests on, and a curve from the stored friction."""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

from rich.console import Console

import gripscale as gs
from benchmarks.table import show

CASE = Path(__file__).parents[1] / "examples" / "tyre" / "case.toml"
MOST_SECONDS, MOST_AGAIN = 60.0, 1.0


def run(console: Console) -> None:
    """Print how long the shipped case takes, first and again."""
    case = gs.read_case(CASE)
    with tempfile.TemporaryDirectory() as folder:
        seconds = []
        for _ in range(3):
            start = time.perf_counter()
            curve = gs.slip_curve(case, folder=folder)
            seconds.append(time.perf_counter() - start)
    rows = [
        ["friction table and curve", f"{seconds[0]:.1f} s", f"< {MOST_SECONDS:.0f} s"],
        ["curve from the stored table", f"{min(seconds[1:]):.2f} s", f"< {MOST_AGAIN:.0f} s"],
    ]
    note = f"{curve.data.table_friction[0, 1].size} contacts, {curve.data.slip.size} slips."
    show(console, "A slip curve of the shipped tread", ["", "measured", "asked"], rows, note)
