"""The area term: laws of the interfacial shear stress."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import (
    Conditions,
    ConstantStress,
    GaussianStress,
    LeGalKlueppelStress,
    TableStress,
    ThermalProperties,
    adhesive_friction,
    shear_stress_from_dict,
    shear_stress_to_dict,
)
from gripscale.conditions.area_term import BOLTZMANN
from gripscale.rubber.softening import Kraus
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES
from tests.samples import SHIFTED_VALUES as LOAD

LAWS = [
    ConstantStress(5e6),
    GaussianStress(6e6, width=0.1, speed_0=6e-3),
    GaussianStress(6e6, 0.1, 6e-3, activation_energy=0.97, reference_temperature=293.15),
    LeGalKlueppelStress(1e5, ratio=300.0, critical_speed=0.1, exponent=0.2),
    TableStress([1e-4, 1e-2, 1.0], [1e6, 4e6, 2e6]),
]


@pytest.mark.parametrize("law", LAWS)
def test_a_law_survives_its_dict(law):
    assert shear_stress_from_dict(shear_stress_to_dict(law)) == law


def test_the_bell():
    law = GaussianStress(6e6, width=0.1, speed_0=6e-3)
    assert law.stress(6e-3) == pytest.approx(6e6)
    # a decade off, exp(-0.1); two, exp(-0.4)
    assert law.stress([6e-2, 6e-4, 0.6]) == pytest.approx(
        6e6 * np.exp([-0.1, -0.1, -0.4]), rel=1e-12
    )
    assert law.stress(0.0) == 0.0


def test_the_bell_moves_with_the_temperature():
    law = GaussianStress(6e6, 0.1, 6e-3, activation_energy=0.97, reference_temperature=293.15)
    colder = 283.15
    shift = math.exp(0.97 / BOLTZMANN * (1.0 / colder - 1.0 / 293.15))
    assert shift > 1.0
    assert law.stress(6e-3 / shift, colder) == pytest.approx(6e6)
    with pytest.raises(gs.InputError, match="temperature must be given"):
        law.stress(1.0)


def test_le_gal_and_klueppel_between_two_plateaus():
    law = LeGalKlueppelStress(1e5, ratio=300.0, critical_speed=0.1, exponent=1.0)
    assert law.stress(0.0) == pytest.approx(1e5)
    assert law.stress(0.1) == pytest.approx(1e5 * 151.0)
    assert law.stress(1e12) == pytest.approx(1e5 * 301.0)


def test_a_table_is_held_beyond_its_ends():
    law = TableStress([1e-4, 1e-2, 1.0], [1e6, 4e6, 2e6])
    assert law.stress([0.0, 1e-5, 1e-3, 1.0, 9.0]) == pytest.approx([1e6, 1e6, 2.5e6, 2e6, 2e6])


def test_the_friction_of_a_sheared_area():
    assert adhesive_friction(5e6, 0.03, 3e5) == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"kind": "bell"}, "kind"),
        ({"kind": "constant"}, "stress_0"),
        ({"kind": "constant", "stress_0": 1e6, "width": 0.1}, "width"),
        ({"kind": "constant", "stress_0": -1.0}, "stress_0"),
        ({"kind": "gaussian", "stress_0": 1e6, "width": 0.0, "speed_0": 1.0}, "width"),
        ({"kind": "gaussian", "stress_0": 1e6, "width": 0.1, "speed_0": 1.0,
         "activation_energy": 0.9}, "reference_temperature"),
        ({"kind": "table", "speed": [1.0], "stress_at": [1e6]}, "speed"),
        ({"kind": "table", "speed": [1.0, 2.0], "stress_at": [1e6, -1.0]}, "stress_at"),
    ],
)  # fmt: skip
def test_a_wrong_law_is_one_sentence(values, word):
    with pytest.raises(gs.InputError, match=word) as caught:
        shear_stress_from_dict(values)
    assert "\n" not in str(caught.value)


def test_a_contact_that_is_not_known_has_no_area_term():
    assert math.isnan(adhesive_friction(5e6, math.nan, 3e5))
    with pytest.raises(gs.InputError, match="pressure must be greater than zero"):
        adhesive_friction(5e6, 0.03, 0.0)


# The area term beside the hysteresis: in the chain, in the direct contact, in files.

TURNS = 2.0 * np.pi * np.arange(512) / 512
LINE = gs.Profile(np.arange(512) * 2e-5, 2e-4 * np.cos(3 * TURNS) + 3e-5 * np.cos(17 * TURNS))
SHEARED = Conditions(shear_stress=ConstantStress(2e6))
EVERYTHING = Conditions(
    temperature=300.0,
    softening=Kraus(0.3, 0.15, 0.02, 1e-3, "shear"),
    heat=ThermalProperties(0.25, 1150.0, 1500.0),
    shear_stress=GaussianStress(6e6, 0.1, 6e-3, 0.97, 293.15),
)


def test_the_chain_shears_its_real_area_and_keeps_its_hysteresis():
    plain = gs.solve_chain(RUBBER, SINES, solver="half_plane", **LOAD)
    both = gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=SHEARED, **LOAD)
    assert both.friction == plain.friction
    assert both.adhesive_friction == pytest.approx(2e6 * plain.contact_fraction / 3e5)
    assert both.total_friction == both.friction + both.adhesive_friction
    assert math.isnan(plain.adhesive_friction)
    data = both.to_dataset()
    assert float(data.total_friction) == plain.friction
    assert float(data.total_adhesive_friction) == both.adhesive_friction
    assert "total_adhesive_friction" not in plain.to_dataset()


def test_the_direct_contact_shears_its_real_area():
    load = {"pressure": 3e5, "speed": 1.0, "periodic": True}
    found = gs.solve_rough_contact(RUBBER, LINE, conditions=SHEARED, **load)
    assert found.adhesive_friction == pytest.approx(2e6 * found.contact_fraction / 3e5)
    assert found.total_friction == found.friction + found.adhesive_friction


@pytest.mark.parametrize("conditions", [Conditions(), EVERYTHING])
def test_conditions_survive_their_dict(conditions):
    assert Conditions.from_dict(conditions.to_dict()) == conditions


def test_at_rest_there_is_no_area_term():
    at_rest = LOAD | {"speed": 0.0}
    found = gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=SHEARED, **at_rest)
    assert math.isnan(found.adhesive_friction)
