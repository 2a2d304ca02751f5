"""A neighbouring solution to start from: the same answer, sooner."""

import pytest

import gripscale as gs
from tests.samples import FAST_RUBBER as RUBBER


@pytest.mark.parametrize("varied", ["speed", "pressure", "amplitude"])
def test_a_warm_start_finds_the_same_solution_sooner(varied):
    load = {
        "wavelength": 1e-3,
        "amplitude": 1.5e-4,
        "pressure": 3e6,
        "speed": 1.0,
        "load_time": 1e-3,
    }
    first = gs.solve_scale(RUBBER, **load)
    load[varied] *= 1.1
    cold = gs.solve_scale(RUBBER, **load)
    warm = gs.solve_scale(RUBBER, **load, start=first)
    assert warm.converged
    assert warm.friction == pytest.approx(cold.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(cold.contact_fraction, abs=1e-6)
    assert warm.details["load_steps"] < cold.details["load_steps"]
    assert warm.contact_fraction_error == pytest.approx(cold.contact_fraction_error, rel=1e-3)


def test_a_chain_starts_from_its_neighbour_along_a_sweep():
    sines = gs.SineStack(wavelength=[1e-2, 2e-3], amplitude=[1e-3, 2e-4])
    load = {"pressure": 3e5, "footprint": 0.1, "columns": 64, "rows": 12}
    first = gs.solve_chain(RUBBER, sines, speed=1.0, **load)
    cold = gs.solve_chain(RUBBER, sines, speed=1.2, **load)
    warm = gs.solve_chain(RUBBER, sines, speed=1.2, **load, start=first)
    assert warm.friction == pytest.approx(cold.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(cold.contact_fraction, rel=1e-6)
    steps = [sum(s.details["load_steps"] for s in p.scales) for p in (warm, cold)]
    assert steps[0] < steps[1]
