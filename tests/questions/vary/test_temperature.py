"""Temperature and effects as axes: one curve over a_T v with nothing else on."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain import Chain
from gripscale.conditions import Conditions, ConstantStress
from gripscale.core.errors import InputError
from gripscale.half_space.model import DirectContact
from gripscale.io.table import as_text
from gripscale.questions import Study, Variation
from gripscale.rubber import WLF, ShiftTable, styrene_butadiene
from gripscale.surface import self_affine_profile
from gripscale.theory import HalfPlane, KlueppelHeinrich, Persson
from tests.samples import THERMAL as HEAT

SPEEDS = "0.1:10:log5"
"""Two in a decade."""


def shifted_by(decades):
    """Return the temperature of the case's shift at which a_T is 10^decades [K]."""
    return 293.15 - 120.0 * decades / (8.0 + decades)


COMMON = [shifted_by(4.0), shifted_by(2.5), shifted_by(2.0)]
"""Cold, so that this rubber is lossy; a_T v at each is one of those at the others."""


WARMER = WLF(8.0, 120.0, valid_range=(273.15, 323.15))
CASE = gs.Case(
    self_affine_profile(0.8, 5e-3, 0.3e-3, 0.1, 1e-4, seed=4),
    replace(styrene_butadiene(), shift=WARMER),
    pressure=3e5,
    speed=0.1,
    footprint=0.05,
    waves=2,
    smallest_wavelength=1e-3,
    cleaning={},
    chain=Chain(HalfPlane(points=256)),
    conditions=Conditions(heat="none"),
)


def direct(**conditions):
    return DirectContact(tolerance=None, periodic=True, conditions=Conditions(**conditions))


def over(model, temperatures=COMMON, speeds=SPEEDS):
    vary = {"speed": speeds, "temperature": temperatures}
    return Study(CASE, vary, model=model).run()


def apart(result, name):
    """Return how far temperatures lie apart at the same a_T v [-]; they share points of it."""
    reduced = np.log(result.reduced_speed.values).ravel()
    values = result[name].transpose(*result.reduced_speed.dims).values.ravel()
    same = np.triu(np.abs(reduced[:, None] - reduced) < 1e-6, 1)
    assert same.sum() > 2
    return float(np.abs(values[:, None] / values - 1.0)[same].max())


@pytest.mark.parametrize("model", ["chain", direct()], ids=["chain", "direct"])
def test_temperatures_are_one_curve_over_reduced_speed(model):
    """To the accuracy of the solvers where points are common: nothing is interpolated.

    With a tolerance of 0.02 up to 2e-4 of the points of a direct contact are on the wrong side.
    """
    result = over(model)
    assert result.reduced_speed.dims == ("speed", "temperature")
    np.testing.assert_allclose(result.reduced_speed[:, 1], result.speed * 10**2.5, rtol=1e-9)
    np.testing.assert_allclose(result.vertical_shift_factor, 1.0)
    assert float(np.ptp(result.total_friction.values)) > 0.05
    assert apart(result, "total_friction") < 1e-5
    assert apart(result, "total_contact_fraction") < (1e-5 if model == "chain" else 2e-4)


def test_a_theory_takes_the_rubber_at_the_temperature_of_the_case():
    """As a comparison does: a theory without conditions gets those of the case."""
    warm = CASE.replace(conditions=Conditions(temperature=313.15, heat="none"))
    result = Study(warm, {"speed": [0.1]}, model=Persson()).run()
    compared = gs.compare(warm, models=["persson"]).to_dataset()
    friction = float(compared.total_friction.sel(model="persson"))
    assert float(result.total_friction[0]) == pytest.approx(friction, rel=1e-12)


def test_a_vertical_shift_makes_them_several():
    """Moduli a tenth higher where it is warmer: another contact at the same a_T v."""
    study = Study(CASE, {"speed": "0.1:10:log5", "temperature": COMMON[1:]})
    table = ShiftTable(
        temperature=[COMMON[1], COMMON[2], 293.15],
        horizontal=[2.5, 2.0, 0.0],
        vertical=[np.log10(1.1), 0.0, 0.0],
    )
    measured = study.measured_rubbers[0]
    study.measured_rubbers = [replace(measured, rubber=replace(measured.rubber, shift=table))]
    result = study.run()
    np.testing.assert_allclose(result.vertical_shift_factor, [1.1, 1.0], rtol=1e-9)
    assert apart(result, "total_contact_fraction") > 0.02


