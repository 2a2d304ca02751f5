"""The chain over both models of one wave: at small slope they must tell the same story.

Two waves of slope 0.063 and 0.05, a Zener rubber. The block is 1.5 wavelengths deep and finite
strain enters at the order of the slope, so less than a per cent is left between the two.
"""

import pytest

from gripscale.chain import solve_chain
from gripscale.rubber import Rubber
from gripscale.surface import SineStack

RUBBER = Rubber(6e6, [12e6], [1e-3], bulk_modulus=2e9)
SINES = SineStack(wavelength=[10e-3, 2e-3], amplitude=[0.1e-3, 0.016e-3])
LOAD = {"pressure": 1e5, "footprint": 0.1}


@pytest.mark.parametrize("speed", [0.3, 0.0])
def test_block_and_half_plane_agree_at_small_slope(speed):
    block = solve_chain(RUBBER, SINES, speed=speed, **LOAD)
    plane = solve_chain(RUBBER, SINES, speed=speed, solver="half_plane", **LOAD)
    assert {s.model for s in block.scales} == {"finite_strain"}
    assert {s.model for s in plane.scales} == {"half_plane"}
    assert 0.05 < plane.contact_fraction < 0.9
    for mine, reference in zip(block.scales, plane.scales, strict=True):
        assert mine.contact_fraction == pytest.approx(reference.contact_fraction, abs=0.004)
    assert block.friction == pytest.approx(plane.friction, rel=0.01, abs=1e-9)
    assert (plane.friction > 0.005) == (speed > 0.0)
