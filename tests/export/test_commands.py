"""`gripscale export rubber`, `tables` and `mesh`."""

import csv
import json
import shutil

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.io import netcdf
from gripscale.rubber import WLF, Rubber, fit_prony, read_master_curve
from gripscale.surface import SineStack
from tests.export.readers import READERS, read_abaqus
from tests.samples import MAXWELL, case_text, write_maxwell


@pytest.fixture(scope="module")
def inputs(tmp_path_factory):
    """A folder with a measured rubber, a case of it, and the file of a rubber."""
    folder = tmp_path_factory.mktemp("inputs")
    write_maxwell(folder / "dma.txt")
    rubber = (
        'file = "dma.txt"\nterms = 6\nreference_temperature = "20 C"\n'
        'shift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }'
    )
    text = case_text('files = ["road.txt"]\nscales = 3', rubber)
    (folder / "case.toml").write_text(text)
    (folder / "rubber.json").write_text(json.dumps(MAXWELL.to_dict()))
    (folder / "bad.json").write_text("{")
    return folder


@pytest.mark.parametrize("program", READERS)
@pytest.mark.parametrize("source", ["case.toml", "dma.txt", "rubber.json"])
def test_a_rubber_of_any_file(shell, inputs, tmp_path, program, source):
    target = tmp_path / "rubber"
    done = shell("export", "rubber", inputs / source, "--to", program, "--output", target)
    assert "The material is" in done.stdout
    found = READERS[program](target.read_text())
    own = MAXWELL
    if source != "rubber.json":
        terms = 6 if source == "case.toml" else None
        own = fit_prony(read_master_curve(inputs / "dma.txt"), terms=terms)
    omega = np.geomspace(1e-1, 1e6, 20)
    np.testing.assert_allclose(found.complex_modulus(omega), own.complex_modulus(omega), rtol=1e-10)


def test_a_rubber_at_another_temperature_and_in_other_units(shell, inputs, tmp_path):
    names = ("cold.inp", "warm.inp")
    options = ["--to", "abaqus", "--modulus-unit", "MPa", "--temperature-unit", "C"]
    for name, more in zip(names, ([], ["--temperature", "60 C", "--name", "warm"]), strict=True):
        target = tmp_path / name
        shell("export", "rubber", inputs / "case.toml", *options, "--output", target, *more)
    cold, warm = (read_abaqus((tmp_path / name).read_text()) for name in names)
    law = WLF(8.0, 120.0, 293.15)
    np.testing.assert_allclose(warm.times / cold.times, law.a(333.15, 293.15), rtol=1e-12)
    assert (cold.wlf[0], warm.wlf[0]) == pytest.approx((20.0, 60.0))
    assert cold.bulk == pytest.approx(2000.0)
    assert "NAME=warm" in (tmp_path / "warm.inp").read_text()


@pytest.mark.parametrize(
    ("source", "options", "said"),
    [
        ("dma.txt", ["--to", "febio", "--temperature", "40 C"], "shift is missing"),
        ("dma.txt", ["--to", "abaqus", "--band", "1 Hz"], "band must be two frequencies such as"),
        ("case.toml", ["--to", "febio", "--temperature", "warm"], "expected a temperature such as"),
        ("none.json", ["--to", "ansys"], "none.json: cannot be read (no such file)"),
        ("bad.json", ["--to", "ansys"], "bad.json cannot be read as a rubber"),
        ("none.toml", ["--to", "ansys"], "does not exist"),
        ("none.txt", ["--to", "ansys"], "none.txt"),
    ],
)
def test_what_cannot_be_a_rubber_is_one_sentence(shell, inputs, tmp_path, source, options, said):
    done = shell("export", "rubber", inputs / source, *options, "--output", tmp_path / "a", code=2)
    assert said in " ".join(done.stderr.split())
    assert not list(tmp_path.iterdir())


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    """The file of a prediction of two waves by the block."""
    prediction = gs.solve_chain(
        Rubber(6e6, [3e6, 5e6], [1e-2, 1e-4]),
        SineStack([1e-2, 2e-3], [1e-3, 1e-4]),
        pressure=3e5,
        speed=0.3,
        footprint=0.1,
        columns=32,
        rows=6,
    )
    return netcdf.save(prediction.to_dataset(), tmp_path_factory.mktemp("run") / "dynamic.nc")


def test_tables_of_a_result(shell, result, tmp_path):
    done = shell("export", "tables", result, "--output", tmp_path / "out")
    assert "scale.csv" in done.stdout
    with (tmp_path / "out" / "scale.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    data = netcdf.load_dataset(result)
    assert [float(row["friction [-]"]) for row in rows] == data.friction.values.tolist()
    done = shell("export", "tables", tmp_path / "none.nc", "--output", tmp_path / "other", code=2)
    assert "does not exist" in done.stderr


def test_the_mesh_of_a_wave(shell, result, tmp_path):
    done = shell("export", "mesh", result, "--wave", 2, "--output", tmp_path / "wave2.vtu")
    assert "Wave 2, 0.002 m long, converged" in done.stdout
    assert (tmp_path / "wave2.vtu").read_text().startswith("<?xml")
    done = shell("export", "mesh", result, "--wave", 3, "--output", tmp_path / "wave3.vtu", code=2)
    assert "wave must be a whole number from 1 to 2; got 3" in done.stderr


def test_a_folder_or_a_result_without_meshes_names_the_file_that_serves(shell, result, tmp_path):
    direct = xr.Dataset({"total_friction": 0.3}).assign_attrs(model="direct")
    other = netcdf.save(direct, tmp_path / "direct.nc")
    shutil.copy(result, tmp_path)
    done = shell("export", "tables", tmp_path, "--output", tmp_path / "out", code=2)
    said = " ".join(done.stderr.split())
    assert "is a folder; expected one of its result files: direct.nc, dynamic.nc" in said
    done = shell("export", "mesh", other, "--wave", 1, "--output", tmp_path / "wave.vtu", code=2)
    assert "direct.nc has no meshes" in done.stderr
    assert "; dynamic.nc beside it has" in " ".join(done.stderr.split())
