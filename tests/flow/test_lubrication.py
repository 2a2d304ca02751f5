"""Squeeze-out and mixed lubrication against Stefan and the dry limit."""

import math

import numpy as np
import pytest

import gripscale as gs
from gripscale.flow import GapCurve, gap_curve, squeeze_out, wet_friction
from tests.closed_forms import stefan_time
from tests.half_space.rough_cases import isotropic_map
from tests.samples import ZENER

LENGTH, LOAD, VISCOSITY = 0.02, 3e5, 1e-3
PLATES = GapCurve(
    pressure=np.array([1e-3, LOAD]),
    mean_gap=np.array([1.01e-8, 1e-8]),
    flow_factor=np.ones(2),
    friction=np.zeros(2),
    rms_height=math.inf,
)
"""Smooth plates that meet at a hundredth of a micrometre."""
ROUGH = GapCurve(
    pressure=LOAD * np.geomspace(0.01, 1.0, 8),
    mean_gap=np.geomspace(4e-4, 5e-5, 8),
    flow_factor=np.geomspace(0.8, 0.02, 8),
    friction=np.linspace(0.2, 0.1, 8),
    rms_height=1e-4,
)


def test_parallel_plates_thin_as_stefan_says():
    water = squeeze_out(PLATES, film=1e-3, length=LENGTH, pressure=LOAD)
    for film in (5e-4, 1e-4, 1e-5):
        time = float(np.interp(-film, -water.mean_gap, water.time))
        expected = stefan_time(LENGTH, LOAD, VISCOSITY, 1e-3, film)
        assert time == pytest.approx(expected, rel=1e-2)


def test_slow_passage_is_dry_and_fast_passage_floats():
    water = squeeze_out(ROUGH, film=1e-3, length=LENGTH, pressure=LOAD)
    slow, fast = (water.until(t, water.asperity_share) for t in (1e4 * water.time[-1], 1e-7))
    assert slow == pytest.approx(1.0, abs=1e-2)
    assert fast < 1e-2
    stress = water.until(1e4 * water.time[-1], ROUGH.friction_stress(water.asperity_share * LOAD))
    assert stress / LOAD == pytest.approx(ROUGH.friction[-1], rel=1e-2)


def test_water_below_the_gap_of_the_contact_is_dry():
    water = squeeze_out(ROUGH, film=1e-5, length=LENGTH, pressure=LOAD)
    assert water.until(1e-3, water.asperity_share) == pytest.approx(1.0)


def test_a_gap_that_does_not_percolate_keeps_its_water():
    closed = GapCurve(ROUGH.pressure, ROUGH.mean_gap, np.zeros(8), ROUGH.friction, math.inf)
    water = squeeze_out(closed, film=2e-4, length=LENGTH, pressure=LOAD)
    expected = float(closed.contact_pressure(np.array(2e-4))) / LOAD
    assert water.until(1.0, water.asperity_share) == pytest.approx(expected, rel=1e-6)


def test_wet_friction_of_a_map_falls_with_speed():
    surface = isotropic_map(32, shortest=3.2e-3)
    data = wet_friction(
        ZENER,
        surface,
        pressure=5e4,
        speeds=[0.01, 300.0],
        film=2e-3,
        length=LENGTH,
        periodic=True,
        tolerance=None,
    )
    slow, fast = data.isel(speed=0), data.isel(speed=1)
    assert float(slow.asperity_share) > 0.95
    assert float(fast.asperity_share) < 0.6
    assert float(slow.friction) == pytest.approx(float(slow.dry_friction), rel=0.1)
    assert "Inertia" in data.notes
    assert float(slow.reduced_reynolds) < 1.0 < float(fast.reduced_reynolds)
    assert float(slow.film) < float(fast.film) < 2e-3


def test_a_line_and_a_negative_film_are_refused():
    x = np.arange(64) * 1e-5
    with pytest.raises(gs.InputError, match="map"):
        gap_curve(ZENER, gs.Profile(x, 1e-6 * np.cos(1e5 * x)), pressure=1e5, speed=1.0)
    with pytest.raises(gs.InputError, match="film"):
        squeeze_out(ROUGH, film=-1e-3, length=LENGTH, pressure=LOAD)
