"""Windows of a profile, spread over it and made one period."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.half_space import one_period, spread_windows
from gripscale.half_space.grid import periodic_heights
from gripscale.surface import Profile, self_affine_profile

LINE = self_affine_profile(0.8, 5e-3, 1e-3, 0.2, 1e-4, seed=4)


def test_one_period_is_what_the_direct_contact_sees():
    period = one_period(LINE, 2e-3)
    there = periodic_heights(LINE, smallest_wavelength=2e-3, periodic=False)
    here = periodic_heights(period, smallest_wavelength=None, periodic=True)
    assert here.grid.lengths == pytest.approx(there.grid.lengths, rel=1e-12)
    # but for waves below half the cut-off, of which 1/16 is left: the period has no points for them
    np.testing.assert_allclose(here.on((800,)), there.on((800,)), atol=1e-2 * np.ptp(LINE.z))


def test_windows_are_spread_over_all_profiles():
    other = Profile(LINE.x + 1.0, LINE.z)
    found = spread_windows([LINE, other], 0.02, 5)
    assert len(found) == 5
    assert found[0].x[0] < 0.02
    assert found[-1].x[0] > 1.15
    assert len(spread_windows([LINE], 0.02, 1000)) == 10


@pytest.mark.parametrize("most", [0, 2.5])
def test_the_number_of_windows_is_a_whole_one(most):
    with pytest.raises(InputError, match="most"):
        spread_windows([LINE], 0.02, most)
