"""The cut-off of a case: rules as they are stated, found, told, kept and varied."""

import numpy as np
import pytest

import gripscale as gs
from gripscale import surface
from gripscale.case_file import read_case
from gripscale.core import InputError
from gripscale.io import netcdf
from gripscale.io.text_table import lines_by_size
from gripscale.questions import Study
from tests.run_case import chain_of
from tests.samples import HALF_PLANE, case_text, write_road

CASE = case_text('files = ["road.txt"]\nscales = 3\n{end}', solver=HALF_PLANE)
ROAD = surface.self_affine_profile(0.8, 3e-3, 6e-4, length=0.1, step=1e-4, seed=1)


@pytest.fixture
def case(tmp_path):
    write_road(tmp_path / "road.txt", ROAD)
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(end='cut_off = "instrument"'))
    return path


def stated(case, end):
    case.write_text(CASE.format(end=end))
    return read_case(case).surface


def test_every_model_ends_where_the_rule_says(case):
    prepared = stated(case, "cut_off = { rms_slope = 0.4 }")
    exact = surface.find_cut_off(prepared.measured.cleaned, surface.RmsSlope(0.4))
    assert prepared.sines.cutoff_wavelength == exact.wavelength
    assert prepared.cut_off == exact
    assert prepared.cut_off.surface_slope == pytest.approx(0.4, rel=1e-6)
    persson = gs.theory.Persson().predict(
        gs.rubber.styrene_butadiene(), prepared, gs.model.Load(3e5, 0.3, 0.1)
    )
    # the rule counts waves down to the cut-off in full, the theory half of the last one
    assert 0.35 < float(persson.rms_gradient) < 0.4


def test_instrument_and_lengths(case):
    assert stated(case, 'cut_off = "instrument"').sines.cutoff_wavelength == pytest.approx(4e-4)
    inside = stated(case, 'cut_off = "1 mm"')
    assert inside.cut_off.rule == "a stated length"
    assert not inside.cut_off.beyond_measurement
    last = stated(case, 'smallest_wavelength = "1 mm"')
    assert last.cut_off.rule == "the last wave"


def test_the_waves_of_a_file_are_replaced(case):
    given = read_case(case)
    shorter = given.replace(longest_wavelength="20 mm")
    (before,), (after,) = (c.surface.measured.cleaned for c in (given, shorter))
    expected = surface.clean(ROAD, longest_wavelength=0.02)[0]
    np.testing.assert_allclose(after.z, expected.z, atol=1e-9)  # the file has six digits
    assert np.std(after.z) < np.std(before.z)
    assert shorter.surface.sines.wavelength[0] < given.surface.sines.wavelength[0]
    assert shorter.surface.rule == given.surface.rule == "instrument"
    again = shorter.replace(longest_wavelength=None).surface
    np.testing.assert_array_equal(again.sines.wavelength, given.surface.sines.wavelength)
    assert len(given.replace(waves=5).surface.sines) == 5
    assert given.replace(smallest_wavelength="1 mm").surface.sines.wavelength[-1] == pytest.approx(
        1e-3
    )
    with pytest.raises(InputError, match="cleaning must be left out"):
        given.replace(cleaning={"detrend": "none"})


def test_too_many_lines_are_refused_before_they_are_read(case, monkeypatch):
    monkeypatch.setattr("gripscale.case_file.prepare.MOST_POINTS", 100)
    with pytest.raises(InputError, match=r"cut_off must be a length, at least 1\d times"):
        read_case(case)


def test_lines_are_counted_by_the_size_of_a_file(tmp_path):
    path = tmp_path / "road.csv"
    write_road(path, surface.self_affine_profile(0.8, 3e-3, 6e-4, length=2.0, step=1e-4, seed=1))
    lines = path.read_bytes().count(b"\n")
    assert path.stat().st_size > 4 * 2**16
    assert lines_by_size(path) == pytest.approx(lines, rel=0.01)
    path.write_bytes(b"\0\1" * 99)
    assert lines_by_size(path) == 0.0


def test_what_was_not_measured_is_refused_or_marked(case):
    with pytest.raises(gs.InputError, match=r"road\.txt: cut_off must be .*at most .* at 0.4 mm"):
        stated(case, "cut_off = { rms_slope = 3 }")
    found = stated(case, "cut_off = { rms_slope = 1.0, extrapolate = true }")
    assert found.cut_off.beyond_measurement
    assert any("beyond what the measurement carries, 0.4 mm" in str(f) for f in found.findings)


def test_a_run_keeps_and_tells_it(shell, case, tmp_path):
    outcome = shell("run", case, "--output", tmp_path / "again", "--verbose")
    inputs = netcdf.load_tree(tmp_path / "again" / "answer.nc")["inputs"]
    assert inputs.attrs["cut_off_m"] == pytest.approx(4e-4)
    assert "the measurement carries" in inputs.attrs["cut_off_rule"]
    slopes = inputs["rms_slope_of_surface"].values
    assert (np.diff(slopes) >= 0.0).all()
    assert slopes[-1] == pytest.approx(inputs.attrs["cut_off_surface_slope"])
    words = " ".join(outcome.output.split())
    assert "cut-off: 0.4 mm (the shortest wavelength that the measurement carries)" in words
    exponent = chain_of(case).cut_off_exponents.friction
    assert f"d ln μ / d ln λ_min = {exponent:.2f}" in words


def test_a_study_varies_lengths_and_rules_side_by_side(case, tmp_path):
    study = Study(read_case(case), vary={"cut_off": "1 mm,instrument,rms_slope 0.4"}, model="chain")
    found = study.run(tmp_path / "study", workers=1)
    names = ["0.001 m", "instrument", "rms slope 0.4 of the surface"]
    assert found.cut_off.values.tolist() == names
    alone = [
        chain_of(write(case, end)) for end in ('"1 mm"', '"instrument"', "{ rms_slope = 0.4 }")
    ]
    assert found.total_friction.values.tolist() == [one.friction for one in alone]
    exponents = [one.cut_off_exponents.friction for one in alone]
    assert found.total_friction_cut_off_exponent.values.tolist() == exponents


def write(case, end):
    case.write_text(CASE.format(end=f"cut_off = {end}"))
    return case


def test_numbers_are_still_an_axis_of_numbers(case):
    assert Study(read_case(case), vary={"cut_off": "0.5 mm:1 mm:log3"}).axes[0].numeric
    with pytest.raises(gs.InputError, match="varies cut_off by numbers; got instrument"):
        gs.compare(read_case(case), vary={"cut_off": "instrument,1 mm"})
    with pytest.raises(gs.InputError, match="cut_off = 'dust': expected a length"):
        Study(read_case(case), vary={"cut_off": "dust"})
