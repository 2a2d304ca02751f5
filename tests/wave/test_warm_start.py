"""A neighbouring solution to start from: the same answer, sooner."""

import dataclasses
import pickle

import numpy as np
import pytest

import gripscale as gs
from tests.samples import FAST_RUBBER as RUBBER

LOAD = {"pressure": 3e6, "load_time": 1e-3}
WAVE = {"wavelength": 1e-3, "amplitude": 1.5e-4}


@pytest.mark.parametrize("varied", ["speed", "pressure", "amplitude"])
def test_a_warm_start_finds_the_same_solution_sooner(varied):
    load = WAVE | LOAD | {"speed": 1.0}
    first = gs.solve_scale(RUBBER, **load)
    load[varied] *= 1.1
    cold = gs.solve_scale(RUBBER, **load)
    warm = gs.solve_scale(RUBBER, **load, start=first)
    assert warm.converged
    assert warm.friction == pytest.approx(cold.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(cold.contact_fraction, abs=1e-6)
    assert warm.details["load_steps"] < cold.details["load_steps"]
    assert warm.contact_fraction_error == pytest.approx(cold.contact_fraction_error, rel=1e-3)


# A large wave is solved by several threads, to the same last bit as by one.


def fields(result):
    """Return every number of a result."""
    return pickle.dumps(dataclasses.asdict(dataclasses.replace(result, solution=None)))


def scale(workers, speed, order):
    """Solve a mesh of which most pieces of work are worth a thread."""
    mesh = {"columns": 768 // order, "rows": 36 // order, "element_order": order}
    return gs.solve_scale(RUBBER, **WAVE, **LOAD, **mesh, speed=speed, workers=workers)


def profile(workers, speed, order):
    """Solve a profile of two waves."""
    x = np.arange(64) * 1.6e-5
    z = 1e-4 * np.cos(2e3 / 1.024 * np.pi * x) + 2e-5 * np.cos(6e3 / 1.024 * np.pi * x)
    mesh = {"columns": 768 // order, "rows": 36 // order, "element_order": order}
    road = gs.Profile(x, z)
    return gs.solve_profile(
        RUBBER, road, **LOAD, **mesh, speed=speed, periodic=True, workers=workers
    )


@pytest.mark.parametrize("solve", [scale, profile])
@pytest.mark.parametrize(("speed", "order"), [(1.0, 1), (0.0, 2)])
def test_no_bit_depends_on_the_number_of_workers(solve, speed, order):
    one = solve(1, speed, order)
    assert one.converged
    assert fields(solve(3, speed, order)) == fields(one)


def test_no_bit_of_a_run_in_time_depends_on_the_number_of_workers():
    stages = [gs.Stage(3e-6, 1.0, 3e6)]
    mesh = {"columns": 512, "rows": 32}

    def run(workers):
        found = gs.solve_transient(RUBBER, **WAVE, **mesh, stages=stages, workers=workers)
        return [found.friction.tobytes(), found.contact_fraction.tobytes()]

    assert run(2) == run(1)
