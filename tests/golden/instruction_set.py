"""Which vector instructions the machine has: sums run in another order where they differ."""

from __future__ import annotations

import platform
from pathlib import Path


def instruction_set() -> str:
    """Return the machine and the vector instructions the kernel may choose from."""
    try:
        flags = set(Path("/proc/cpuinfo").read_text().split())
    except OSError:
        return platform.machine()
    return " ".join([platform.machine(), *sorted({"avx2", "fma", "avx512f"} & flags)])
