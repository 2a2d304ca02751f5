"""`gripscale compare` and what a run says of its chain: models side by side over one case."""

import json
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case, read_case_file
from gripscale.case_file.folder import CASE_NOTE
from gripscale.core.errors import FileError
from gripscale.io import netcdf
from gripscale.io.table import as_text
from gripscale.questions.answer.direct_contact import solve_direct_contact
from gripscale.questions.answer.samples import curve_at
from gripscale.questions.compare.charts import (
    comparison_axis_figure,
    comparison_figure,
    comparison_pictures,
    rows_of,
)
from gripscale.questions.compare.question import Comparison, comparison_table
from gripscale.questions.terminal import PROGRESS_LINES
from tests.samples import HALF_PLANE, TWO_WAVES, case_text

RUNGS = ["chain_half_plane", "chain_upper", "sines", "direct", "persson"]


LOAD = {"pressure": 3e5, "speed": 0.3}
OF_CHAIN = {"footprint": 0.1, "solver": "half_plane"}
MEASURED = "speed [mm/s],friction,spread\n100,0.31,0.02\n1000,0.42,0.02\n"


@pytest.fixture(scope="module")
def comparison(shell, inputs, tmp_path_factory):
    """What the command prints of five models with two samples each, and where it writes."""
    folder = tmp_path_factory.mktemp("comparison")
    (folder / "mu.csv").write_text(MEASURED)
    target = folder / "out"
    words = (
        "compare", inputs / "case.toml", "--seeds", 2, "--output", target,
        "--measured", folder / "mu.csv", "--models", "waves,measured,theory",
    )  # fmt: skip
    return shell(*words).stdout, target


def test_command_puts_the_models_side_by_side(comparison):
    printed, target = comparison
    figures = {f"{name}.png" for name in ("comparison", "by_wavelength", "at_measured")}
    files = {"comparison.nc", "at_measured.nc", "predictions", CASE_NOTE, "report.html"}
    assert {path.name for path in target.iterdir()} == files | figures
    beside = netcdf.load_dataset(target / "at_measured.nc")
    assert {*beside.model.values} == {*RUNGS, "answer"} - {"sines"}
    assert np.isfinite(beside.difference).all()
    data = netcdf.load_dataset(target / "comparison.nc")
    assert data.model.values.tolist() == RUNGS
    assert data.samples.values.tolist() == [1, 1, 2, 1, 1]
    assert (data.status == "converged").all()
    # A spread belongs to what was drawn more than once, and only to that.
    assert np.isfinite(data.friction_spread).values.tolist() == [False, False, True, False, False]
    assert data.measured_speed.values.tolist() == [0.1, 1.0]
    assert all(str(label) in printed for label in data.label.values)


@pytest.mark.parametrize("group", ["waves", "windows"])
def test_rungs_of_any_group_alone_are_drawn(comparison, group):
    data = netcdf.load_dataset(comparison[1] / "comparison.nc").isel(model=[3])
    data = data.assign_coords(group=("model", [group]))
    for octaves in (data, data.isel(wavelength=slice(0))):  # maps and blocks have no octaves
        assert next(comparison_pictures(octaves)).name == "comparison"
        labels = [row.label for row in rows_of(octaves, "friction")]
        assert labels[0].startswith(str(data.label.item(0)))
        assert Comparison(octaves).page_content().sections[0].figures


def test_factors_lead_from_the_chain_to_the_profile_as_measured(comparison):
    data = netcdf.load_dataset(comparison[1] / "comparison.nc")
    aside = (data.group == "theory") | (data.model == "chain_upper")
    path = data.isel(model=~aside.values)
    for name in ("contact_fraction", "friction"):
        ends = path[f"total_{name}"].values[[0, -1]]
        assert np.nanprod(path[f"{name}_factor"]) == pytest.approx(ends[1] / ends[0])
        # Down to the last wavelength everything is in: of the harmonics what the rubber loses,
        # of the waves of the chain what the traction takes.
        last = path[f"running_{name}"].isel(wavelength=-1).values
        totals = path[f"total_{name}"].values
        if name == "friction":
            totals = np.append(totals[:1], path.total_friction_from_dissipation.values[1:])
        assert last == pytest.approx(totals, rel=1e-9)


