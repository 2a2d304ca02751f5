"""Which vector instructions sums are made with, and what has moved beside what is kept.

Newton stops at a residual of 1e-8, and contacts with a tolerance with some points on the wrong
side, so where sums run in another order (other vector instructions, more threads of BLAS) results
may differ; on the instructions a file was written with, the same operations must give the same
numbers to round-off.
"""

from __future__ import annotations

import os
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

SAME, OTHER = 1e-12, 1e-3
"""Of the largest number of a variable: its small ones are known to the round-off of that."""
ZERO = 1e-9
"""Numbers below this are zero to the residual of the solvers, and stay so."""

Values = dict[str, NDArray[Any]]


def instruction_set() -> str:
    """Return the machine, its vector instructions, and kernel and threads chosen for BLAS."""
    try:
        flags = set(Path("/proc/cpuinfo").read_text().split())
    except OSError:
        return platform.machine()
    blas = (os.environ.get(f"OPENBLAS_{name}", "") for name in ("CORETYPE", "NUM_THREADS"))
    return " ".join([platform.machine(), *sorted({"avx2", "fma", "avx512f"} & flags), *blas])


def kept_values(path: Path) -> Values:
    """Return all values of a file."""
    with np.load(path) as file:
        return {name: file[name] for name in file.files}


def moved(kept: Mapping[str, Any], now: Mapping[str, Any], counted: tuple[str, ...]) -> str:
    """Return which values of a file are others now.

    `counted` are ends of names that belong to the way to a solution: others elsewhere.
    """
    same, changes = str(kept["instruction_set"]) == instruction_set(), []
    for name in sorted(kept.keys() & now.keys()):
        before, after = kept[name], now[name]
        if after.shape != before.shape:
            changes.append(f"{name}: shape {before.shape} became {after.shape}")
        elif before.dtype.kind == "U":
            if same and not np.array_equal(before, after):
                changes.append(f"{name}: {before.tolist()} became {after.tolist()}")
        elif same or not name.endswith(counted):
            scale = float(np.max(np.abs(before), initial=0.0, where=np.isfinite(before)))
            atol = ZERO if scale < ZERO else (SAME if same else OTHER) * scale
            if not np.isclose(after, before, rtol=0.0, atol=atol, equal_nan=True).all():
                change = np.nanmax(np.abs(after - before)) / (scale or 1.0)
                changes.append(f"{name}: {change:.1e}")
    return "\n".join(changes)
