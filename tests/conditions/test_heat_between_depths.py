"""Uniform heat of sources at different depths, where each loses its energy."""

import numpy as np
import pytest

from gripscale.conditions import LossDepth, uniform_at_surface
from gripscale.conditions.flash_temperature import ierfc, uniform_from_others
from tests.samples import THERMAL


def exact(depth, other, time):
    """Return q l/(2 kappa) (E ierfc(|Z - Z'|/l) + E ierfc((Z + Z')/l)) of sampled depths."""
    draw = np.random.default_rng(1)
    length = 2.0 * np.sqrt(THERMAL.diffusivity * time)
    z, source = (draw.gamma(3, each.mean / 3.0, 400_000) for each in (depth, other))
    both = ierfc(np.abs(z - source) / length) + ierfc((z + source) / length)
    return float(length * both.mean() / (2.0 * THERMAL.conductivity))


@pytest.mark.parametrize("ratio", [2.0, 8.0, 32.0])
@pytest.mark.parametrize("spread", [1.0, 3.0, 10.0])
def test_the_deeper_of_two_depths_decides(spread, ratio):
    """2 sqrt(D t) = `spread` times the deeper depth: 20 % off where both are near, 5 % else."""
    deep, shallow = LossDepth(1e-4), LossDepth(1e-4 / ratio)
    time = (0.5e-4 * spread) ** 2 / THERMAL.diffusivity
    tops = [uniform_at_surface(time, each, THERMAL) for each in (deep, shallow)]
    error = 0.05 if ratio > 2.0 or spread > 1.0 else 0.2
    for which in (0, 1):
        rise = uniform_from_others([1.0, 1.0], tops, which)
        assert rise == pytest.approx(exact(deep, shallow, time), rel=error)


def test_what_lies_deeper_than_the_heat_spreads_stays_cold():
    deep, shallow, time = LossDepth(1e-2), LossDepth(1e-5), 0.1
    tops = [uniform_at_surface(time, each, THERMAL) for each in (deep, shallow)]
    assert uniform_from_others([0.0, 1.0], tops, 0) < 0.01 * tops[1]
