"""Tables hold every number of a result, with its unit and its place."""

import csv

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.core.errors import FileError, InputError
from gripscale.export import tables_of, write_tables
from gripscale.half_space import RoughContact
from gripscale.io import netcdf
from gripscale.surface import SineStack, self_affine_profile
from gripscale.wave.result import waves_to_dataset


@pytest.fixture(scope="module")
def prediction():
    """Two waves of the block on meshes of different size, so that something is padded."""
    rubber = gs.Rubber(6e6, [3e6, 5e6], [1e-2, 1e-4], name="=tread")
    waves = [
        gs.solve_scale(
            rubber,
            wavelength=1e-2,
            amplitude=1e-3,
            pressure=1e6,
            speed=0.3,
            columns=columns,
            rows=4,
        )
        for columns in (16, 32)
    ]
    return waves_to_dataset(waves).assign_attrs(title="=SUM(A1:A2)", numbers=np.array([1.0, 2.5]))


def read_csv(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.reader(file))


def numbers(rows, title):
    place = rows[0].index(title)
    cells = [row[place] for row in rows[1:]]
    return np.array([np.nan if cell in ("", None) else float(cell) for cell in cells])


def test_every_number_comes_back(prediction, tmp_path):
    write_tables(prediction, tmp_path)
    seen = set()
    for name, variable in prediction.data_vars.items():
        if variable.dtype.kind not in "fiu":
            continue
        unit = variable.attrs["units"].replace("1", "-")
        written = read_csv(tmp_path / f"{'_'.join(variable.dims)}.csv")
        found = numbers(written, f"{name} [{unit}]")
        values = variable.values.astype(float).ravel()
        kept = values if variable.ndim == 1 else values[np.isfinite(values)]
        np.testing.assert_allclose(found, kept, rtol=1e-15, atol=0.0)
        seen.add(variable.dims)
    assert seen == {("scale",), ("scale", "surface_node"), ("scale", "layer", "column")}


def test_a_row_stands_where_its_numbers_are(prediction, tmp_path):
    write_tables(prediction, tmp_path)
    rows = read_csv(tmp_path / "scale_layer_column.csv")
    assert rows[0] == ["scale [-]", "layer [-]", "column [-]", "mesh_x [m]", "mesh_z [m]"]
    assert len(rows) == 1 + 5 * (17 + 33)
    for scale, layer, column, x, z in rows[1::37]:
        place = {"scale": int(scale) - 1, "layer": int(layer), "column": int(column)}
        assert float(x) == float(prediction.mesh_x.isel(place))
        assert float(z) == float(prediction.mesh_z.isel(place))


def test_texts_and_attributes_come_back(prediction, tmp_path):
    write_tables(prediction, tmp_path)
    scales, attributes = (read_csv(tmp_path / f"{n}.csv") for n in ("scale", "attributes"))
    place = scales[0].index("rubber_parameters")
    assert [row[place] for row in scales[1:]] == prediction.rubber_parameters.values.tolist()
    found = {(of or "", name): value for of, name, value in attributes[1:]}
    assert found["", "title"] == "=SUM(A1:A2)"
    assert found["", "numbers"] == "[1.0, 2.5]"
    assert found["friction", "long_name"] == prediction.friction.attrs["long_name"]
    assert found["friction", "units"] == "1"
    count = len(prediction.attrs) + sum(len(v.attrs) for v in prediction.variables.values())
    assert len(attributes) == 1 + count


def test_other_results_become_tables(tmp_path):
    rubber = gs.Rubber(6e6, [3e6, 5e6], [1e-2, 1e-4])
    surface = SineStack([1e-2, 2e-3], [1e-3, 1e-4])
    chain = gs.solve_chain(
        rubber, surface, pressure=3e5, speed=0.3, footprint=0.1, solver="half_plane", points=64
    )
    profile = self_affine_profile(0.8, 3e-3, 8e-4, length=0.02, step=1e-4, seed=1)
    direct = gs.solve_rough_contact(rubber, profile, pressure=3e5, speed=0.3)
    assert isinstance(direct, RoughContact)
    study = xr.Dataset(
        {"total_friction": (("speed", "rubber"), [[0.1, np.nan], [0.3, 0.4]], {"units": "1"})},
        coords={"speed": ("speed", [0.1, 1.0], {"units": "m/s"}), "rubber": ["soft", "hard"]},
    )
    for result in (chain.to_dataset(), direct.to_dataset(), study):
        for made in tables_of(result).values():
            assert made.columns.is_unique
    made = tables_of(study)["speed_rubber"]
    assert list(made) == ["speed [m/s]", "rubber", "total_friction [-]"]
    assert made.values.tolist() == [[0.1, "soft", 0.1], [1.0, "soft", 0.3], [1.0, "hard", 0.4]]


def test_rows_with_something_in_them_are_kept_and_odd_numbers_are_words(tmp_path):
    values = {"a": [[1.0, np.nan], [np.nan, np.nan]], "b": [[np.nan, 2.0], [np.nan, -np.inf]]}
    data = xr.Dataset({name: (("i", "j"), value) for name, value in values.items()})
    write_tables(data.assign_coords(speed=("speed", [0.1], {"units": "m/s"})), tmp_path)
    rows = [["0", "0", "1.0", ""], ["0", "1", "", "2.0"], ["1", "1", "", "-inf"]]
    assert read_csv(tmp_path / "i_j.csv")[1:] == rows
    assert read_csv(tmp_path / "speed.csv") == [["speed [m/s]"], ["0.1"]]


def test_a_file_is_read_with_its_groups(prediction, tmp_path):
    inputs = xr.Dataset({"lag_count": ("lag", [3, 4], {"units": "1"})})
    netcdf.save(prediction, tmp_path / "a.nc", {"inputs": inputs})
    files = write_tables(tmp_path / "a.nc", tmp_path / "out")
    assert tmp_path / "out" / "inputs_lag.csv" in files
    assert read_csv(tmp_path / "out" / "inputs_lag.csv")[1:] == [["0", "3"], ["1", "4"]]
    assert sorted(files) == sorted((tmp_path / "out").iterdir())
    found = read_csv(tmp_path / "out" / "attributes.csv")
    assert ["inputs/lag_count", "units", "1"] in found


def test_what_cannot_be_written_is_refused(prediction, tmp_path):
    with pytest.raises(InputError, match="result must be a Dataset; got int"):
        tables_of(3)
    with pytest.raises(FileError, match="does not exist"):
        write_tables(tmp_path / "none.nc", tmp_path / "a")
    (tmp_path / "file").write_text("")
    with pytest.raises(FileError, match="cannot be written"):
        write_tables(prediction, tmp_path / "file")
