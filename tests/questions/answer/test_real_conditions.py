"""Answers for real conditions: filled rubber, heat and a dry road, stated or left open."""

import math
from dataclasses import replace
from functools import partial

import pytest

import gripscale as gs
from gripscale.conditions import Conditions, ConstantStress, ThermalProperties
from gripscale.conditions.area_term import DRY_ASSUMPTIONS, DRY_TREAD, STRESS_SCATTER
from gripscale.conditions.flash_temperature import CONCRETE, STONE
from gripscale.half_space.sampling_error import condition_changes
from gripscale.questions.answer.page import HYSTERESIS_ALONE
from gripscale.rubber.softening import SOFTER_TREAD, TYPICAL_TREAD, softening_of_sweeps
from gripscale.surface import self_affine_profile
from studies.treads import SERIES_S, compound, sweeps

ROAD = self_affine_profile(0.8, 2e-3, 4e-4, length=0.2, step=1e-4, seed=3)
TREAD = compound("S100")
UNSHIFTED = replace(TREAD, shift=None)
PRESSURE, SPEED = 3e5, 0.3
LOAD = {"pressure": PRESSURE, "speed": SPEED, "smallest_wavelength": 1e-3}
COLD = Conditions(heat="none")
NUMBERS = ("friction", "contact_fraction")


def made(rubber=UNSHIFTED, **other):
    return gs.Case(ROAD, rubber, **LOAD | {"waves": 4} | other)


def interval(answer, name):
    return getattr(answer, f"{name}_interval")


def width(answer, name):
    """Return the logarithm of the ratio of the ends of an interval."""
    low, high = interval(answer, name)
    return math.log(high / low)


@pytest.fixture(scope="module")
def filled():
    return gs.answer(made(filled=True))


@pytest.fixture(scope="module")
def unfilled():
    return gs.answer(made(filled=False))


@pytest.fixture(scope="module")
def unstated():
    return gs.answer(made())


def test_an_answer_without_the_filler_has_both_numbers(filled, unfilled, unstated):
    assert filled.contact_fraction > 1.5 * unfilled.contact_fraction
    for name in NUMBERS:
        ends = [interval(answer, name) for answer in (filled, unfilled)]
        assert interval(unstated, name) == (min(e[0] for e in ends), max(e[1] for e in ends))
        for filler, answer in (("filled", filled), ("unfilled", unfilled)):
            number = float(unstated.data[f"{filler}_answer_{name}"])
            assert number == pytest.approx(getattr(answer, name), rel=1e-9)


def test_the_first_line_asks_whether_the_rubber_is_filled(filled, unfilled, unstated):
    assert not unstated.reliable
    first = unstated.lines[0]
    assert "one question decides, whether the rubber is filled" in first
    for answer in (filled, unfilled):
        assert answer.reliable
        assert f"{answer.friction:.3g}" in first
        assert "question" not in answer.lines[0]


def test_what_a_case_states_of_its_filler_decides_its_softening():
    for filler, law in ((True, TYPICAL_TREAD), (False, None), (None, None)):
        conditions = made(filled=filler).conditions or Conditions()
        assert conditions.softening == law
    asked = made(filled=True, conditions=Conditions(softening="none"))
    assert (asked.conditions or Conditions()).softening is None
    assert not asked.softening_doubts
    own = made(filled=True, conditions=Conditions(softening=SOFTER_TREAD))
    assert own.conditions.softening == SOFTER_TREAD
    with pytest.raises(gs.InputError, match="filled must be true with softening"):
        made(filled=False, conditions=Conditions(softening=TYPICAL_TREAD))


def test_the_typical_tread_holds_the_answers_of_measured_sweeps(filled):
    """Three compounds of which its mean is made: 0.9^3 of all three to lie inside, if they lie."""
    for name in SERIES_S:
        law = softening_of_sweeps(list(sweeps(name).values()), measured_at=1e-3)
        answer = gs.answer(made(filled=True, conditions=Conditions(softening=law)))
        for number in NUMBERS:
            low, high = interval(filled, number)
            assert low < getattr(answer, number) < high
        # nothing is left of the scatter between treads
        assert width(answer, "contact_fraction") < width(filled, "contact_fraction")


