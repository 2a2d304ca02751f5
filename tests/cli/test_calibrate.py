"""`gripscale calibrate`: the area term of a case from its measured friction."""

import re
import shlex
import shutil

import pytest

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.questions.calibration.calibration_law import parse_fixed
from gripscale.questions.calibration.question import Calibration, fitted_figure
from gripscale.questions.vary.inputs import default_model
from tests.report.reading import Page
from tests.samples import EXAMPLES

pytestmark = pytest.mark.usefixtures("undrawn")
FOLDER = EXAMPLES / "measured_friction"


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """A copy of the shipped case with synthetic friction."""
    folder = tmp_path_factory.mktemp("case")
    for name in ("case.toml", "synthetic_friction.csv"):
        shutil.copy(FOLDER / name, folder)
    return folder / "case.toml"


@pytest.fixture(scope="module")
def calibrated(shell, case):
    """What the command says of it, and its folder."""
    result = shell("calibrate", case, "--model", "chain", "--hold-out", "temperature")
    return result.stdout, case.parent / "results" / "calibration"


def test_command_leaves_everything_behind(calibrated):
    said, target = calibrated
    files = {"shear_stress.toml", "calibration.nc", "predictions", "measured_and_fitted.png"}
    assert {path.name for path in target.iterdir()} == files | {".case", "report.html"}
    assert len(list((target / "predictions").iterdir())) == 24
    for word in ("stress_0", "left out", "90 % by profile likelihood"):
        assert word in said
    data = netcdf.load_dataset(target / "calibration.nc")
    answer, adds, misses = Calibration(data).lines
    low, high = (float(data.area_term.min()), float(data.area_term.max()))
    assert "shear stress τ_0 = 0.346 MPa (0.341 MPa to 0.350 MPa)" in answer
    assert adds.startswith(f"  It adds {low:.4f} to {high:.3f} to a hysteresis friction of ")
    assert " 0.015 (rms), without it by " in misses
    panels = fitted_figure(data).axes
    assert [axes.get_title() for axes in panels] == ["5 °C", "20 °C", "40 °C"]
    assert panels[1].collections[0].get_label() == "90 % interval of the fit"
    line = next(line for line in panels[1].lines if line.get_label() == "hysteresis alone")
    chosen = abs(data.measured_temperature - 293.15) < 0.5
    assert line.get_ydata() == pytest.approx(data.hysteresis.values[chosen.values])
    page = (target / "report.html").read_text()
    assert page.count("<img ") == 1
    for word in ("90 % by profile likelihood", "gripscale calibrate case.toml", "[rubber]"):
        assert word in page


def test_the_surface_decides_what_predicts(case, inputs):
    assert default_model(read_case(case)) == "chain"
    measured = inputs / "of_a_profile.toml"
    measured.write_text('[surface]\nfiles = ["road.txt"]\nscales = 3\n', encoding="utf-8")
    text = case.read_text(encoding="utf-8")
    rest = text[text.index("[rubber]") :].partition("[measured]")[0]
    measured.write_text(measured.read_text(encoding="utf-8") + rest, encoding="utf-8")
    read = read_case(measured)
    waves = read_case(case).surface
    assert default_model(read) == "direct"
    assert default_model(read, [read.surface, waves]) == "chain"


def test_the_page_names_the_command_that_makes_it_again(shell, calibrated, case, monkeypatch):
    """Word for word, options included: run again, it prints the same answer."""
    said, target = calibrated
    text = Page(target / "report.html").text
    command = re.search(r"Command Copy (gripscale .*?) Case file", text)[1]
    monkeypatch.chdir(case.parent)
    again = shell(*shlex.split(command)[1:]).stdout
    answers = {run.partition("Answer: ")[2].partition("\n\n")[0] for run in (said, again)}
    assert len(answers) == 1
    assert "τ_0" in answers.pop()


def test_what_needs_no_prediction_is_refused_before_any(case, tmp_path):
    few = tmp_path / "few.csv"
    few.write_text("speed [m/s],friction\n0.1,0.9\n1,0.9\n")
    short = case.with_name("short.toml")
    short.write_text(case.read_text().replace("synthetic_friction.csv", str(few)))
    for options, sentence in (
        ({}, "fitting stress_0, width, speed_0 needs more than 3 measured points; got 2"),
        ({"law": "constant", "hold_out": "temperature"}, "needs the temperature of every point"),
        ({"law": "constant", "model": "direct"}, "the direct contact needs a measured profile"),
    ):
        with pytest.raises(InputError, match=sentence):
            gs.calibrate(read_case(short), on_task=pytest.fail, **options)


def test_fixed_parameters_have_units():
    texts = ["stress_0=5 MPa", "speed_0 = 6 mm/s", "activation_energy=0.9 eV", "width=0.1",
             "reference_temperature=20 C"]  # fmt: skip
    assert parse_fixed(texts) == pytest.approx(
        {
            "stress_0": 5e6,
            "speed_0": 6e-3,
            "activation_energy": 0.9,
            "width": 0.1,
            "reference_temperature": 293.15,
        }
    )
    with pytest.raises(InputError, match="width twice"):
        parse_fixed(["width=1", "width=2"])
