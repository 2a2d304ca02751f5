"""A case made in Python and the case file with the same inputs have one answer."""

from dataclasses import replace
from pathlib import Path

import pytest

import gripscale as gs
from gripscale.half_space import model

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
