"""Numbers down to each wavelength: steps of waves, octaves of harmonics, on one scale."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gripscale.questions.answer.samples import curve_at, octaves

WAVES = np.array([10e-3, 3e-3, 1e-3])
SPLIT = np.array([16e-3, 8e-3, 4e-3, 2e-3, 1e-3, np.nan])


def test_waves_add_in_steps() -> None:
    at = np.array([20e-3, 10e-3, 4e-3, 3e-3, 0.5e-3])
    friction = curve_at("friction", at, WAVES, np.array([0.1, 0.3, 0.4]), stepped=True)
    assert friction.tolist() == [0.0, 0.1, 0.1, 0.3, 0.4]
    area = curve_at("contact_fraction", at, WAVES, np.array([0.3, 0.1, 0.05]), stepped=True)
    assert area.tolist() == [1.0, 0.3, 0.3, 0.1, 0.05]


def test_octaves_are_interpolated_and_the_unknown_stays_unknown() -> None:
    at = np.array([32e-3, 16e-3, 8e-3, np.sqrt(32.0) * 1e-3, 0.5e-3])
    friction = np.array([0.0, 0.1, 0.3, 0.35, 0.4, np.nan])
    area = np.array([np.nan, 0.4, 0.2, 0.1, np.nan, np.nan])
    assert curve_at("friction", at, SPLIT, friction) == pytest.approx([0.0, 0.0, 0.1, 0.2, 0.4])
    np.testing.assert_allclose(
        curve_at("contact_fraction", at, SPLIT, area), [1.0, np.nan, 0.4, 0.3, 0.1]
    )


def test_scale_of_wavelengths_holds_all() -> None:
    ends = octaves(16e-3, 1e-3, 1e-3)
    assert ends == pytest.approx(1e-3 * 2.0 ** np.arange(4, -1, -1.0))
    assert octaves(math.nan, math.nan, 1e-3).size == 0
