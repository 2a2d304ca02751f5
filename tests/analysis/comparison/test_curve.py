"""Numbers down to each wavelength: steps of waves, octaves of harmonics, on one scale."""

from __future__ import annotations

import numpy as np
import pytest

from gripscale.analysis.best_estimate import Curve, octaves

WAVES = Curve(
    np.array([10e-3, 3e-3, 1e-3]), np.array([0.3, 0.1, 0.05]), np.array([0.1, 0.3, 0.4]), True
)
SPLIT = Curve(
    np.array([16e-3, 8e-3, 4e-3, 2e-3, 1e-3]),
    np.array([np.nan, 0.4, 0.2, 0.1, np.nan]),
    np.array([0.0, 0.1, 0.3, 0.35, 0.4]),
    False,
)


def test_waves_add_in_steps() -> None:
    at = np.array([20e-3, 10e-3, 4e-3, 3e-3, 0.5e-3])
    assert WAVES.at("friction", at).tolist() == [0.0, 0.1, 0.1, 0.3, 0.4]
    assert WAVES.at("contact_fraction", at).tolist() == [1.0, 0.3, 0.3, 0.1, 0.05]


def test_octaves_are_interpolated_and_the_unknown_stays_unknown() -> None:
    at = np.array([32e-3, 16e-3, 8e-3, np.sqrt(32.0) * 1e-3, 0.5e-3])
    assert SPLIT.at("friction", at) == pytest.approx([0.0, 0.0, 0.1, 0.2, 0.4])
    np.testing.assert_allclose(SPLIT.at("contact_fraction", at), [1.0, np.nan, 0.4, 0.3, 0.1])


def test_scale_of_wavelengths_holds_all() -> None:
    found = octaves([WAVES, SPLIT], 1e-3)
    assert found == pytest.approx(1e-3 * 2.0 ** np.arange(4, -1, -1.0))
    assert octaves([], 1e-3).size == 0
