"""A case of three small waves by hand on a coarse mesh, which solves in a fraction of a second."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

from gripscale.cli import app

CASE = """\
[[surface.sines]]
wavelength = "10 mm"
amplitude = "0.8 mm"
[[surface.sines]]
wavelength = "3 mm"
amplitude = "0.25 mm"
[[surface.sines]]
wavelength = "1 mm"
amplitude = "0.08 mm"

[rubber]
name = "styrene_butadiene"

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
static = false

[solver]
columns = 32
rows = 8
"""


@pytest.fixture
def case(tmp_path: Path) -> Path:
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture
def shell() -> Callable[..., Result]:
    """Run the command line in this process, as if its output went to a file."""

    def run(*arguments: object) -> Result:
        environment = {"COLUMNS": "100", "NO_COLOR": "1", "TERM": "dumb"}
        return CliRunner().invoke(app, [str(a) for a in arguments], env=environment)

    return run


@pytest.fixture
def same_bytes() -> Callable[[xr.Dataset, xr.Dataset], None]:
    """Assert that two Datasets hold the same, to the last bit."""

    def compare(one: xr.Dataset, other: xr.Dataset) -> None:
        assert list(one.variables) == list(other.variables)
        assert one.attrs == other.attrs
        for name in one.variables:
            a, b = one[name], other[name]
            assert (a.dims, a.dtype, a.attrs) == (b.dims, b.dtype, b.attrs), name
            if a.dtype == object:
                assert a.values.tolist() == b.values.tolist(), name
            else:
                assert np.ascontiguousarray(a).tobytes() == np.ascontiguousarray(b).tobytes(), name

    return compare