def test_temperature_is_that_of_the_conditions():
    study = Study(CASE, {"temperature": ["40 C"]}, model="chain")
    result = study.run()
    task = study.points[0].task
    model = Chain(HalfPlane(points=256), conditions=Conditions(temperature=313.15))
    alone = model.predict(task.rubber, task.surface, task.load)
    assert result.temperature.values.tolist() == [313.15]
    assert float(result.total_friction[0]) == float(alone.total_friction)


def test_friction_by_decade_is_of_the_rubber_as_warm_as_it_is():
    """Relaxation times a hundred times shorter, speed a hundred times higher: two decades off."""
    result = over("chain", [shifted_by(4.0), shifted_by(2.0)], "0.01,1")
    cold, warm = (
        result.friction_by_decade.isel(speed=i, temperature=i).dropna("decade") for i in (0, 1)
    )
    shifted = warm.assign_coords(decade=warm.decade * 100.0)
    there = shifted.reindex(decade=cold.decade, method="nearest", tolerance=1e-9 * cold.decade)
    where = there.notnull() & (cold > 1e-4)
    assert int(where.sum()) > 3
    np.testing.assert_allclose(there.where(where, 0.0), cold.where(where, 0.0), atol=1e-5)


def test_temperatures_beyond_the_shift_are_flagged_and_said():
    result = Study(CASE, {"temperature": "10 C, 60 C"}).run()
    assert result.rubber_temperature_extrapolated.values.tolist() == [False, True]
    assert any(
        "1 of 2 predictions lie beyond the temp" in str(f) for f in Variation(result).findings
    )
    text = as_text(Variation(result).table())
    assert "60 °C *" in text
    assert "10 °C *" not in text


@pytest.mark.parametrize("kind", [Chain(HalfPlane(points=256)), direct()], ids=["chain", "direct"])
def test_effects_are_left_out_by_name(kind):
    conditions = Conditions(temperature=313.15, heat=HEAT, shear_stress=ConstantStress(2e6))
    model = replace(kind, conditions=conditions)
    study = Study(CASE, {"effects": "all, no_heat, no temperature, none"}, model=model)
    result = study.run()
    task = study.points[0].task
    assert result.effects.values.tolist() == ["all", "no heat", "no temperature", "none"]
    none = {"heat": None, "temperature": None}
    for i, left_out in enumerate(({}, {"heat": None}, {"temperature": None}, none)):
        own = replace(model, conditions=replace(conditions, **left_out))
        alone = own.predict(task.rubber, task.surface, task.load)
        assert float(result.total_friction[i]) == float(alone.total_friction)
        assert float(result.total_adhesive_friction[i]) == float(alone.total_adhesive_friction)
    text = as_text(Variation(result).table())
    assert "area term" in text
    assert "no effects" in text


@pytest.mark.parametrize(
    ("vary", "model", "words"),
    [
        ({"temperature": "20, 30"}, "chain", 'temperature must have a unit, such as "20 C"'),
        ({"temperature": "20:60:lin3"}, "chain", "temperature must have a unit"),
        ({"temperature": "-300 C"}, "chain", "temperature must be greater than zero"),
        (
            {"temperature": ["20 C"]},
            KlueppelHeinrich(1.0, 1e-3),
            "such as chain and direct; got the model klueppel_heinrich",
        ),
        ({"temperature": "20 C, -150 C"}, "chain", "temperature must lie within"),
        ({"temperature": "20 C"}, "toy", "model must be one of chain, direct; got 'toy'"),
        ({"effects": "all, no luck"}, "chain", "effects must be one of all, none; got"),
        ({"effects": "no heat"}, "chain", "effects must be one of all, none; got"),
    ],
)
def test_what_cannot_be_varied_is_one_sentence(vary, model, words):
    with pytest.raises(InputError, match=words) as caught:
        _ = Study(CASE, vary, model=model).points
    assert "\n" not in str(caught.value)


def test_rubber_without_shift_is_refused_before_anything_is_solved(tmp_path):
    study = Study(CASE.replace(rubber=styrene_butadiene()), {"temperature": "20 C, 40 C"})
    with pytest.raises(InputError, match="time-temperature shift is missing"):
        study.run(tmp_path)
    assert not list(tmp_path.rglob("*.nc"))
