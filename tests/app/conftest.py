"""A small case with its files, and the folder of a visit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gripscale import Rubber, surface

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


def road_text() -> str:
    """Return a profile of 0.1 m with a step of 0.1 mm."""
    road = surface.self_affine_profile(0.8, 3e-3, 8e-4, length=0.1, step=1e-4, seed=1)
    rows = [f"{x * 1e3:.1f}\t{z * 1e3:.5f}" for x, z in zip(road.x, road.z, strict=True)]
    return "\n".join(["x [mm]\tz [mm]", *rows])


def dma_text() -> str:
    """Return a master curve of two relaxations."""
    frequency = np.geomspace(1e-1, 1e5, 30)
    modulus = Rubber(6e6, [3e6, 5e6], [1e-1, 1e-4]).complex_modulus(2 * np.pi * frequency)
    lines = [f"{f:.5e} {e.real:.6e} {e.imag:.6e}" for f, e in zip(frequency, modulus, strict=True)]
    return "\n".join(["# frequency (Hz) E' (Pa) E'' (Pa)", *lines])


@pytest.fixture(scope="session")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a folder with case.toml, road.txt and dma.txt, side by side as they are dropped."""
    folder = tmp_path_factory.mktemp("small")
    for name, text in (("case.toml", CASE), ("road.txt", road_text()), ("dma.txt", dma_text())):
        (folder / name).write_text(text, encoding="utf-8")
    return folder


@pytest.fixture(scope="session")
def dropped(small: Path) -> dict[str, bytes]:
    """Return the same by name, as the page gets them."""
    return {path.name: path.read_bytes() for path in small.iterdir()}
