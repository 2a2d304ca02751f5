"""Maps over sizes: time, memory and error, elastic and viscoelastic, beside an elastic code.

ASPHER (V. A. Yastrebov, BSD-3-Clause) solves the elastic contact of periodic maps by conjugate
gradients on nested grids. It is no dependency: it runs in a process of its own, by the Python that
ASPHER_PYTHON names or by this one. One thread each, and the same heights, pressure and modulus.
Processor seconds, and memory above what the heights take.

python -m benchmarks.large_maps [POINTS ...]
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.measure import peak_since_reset, reset_peak
from benchmarks.rough_contact import SPACING, isotropic_map, tread
from benchmarks.table import show
from gripscale.half_space.response import half_space

PRESSURE, SPEED = 3e5, 0.3  # [Pa], [m/s]
SIZES = (512, 1024, 2048)
PEER = """
import json, sys, time
import numpy as np
import aspher
heights, pressure, modulus, length, precision = json.loads(sys.argv[1])
gap = -np.load(heights).ravel()
points = round(len(gap) ** 0.5)
open("/proc/self/clear_refs", "w").write("5")
peak = lambda: int(open("/proc/self/status").read().split("VmHWM:")[1].split()[0])
before, start = peak(), time.process_time()
found = aspher.solve_nested(
    grid_size=points, gap=gap, p_nominal=pressure, domain_size=length, E_star=modulus,
    coarsest=32, backend="periodic", precision=precision, light_result=True,
    tol=1e-8 if precision == "double" else 1e-5, allow_tolerance_relaxation=True,
)
seconds = time.process_time() - start
memory = peak() - before
touching = float(np.mean(np.asarray(found.pressure) > 0.0)) if found.pressure is not None else None
print(json.dumps([seconds, memory / 1024, found.contact_area, touching, found.iterations]))
"""
ABSENT = (
    "ASPHER is not installed. `python3 -m venv FOLDER && FOLDER/bin/pip install aspher` (needs a "
    "C++ compiler and Eigen), then ASPHER_PYTHON=FOLDER/bin/python."
)


def run(console: Console, sizes: Sequence[int] = SIZES) -> None:
    """Print a row for each size and code."""
    rubber, python = tread(), os.environ.get("ASPHER_PYTHON", sys.executable)
    beside = subprocess.run([python, "-c", "import aspher"], capture_output=True).returncode == 0
    gs.solve_rough_contact(rubber, isotropic_map(64), pressure=PRESSURE, speed=SPEED)  # imports
    rows: list[list[str]] = []
    last: dict[str, tuple[int, float]] = {}
    for points in sizes:
        surface = isotropic_map(points)
        found = {
            "elastic": _ours(rubber, surface, 0.0),
            "viscoelastic": _ours(rubber, surface, SPEED),
        }
        for precision in ("double", "float") if beside else ():
            found[f"ASPHER, {precision}"] = _peer(python, rubber, surface, precision)
        for kind, (seconds, megabytes, *cells) in found.items():
            exponent = "-"
            if kind in last:
                before, earlier = last[kind]
                exponent = f"{math.log(seconds / earlier) / math.log((points / before) ** 2):.2f}"
            last[kind] = points, seconds
            each = [f"{1e6 * seconds / points**2:.2f}", f"{1e6 * megabytes / points**2:.0f}"]
            head = [f"{points} x {points}", kind, f"{seconds:.1f}", exponent, f"{megabytes:.0f}"]
            rows.append([*head, *each, *cells])
    show(
        console,
        "Maps over sizes, one thread",
        [
            *("grid", "code", "CPU s", "exponent", "MB", "us a point", "bytes a point"),
            *("products", "touching", "area", "+-", "friction", "+-", "status"),
        ],
        rows,
        "Gaussian heights, rms 0.3 mm, waves from 20 mm down to four points; 3 bar. `touching` is "
        f"the share of points. {'' if beside else ABSENT}",
    )


def _ours(rubber: gs.Rubber, surface: gs.HeightMap, speed: float) -> tuple[Any, ...]:
    reset_peak()
    before, start = peak_since_reset(), time.process_time()
    found = gs.solve_rough_contact(
        rubber, surface, pressure=PRESSURE, speed=speed, periodic=True, tolerance=None, workers=1
    )
    seconds, memory = time.process_time() - start, peak_since_reset() - before
    return (
        *(seconds, memory, f"{sum(grid.products for grid in found.grids)}"),
        f"{found.grids[-1].in_contact / surface.z.size:.5f}",
        *(f"{found.contact_fraction:.5f}", f"{found.contact_fraction_error:.5f}"),
        *(f"{found.friction:.5f}", f"{found.friction_error:.5f}", str(found.status)),
    )


def _peer(python: str, rubber: gs.Rubber, surface: gs.HeightMap, precision: str) -> tuple[Any, ...]:
    body = half_space(rubber, 0.0)
    grid = gs.solve_rough_contact(
        rubber, isotropic_map(64), pressure=PRESSURE, speed=0.0, periodic=True, tolerance=None
    ).grid
    modulus = float(body.modulus(grid).real.flat[1])
    with tempfile.TemporaryDirectory() as folder:
        heights = Path(folder) / "heights.npy"
        np.save(heights, surface.z)
        inputs = [str(heights), PRESSURE, modulus, SPACING * len(surface.x), precision]
        command = [python, "-c", PEER, json.dumps(inputs)]
        environment = os.environ | {"OMP_NUM_THREADS": "1"}
        output = subprocess.run(command, capture_output=True, check=True, env=environment)
    seconds, memory, area, touching, products = json.loads(output.stdout.splitlines()[-1])
    points = "-" if touching is None else f"{touching:.5f}"
    return seconds, memory, f"{products}", points, f"{area:.5f}", "-", "-", "-", "-"


if __name__ == "__main__":
    run(Console(width=170), [int(points) for points in sys.argv[1:]] or SIZES)
