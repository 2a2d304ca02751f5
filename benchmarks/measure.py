"""Processor time and memory of one solution."""

from __future__ import annotations

import ctypes
import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from gripscale.wave import FiniteStrainBlock, Mesh, ScaleResult
from tests.verification.families import Family


@dataclass(frozen=True)
class Cost:
    """Median processor seconds and Newton iterations of one solution, memory above the start [MB].

    By one thread: on an idle core wall time is the same.
    """

    seconds: float
    megabytes: float
    iterations: float

    def cells(self) -> list[str]:
        """Return the table cells of `HEADINGS`."""
        memory = "-" if np.isnan(self.megabytes) else f"{self.megabytes:.0f}"
        return [f"{self.seconds:.3f}", memory, f"{self.iterations:.0f}"]


HEADINGS = ["CPU s", "peak MB", "Newton"]


def solve_all(family: Family, mesh: Mesh) -> tuple[list[ScaleResult], Cost]:
    """Solve every wave of a family; all must converge."""
    results, seconds = [], []
    reset_peak()
    before = _status("VmRSS")
    block = FiniteStrainBlock(replace(mesh, depth=family.depth))
    for problem in family.problems:
        start = time.process_time()
        result = block.solve(problem, workers=1)
        seconds.append(time.process_time() - start)
        if not result.converged:
            raise RuntimeError(f"benchmark wave did not converge: {result.status}; {result}")
        results.append(result)
    iterations = float(np.median([result.newton_iterations for result in results]))
    peak = peak_since_reset() - before / 1024.0
    return results, Cost(float(np.median(seconds)), peak, iterations)


def name(mesh: Mesh) -> str:
    """Return "columns x rows", with the order if it is not one."""
    order = "" if mesh.element_order == 1 else f" order {mesh.element_order}"
    return f"{mesh.columns}x{mesh.rows}{order}"


def unknowns(mesh: Mesh) -> int:
    """Return the number of displacement unknowns."""
    return 2 * mesh.element_order**2 * mesh.columns * mesh.rows


def reset_peak() -> None:
    """Give freed memory back and let Linux forget the peak; do nothing elsewhere."""
    try:
        ctypes.CDLL(None).malloc_trim(0)  # glibc only
        Path("/proc/self/clear_refs").write_text("5")
    except (OSError, AttributeError, TypeError):
        return


def peak_since_reset() -> float:
    """Return the largest memory of this process since `reset_peak` [MB], NaN where unknown."""
    return _status("VmHWM") / 1024.0


def _status(key: str) -> float:
    """Return a line of /proc/self/status [kB], NaN where there is none."""
    try:
        text = Path("/proc/self/status").read_text()
    except OSError:
        return float("nan")
    return next(
        (float(line.split()[1]) for line in text.splitlines() if line.startswith(key)), float("nan")
    )