def test_rungs_are_the_models_themselves(inputs):
    results = read_case(inputs / "case.toml")
    asked = ["chain_half_plane", "direct"]
    made = gs.compare(results, seeds=1, tolerance=0.02, models=asked).ladder
    sines, measured = results.surface.sines, results.surface.measured
    alone = gs.solve_rough_contact(
        results.rubber,
        measured.profiles[0][1],
        smallest_wavelength=float(sines.wavelength[-1]),
        **LOAD,
    )
    direct = made.samples.sel(model="direct").isel(sample=0)
    for name in ("contact_fraction", "friction", "friction_from_dissipation", "friction_error"):
        assert direct[name] == getattr(alone, name), name
    octaves = alone.friction_by_wavelength
    curve = direct.curve_wavelength.values, direct.curve_friction.values
    friction = curve_at("friction", octaves.wavelength.values, *curve)
    assert friction == pytest.approx(octaves.running_friction.values)
    chain = gs.solve_chain(results.rubber, sines, **LOAD, **OF_CHAIN, points=128)
    assert made.data.total_friction.sel(model="chain_half_plane") == chain.friction


@pytest.mark.usefixtures("undrawn")
def test_chain_of_the_upper_half_is_left_out_where_the_case_is_one(changed):
    case = changed(
        "scales = 3\ns_wavelength = 3", 'scales = 4\ntop_height_fraction = 0.5\ncut_off = "4 mm"'
    )
    results = read_case(case)
    upper = gs.compare(results, models=["chain_upper"]).data.squeeze("model")
    own = LOAD | OF_CHAIN | {"points": 256, "pressure_classes": 8}
    chain = gs.solve_chain(results.rubber, results.surface.sines, **own)
    assert float(upper.total_friction) == pytest.approx(chain.friction, rel=1e-6)
    assert float(upper.total_contact_fraction) == pytest.approx(chain.contact_fraction, rel=1e-6)
    case.write_text(case.read_text() + "[chain]\npressure_classes = 4\n")
    models = gs.compare(read_case(case), models=["waves"]).data
    assert models.model.values.tolist() == ["chain_half_plane", "sines"]
    chain = gs.solve_chain(
        results.rubber, results.surface.sines, **own | {"points": 128, "pressure_classes": 4}
    )
    friction = float(models.total_friction.sel(model="chain_half_plane"))
    assert friction == pytest.approx(chain.friction, rel=1e-12)


def test_over_speed_is_each_speed_alone_and_is_not_solved_twice(
    shell, inputs, tmp_path, monkeypatch
):
    monkeypatch.setenv(PROGRESS_LINES, "1")
    (tmp_path / "mu.csv").write_text(MEASURED)
    command = [
        "compare", inputs / "case.toml", "--models", "chain_half_plane,direct,persson",
        "--vary", "speed=0.03,0.3", "--output", tmp_path / "out", "--measured", tmp_path / "mu.csv",
    ]  # fmt: skip
    shell(*command)
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {"over_speed.nc", "over_speed.png", "predictions", "report.html", CASE_NOTE}
    data = netcdf.load_dataset(tmp_path / "out" / "over_speed.nc")
    assert data.total_friction.dims == ("speed", "model")
    alone = gs.compare(read_case(inputs / "case.toml"), models=["direct"]).data.isel(model=0)
    assert data.total_friction.sel(speed=0.3, model="direct") == alone.total_friction
    friction = comparison_axis_figure(data).axes[1]
    lines = [line.get_ydata() for line in friction.lines if len(line.get_ydata()) == 2]
    for member in data.model.values:
        drawn = data.total_friction.sel(model=member).values
        assert any(np.array_equal(line, drawn) for line in lines), member
    assert any(np.array_equal(line, data.measured_friction) for line in lines)
    next((tmp_path / "out" / "predictions").iterdir()).unlink()
    again = shell(*command)
    assert again.stdout.count("already solved") == 5
    second = netcdf.load_dataset(tmp_path / "out" / "over_speed.nc")
    assert second.drop_vars("seconds").equals(data.drop_vars("seconds"))


