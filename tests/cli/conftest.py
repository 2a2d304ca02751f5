"""A small case that runs in seconds: a made-up road, a made-up rubber, the half-plane solver."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from gripscale.charts.draw import FigureFolder
from tests.samples import (
    HALF_PLANE,
    blank_figures,
    case_text,
    three_waves,
    write_maxwell,
    write_road,
)

CASE = case_text(
    'files = ["road.txt"]\ncrop = ["10 mm", "390 mm"]\nscales = 3\ns_wavelength = 3',
    'file = "dma.txt"\nterms = 6',
    HALF_PLANE.replace("64", "128") + '\n\n[output]\nfolder = "results"',
)


@pytest.fixture(scope="module", autouse=True)
def _blank() -> Iterator[None]:
    with blank_figures():
        yield


@pytest.fixture(scope="session")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a road of three waves, a Maxwell rubber and a case."""
    folder = tmp_path_factory.mktemp("inputs")
    write_road(folder / "road.txt", three_waves())
    write_maxwell(folder / "dma.txt")
    (folder / "case.toml").write_text(CASE)
    return folder


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


@pytest.fixture
def undrawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands that write no pictures."""
    monkeypatch.setattr(FigureFolder, "save", lambda *_: None)
