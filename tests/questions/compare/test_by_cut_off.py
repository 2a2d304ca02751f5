"""What every model says of its cut-off against really changing it."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain import Chain
from gripscale.experiment import Task
from gripscale.experiment.design import stack
from gripscale.half_space import BlockOnProfile
from gripscale.half_space.model import DirectContact
from gripscale.model import CUT_OFF_EXPONENTS, WHY_NO_EXPONENT, Load, cut_off_exponents_of
from gripscale.questions.answer.samples import cut_off_exponents, sample_numbers
from gripscale.rubber import styrene_butadiene
from gripscale.surface import (
    Measured,
    Profile,
    Surface,
    fit_sines,
    height_difference,
    self_affine_profile,
)
from gripscale.theory import HalfPlane, KlueppelHeinrich, Persson

RUBBER = styrene_butadiene()
LOAD = Load(3e5, 3.0, 0.1)
LINE = self_affine_profile(0.8, 10e-3, 1e-3, length=0.4, step=5e-5, seed=3)
LAST = 0.4e-3
CORRELATION = height_difference(LINE)
CHAIN = Chain(HalfPlane(points=256))


def surface(cut_off=LAST):
    fit = {"scales": 5, "cut_off": cut_off}
    sines = fit_sines(CORRELATION, scales=5, cut_off=cut_off)
    return Surface(sines, "", CORRELATION, fit, Measured.of([LINE]))


def told(model, load=LOAD):
    answer = model.predict(RUBBER, surface(), load)
    assert {*CUT_OFF_EXPONENTS, WHY_NO_EXPONENT} <= set(answer.data_vars)
    return cut_off_exponents_of(answer)


@pytest.mark.parametrize(
    ("model", "of_area", "of_friction"),
    [
        # grids of four points in the shortest wave, each some per cent off: 0.05/ln 2 at worst
        (DirectContact(tolerance=0.01), 0.07, 0.07),
        # the waves are others, and as many: a sum over waves depends on their number by itself
        (CHAIN, 0.15, 0.1),
        # between nodes up to h = 0.25 apart in log q mu is drawn straight: h^2/8 mu''/mu/ln 2
        (Persson(), 6e-3, 6e-3),
        (KlueppelHeinrich(1.0, 1e-3), None, 6e-3),
    ],
    ids=["direct", "chain", "persson", "klueppel_heinrich"],
)
def test_exponents_are_those_of_a_second_solution(model, of_area, of_friction):
    """Of the model with twice the cut-off."""
    found = told(model)
    one, other = (model.predict(RUBBER, surface(end), LOAD) for end in (LAST, 2.0 * LAST))
    area, friction = (
        math.log(other[name] / one[name]) / math.log(2.0)
        for name in ("total_contact_fraction", "total_friction_from_dissipation")
    )
    assert found.friction == pytest.approx(friction, abs=of_friction)
    assert found.friction < -0.3 or not isinstance(model, DirectContact)
    if of_area is None:
        assert math.isnan(found.contact_fraction)
        assert "does not tell the contact area" in found.why_not
    else:
        assert found.contact_fraction == pytest.approx(area, abs=of_area)


def test_direct_contact_pressed_flat_is_the_closed_form():
    load = {"pressure": 1e12, "speed": 3.0, "smallest_wavelength": LAST, "periodic": True}
    found, other = (
        gs.solve_rough_contact(RUBBER, LINE, **(load | {"smallest_wavelength": length}))
        for length in (LAST, 2.0 * LAST)
    )
    assert found.full_contact
    exact = math.log(other.friction / found.friction) / math.log(2.0)
    assert found.cut_off_exponents.friction == pytest.approx(exact, rel=1e-3)
    assert found.cut_off_exponents.contact_fraction == 0.0


def test_one_grid_tells_nothing():
    few = Profile(LINE.x[:64], LINE.z[:64])
    found = gs.solve_rough_contact(RUBBER, few, pressure=3e5, speed=3.0)
    assert found.cut_off_exponents.why_not == "solved with one cut-off only"


def test_chain_without_its_last_wave_of_half_the_length():
    sines = gs.SineStack([8e-3, 4e-3, 2e-3, 1e-3], [8e-4, 4.4e-4, 2.4e-4, 1.3e-4])
    load = {"pressure": 3e5, "speed": 3.0, "footprint": 0.1, "solver": CHAIN.solver}
    whole = gs.solve_chain(RUBBER, sines, **load)
    short = gs.solve_chain(RUBBER, sines, smallest_wavelength=2e-3, **load)
    found = whole.cut_off_exponents
    for name in ("contact_fraction", "friction"):
        exact = math.log(getattr(short, name) / getattr(whole, name)) / math.log(2.0)
        assert getattr(found, name) == pytest.approx(exact, rel=1e-12)


def test_what_answers_for_one_cut_off_only_says_so():
    x = np.arange(64) * 1e-3 / 64
    lines = [Profile(x, 1e-5 * np.cos(2.0 * np.pi * x / 1e-3))]
    one = Surface(gs.SineStack([1e-3], [1e-5]), "", measured=Measured.of(lines))
    for model, why in (
        (BlockOnProfile(periodic=True), "the model does not tell it"),
        (CHAIN, "only one wave"),
    ):
        answer = model.predict(RUBBER, one, LOAD)
        assert answer.prediction_status == "converged"
        assert cut_off_exponents_of(answer).why_not == why
        assert math.isnan(answer.total_friction_cut_off_exponent)


def test_there_is_no_friction_at_rest_to_change():
    rest = Load(1e4, 0.0, 0.1)  # so light that the relaxed rubber does not touch all over
    for model in (CHAIN, Persson(), DirectContact(tolerance=None)):
        found = told(model, rest)
        assert found.contact_fraction > 0.0
        assert math.isnan(found.friction)
        assert found.why_not == "no friction at rest"


def test_profiles_count_by_their_length_and_models_by_their_samples():
    half = Profile(LINE.x[:4000], LINE.z[:4000])
    model = DirectContact(tolerance=None)
    both = Surface(surface().sines, "", measured=Measured.of([LINE, half]))
    answer = model.predict(RUBBER, both, LOAD)
    weight = answer.weight * answer.friction_from_dissipation
    each = answer.friction_cut_off_exponent
    mean = float((weight * each).sum() / weight.sum())
    assert float(answer.total_friction_cut_off_exponent) == pytest.approx(mean)
    sample = sample_numbers(answer, Task(RUBBER, both, LOAD, model))
    member = stack({(0,): sample, (1,): sample}, {"sample": 2})
    assert cut_off_exponents(member).total_friction_cut_off_exponent == pytest.approx(mean)
