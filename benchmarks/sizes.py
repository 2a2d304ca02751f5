"""Large files: time and memory of `gripscale new` and `gripscale fit-rubber`.

A profile of five million points, a map of 4000 x 4000 heights as text and as an array, and moduli
of 1e5 and 1e6 rows. The files are made here.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from rich.console import Console

from benchmarks.case import LAUNCHER
from benchmarks.table import show
from tests.samples import write_maxwell

PROFILE_POINTS, MAP_POINTS = 5_000_000, 4000
ASKED = {"fit-rubber 1e5": 10, "fit-rubber 1e6": 10, "profile": 30, "map.txt": 20, "map.npy": 20}


def run(console: Console) -> None:
    """Print wall and processor time and memory of each command."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_maxwell(folder / "dma.txt")
        reading = ["--z-unit", "m", "--step", "5 um"]
        commands = {
            f"fit-rubber {rows:.0e}".replace("+0", ""): ["fit-rubber", _moduli(folder, rows)]
            for rows in (10**5, 10**6)
        }
        for file, options in (
            (_profile(folder), []),
            (_map(folder, ".txt"), []),
            (_map(folder, ".npy"), reading),
        ):
            new = ["new", file, "dma.txt", "-o", f"{Path(file).stem}{len(options)}.toml", *options]
            commands[Path(file).stem if file.endswith("csv") else file] = new
        rows = [[label, *_measured(words, folder)] for label, words in commands.items()]
    rows = [[*row, f"{ASKED[row[0]]} s"] for row in rows]
    headings = ["file", "wall s", "processor s", "peak MB", "asked"]
    show(console, "Large files", headings, rows, "The commands read, clean, fit and write a case.")


def _measured(words: list[str], folder: Path) -> list[str]:
    before = os.times()
    command = [sys.executable, "-c", LAUNCHER, *words]
    done = subprocess.run(command, check=True, capture_output=True, cwd=folder)
    after = os.times()
    spent = (after.children_user + after.children_system) - (
        before.children_user + before.children_system
    )
    megabytes = float(done.stdout.split()[-1]) / 1024.0
    return [f"{after.elapsed - before.elapsed:.1f}", f"{spent:.1f}", f"{megabytes:.0f}"]


def _moduli(folder: Path, rows: int) -> str:
    hertz = np.geomspace(1e-3, 1e7, rows)
    omega_tau = 2.0 * np.pi * np.outer(np.geomspace(1e-7, 1e2, 10), hertz)
    sizes = np.geomspace(100.0, 1.0, 10)[:, None] / (1.0 + omega_tau**2)
    moduli = 5.0 + (sizes * omega_tau**2).sum(axis=0), (sizes * omega_tau).sum(axis=0)
    noise = 1.0 + 0.01 * np.random.default_rng(1).standard_normal((2, rows))
    path = folder / f"moduli_{rows}.csv"
    table = np.column_stack([hertz, *(np.array(moduli) * noise)])
    header = "f [Hz],E' [MPa],E'' [MPa]"
    np.savetxt(path, table, fmt="%.6g", delimiter=",", header=header, comments="")
    return path.name


def _profile(folder: Path) -> str:
    q = np.fft.rfftfreq(PROFILE_POINTS, 1e-3)  # in 1/mm
    phase = np.exp(2j * np.pi * np.random.default_rng(2).random(q.size))
    z = np.fft.irfft(phase * np.maximum(q, 0.05) ** -1.3, PROFILE_POINTS)
    table = np.column_stack([1e-3 * np.arange(PROFILE_POINTS), 0.4 * z / z.std()])
    path, header = folder / "profile.csv", "x [mm],z [mm]"
    np.savetxt(path, table, fmt=("%.3f", "%.5f"), delimiter=",", header=header, comments="")
    return path.name


def _map(folder: Path, suffix: str) -> str:
    shape = (MAP_POINTS, MAP_POINTS)
    q = np.hypot(np.fft.fftfreq(MAP_POINTS)[:, None], np.fft.rfftfreq(MAP_POINTS))
    phase = np.exp(2j * np.pi * np.random.default_rng(3).random(q.shape))
    z = np.fft.irfft2(phase * np.maximum(q, 2e-3) ** -1.8, shape)
    z *= 20e-6 / z.std()
    path = folder / f"map{suffix}"
    if suffix == ".npy":
        np.save(path, z)
    else:
        header = "Spacing: 5 um\nHeight unit: um"
        np.savetxt(path, 1e6 * z, fmt="%.3f", delimiter="\t", header=header)
    return path.name
