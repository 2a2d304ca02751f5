"""Direct contact against a code that steps in time: Tamaas, on the same grids, in one run.

Tamaas (L. Frerot et al., J. Open Source Softw. 5 (2020) 2121, doi:10.21105/joss.02121; AGPL) is no
dependency: it runs in a process of its own, by the Python that TAMAAS_PYTHON names or by this one.
Steady sliding is one solve here and hundreds of steps there; backward Euler makes those first-order
in the spacing, so that their limit may be extrapolated.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from rich.console import Console

import gripscale as gs
from benchmarks.table import show
from gripscale.half_space.grid_sequence import LevelContact
from gripscale.surface import HeightMap, Profile
from tests.half_space.rough_cases import isotropic_map, on_grid

RELAXED, ELEMENT, TIME = 1e6, 9e6, 2e-3
"""Young's moduli [Pa] and relaxation time [s] of a Zener solid."""
RUBBER = gs.Rubber(RELAXED, [ELEMENT], [TIME], bulk_modulus=1e12)
ABSENT = (
    "rival: skipped, Tamaas is not installed. `python3 -m venv FOLDER && FOLDER/bin/pip install "
    "tamaas numpy scipy`, then `TAMAAS_PYTHON=FOLDER/bin/python make bench`."
)


@dataclass(frozen=True)
class Problem:
    """A surface of one period under a load, and the grids it is solved on."""

    name: str
    surface: Profile | HeightMap
    pressure: float
    speed: float
    shortest: float
    """Wavelength [m]."""
    grids: tuple[int, ...]
    """Points along x."""
    marched: tuple[int, ...]
    """Those that are stepped through in time."""


def line() -> Problem:
    """Return a self-affine line: H = 0.8, 20 mm, waves down to 0.64 mm."""
    profile = gs.surface.self_affine_profile(0.8, 0.01, 1e-4, 0.02, 1e-5, seed=1)
    z = profile.z - np.linspace(profile.z[0], profile.z[-1], len(profile.z))
    grids = (128, 256, 512, 1024, 4096)
    return Problem("line", Profile(profile.x, z), 2e4, 0.1, 6.4e-4, grids, grids[:4])


def map_() -> Problem:
    """Return an isotropic map: 25.6 mm, waves down to 3.2 mm."""
    surface = isotropic_map(128, 0.0256, shortest=3.2e-3)
    return Problem("map", surface, 1e5, 0.3, 3.2e-3, (32, 64, 128, 512), (32, 64, 128))


def run(console: Console) -> None:
    """Print both codes on every grid, or one sentence where Tamaas is missing."""
    python = os.environ.get("TAMAAS_PYTHON", sys.executable)
    if subprocess.run([python, "-c", "import tamaas"], capture_output=True).returncode != 0:
        console.print(ABSENT + "\n")
        return
    for problem in (line(), map_()):
        _compare(console, python, problem)


def _compare(console: Console, python: str, problem: Problem) -> None:
    ours = {points: _solved(problem, points) for points in problem.grids}
    truth = ours[problem.grids[-1]][0].record.friction_from_dissipation
    marched = {points: _marched(python, problem, ours[points][0]) for points in problem.marched}
    rows = []
    for points, (found, seconds) in ours.items():
        cells = [str(points), f"{seconds:.3f}", *_friction(found.record.friction, truth)]
        cells += [f"{found.contact.active.mean():.4f}"]
        if points in marched:
            march = marched[points]
            cells += [f"{march['seconds']:.2f}", f"{march['steps']:.0f}"]
            cells += [*_friction(march["friction"], truth), f"{march['touching']:.4f}"]
        rows.append(cells)
    last, finest = (marched[points] for points in problem.marched[-2:])
    limit = 2.0 * finest["friction"] - last["friction"]
    error = abs(finest["friction"] / truth - 1.0)
    equal = next(s for found, s in ours.values() if _error(found, truth) <= error)
    show(
        console,
        f"Direct contact against stepping in time, {problem.name}, one Maxwell element",
        [
            *("points", "CPU s", "friction", "error", "touching"),
            *("Tamaas: CPU s", "steps", "friction", "error", "touching"),
        ],
        rows,
        f"Tamaas extrapolated to no spacing: {limit:.5f}, {limit / truth - 1.0:+.2%} from the "
        f"finest grid here. At the {error:.1%} of its finest grid the direct contact takes "
        f"{equal:.3f} s, {finest['seconds'] / equal:.0f} times less. One thread each.",
    )


def _error(found: LevelContact, truth: float) -> float:
    return abs(found.record.friction / truth - 1.0)


def _friction(value: float, truth: float) -> list[str]:
    return [f"{value:.5f}", f"{value / truth - 1.0:+.2%}"]


def _solved(problem: Problem, points: int) -> tuple[LevelContact, float]:
    """Return the contact with `points` along x, from nothing, and processor seconds."""
    directions = 1 if isinstance(problem.surface, Profile) else 2
    start = time.process_time()
    found = on_grid(
        RUBBER,
        problem.surface,
        pressure=problem.pressure,
        speed=problem.speed,
        shape=(points,) * directions,
        shortest=problem.shortest,
    )
    return found, time.process_time() - start


def _marched(python: str, problem: Problem, found: LevelContact) -> dict[str, float]:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "problem.npz"
        nu, grid = float(RUBBER.poisson_ratio(0.0)), found.level.grid
        to_shear = 0.5 / (1.0 + nu)
        np.savez(
            path,
            height=found.height,
            slope=grid.slope(found.height),
            lengths=grid.lengths,
            pressure=problem.pressure,
            speed=problem.speed,
            relaxed=to_shear * RELAXED,
            moduli=[to_shear * ELEMENT],
            times=[TIME],
            poisson_ratio=nu,
        )
        march = Path(__file__).with_name("tamaas_march.py")
        done = subprocess.run([python, march, path], capture_output=True, text=True, check=True)
    return dict(json.loads(done.stdout))
