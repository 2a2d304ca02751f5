"""A small case that runs in seconds: a made-up road, a made-up rubber, the half-plane solver."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner, Result

from gripscale.cli import app
from tests.written import three_waves, write_maxwell, write_road

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
    write_road(folder / "road.txt", three_waves())
    write_maxwell(folder / "dma.txt")
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
