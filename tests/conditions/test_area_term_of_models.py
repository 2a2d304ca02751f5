"""The area term beside the hysteresis: in the chain, in the direct contact, in files."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions, ConstantStress, GaussianStress, ThermalProperties
from gripscale.rubber.softening import Kraus
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES
from tests.samples import SHIFTED_VALUES as LOAD

TURNS = 2.0 * np.pi * np.arange(512) / 512
LINE = gs.Profile(np.arange(512) * 2e-5, 2e-4 * np.cos(3 * TURNS) + 3e-5 * np.cos(17 * TURNS))
EVERYTHING = Conditions(
    temperature=300.0,
    softening=Kraus(0.3, 0.15, 0.02, 1e-3, "shear"),
    heat=ThermalProperties(0.25, 1150.0, 1500.0),
    shear_stress=GaussianStress(6e6, 0.1, 6e-3, 0.97, 293.15),
)


def test_the_chain_shears_its_real_area_and_keeps_its_hysteresis():
    plain = gs.solve_chain(RUBBER, SINES, solver="half_plane", **LOAD)
    both = gs.solve_chain(
        RUBBER,
        SINES,
        solver="half_plane",
        conditions=Conditions(shear_stress=ConstantStress(2e6)),
        **LOAD,
    )
    assert both.friction == plain.friction
    assert both.adhesive_friction == pytest.approx(2e6 * plain.contact_fraction / 3e5)
    assert both.total_friction == both.friction + both.adhesive_friction
    assert math.isnan(plain.adhesive_friction)
    data = both.to_dataset()
    assert float(data.total_friction) == plain.friction
    assert float(data.total_adhesive_friction) == both.adhesive_friction
    assert "total_adhesive_friction" not in plain.to_dataset()


def test_the_direct_contact_shears_its_real_area():
    found = gs.solve_rough_contact(
        RUBBER,
        LINE,
        pressure=3e5,
        speed=1.0,
        periodic=True,
        conditions=Conditions(shear_stress=ConstantStress(2e6)),
    )
    assert found.adhesive_friction == pytest.approx(2e6 * found.contact_fraction / 3e5)
    assert found.total_friction == found.friction + found.adhesive_friction


def test_the_stress_is_that_at_the_temperature_in_the_contact():
    found = gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=EVERYTHING, **LOAD)
    kelvin = found.scales[-1].details["contact_temperature"]
    assert kelvin > 301.0
    stress = float(EVERYTHING.shear_stress.stress(1.0, kelvin))
    assert found.adhesive_friction == pytest.approx(stress * found.contact_fraction / 3e5)


@pytest.mark.parametrize("conditions", [Conditions(), EVERYTHING])
def test_conditions_survive_their_dict(conditions):
    assert Conditions.from_dict(conditions.to_dict()) == conditions


def test_at_rest_there_is_no_area_term():
    at_rest = LOAD | {"speed": 0.0}
    shear = Conditions(shear_stress=ConstantStress(2e6))
    found = gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=shear, **at_rest)
    assert math.isnan(found.adhesive_friction)
