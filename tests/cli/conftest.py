"""A small case that runs in seconds: a made-up road, a made-up rubber, the half-plane solver."""

import pytest

from gripscale.charts.draw import FigureFolder
from tests.questions.conftest import _blank as _blank
from tests.samples import (
    HALF_PLANE,
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


@pytest.fixture(scope="session")
def inputs(tmp_path_factory):
    """A folder with a road of three waves, a Maxwell rubber and a case."""
    folder = tmp_path_factory.mktemp("inputs")
    write_road(folder / "road.txt", three_waves())
    write_maxwell(folder / "dma.txt")
    (folder / "case.toml").write_text(CASE)
    return folder


@pytest.fixture
def changed(inputs, tmp_path):
    """Write the case with `old` replaced by `new`, next to copies of its inputs."""

    def write(old="", new=""):
        assert old in CASE
        for name in ("road.txt", "dma.txt"):
            (tmp_path / name).write_bytes((inputs / name).read_bytes())
        path = tmp_path / "case.toml"
        path.write_text(CASE.replace(old, new) if old else CASE)
        return path

    return write


@pytest.fixture
def undrawn(monkeypatch):
    """Commands that write no pictures."""
    monkeypatch.setattr(FigureFolder, "save", lambda *_: None)
