"""Random loads of real roads from a cold start, and warm starts along sweeps."""

import sys
from pathlib import Path

import numpy as np
import pytest

import gripscale as gs

sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from load_grid import cases

CASES = cases(30)


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"case {case.number}")
def test_a_random_load_converges_cold(case):
    result = gs.solve_scale(case.rubber, **case.arguments(), columns=64, rows=12)
    assert result.status == "converged"
    # 5 % is what 64 columns owe to narrow, nearly elastic contacts (A/lambda 0.35, 4 nodes).
    assert result.friction_mismatch < 0.07
    assert 0.0 < result.contact_fraction <= 1.0
    assert 0.0 < result.min_stretch < 1.0 < result.max_stretch


def test_the_random_loads_cover_the_range():
    slopes = [case.slope for case in CASES]
    pressures = [case.pressure_ratio for case in CASES]
    losses = [case.loss_factor for case in CASES]
    assert min(slopes) < 0.06
    assert max(slopes) > 0.3
    assert min(pressures) < 0.05
    assert max(pressures) > 0.7
    assert min(losses) < 0.08
    assert max(losses) > 0.6
    assert any(np.isinf(case.passages) for case in CASES)


@pytest.mark.parametrize("varied", ["speed", "pressure", "amplitude"])
def test_a_warm_start_finds_the_same_solution_sooner(varied):
    material = gs.Rubber(3e6, [6e6, 9e6], [2e-5, 2e-4], bulk_modulus=1e9)
    load = {
        "wavelength": 1e-3,
        "amplitude": 1.5e-4,
        "pressure": 3e6,
        "speed": 1.0,
        "load_time": 1e-3,
    }
    first = gs.solve_scale(material, **load)
    load[varied] *= 1.1
    cold = gs.solve_scale(material, **load)
    warm = gs.solve_scale(material, **load, start=first)
    assert warm.converged
    assert warm.friction == pytest.approx(cold.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(cold.contact_fraction, abs=1e-6)
    assert warm.details["load_steps"] < cold.details["load_steps"]
    assert warm.contact_fraction_error == pytest.approx(cold.contact_fraction_error, rel=1e-3)


def test_a_chain_starts_from_its_neighbour_along_a_sweep():
    material = gs.Rubber(3e6, [6e6, 9e6], [2e-5, 2e-4], bulk_modulus=1e9)
    sines = gs.SineStack(wavelength=[1e-2, 2e-3], amplitude=[1e-3, 2e-4])
    load = {"pressure": 3e5, "footprint": 0.1, "columns": 64, "rows": 12}
    first = gs.predict(material, sines, speed=1.0, **load)
    cold = gs.predict(material, sines, speed=1.2, **load)
    warm = gs.predict(material, sines, speed=1.2, **load, start=first)
    assert warm.friction == pytest.approx(cold.friction, rel=1e-6)
    assert warm.contact_fraction == pytest.approx(cold.contact_fraction, rel=1e-6)
    steps = [sum(s.details["load_steps"] for s in p.scales) for p in (warm, cold)]
    assert steps[0] < steps[1]