def test_case_names_its_measurement_and_the_fits_of_a_theory(changed):
    case = changed(
        "[output]",
        '[measured]\nfriction = "mu.csv"\n'
        '[compare]\nlayer_ratio = 2.0\npenetration_depth = "0.5 mm"\n[output]',
    )
    case.write_text(case.read_text().replace("scales = 3", "scales = 6"))  # below the cut-off
    (case.parent / "mu.csv").write_text(MEASURED)
    made = gs.compare(read_case(case), models=["theory"]).ladder
    assert [member.name for member in made.models] == ["persson", "klueppel_heinrich"]
    theory = made.data.sel(model="klueppel_heinrich")
    results = read_case(case)
    alone = gs.theory.klueppel_heinrich(
        results.rubber,
        results.surface.measured.cleaned,
        pressure=3e5,
        speed=0.3,
        layer_ratio=2.0,
        penetration_depth=0.5e-3,
        smallest_wavelength=float(results.surface.sines.wavelength[-1]),
    )
    assert theory.total_friction == alone.friction
    assert np.isnan(theory.total_contact_fraction)


def test_waves_by_hand_have_no_profile_and_nothing_rubs_at_rest(tmp_path):
    case = tmp_path / "case.toml"
    case.write_text(case_text(TWO_WAVES, solver=HALF_PLANE).replace('"0.3 m/s"', "0.0"))
    assert solve_direct_contact(read_case(case)) is None
    data = gs.compare(read_case(case), seeds=2).to_dataset()
    assert data.model.values.tolist() == ["chain_half_plane", "sines"]
    assert data.attrs["display_units"] == json.dumps(read_case_file(case).units)
    assert (data.total_friction == 0.0).all()
    assert np.isnan(data.friction_uncertainty).all()
    assert (data.total_contact_fraction > 0.0).all()
    assert len(comparison_figure(data).axes) == 2


def test_what_was_measured_is_refused_before_anything_is_solved(changed):
    case = changed("[output]", '[measured]\nfriction = "mu.csv"\n[output]')
    case.with_name("mu.csv").write_text("speed [m/s],friction\n0.1,none\n")
    with pytest.raises(FileError, match=r"mu\.csv"):
        gs.compare(read_case(case), models=["chain_half_plane"], on_task=pytest.fail)


def test_model_that_failed_is_open_and_says_why(inputs):
    made = gs.compare(
        read_case(inputs / "case.toml"), seeds=1, models=["chain_half_plane", "direct"]
    ).ladder
    direct = made.models[1]
    second = made.samples.isel(sample=[0])
    second["prediction_status"] = second.prediction_status.where(False, "tolerance not met")
    samples = xr.concat([made.samples, second], "sample")
    samples["prediction_status"].values[0] = ["tolerance not met", ""]
    broken = replace(made, samples=samples)
    data = broken.data
    assert np.isnan(data.total_friction.values[0])
    assert data.total_friction[1] == made.data.total_friction[1]
    told = "1 of 2 samples failed: tolerance not met"
    assert data.status.values.tolist() == ["tolerance not met", told]
    assert any(direct.label in str(finding) for finding in Comparison(data).findings)
    assert "1/2" in as_text(comparison_table(data))
    area = comparison_figure(data).axes[0]
    faces = {line.get_marker(): line.get_markerfacecolor() for line in area.lines}
    assert faces["D"] == "white"
    assert "failed" in [text.get_text() for text in area.texts]


@pytest.mark.usefixtures("undrawn")
def test_measured_speeds_without_a_unit_are_the_first_doubt_of_each_command(shell, changed):
    case = changed("[output]", '[measured]\nfriction = "mu.csv"\n[output]')
    (case.parent / "mu.csv").write_text(MEASURED.replace("speed [mm/s]", "speed"))
    compare = ["compare", case, "--models", "chain_half_plane"]
    calibrate = ["calibrate", case, "--law", "constant"]
    for command in (["run", case], compare, calibrate):
        result = shell(*command)
        first = " ".join(result.stdout.split()).partition("Warnings, by what they change: ")[2]
        assert first.startswith("The unit of speed in mu.csv is not stated and m/s is assumed")
    for folder in ("", "comparison", "calibration"):
        page = (case.parent / "results" / folder / "report.html").read_text(encoding="utf-8")
        assert "The unit of speed in mu.csv is not stated" in page
