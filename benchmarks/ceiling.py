"""Rates of dense linear algebra in numpy: size, product, solution, per line; see `scaling`."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

SIZES = [128, 256, 512]
SHORTEST = 0.4


def main() -> None:
    """Print GFlop/s of the product and of LU with as many right-hand sides."""
    generator = np.random.default_rng(1)
    for size in SIZES:
        a, b = generator.random((2, size, size)) + size * np.eye(size)
        product = _rate(lambda a=a, b=b: a @ b, 2.0 * size**3)
        solution = _rate(lambda a=a, b=b: np.linalg.solve(a, b), 8.0 / 3.0 * size**3)
        print(size, f"{product:.1f}", f"{solution:.1f}")


def _rate(call: Callable[[], object], flops: float) -> float:
    call()
    count, start = 0, time.process_time()
    while time.process_time() - start < SHORTEST:
        call()
        count += 1
    return flops * count / (time.process_time() - start) / 1e9


if __name__ == "__main__":
    main()
