"""Temperature alone: speed and temperature are one variable, in every model."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions

from .shifted import RUBBER, SINES

LOAD = {"pressure": 3e5, "footprint": 0.05}
WARM = 313.15
SHIFT = float(RUBBER.shift.a(WARM, 293.15))


@pytest.mark.parametrize("speed", [1e-2, 1.0])
@pytest.mark.parametrize("solver", ["half_plane", "finite_strain"])
def test_the_chain_collapses_on_a_t_times_speed(solver, speed):
    """The bulk modulus does not relax and nothing else has a time: to the solver's residual."""
    options = {"columns": 48, "rows": 10} if solver == "finite_strain" else {"points": 256}
    at = Conditions(temperature=WARM)
    warm = gs.predict(RUBBER, SINES, speed=speed, conditions=at, solver=solver, **LOAD, **options)
    master = gs.predict(RUBBER, SINES, speed=SHIFT * speed, solver=solver, **LOAD, **options)
    cold = gs.predict(RUBBER, SINES, speed=speed, solver=solver, **LOAD, **options)
    assert warm.friction == pytest.approx(master.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(master.contact_fraction, rel=1e-6)
    assert abs(warm.friction / cold.friction - 1.0) > 0.05


def test_the_direct_contact_collapses_on_a_t_times_speed():
    x = np.arange(1024) * 1e-5
    turns = 2.0 * np.pi * x / (1024 * 1e-5)
    line = gs.Profile(x, 2e-4 * np.cos(3 * turns) + 3e-5 * np.cos(17 * turns + 1.0))
    load = {"pressure": 3e5, "periodic": True, "tolerance": None}
    warm = gs.solve_rough_contact(
        RUBBER, line, speed=0.1, conditions=Conditions(temperature=WARM), **load
    )
    master = gs.solve_rough_contact(RUBBER, line, speed=SHIFT * 0.1, **load)
    assert warm.friction == pytest.approx(master.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(master.contact_fraction, rel=1e-6)


def test_at_the_reference_temperature_nothing_changes():
    same = gs.predict(
        RUBBER,
        SINES,
        speed=0.1,
        solver="half_plane",
        conditions=Conditions(temperature=293.15),
        **LOAD,
    )
    plain = gs.predict(RUBBER, SINES, speed=0.1, solver="half_plane", **LOAD)
    assert same.friction == plain.friction


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


def test_a_rubber_without_shift_has_no_other_temperature():
    plain = gs.Rubber(5e6, [1e7], [1e-3])
    with pytest.raises(gs.InputError, match="shift"):
        gs.predict(plain, SINES, speed=0.1, conditions=Conditions(temperature=310.0), **LOAD)
