"""Options for what files of surfaces do not state, where messages ask for them."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from gripscale.cli import app


@pytest.fixture
def tracks(tmp_path: Path) -> Path:
    x = 0.1 * np.arange(2000)
    z = np.random.default_rng(1).standard_normal((2, 2000)).cumsum(axis=1) * 0.02
    path = tmp_path / "road.csv"
    np.savetxt(path, np.c_[x, *z], delimiter=",", header="x [furlong],left [mm],right [mm]")
    return path


def test_the_option_that_a_message_names_cures_it(tracks: Path, tmp_path: Path) -> None:
    call = CliRunner().invoke
    refused = call(app, ["fit-surface", str(tracks)])
    assert "give --channel, its title or number, such as --channel 2" in " ".join(
        refused.output.split()
    )
    refused = call(app, ["fit-surface", str(tracks), "--channel", "2"])
    assert "'furlong', which is no known unit of length" in " ".join(refused.output.split())
    done = call(
        app, ["fit-surface", str(tracks), "--channel", "right", "--x-unit", "mm", "--scales", "2"]
    )
    assert done.exit_code == 0, done.output
    options = ["--channel", "3", "--x-unit", "mm", "--crop", "10 mm", "150 mm"]
    curve = tmp_path / "dma.csv"
    rows = "\n".join(
        f"{f},{5 * f**0.1:.6g},{0.8 * f**0.12:.6g}" for f in np.geomspace(0.1, 1e6, 40)
    )
    curve.write_text("f (Hz),E' (MPa),E'' (MPa)\n" + rows)
    case = tmp_path / "case.toml"
    files = [str(tracks), str(curve), "--reference-temperature", "20 C", "--output", str(case)]
    done = call(app, ["new", *files, *options])
    assert done.exit_code == 0, done.output
    tables = tomllib.loads(case.read_text(encoding="utf-8"))
    stated = {"channel": 3, "x_unit": "mm", "crop": ["10 mm", "150 mm"]}
    assert {key: tables["surface"][key] for key in stated} == stated
    assert tables["rubber"]["reference_temperature"] == "20 C"
    assert "assumed" not in tables["surface"].keys() | tables["rubber"].keys()
