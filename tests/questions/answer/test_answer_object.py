"""A case made in Python and its answer: object, file, variables."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale.half_space import model
from gripscale.io import netcdf
from gripscale.questions.answer.answer import Answer
from gripscale.questions.answer.variables import believed, described
from gripscale.questions.page_of_folder import load

DATA = Path(__file__).parents[3] / "examples" / "data"
ROAD = DATA / "road" / "20211011_aylesbury_dec_station_0.dat"
DMA = DATA / "rubber" / "measured_dma.txt"
CROP = (0.3, 0.6)
LOAD = {"pressure": 3e5, "speed": 0.3, "footprint": 0.1}
UNFILLED = {**LOAD, "filled": False}
END, WAVES = 2e-3, 4

CASE = f"""\
[surface]
files = ["{ROAD}"]
crop = ["{CROP[0]} m", "{CROP[1]} m"]
scales = {WAVES}
smallest_wavelength = "2 mm"

[rubber]
filled = false
file = "{DMA}"
reference_temperature = "20 C"

[load]
pressure = "3 bar"
speed = "0.3 m/s"
footprint = "100 mm"
"""


def made(**other):
    """Return the case made in Python, with other arguments where they are given."""
    profile = gs.read_profile(ROAD)
    rubber = gs.read_master_curve(DMA, reference_temperature=293.15)
    arguments = {"smallest_wavelength": END, "waves": WAVES, **UNFILLED, **other}
    return gs.Case(profile, rubber, cleaning={"crop": CROP}, **arguments)


def numbers(answer):
    """Return friction and contact fraction with their intervals."""
    names = ("friction", "contact_fraction")
    return [getattr(answer, f"{name}{end}") for name in names for end in ("", "_interval")]


@pytest.fixture(scope="module")
def answer():
    return gs.answer(made())


def test_a_profile_may_be_cleaned_and_a_master_curve_fitted_before(answer):
    """A series that was fitted evenly gives another answer, whose interval knows."""
    assert answer.reliable
    profile, _ = gs.clean(gs.read_profile(ROAD), crop=CROP)
    master = gs.read_master_curve(DMA, reference_temperature=293.15)
    given = {"smallest_wavelength": END, "waves": WAVES, **UNFILLED}
    assert numbers(gs.answer(gs.Case([profile], master, **given))) == numbers(answer)
    even = gs.answer(gs.Case([profile], gs.fit_prony(master), **given))
    assert even.friction != answer.friction
    assert even.friction_interval[0] < answer.friction < even.friction_interval[1]


def test_texts_with_units_are_the_same_case(answer):
    texts = {"pressure": "300 kPa", "speed": "0.3 m/s", "footprint": "100 mm"}
    same = gs.answer(made(**texts, smallest_wavelength="2 mm"))
    assert numbers(same) == numbers(answer)
    assert "For 300 kPa and 0.3 m/s, roughness down to 2 mm." in str(same)
    assert "For 0.3 MPa and 0.3 m/s, roughness down to 2 mm." in str(answer)


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"pressure": "3 bananas"}, "pressure = '3 bananas': "),
        ({"speed": -0.3}, "speed must not be negative"),
        ({"conditions": gs.conditions.Conditions(temperature=313.15)}, "shift"),
    ],
)
def test_a_bad_input_is_refused_in_one_sentence(wrong, sentence):
    with pytest.raises(gs.InputError, match=sentence) as refused:
        made(**wrong)
    assert "\n" not in str(refused.value)


def tread_of(answer):
    return [finding for finding in answer.findings if finding.key == "rubber.thickness"]


def test_rubber_without_end_is_compared_with_a_tread(answer, tmp_path):
    """The effect is that of the case with 8 mm of rubber, within the 5 % of both grids."""
    (told,) = tread_of(answer)
    thin = gs.answer(made(thickness="8 mm"))
    assert tread_of(thin) == []
    changes = thin.contact_fraction / answer.contact_fraction, thin.friction / answer.friction
    assert (1.0 + told.area, 1.0 + told.friction) == pytest.approx(changes, abs=0.05)
    assert told.area < -0.05
    assert "With a tread of 8 mm on a rigid base" in told.sentence
    kept = gs.load(answer.save(tmp_path / "answer.nc"))
    assert tread_of(kept) == [told]
    assert str(kept) == str(answer)


def test_a_tread_within_the_sampling_error_is_no_finding(monkeypatch):
    """Of a tread of a metre nothing is said: the layer is a half-space."""
    monkeypatch.setattr(model, "TREAD", 1.0)
    monkeypatch.setattr(model, "FELT", 0.0)
    assert tread_of(gs.answer(made())) == []


def test_other_questions_do_not_pay_for_the_tread(monkeypatch):
    def refuse(*_):
        raise AssertionError("a tread was solved")

    monkeypatch.setattr(model, "log_change", refuse)
    gs.vary(made(), speed=[0.1, 0.3])
    gs.uncertainty(made(), samples=10)
    with pytest.raises(AssertionError, match="a tread was solved"):
        gs.answer(made())


def test_profiles_across_each_other_say_that_a_road_is_isotropic():
    """Both stations of the road, one of them taken to lie across: ridges are no finding then."""
    other = ROAD.with_name(ROAD.name.replace("station_0", "station_1"))
    lines = [gs.read_profile(ROAD), replace(gs.read_profile(other), lay="across")]
    rubber = gs.read_master_curve(DMA, reference_temperature=293.15)
    whole = {"cleaning": {"crop": (0.12, 1.78)}, "smallest_wavelength": END, "waves": WAVES}
    answer = gs.answer(gs.Case(lines, rubber, **UNFILLED, **whole))
    isotropic = "The surface is isotropic: the rms slope over 1 mm along sliding is"
    assert any(isotropic in line for line in answer.basis)
    assert not any("ridges" in finding.sentence for finding in answer.findings)
    alone = gs.answer(gs.Case(lines[:1], rubber, **UNFILLED, **whole))
    assert numbers(alone) == numbers(answer)
    assert any("Profiles in one direction do not show ridges" in f.sentence for f in alone.findings)


def with_interval(start, value):
    return {start: value, f"{start}_low": 0.9 * value, f"{start}_high": 1.1 * value}


def earlier():
    """Return an answer with an area term as version 0.1 named its numbers."""
    friction = with_interval("answer_friction", 0.2) | with_interval("answer_total_friction", 0.9)
    area = with_interval("answer_contact_fraction", 0.03)
    others = {"answer_adhesive_friction": 0.7, "total_friction": 0.21, "nominal_speed": 0.3}
    return xr.Dataset(friction | area | others)


def test_a_variable_names_its_role_and_its_interval_in_the_file(tmp_path):
    data = xr.Dataset(with_interval("answer_friction", 0.2) | {"total_friction": 0.21})
    netcdf.save(described(data), tmp_path / "answer.nc")
    read = netcdf.load_dataset(tmp_path / "answer.nc")
    assert read.answer_friction.attrs["role"] == "answer"
    low, high = read.answer_friction.attrs["interval"].split()
    assert float(read[low]) < float(read.answer_friction) < float(read[high])
    assert read.total_friction.attrs["role"] == "number"


def test_without_an_answer_the_total_is_to_be_believed():
    data = described(xr.Dataset({"total_friction": 0.21, "answer_friction": np.nan}))
    assert data.total_friction.attrs["role"] == "answer"
    assert believed(data, "friction") == "total_friction"


def test_a_file_of_an_earlier_version_has_the_names_of_today(tmp_path):
    netcdf.save(earlier().assign_attrs(kind="answer"), tmp_path / "answer.nc")
    answer = load(tmp_path / "answer.nc")
    assert isinstance(answer, Answer)
    assert answer.friction == pytest.approx(0.9)
    assert answer.friction_interval == pytest.approx((0.81, 0.99))
    assert answer.hysteresis_friction == pytest.approx(0.2)
    assert answer.interface_friction == pytest.approx(0.7)
    assert believed(answer.data, "friction") == "answer_friction"
