"""How near settled models are to their fixed point, and what all their passes took."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.conditions import Conditions, fixed_point
from gripscale.half_space import conditions as half_space
from gripscale.theory.half_plane import HalfPlane
from gripscale.wave import FiniteStrainBlock
from tests.samples import KRAUS as SOFTENING
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES
from tests.samples import SHIFTED_VALUES as LOAD
from tests.samples import THERMAL as HEAT

from .test_settle import DIRECT, LINE

EFFECTS = [
    Conditions(softening=SOFTENING),
    Conditions(heat=HEAT),
    Conditions(softening=SOFTENING, heat=HEAT),
]
MESH = {"columns": 64, "rows": 12}


def chain(conditions, **options):
    return gs.solve_chain(RUBBER, SINES, conditions=conditions, **MESH, **options, **LOAD)


def half_plane(conditions):
    options = {"solver": "half_plane", "points": 256}
    return gs.solve_chain(RUBBER, SINES, conditions=conditions, **options, **LOAD)


def direct(conditions, tolerance=1.25e-3):
    """Settle to two fifths of the tolerance of the contact, as far as a chain does."""
    options = DIRECT | {"tolerance": tolerance}
    return gs.solve_rough_contact(RUBBER, LINE, conditions=conditions, **options)


@pytest.fixture
def tight(monkeypatch):
    """Return what solves with passes held to 1e-6, a thousandth of what is promised."""

    def held(model, conditions):
        with monkeypatch.context() as patch:
            for name in ("RESULT_TOLERANCE", "STATE_TOLERANCE", "COARSE_TOLERANCE"):
                patch.setattr(fixed_point, name, 1e-6)
            patch.setattr(half_space, "STATE_TOLERANCE", 1e-6)
            patch.setattr(half_space, "_LOOSEST", 1e-6)
            patch.setattr(fixed_point, "MOST_PASSES", 40)
            found = model(conditions)
        assert found.converged
        return found

    return held


@pytest.mark.parametrize("conditions", EFFECTS, ids=["softening", "heat", "both"])
@pytest.mark.parametrize("model", [chain, half_plane, direct])
def test_what_settled_is_within_a_thousandth(model, conditions, tight):
    found, exact = model(conditions), tight(model, conditions)
    assert found.converged
    assert found.friction == pytest.approx(exact.friction, rel=1e-3)
    assert found.contact_fraction == pytest.approx(exact.contact_fraction, rel=1e-3)
    taken = found.passes if model is direct else found.scales[0].details["passes"]
    assert taken <= 8


@pytest.mark.parametrize("conditions", EFFECTS[:2], ids=["softening", "heat"])
def test_a_direct_contact_settles_within_its_tolerance(conditions, tight):
    """To two fifths of it, beside the errors of the grid."""
    loose, exact = direct(conditions, 0.05), tight(lambda c: direct(c, 0.05), conditions)
    assert loose.grid.shape == exact.grid.shape
    assert loose.friction == pytest.approx(exact.friction, rel=0.01)
    assert loose.contact_fraction == pytest.approx(exact.contact_fraction, rel=0.01)


@pytest.mark.parametrize(
    ("solver", "asked"),
    [(FiniteStrainBlock, FiniteStrainBlock.of(**MESH)), (HalfPlane, HalfPlane(points=256))],
)
def test_the_work_of_all_passes_is_told(solver, asked, monkeypatch):
    """Solutions, Newton iterations and load steps of a wave, counted where they are made."""
    solved, own = [], solver.solve

    def counting(self, problem, start=None):
        solved.append((self, problem.profile.wavelength, own(self, problem, start)))
        return solved[-1][2]

    monkeypatch.setattr(solver, "solve", counting)
    found = (chain if solver is FiniteStrainBlock else half_plane)(EFFECTS[2])
    for wave in found.scales:
        mine = [(by, one) for by, wavelength, one in solved if wavelength == wave.wavelength]
        assert wave.newton_iterations == sum(one.newton_iterations for _, one in mine)
        assert wave.details["passes"] == sum(by == asked for by, _ in mine)
        assert wave.details["coarse_passes"] == sum(by != asked for by, _ in mine)
        if solver is FiniteStrainBlock:
            steps = sum(one.details["load_steps"] for _, one in mine)
            assert wave.details["load_steps"] == steps


def test_the_grids_of_all_passes_are_kept():
    found = gs.solve_rough_contact(RUBBER, LINE, conditions=EFFECTS[2], **DIRECT)
    assert found.coarse_passes > 0
    finest = sum(record.points == found.grid.shape[0] for record in found.grids)
    assert finest >= found.passes


def test_the_grids_of_the_result_come_last():
    """Not of a coarse pass after it: what another rubber changes is taken from its own grids."""
    load = DIRECT | {"tolerance": 0.02}
    found = gs.solve_rough_contact(RUBBER, LINE, conditions=EFFECTS[0], **load)
    assert found.coarse_passes > 4
    assert found.grids[-1].friction == found.friction


def test_a_slow_chain_is_warmed_by_what_lasts():
    """0.1 mm/s: no pattern of the heat matters, and what is even is that of a surface source.

    T = 2 q sqrt(t / (pi kappa rho c)), Carslaw and Jaeger; less by half the depth of the loss over
    the way the heat spreads, of the order of a per cent.
    """
    speed, footprint = 1e-4, 0.05
    found = half_plane_at(speed)
    last = found.scales[-1].details
    flux = found.friction * LOAD["pressure"] * speed
    spread = np.sqrt(footprint / speed / (np.pi * 0.25 * 1150.0 * 1500.0))
    assert last["flash_temperature_rise_uniform"] == pytest.approx(2.0 * flux * spread, rel=0.05)
    assert last["flash_temperature_rise_larger_waves"] + last["flash_temperature_rise_own"] < 0.02


def half_plane_at(speed):
    load = LOAD | {"speed": speed}
    return gs.solve_chain(
        RUBBER, SINES, conditions=EFFECTS[1], solver="half_plane", points=256, **load
    )
