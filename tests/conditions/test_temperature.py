"""Temperature alone: speed and temperature are one variable, in every model."""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions, ThermalProperties
from tests.half_space.rough_cases import two_waves
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES

LOAD = {"pressure": 3e5, "footprint": 0.05}
WARM = 313.15
LINE = two_waves(1e-5)
SHIFT = float(RUBBER.shift.a(WARM, 293.15))


@pytest.mark.parametrize("speed", [1e-2, 1.0])
@pytest.mark.parametrize("solver", ["half_plane", "finite_strain"])
def test_the_chain_collapses_on_a_t_times_speed(solver, speed):
    """The bulk modulus does not relax and nothing else has a time: to the solver's residual."""
    options = {"columns": 48, "rows": 10} if solver == "finite_strain" else {"points": 256}
    at = Conditions(temperature=WARM)
    warm = gs.solve_chain(
        RUBBER, SINES, speed=speed, conditions=at, solver=solver, **LOAD, **options
    )
    master = gs.solve_chain(RUBBER, SINES, speed=SHIFT * speed, solver=solver, **LOAD, **options)
    cold = gs.solve_chain(RUBBER, SINES, speed=speed, solver=solver, **LOAD, **options)
    assert warm.friction == pytest.approx(master.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(master.contact_fraction, rel=1e-6)
    assert abs(warm.friction / cold.friction - 1.0) > 0.05


def test_the_direct_contact_collapses_on_a_t_times_speed():
    load = {"pressure": 3e5, "periodic": True, "tolerance": None}
    warm = gs.solve_rough_contact(
        RUBBER, LINE, speed=0.1, conditions=Conditions(temperature=WARM), **load
    )
    master = gs.solve_rough_contact(RUBBER, LINE, speed=SHIFT * 0.1, **load)
    assert warm.friction == pytest.approx(master.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(master.contact_fraction, rel=1e-6)


def test_at_the_reference_temperature_nothing_changes():
    same, plain = (
        gs.solve_chain(RUBBER, SINES, speed=0.1, solver="half_plane", conditions=each, **LOAD)
        for each in (Conditions(temperature=293.15), None)
    )
    assert same.friction == plain.friction


BAND = (1e2, 1e5)
"""In which a rubber was measured [rad/s]."""


def test_the_band_that_is_not_to_be_left_moves_with_the_temperature():
    """Warmer by 20 K the same rubber is measured to higher frequencies, a_T of them."""
    rubber = replace(RUBBER, valid_band=BAND)
    load = {"pressure": 3e5, "periodic": True, "tolerance": None, "extrapolate": "refuse"}
    smallest = 4e-5
    edge = BAND[1] * smallest / (2.0 * np.pi)
    for kelvin, most in ((293.15, edge), (WARM, edge / SHIFT)):
        conditions = Conditions(temperature=kelvin)
        gs.solve_rough_contact(rubber, LINE, speed=0.99 * most, conditions=conditions, **load)
        with pytest.raises(gs.ExtrapolationError, match="above the measured band"):
            gs.solve_rough_contact(rubber, LINE, speed=1.01 * most, conditions=conditions, **load)


def test_heat_moves_harmonics_into_the_band():
    """Just beyond the band when cold; warmed by its own heat the same friction is within it."""
    rubber = replace(RUBBER, valid_band=(1.0, 2.5e4))
    heat = Conditions(heat=ThermalProperties(0.25, 1150.0, 1500.0))
    load = {"pressure": 3e5, "periodic": True, "tolerance": None, "speed": 5.0}
    cold = gs.solve_rough_contact(rubber, LINE, **load)
    warm = gs.solve_rough_contact(rubber, LINE, conditions=heat, footprint=0.05, **load)
    assert warm.extrapolation.above < cold.extrapolation.above - 0.1


@pytest.mark.parametrize(
    ("values", "word"),
    [
        ({"temperature": -3.0}, "temperature"),
        ({"softening": 0.5}, "softening"),
        ({"heat": 0.25}, "heat"),
        ({"shear_stress": 5e6}, "shear_stress"),
        ({"strain_norm": "peak"}, "strain_norm"),
    ],
)
def test_wrong_conditions_are_one_sentence(values, word):
    with pytest.raises(gs.InputError, match=word):
        Conditions(**values)
