"""Processor time and memory of one call, and what several solutions err together."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from gripscale import ScaleResult

Mesh = tuple[int, int, int]
"""Columns, rows, element order."""


@dataclass(frozen=True)
class Cost:
    """Median processor seconds and Newton iterations of one solution, memory above the start [MB].

    The kernel uses one thread: on an idle core wall time is the same.
    """

    seconds: float
    megabytes: float
    iterations: float

    def cells(self) -> list[str]:
        """Return the table cells of `HEADINGS`."""
        memory = "-" if np.isnan(self.megabytes) else f"{self.megabytes:.0f}"
        return [f"{self.seconds:.3f}", memory, f"{self.iterations:.0f}"]


HEADINGS = ["CPU s", "peak MB", "Newton"]


def solve_all(calls: Sequence[Callable[[], ScaleResult]]) -> tuple[list[ScaleResult], Cost]:
    """Run every call; all must converge."""
    results, seconds = [], []
    reset_peak()
    before = _status("VmRSS")
    for call in calls:
        start = time.process_time()
        result = call()
        seconds.append(time.process_time() - start)
        if not result.converged:
            raise RuntimeError(f"benchmark case did not converge: {result.status}; {result}")
        results.append(result)
    iterations = float(np.median([result.newton_iterations for result in results]))
    peak = peak_since_reset() - before / 1024.0
    return results, Cost(float(np.median(seconds)), peak, iterations)


def root_mean_square(errors: Sequence[float]) -> float:
    """Return the rms of `errors`."""
    return float(np.sqrt(np.mean(np.square(errors))))


def worst(errors: Sequence[float]) -> float:
    """Return the largest magnitude of `errors`."""
    return float(np.abs(errors).max())


def name(mesh: Mesh) -> str:
    """Return "columns x rows", with the order if it is not one."""
    columns, rows, order = mesh
    return f"{columns}x{rows}" + ("" if order == 1 else f" order {order}")


def unknowns(mesh: Mesh) -> int:
    """Return the number of displacement unknowns."""
    columns, rows, order = mesh
    return 2 * order * columns * order * rows


def rate(columns: Sequence[float], errors: Sequence[float]) -> float:
    """Return the order of convergence: error ~ columns^-rate, least squares in logarithms."""
    return float(-np.polyfit(np.log(columns), np.log(errors), 1)[0])


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
