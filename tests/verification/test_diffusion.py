"""Diffusion over four octaves against the direct contact of whole Gaussian maps."""

from __future__ import annotations

import numpy as np
import pytest

from gripscale.rubber import styrene_butadiene
from tests.samples import MAXWELL, POWER_LAW, ZENER
from tests.verification.families import tread
from tests.verification.gaussian_maps import GaussianCase, judged

pytestmark = pytest.mark.verification

CASES = [
    GaussianCase(0.5, tread(), 0.3, 0.02, 301),
    GaussianCase(0.7, tread(), 30.0, 0.1, 302),
    GaussianCase(0.9, tread(), 0.003, 0.4, 303),
    GaussianCase(0.6, styrene_butadiene(), 0.1, 0.1, 304),
    GaussianCase(0.85, styrene_butadiene(), 1.0, 0.02, 305),
    GaussianCase(0.8, POWER_LAW, 1.0, 0.05, 306),
    GaussianCase(0.55, POWER_LAW, 1.0, 0.3, 307),
    GaussianCase(0.65, ZENER, 1.0, 0.03, 308),
    GaussianCase(0.75, ZENER, 3.0, 0.1, 309),
    GaussianCase(0.8, MAXWELL, 0.1, 0.05, 310),
]
"""Maps, rubbers and loads that the constants were not fitted to; 2 to 50 % of contact."""


def test_four_octaves_of_gaussian_maps():
    """1024 x 1024 points; 10 s of one core each."""
    ratios = np.array([judged(case, points=1024, octaves=4) for case in CASES])
    print(np.round(ratios, 3))
    area, friction = np.abs(ratios - 1.0).T
    assert area.max() < 0.10
    assert friction.max() < 0.05