def test_the_error_of_another_tread_is_that_of_its_whole_solution():
    """Strains that are kept change the answer in second order: a tenth of the change remains."""
    solve = partial(gs.solve_rough_contact, UNSHIFTED, ROAD, **LOAD)
    contact, softer = (
        solve(tolerance=1e-2, conditions=Conditions(softening=law))
        for law in (TYPICAL_TREAD, SOFTER_TREAD)
    )
    frozen = partial(solve, tolerance=None, start=contact)
    changes = condition_changes(contact, UNSHIFTED, lambda _, scale: frozen(by_scale=scale))
    error = dict(changes)["scatter between treads"]
    area = math.log(softer.contact_fraction / contact.contact_fraction)
    friction = math.log(softer.friction_from_dissipation / contact.friction_from_dissipation)
    assert (error.contact_fraction, error.friction) == pytest.approx((area, friction), abs=0.03)
    assert error.contact_fraction > 0.05


@pytest.fixture(scope="module")
def dry():
    return gs.answer(made(filled=True, interface="dry"))


def test_a_dry_road_adds_the_shear_of_the_real_area(dry, filled):
    assert dry.hysteresis_friction == filled.friction
    assert dry.contact_fraction == filled.contact_fraction
    shear = float(DRY_TREAD.stress(SPEED)) * dry.contact_fraction / PRESSURE
    assert dry.interface_friction == pytest.approx(shear, rel=0.02)
    assert dry.friction == pytest.approx(dry.hysteresis_friction + dry.interface_friction)
    words = (DRY_ASSUMPTIONS, HYSTERESIS_ALONE)
    assert [[word in each.basis for word in words] for each in (dry, filled)] == [
        [True, False],
        [False, True],
    ]


def test_a_stated_shear_stress_wins_over_the_dry_road(dry):
    """It has no scatter of its own: of the interval that of the dry road remains the wider."""
    law = ConstantStress(float(DRY_TREAD.stress(SPEED)))
    conditions = Conditions(shear_stress=law)
    stated = gs.answer(made(filled=True, interface="dry", conditions=conditions))
    assert stated.friction == pytest.approx(dry.friction)
    assert DRY_ASSUMPTIONS not in stated.basis
    share = dry.interface_friction / dry.friction
    wide, narrow = (width(answer, "friction") / 2.0 / 1.645 for answer in (dry, stated))
    added = math.sqrt(wide**2 - narrow**2)
    # Student's t in place of the normal makes the intervals wider by up to a sixth
    assert added == pytest.approx(STRESS_SCATTER * share, rel=0.25)


def test_heat_is_on_where_the_rubber_has_a_shift():
    for kind, counterface in (("surface", STONE), ("floor", CONCRETE)):
        conditions = made(TREAD, filled=False, kind=kind).conditions
        assert (conditions.heat, conditions.counterface) == (ThermalProperties(), counterface)
    assert (made(TREAD, filled=False, conditions=COLD).conditions or COLD).heat is None
    assert made(filled=False).conditions is None


def test_rubber_without_a_shift_is_told_what_heat_would_change():
    """The finding of rubber without its shift against the answer with it, which warms."""
    fast = {"speed": 10.0, "pressure": 3e6, "filled": False}
    cold, warm = gs.answer(made(**fast)), gs.answer(made(TREAD, **fast))
    (finding,) = (f for f in cold.findings if "temperature shift" in f.sentence)
    change = warm.friction / cold.friction - 1.0
    assert finding.key == "rubber.shift"
    assert change < -0.02
    # the finding takes a mean shift of treads, 0.1 decades a kelvin, not that of this one
    assert finding.friction == pytest.approx(change, rel=0.5)
    assert not any("temperature shift" in f.sentence for f in warm.findings)


def test_old_names_of_the_parts_warn(dry):
    for name, new in (
        ("adhesive_friction", "interface_friction"),
        ("total_friction", "friction"),
        ("total_friction_interval", "friction_interval"),
    ):
        with pytest.warns(DeprecationWarning, match=f"{name} is called {new} now"):
            assert getattr(dry, name) == getattr(dry, new)
    with pytest.raises(AttributeError, match="Answer has no attribute adhesion"):
        _ = dry.adhesion


def test_a_case_with_other_arguments():
    case = made(TREAD, filled=False, conditions=COLD)
    other = case.replace(pressure="1 bar", filled=True)
    assert other.load.pressure == 1e5
    assert other.load.speed == case.load.speed
    assert other.surface is case.surface
    assert other.stated_conditions == case.stated_conditions
    assert (other.conditions.softening, other.conditions.heat) == (TYPICAL_TREAD, None)
    assert case.filled is False
    coarse = case.replace(smallest_wavelength=2e-3)
    assert coarse.surface.cutoff_wavelength > 1.5 * case.surface.cutoff_wavelength
    assert case.replace().key == case.key
    with pytest.raises(gs.InputError, match="argument of a case"):
        case.replace(presure="1 bar")
