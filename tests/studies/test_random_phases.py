"""Surfaces of the same spectrum with random phases."""

import numpy as np
import pytest

from gripscale.half_space.grid import joined
from gripscale.surface import HeightMap, Profile, height_difference, self_affine_profile
from gripscale.surface.resampling import fill_gaps
from studies.random_phases import random_phases
from tests.half_space.rough_cases import isotropic_map

LINE = self_affine_profile(0.8, 5e-3, 1e-3, 0.2, 1e-4, seed=4)


def test_random_phases_keep_the_height_difference_correlation():
    drawn = random_phases(LINE, seed=1)
    lags = height_difference(LINE).lag
    keep = lags < 2e-3
    before = height_difference(Profile(LINE.x, joined(LINE.z))).value[keep]
    after = height_difference(drawn).value[keep]
    # open ends count differently: one pair in a hundred at the longest lag
    np.testing.assert_allclose(after, before, rtol=0.1)
    assert np.corrcoef(drawn.z, LINE.z)[0, 1] < 0.5
    assert isinstance(random_phases(isotropic_map(64), seed=1), HeightMap)


def test_random_phases_have_the_steep_lines_that_bridge_gaps():
    # Plateaus 0.2 mm apart in height; between them, every 4 mm, ten points are missing.
    x = 1e-4 * np.arange(4000)
    low = (np.arange(x.size) // 40) % 2 == 0
    z = np.where(low, 0.0, 2e-4) + 1e-6 * np.random.default_rng(5).standard_normal(x.size)
    line = Profile(x, np.where(np.arange(x.size) % 40 < 10, np.nan, z))
    measured, bridged, drawn = (
        height_difference(one, max_lag=2e-4).value[0]
        for one in (line, Profile(x, joined(fill_gaps(line.z))), random_phases(line, seed=1))
    )
    # One flank a gap of eleven steps: a quarter of the steps rise by 0.2 mm / 11.
    assert bridged == pytest.approx(11 / 40 * (2e-4 / 11) ** 2, rel=0.05)
    assert drawn == pytest.approx(bridged, rel=0.05)
    assert measured == pytest.approx(2e-12, rel=0.1)
