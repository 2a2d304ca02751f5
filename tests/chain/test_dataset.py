"""A prediction as a Dataset, on disk and back."""

import math

import numpy as np
import pytest
import xarray as xr

from gripscale.chain import solve_chain
from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.rubber import Rubber, Yeoh
from gripscale.surface import SineStack
from gripscale.wave.result import waves_from_dataset
from tests.samples import THREE_SINES as THREE

from .stand_ins import Scripted, Spring


@pytest.fixture
def prediction():
    solver = Scripted([0.5, 0.25, 0.125])
    return solve_chain(Spring(), THREE, solver=solver, pressure=3e5, speed=0.25, footprint=0.1)


def test_values_are_those_of_the_prediction(prediction):
    data = prediction.to_dataset()
    assert data.sizes == {"scale": 3, "surface_node": 8, "wave": 3}
    assert data.wavelength.values.tolist() == THREE.wavelength.tolist()
    assert data.contact_fraction.values.tolist() == [0.5, 0.25, 0.125]
    np.testing.assert_array_equal(data.running_contact_fraction, [2.0**-1, 2.0**-3, 2.0**-6])
    np.testing.assert_array_equal(data.running_friction, [0.125, 0.375, 0.875])
    np.testing.assert_allclose(data.slope, 2 * np.pi * np.array([1 / 16, 1 / 8, 1 / 8]))
    np.testing.assert_allclose(data.friction_mismatch, 0.25)
    np.testing.assert_allclose(data.modulus, 5e6)
    np.testing.assert_allclose(data.loss_factor, 0.75)
    assert data.status.values.tolist() == ["converged"] * 3
    assert data.total_friction == 0.875
    assert data.total_contact_fraction == 2.0**-6
    assert data.prediction_status == "converged"


def test_shorter_waves_are_padded_not_invented(prediction):
    data = prediction.to_dataset()
    counts = data.surface_pressure.notnull().sum("surface_node").values.tolist()
    assert counts == [4, 6, 8]
    assert data.surface_x.notnull().sum().item() == 18


def test_every_variable_says_unit_name_and_source(prediction):
    data = prediction.to_dataset()
    for name, variable in data.variables.items():
        assert {"units", "long_name", "source"} <= set(variable.attrs), name


def test_netcdf_brings_everything_back(prediction, tmp_path):
    data = prediction.to_dataset().assign_attrs(case='[load]\npressure = "3 bar"\n')
    path = netcdf.save(data, tmp_path / "result.nc")
    again = netcdf.load_dataset(path)
    xr.testing.assert_identical(again, data)
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


def test_dataset_brings_the_waves_back(tmp_path):
    rubber = Rubber(5e6, [1e6, 3e6], [1e-3, 1e-5], name="r", strain_energy=Yeoh(-0.1, 0.02))
    sines = SineStack([10e-3, 3e-3], [0.8e-3, 0.2e-3])
    load = {"pressure": 3e5, "speed": 0.3, "footprint": 0.1, "load_time": math.inf}
    for solver in ("finite_strain", "half_plane"):
        made = solve_chain(rubber, sines, solver=solver, **load)
        path = netcdf.save(made.to_dataset(), tmp_path / "result.nc")
        for one, other in zip(
            waves_from_dataset(netcdf.load_dataset(path)), made.scales, strict=True
        ):
            assert one.friction == other.friction
            np.testing.assert_array_equal(one.pressure, other.pressure)
            assert (one.status, one.rubber, one.why) == (other.status, rubber, other.why)
            if other.deformed_mesh is not None and one.deformed_mesh is not None:
                np.testing.assert_array_equal(one.deformed_mesh, other.deformed_mesh)


def test_failed_write_leaves_the_old_file_and_no_rubbish(tmp_path):
    path = tmp_path / "result.nc"
    path.write_text("old")

    def interrupted(temporary):
        temporary.write_text("half")
        raise OSError(28, "No space left on device")

    with pytest.raises(FileError, match=r"result\.nc cannot be written: No space left"):
        netcdf.write_whole(path, interrupted)
    assert path.read_text() == "old"
    assert [p.name for p in tmp_path.iterdir()] == ["result.nc"]


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("nowhere/result.nc", r"nowhere/result\.nc cannot be written"),
        ("folder", r"cannot be written: it is a folder"),
    ],
)
def test_a_place_where_nothing_can_be_written_is_named(prediction, tmp_path, name, says):
    (tmp_path / "folder").mkdir()
    with pytest.raises(FileError, match=says):
        netcdf.save(prediction.to_dataset(), tmp_path / name)


def test_missing_result_is_named(tmp_path):
    with pytest.raises(FileError, match=r"result\.nc does not exist"):
        netcdf.load_dataset(tmp_path / "result.nc")


def test_a_whole_file_appears_at_once(tmp_path):
    path, seen = tmp_path / "result.txt", []

    def slowly(temporary):
        temporary.write_text("half")
        seen.append(path.exists())
        temporary.write_text("whole")
        seen.append(temporary.stat().st_ino)

    netcdf.write_whole(path, slowly)
    assert path.read_text() == "whole"
    assert seen == [False, path.stat().st_ino]  # renamed, not copied
