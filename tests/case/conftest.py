"""A case of two waves by hand on a coarse mesh, solved in a fraction of a second; one of files."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import inputs as inputs

CASE = """\
[[surface.sines]]
wavelength = "10 mm"
amplitude = "0.8 mm"
[[surface.sines]]
wavelength = "3 mm"
amplitude = "0.25 mm"

[rubber]
name = "styrene_butadiene"

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
static = true

[solver]
columns = 32
rows = 8
"""


@pytest.fixture
def case(tmp_path: Path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path
