"""The shipped case as a user runs it: time and memory of the command, accuracy of every wave."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path

from rich.console import Console

import gripscale as gs
from benchmarks.measure import name
from benchmarks.table import show
from gripscale.case_file import read_case
from gripscale.wave import FiniteStrainBlock, Mesh, Sine, WaveLoad, WaveProblem
from tests.samples import ROOT

CASE = ROOT / "examples" / "road_and_tread" / "case.toml"
FINE = Mesh(256, 30)
REPEATS = 3
MOST_SECONDS, AIM_SECONDS, MOST_MEGABYTES = 60.0, 10.0, 1000.0

LAUNCHER = """
import os, subprocess, sys
run = "from gripscale.cli import main; main()"
child = subprocess.Popen([sys.executable, "-c", run, *sys.argv[1:]], stdout=subprocess.DEVNULL)
_, status, usage = os.wait4(child.pid, 0)
print(usage.ru_maxrss)
sys.exit(os.waitstatus_to_exitcode(status))
"""
"""Runs the command from a small process: a child's peak counts that of the process it left."""


@dataclass(frozen=True)
class Chain:
    """One chain of the case and the same waves, with the same inputs, on the fine mesh."""

    name: str
    default: gs.ChainResult
    fine: list[gs.ScaleResult]
    seconds: list[float]


def run(console: Console) -> None:
    """Print what the command takes and how accurate it is."""
    _whole_command(console)
    for chain in _chains():
        _waves(console, chain)


def _whole_command(console: Console) -> None:
    """Run `gripscale run` in processes of its own."""
    seconds, megabytes = [], []
    for _ in range(REPEATS):
        with tempfile.TemporaryDirectory() as folder:
            command = ["run", str(CASE), "--output", str(Path(folder) / "results")]
            start = time.perf_counter()
            launched = subprocess.run(
                [sys.executable, "-c", LAUNCHER, *command], check=True, capture_output=True
            )
            seconds.append(time.perf_counter() - start)
        megabytes.append(float(launched.stdout.split()[-1]) / 1024.0)
    show(
        console,
        f"gripscale run {CASE.relative_to(ROOT)}: files in, tables and figures out",
        ["", "measured", "asked"],
        [
            ["time, median", f"{statistics.median(seconds):.1f} s", f"< {MOST_SECONDS:.0f} s"],
            ["time, all", " ".join(f"{s:.1f}" for s in seconds), f"aim {AIM_SECONDS:.0f} s"],
            ["peak memory", f"{max(megabytes):.0f} MB", f"< {MOST_MEGABYTES:.0f} MB"],
        ],
        "Direct contact of two profiles, chain of eight waves, eight figures.",
    )


def _chains() -> list[Chain]:
    case = read_case(CASE)
    chains = []
    for title, speed in {"dynamic": case.load.speed, "static": 0.0}.items():
        marks = [time.perf_counter()]
        default = gs.solve_chain(
            case.rubber,
            case.surface.sines,
            pressure=case.load.pressure,
            speed=speed,
            footprint=case.load.footprint,
            load_time=case.load.load_time,
            on_scale=partial(_mark, marks),
        )
        fine = [_again(scale) for scale in default.scales]
        seconds = [b - a for a, b in pairwise(marks)]
        chains.append(Chain(title, default, fine, seconds))
    return chains


def _mark(marks: list[float], _: gs.ChainResult) -> None:
    marks.append(time.perf_counter())


def _again(scale: gs.ScaleResult) -> gs.ScaleResult:
    """Solve the same wave under the same load on the fine mesh."""
    load = WaveLoad(scale.pressure_received, scale.speed, scale.load_time)
    assert scale.rubber is not None
    wave = Sine(scale.wavelength, scale.amplitude)
    return FiniteStrainBlock(FINE).solve(WaveProblem(scale.rubber, wave, load))


def _waves(console: Console, chain: Chain) -> None:
    moving = chain.default.load.speed > 0.0
    rows, products = [], [1.0, 1.0]
    for i, (scale, fine) in enumerate(zip(chain.default.scales, chain.fine, strict=True)):
        products = [products[0] * scale.contact_fraction, products[1] * fine.contact_fraction]
        row = [
            f"{i + 1}: {scale.wavelength * 1e3:.3g} mm",
            f"{scale.amplitude / scale.wavelength:.3f}",
            f"{scale.pressure_received / scale.modulus:.2f}",
            f"{chain.seconds[i]:.2f}",
            f"{scale.newton_iterations}",
            f"{scale.contact_fraction:.4f}",
            f"{scale.contact_fraction - fine.contact_fraction:+.4f}",
            f"{scale.contact_fraction_error:.4f}",
        ]
        if moving:
            row += [
                f"{scale.friction:.4f}",
                f"{scale.friction / fine.friction - 1.0:+.2%}",
                f"{scale.friction_error / scale.friction:.2%}",
                f"{scale.friction_mismatch:.2%}",
                f"{fine.friction_mismatch:.2%}",
            ]
        rows.append(row)
    headings = ["wave", "A/λ", "p/|E*|", "time s", "Newton", "area", "error", "estimate"]
    headings += ["mu", "error", "estimate", "mismatch", "fine mismatch"] if moving else []
    note = (
        f"Error: difference from {name(FINE)}, every wave under the load it has in the table; "
        "estimate: the solver's own, from its coarser meshes; "
        f"the product of the contact fractions differs by {products[0] / products[1] - 1.0:+.2%}"
    )
    if moving:
        total = sum(fine.friction for fine in chain.fine)
        note += f", the sum of the frictions by {chain.default.friction / total - 1.0:+.2%}"
        worst = max(scale.friction_mismatch for scale in chain.default.scales)
        note += f". Largest mismatch of the two friction measures {worst:.2%}; asked: below 2 %"
    show(console, f"The shipped case, {chain.name}, wave by wave", headings, rows, f"{note}.")
