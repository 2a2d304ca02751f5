"""Water of a case: from Python and the case file to the answer, and where it is refused."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain import Chain
from gripscale.conditions import Conditions
from gripscale.core.errors import InputError
from gripscale.questions.answer.direct_contact import solve_direct_contact
from gripscale.questions.inputs.page import conditions_lines
from gripscale.questions.vary import inputs
from gripscale.questions.vary.inputs import AnswerModel
from gripscale.rubber.softening import Kraus
from gripscale.surface import HeightMap
from tests.half_space.rough_cases import isotropic_map, sine
from tests.samples import ZENER

MAP = isotropic_map(64, shortest=1.6e-3)
LOAD = {"pressure": 7e5, "speed": 0.3}


@pytest.fixture(scope="module")
def wet():
    return gs.Case(MAP, ZENER, water=True, **LOAD)


def test_the_answer_is_that_of_the_wet_contact(wet):
    """Alone it has the numbers of `solve_rough_contact` with water, and says so."""
    answer = gs.answer(wet)
    end = wet.surface.cutoff_wavelength
    alone = gs.solve_rough_contact(
        ZENER, MAP, smallest_wavelength=end, water=True, tolerance=0.05, **LOAD
    )
    for name in ("friction", "contact_fraction"):  # times the factor of large strain
        assert answer.data[f"answer_{name}_factor"].size == 1
        value = float(answer.data[f"answer_{name}"] / answer.data[f"answer_{name}_factor"][0])
        assert value == pytest.approx(getattr(alone, name))
    ratio = alone.friction_from_dissipation / alone.water.dry_friction
    assert ratio < 0.9
    line = f"friction wet over dry ×{ratio:.2f}, load on water {alone.water_load_share:.1%}"
    assert any(line in text for text in answer.basis)


def test_a_dry_case_says_nothing_of_water():
    samples = solve_direct_contact(gs.Case(MAP, ZENER, **LOAD))
    assert samples is not None
    assert "water_load_share" not in samples


def test_derivatives_of_a_wet_contact_are_refused(wet):
    with pytest.raises(InputError, match="dry contacts only: leave out the water"):
        gs.sensitivity(wet)
    assert "water=flooded" in repr(wet)


def test_a_saved_case_keeps_its_water(wet, tmp_path):
    for water, film in ((True, np.inf), ("0.2 mm", 2e-4)):
        case = gs.Case(MAP, ZENER, water=water, **LOAD)
        conditions = gs.read_case(case.save(tmp_path / "case.toml")).conditions
        assert conditions is not None
        assert conditions.water == pytest.approx(film)
    assert Conditions.from_dict(Conditions(water=True).to_dict()) == Conditions(water=True)
    assert case.key != wet.key


def test_water_is_an_effect_of_the_direct_contact(wet):
    model = AnswerModel(conditions=wet.conditions)
    assert inputs.conditions_of(inputs.with_effects(model, "no water")).water is None
    assert wet.chain.conditions == Conditions()
    assert "water: flooded" in "\n".join(conditions_lines(wet.conditions, ZENER))


def test_water_is_refused_where_no_law_is_known():
    line = sine()
    with pytest.raises(InputError, match="water needs a map"):
        gs.Case(line, ZENER, water=True, **LOAD)
    with pytest.raises(InputError, match="water must be left out with softening"):
        Conditions(softening=Kraus(0.3, 0.2, 0.02, 0.001, "shear"), water=True)
    with pytest.raises(InputError, match="waves have no pools"):
        Chain(conditions=Conditions(water="0.2 mm"))
    with pytest.raises(InputError, match="thickness of a film"):
        gs.Case(HeightMap(MAP.x, MAP.y, MAP.z), ZENER, water="wet", **LOAD)
