"""Sparse factors of the assembled tangent against the kernel's iteration: a bench of the kernel."""

from __future__ import annotations

import subprocess
from pathlib import Path

from rich.console import Console


def run(console: Console) -> None:
    """Build and run `benchmarks/sparse_kernel`, which prints its tables; needs cargo."""
    console.print("Sparse factors against iteration, by cargo bench")
    command = ["cargo", "bench", "--locked", "--features", "internals", "--bench", "sparse_factor"]
    subprocess.run(command, check=True, cwd=Path(__file__).parents[1])
