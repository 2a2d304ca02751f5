"""A small case that runs in seconds: a made-up road, a made-up rubber, the half-plane solver."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from gripscale.cli import app
from gripscale.rubber import Rubber

CASE = """\
[surface]
files = ["road.txt"]
crop = ["10 mm", "390 mm"]
scales = 3
s_wavelength = 3

[rubber]
file = "dma.txt"
terms = 6

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
static = true

[solver]
model = "half_plane"
points = 128

[output]
folder = "results"
"""


@pytest.fixture(scope="session")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a road of three waves, a Maxwell rubber and a case."""
    folder = tmp_path_factory.mktemp("inputs")
    x = np.arange(4000) * 0.1
    z = 2.0 * np.cos(x / 3.0) + 0.7 * np.cos(x + 1.0) + 0.2 * np.cos(3.1 * x + 2.0)
    rows = [f"{a:.1f}\t{b:.4f}" for a, b in zip(x, z, strict=True)]
    (folder / "road.txt").write_text("\n".join(["x [mm]\tz [mm]", *rows]) + "\n")
    frequency = np.geomspace(1e-2, 1e6, 60)
    rubber = Rubber(6e6, [2e6, 3e6, 5e6], [1e-1, 1e-3, 1e-5])
    modulus = rubber.complex_modulus(2 * np.pi * frequency)
    lines = [
        f"{f:.5e} {e.real / 1e6:.6e} {e.imag / 1e6:.6e}"
        for f, e in zip(frequency, modulus, strict=True)
        if e.imag > 0.0
    ]
    header = "# Frequency (Hz) E' (MPa) E'' (MPa)"
    (folder / "dma.txt").write_text("\n".join([header, *lines]) + "\n")
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.fixture
def shell() -> Callable[..., Result]:
    """Run the command line in this process, as if its output went to a file."""

    def run(*arguments: Any, columns: int = 100) -> Result:
        environment = {"COLUMNS": str(columns), "NO_COLOR": "1", "TERM": "dumb"}
        return CliRunner().invoke(app, [str(a) for a in arguments], env=environment)

    return run


@pytest.fixture
def changed(inputs: Path, tmp_path: Path) -> Callable[..., Path]:
    """Write the case with `old` replaced by `new`, next to copies of its inputs."""

    def write(old: str = "", new: str = "") -> Path:
        assert old in CASE
        for name in ("road.txt", "dma.txt"):
            (tmp_path / name).write_bytes((inputs / name).read_bytes())
        path = tmp_path / "case.toml"
        path.write_text(CASE.replace(old, new) if old else CASE)
        return path

    return write
