"""Filler, dry road and effects that are switched off, as a case file states and keeps them."""

import pytest

import gripscale as gs
from gripscale.conditions import Conditions, ThermalProperties
from gripscale.conditions.area_term import DRY_TREAD
from gripscale.conditions.flash_temperature import STEEL, STONE
from gripscale.rubber.softening import TYPICAL_TREAD
from tests.case_file.cases import refusal, written
from tests.samples import SOFTENING, case_text, write_maxwell, write_short_road

ROAD = 'files = ["road.txt"]\nscales = 3\nsmallest_wavelength = "2 mm"'
RUBBER = (
    'file = "maxwell.txt"\nreference_temperature = "20 C"\n'
    'shift = { kind = "wlf", c1 = 8.0, c2 = "120 K" }\n'
)
CASE = case_text(ROAD, RUBBER).replace("filled = false\n", "")
"""Without a word about the filler."""


@pytest.fixture
def folder(tmp_path):
    write_short_road(tmp_path)
    write_maxwell(tmp_path / "maxwell.txt")
    return tmp_path


def read(folder, rubber="", conditions=""):
    text = CASE.replace(RUBBER, RUBBER + rubber)
    return gs.read_case(written(folder, text + (conditions and f"[conditions]\n{conditions}")))


def effects(case):
    return case.conditions or Conditions()


def test_effects_are_on_by_default_and_off_by_a_word(folder):
    case = read(folder, "filled = true")
    default = effects(case)
    assert (case.filled, default.softening) == (True, TYPICAL_TREAD)
    assert (default.heat, default.counterface) == (ThermalProperties(), STONE)
    unfilled = read(folder, "filled = false")
    assert (unfilled.filled, effects(unfilled).softening) == (False, None)
    assert read(folder).softening_doubts
    off = read(folder, "filled = true", 'softening = "none"\nheat = "none"\n')
    assert (effects(off).softening, effects(off).heat) == (None, None)
    assert set(effects(off).off) == {"softening", "heat"}
    assert not read(folder, "", 'softening = "none"\n').softening_doubts
    steel = "counterface = { conductivity = 60.5, density = 7850.0, specific_heat = 434.0 }\n"
    assert effects(read(folder, "", steel)).counterface == STEEL
    assert effects(read(folder, "", 'interface = "dry"\n')).shear_stress == DRY_TREAD


def test_a_rubber_known_by_name_is_unfilled(folder):
    case = gs.read_case(written(folder, case_text(ROAD)))
    assert case.filled is False
    assert not case.softening_doubts


WRONG = [
    (RUBBER, f'{RUBBER}filled = "yes"\n', "[rubber] filled = 'yes': expected true or false"),
    (SOFTENING, '[conditions]\nsoftening = "off"\n', "softening = 'off': "),
    (SOFTENING, '[conditions]\ninterface = "wet"\n', "interface = 'wet': "),
    (SOFTENING, '[conditions]\nstrain_norm = "slope"\n', "strain_norm belongs to softening"),
]


@pytest.mark.parametrize(("old", "new", "words"), WRONG)
def test_what_contradicts_is_refused(folder, old, new, words):
    assert words in refusal(gs.read_case, folder, CASE + SOFTENING, old, new)


@pytest.mark.parametrize(
    ("filled", "interface", "conditions"),
    [
        (True, "dry", None),
        (True, None, Conditions(softening="none", heat="none")),
        (False, None, Conditions(heat="none")),
        (None, None, Conditions(heat="none")),
    ],
    ids=["dry", "off", "unfilled", "unstated"],
)
def test_a_saved_case_has_the_same_conditions_and_answer(folder, filled, interface, conditions):
    case = read(folder)
    case = case.replace(filled=filled, interface=interface, conditions=conditions)
    again = gs.read_case(case.save(folder / "saved" / "case.toml"))
    assert (again.filled, again.interface) == (filled, interface)
    assert again.conditions == case.conditions
    assert bool(again.softening_doubts) == bool(case.softening_doubts)
    if interface:  # of the others heights, rubber and conditions are the same
        answers = [gs.answer(each) for each in (case, again)]
        assert answers[0].friction == pytest.approx(answers[1].friction, rel=1e-4)
        area = [answer.contact_fraction for answer in answers]
        assert area[0] == pytest.approx(area[1], rel=1e-4)
