"""Rubbers and results draw themselves."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.surface import self_affine_profile
from tests.samples import SHIFTED_RUBBER

ROAD = self_affine_profile(0.8, 2e-3, 1e-4, 0.1, 1e-4, seed=1)


def test_a_direct_contact_is_drawn():
    contact = gs.solve_rough_contact(
        SHIFTED_RUBBER, ROAD, pressure=3e5, speed=1.0, smallest_wavelength=2e-3
    )
    heights, pressure, running, stretch = contact.plot().axes
    (line,) = pressure.get_lines()
    assert np.nanmax(line.get_ydata()) == pytest.approx(contact.pressure.max() / 1e6)
    load, friction = (line.get_ydata()[-1] for line in running.get_lines())
    assert (load, friction) == pytest.approx((1.0, 1.0), abs=1e-5)
    assert len(heights.get_lines()) == 3
    lower, upper, touching = (np.asarray(line.get_ydata()) for line in stretch.get_lines())
    inside = np.isfinite(lower)
    assert (upper[inside] >= lower[inside] - 1e-9).all()  # [mm]: rubber lies on the road
    touched = np.isfinite(touching)
    np.testing.assert_allclose(touching[touched], upper[touched], atol=1e-6)
    assert stretch.get_aspect() == 1.0
