"""Heat of the interface on the waves of a chain, and the counterface it is shared with."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain.heat import WaveHeat, warming
from gripscale.conditions import Conditions, ConstantStress, GaussianStress, LossDepth
from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.flash_temperature import STONE
from tests.samples import SHIFTED_LOAD, SHIFTED_RUBBER, SHIFTED_SINES, SHIFTED_VALUES, THERMAL

SHEAR = GaussianStress(3e6, 0.1, 6e-3, 0.97, 293.15)
FLAT = np.zeros(127, dtype=complex)
SPEED, TIME, PRESSURE = 0.5, 0.2, 3e5


def _full_contact(friction):
    """Return the heat of a wave in full contact, lost evenly at 0.1 mm."""
    return WaveHeat(1e-3, PRESSURE, friction, FLAT, FLAT, LossDepth(1e-4))


def _shared(waves, conditions, friction):
    return warming(waves, conditions, lambda _: friction, speed=SPEED, time=TIME)


def test_in_full_contact_the_effusivities_share_the_heat():
    conditions = Conditions(heat=THERMAL, counterface=STONE, shear_stress=ConstantStress(1.0))
    [warm] = _shared([_full_contact(0.0)], conditions, 0.8)
    both = THERMAL.effusivity + STONE.effusivity
    exact = 2.0 * PRESSURE * SPEED * 0.8 * math.sqrt(TIME / math.pi) / both
    assert warm.contact == pytest.approx(exact, rel=1e-12)
    depth = LossDepth(1e-4)
    share = THERMAL.effusivity / both
    deeper = PRESSURE * SPEED * 0.8 * share * rise.uniform_at_surface(TIME, depth, THERMAL)
    assert warm.total == pytest.approx(deeper, rel=1e-12)


def test_the_road_cools_the_heat_of_the_hysteresis():
    conditions = Conditions(heat=THERMAL, counterface=STONE)
    [cold] = _shared([_full_contact(0.3)], Conditions(heat=THERMAL), math.nan)
    [warm] = _shared([_full_contact(0.3)], conditions, math.nan)
    both = THERMAL.effusivity + STONE.effusivity
    assert warm.contact == pytest.approx(cold.contact * THERMAL.effusivity / both, rel=1e-12)


@pytest.mark.parametrize("counterface", [None, STONE], ids=["insulating", "stone"])
def test_the_settled_chain_has_the_stress_of_its_temperature(counterface):
    conditions = Conditions(heat=THERMAL, counterface=counterface, shear_stress=SHEAR)
    chain, alone = (
        gs.solve_chain(
            SHIFTED_RUBBER, SHIFTED_SINES, solver="half_plane", conditions=each, **SHIFTED_VALUES
        )
        for each in (conditions, Conditions(heat=THERMAL))
    )
    assert chain.converged
    kelvin = chain.scales[-1].details["contact_temperature"]
    stress = float(SHEAR.stress(SHIFTED_LOAD.speed, kelvin))
    exact = stress * chain.contact_fraction / SHIFTED_LOAD.pressure
    assert chain.adhesive_friction == pytest.approx(exact, rel=1e-12)
    # the friction of the interface is several times that of the waves
    assert chain.adhesive_friction > 2.0 * chain.friction
    assert kelvin > 20.0 + alone.scales[-1].details["contact_temperature"]
