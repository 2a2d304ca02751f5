"""Softening and heat: rubber, strains and temperatures agree when a model has settled."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.chain.heat import WaveHeat, strains, warming
from gripscale.conditions import Conditions
from gripscale.conditions.conditions import rubber_under
from gripscale.half_space.conditions import strain_by_scale, temperature
from gripscale.rubber.softening import Kraus
from tests.half_space.rough_cases import two_waves
from tests.samples import KRAUS, THERMAL
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES
from tests.samples import SHIFTED_VALUES as LOAD

BOTH = Conditions(softening=KRAUS, heat=THERMAL)
SOLVERS = [("half_plane", {"points": 256}), ("finite_strain", {"columns": 64, "rows": 12})]
LINE = two_waves(1e-5)
DIRECT = {"periodic": True, "tolerance": None, **LOAD}


@pytest.mark.parametrize(("solver", "options"), SOLVERS)
def test_a_settled_chain_is_its_own_rubber(solver, options):
    """Solved again with the rubber that its own strains and heat make, nothing moves by 1e-3."""
    found = gs.solve_chain(RUBBER, SINES, solver=solver, conditions=BOTH, **options, **LOAD)
    assert found.converged
    assert found.scales[0].details["passes"] <= 8
    heats = [WaveHeat.of(wave, wave.rubber) for wave in found.scales]
    warm = warming(heats, Conditions(heat=THERMAL), lambda _: 0.0, speed=1.0, time=0.05)
    strain = strains(found.scales, "slope")

    def again(wave, so_far):
        number = len(so_far.scales)
        omega = 2.0 * np.pi / wave.wavelength
        state = rubber_under(
            BOTH, RUBBER, warming=warm[number].total, strain=strain[number], omega=omega
        )
        return state.rubber

    repeated = gs.solve_chain(RUBBER, SINES, solver=solver, rubber_at=again, **options, **LOAD)
    assert repeated.friction == pytest.approx(found.friction, rel=1e-3)
    assert repeated.contact_fraction == pytest.approx(found.contact_fraction, rel=1e-3)
    told = found.scales[-1].details
    assert told["temperature"] == pytest.approx(293.15 + warm[-1].total, abs=0.3)
    assert told["strain"] == pytest.approx(strain[-1], rel=1e-2)


def test_the_heat_of_a_chain_is_the_friction_work():
    """Uniform heat and a time too short to spread: rho c T averaged over depth is the work."""
    plain = gs.solve_chain(RUBBER, SINES, solver="half_plane", **LOAD)
    heats = [WaveHeat.of(wave, RUBBER) for wave in plain.scales]
    assert sum(heat.friction for heat in heats) == pytest.approx(plain.friction, rel=1e-12)
    for heat in heats:
        # of the patterns, which have a mean of one, only what differs from it warms by harmonics
        assert np.isfinite(heat.lost).all()
        assert heat.pressure * plain.scales[0].pressure_received > 0.0


def test_at_rest_nothing_is_heated():
    at_rest = LOAD | {"speed": 0.0}
    plain, hot = (
        gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=conditions, **at_rest)
        for conditions in (None, Conditions(heat=THERMAL))
    )
    assert hot.contact_fraction == plain.contact_fraction
    direct = gs.solve_rough_contact(RUBBER, LINE, conditions=BOTH, **(DIRECT | {"speed": 0.0}))
    assert direct.converged
    assert direct.surface_warming is None


def test_stretches_give_another_strain():
    options = {"columns": 64, "rows": 12, "solver": "finite_strain"}
    under = {n: Conditions(softening=KRAUS, strain_norm=n) for n in ("slope", "stretch")}
    slope, stretch = (
        gs.solve_chain(RUBBER, SINES, conditions=conditions, **options, **LOAD)
        for conditions in under.values()
    )
    assert stretch.scales[0].details["strain"] != slope.scales[0].details["strain"]
    assert stretch.friction != pytest.approx(slope.friction, rel=1e-3)
    with pytest.raises(gs.InputError, match="strain_norm"):
        gs.solve_chain(RUBBER, SINES, solver="half_plane", conditions=under["stretch"], **LOAD)


def test_a_settled_direct_contact_is_its_own_rubber():
    """Rubber, strains and heat of the contact are those it was solved with."""
    found = gs.solve_rough_contact(RUBBER, LINE, conditions=BOTH, **DIRECT)
    assert found.converged
    assert found.passes <= 8
    state = found.scales
    heats, rise = temperature(found, BOTH, 0.05)
    at = [heat.wavenumber for heat in heats]
    warm = np.interp(np.log(state.wavenumber), np.log(at), rise.octave)
    assert warm == pytest.approx(state.warming, rel=5e-3, abs=0.1)
    moved = found.height + found.gap
    strain = strain_by_scale(found.grid, moved, found.active, state.wavenumber)
    assert strain == pytest.approx(state.strain, rel=5e-3)
    assert found.surface_warming == pytest.approx(rise.surface)
    assert state.strain[-1] > 10.0 * KRAUS.measured_at
    assert state.storage_modulus_ratio[-1] < 0.6


def test_by_scale_the_unchanged_rubber_is_the_rubber():
    """A law that softens nothing: answer, grid and errors of the rubber through that by scale.

    With a tolerance of 0.02 the last system is solved to 2e-5 of its pressures, from another start,
    and up to 2e-4 of the points in contact may be on the wrong side; other grids to 1e-4 and 1e-3.
    """
    nothing = Conditions(softening=Kraus(1.0, 1.0, 0.02, 1e-3, "shear"))
    load = DIRECT | {"tolerance": 0.02}
    plain, same = (
        gs.solve_rough_contact(RUBBER, LINE, conditions=conditions, **load)
        for conditions in (None, nothing)
    )
    assert same.friction == pytest.approx(plain.friction, rel=2e-5)
    assert same.contact_fraction == pytest.approx(plain.contact_fraction, rel=2e-4)
    assert same.grid.shape == plain.grid.shape
    assert same.friction_error == pytest.approx(plain.friction_error, rel=1e-2)
    assert same.contact_fraction_error == pytest.approx(plain.contact_fraction_error, rel=1e-2)


def test_heat_needs_the_length_of_the_footprint_in_the_direct_contact_and_a_shift():
    load = DIRECT | {"footprint": None}
    with pytest.raises(gs.InputError, match="footprint"):
        gs.solve_rough_contact(RUBBER, LINE, conditions=Conditions(heat=THERMAL), **load)
    for conditions in (Conditions(heat=THERMAL), Conditions(temperature=310.0)):
        with pytest.raises(gs.InputError, match="shift"):
            gs.solve_chain(gs.Rubber(5e6, [1e7], [1e-3]), SINES, conditions=conditions, **LOAD)
