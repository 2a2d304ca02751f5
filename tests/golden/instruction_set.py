"""Which vector instructions sums are made with: they run in another order where these differ."""

from __future__ import annotations

import os
import platform
from pathlib import Path


def instruction_set() -> str:
    """Return the machine, its vector instructions, and the BLAS kernel chosen for it, if any."""
    try:
        flags = set(Path("/proc/cpuinfo").read_text().split())
    except OSError:
        return platform.machine()
    kernel = os.environ.get("OPENBLAS_CORETYPE", "")
    return " ".join([platform.machine(), *sorted({"avx2", "fma", "avx512f"} & flags), kernel])
