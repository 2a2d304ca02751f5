"""Maps over sizes: time, memory and error, elastic and viscoelastic, beside an elastic code.

ASPHER (V. A. Yastrebov, BSD-3-Clause) solves the elastic contact of periodic maps by conjugate
gradients on nested grids. It is no dependency: it runs in a process of its own, by the Python that
ASPHER_PYTHON names or by this one. One thread each, and the same heights, pressure and modulus.
Processor seconds, and memory above what the heights take.

python -m benchmarks.large_maps [POINTS ...]

A size above 4096 is solved by gripscale alone, with a thread for each core.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.rough_contact import SPACING, isotropic_map, tread
from benchmarks.table import show
from gripscale.half_space.grid import Grid
from gripscale.half_space.response import half_space

PRESSURE, SPEED = 3e5, 0.3  # [Pa], [m/s]
SIZES = (512, 1024, 2048)
LARGEST_OF_BOTH = 4096
PEER = """
import json, sys, time
import numpy as np
import aspher

heights, pressure, modulus, length, precision = json.loads(sys.argv[1])
gap = -np.load(heights).ravel()
open("/proc/self/clear_refs", "w").write("5")
peak = lambda: int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
before, wall, processor = peak(), time.perf_counter(), time.process_time()
found = aspher.solve_nested(
    grid_size=round(len(gap) ** 0.5), gap=gap, p_nominal=pressure, domain_size=length,
    E_star=modulus, coarsest=32, backend="periodic", precision=precision, light_result=True,
    tol=1e-8 if precision == "double" else 1e-5, allow_tolerance_relaxation=True,
)
wall, processor = time.perf_counter() - wall, time.process_time() - processor
megabytes = 1024e-6 * (peak() - before)
print(json.dumps([wall, processor, megabytes, found.iterations, found.contact_area]))
"""
ABSENT = (
    "ASPHER is not installed. `python3 -m venv FOLDER && FOLDER/bin/pip install aspher` (needs a "
    "C++ compiler and Eigen), then ASPHER_PYTHON=FOLDER/bin/python."
)


@dataclass(frozen=True)
class Row:
    """What a code took for one map, and what it found."""

    code: str
    wall: float  # [s]
    processor: float  # [s]
    megabytes: float
    products: int
    touching: float  # share of the points
    more: tuple[str, ...] = ("-",) * 5  # area, friction and their errors, status


def run(console: Console, sizes: Sequence[int] = SIZES) -> None:
    """Print a row for each size and code."""
    rubber, python = tread(), os.environ.get("ASPHER_PYTHON", sys.executable)
    beside = subprocess.run([python, "-c", "import aspher"], capture_output=True).returncode == 0
    gs.solve_rough_contact(rubber, isotropic_map(64), pressure=PRESSURE, speed=SPEED)  # imports
    cells: list[list[str]] = []
    last: dict[str, tuple[int, float]] = {}
    for points in sizes:
        surface = isotropic_map(points)
        for row in _rows(python if beside else "", rubber, surface):
            exponent = "-"
            if row.code in last:
                before, earlier = last[row.code]
                exponent = f"{0.5 * math.log(row.processor / earlier, points / before):.2f}"
            last[row.code] = points, row.processor
            each = 1e6 / points**2
            numbers = f"{row.wall:.1f}", f"{row.processor:.1f}", exponent, f"{row.megabytes:.0f}"
            by_point = f"{each * row.processor:.2f}", f"{each * row.megabytes:.0f}"
            found = f"{row.products}", f"{row.touching:.5f}"
            cells.append([f"{points}", row.code, *numbers, *by_point, *found, *row.more])
    show(
        console,
        "Maps over sizes",
        [
            *("points a side", "code", "wall s", "CPU s", "exponent", "MB", "us a point"),
            *("bytes a point", "products", "touching", "area", "+-", "friction", "+-", "status"),
        ],
        cells,
        "Gaussian heights, rms 0.3 mm, waves from 20 mm down to four points; 3 bar, tread rubber. "
        f"One thread up to {LARGEST_OF_BOTH}, above one a core. {'' if beside else ABSENT}",
    )


def _rows(python: str, rubber: gs.Rubber, surface: gs.HeightMap) -> Iterator[Row]:
    """Yield the rows of a map; without a `python` of the peer those of gripscale."""
    if len(surface.x) > LARGEST_OF_BOTH:
        yield _ours("viscoelastic", rubber, surface, SPEED, None)
        return
    yield _ours("elastic", rubber, surface, 0.0, 1)
    yield _ours("viscoelastic", rubber, surface, SPEED, 1)
    both = ("double", "float") if len(surface.x) < LARGEST_OF_BOTH else ("float",)
    for precision in both if python else ():
        yield _peer(python, rubber, surface, precision)


def _ours(
    code: str, rubber: gs.Rubber, surface: gs.HeightMap, speed: float, workers: int | None
) -> Row:
    reset_peak()
    before, wall, processor = peak_since_reset(), time.perf_counter(), time.process_time()
    found = gs.solve_rough_contact(
        rubber, surface, pressure=PRESSURE, speed=speed, periodic=True, tolerance=None,
        workers=workers, most_points=2**30,
    )  # fmt: skip
    wall, processor = time.perf_counter() - wall, time.process_time() - processor
    megabytes = 1.048576 * (peak_since_reset() - before)
    more = (
        *(f"{found.contact_fraction:.5f}", f"{found.contact_fraction_error:.5f}"),
        *(f"{found.friction:.5f}", f"{found.friction_error:.5f}", str(found.status)),
    )
    products = sum(grid.products for grid in found.grids)
    touching = found.grids[-1].in_contact / surface.z.size
    return Row(code, wall, processor, megabytes, products, touching, more)


def _peer(python: str, rubber: gs.Rubber, surface: gs.HeightMap, precision: str) -> Row:
    line = Grid((64,), (1e-3,))
    modulus = float(half_space(rubber, 0.0).modulus(line).real[1])
    with tempfile.TemporaryDirectory() as folder:
        heights = Path(folder) / "heights.npy"
        np.save(heights, surface.z)
        inputs = [str(heights), PRESSURE, modulus, SPACING * len(surface.x), precision]
        command = [python, "-c", PEER, json.dumps(inputs)]
        environment = os.environ | {"OMP_NUM_THREADS": "1"}
        output = subprocess.run(command, capture_output=True, check=True, env=environment)
    return Row(f"ASPHER, {precision}", *json.loads(output.stdout.splitlines()[-1]))


if __name__ == "__main__":
    run(Console(width=170), [int(points) for points in sys.argv[1:]] or SIZES)
