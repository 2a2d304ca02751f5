"""A small case with its files, and the folder of a visit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gripscale import Rubber, surface
from tests.written import write_master_curve, write_road

pytest.importorskip("panel", reason="needs pip install 'gripscale[app]'")

CASE = """\
# a short road
[surface]
files = ["../elsewhere/road.txt"]  # dropped with the case
scales = 3
smallest_wavelength = "1 mm"

[rubber]
file = "dma.txt"
terms = 4

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"

[solver]
model = "half_plane"
points = 64
"""


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with case.toml, road.txt and dma.txt, side by side as they are dropped."""
    folder = tmp_path_factory.mktemp("small")
    road = surface.self_affine_profile(0.8, 3e-3, 8e-4, length=0.1, step=1e-4, seed=1)
    write_road(folder / "road.txt", road)
    frequency = np.geomspace(1e-1, 1e5, 30)
    modulus = Rubber(6e6, [3e6, 5e6], [1e-1, 1e-4]).complex_modulus(2 * np.pi * frequency)
    write_master_curve(folder / "dma.txt", frequency, modulus)
    (folder / "case.toml").write_text(CASE, encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def dropped(small: Path) -> dict[str, bytes]:
    """Return the same by name, as the page gets them."""
    return {path.name: path.read_bytes() for path in small.iterdir()}
