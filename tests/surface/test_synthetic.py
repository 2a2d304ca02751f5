import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import height_difference, self_affine_profile


@pytest.mark.parametrize("hurst", [0.4, 0.8, 1.0])
def test_self_affine_profiles_have_the_curve_they_promise(hurst):
    curves = [
        height_difference(line, max_lag=0.02, steepest=np.inf)
        for line in (self_affine_profile(hurst, 2e-3, 1e-3, 0.8, 5e-5, seed) for seed in range(12))
    ]
    mean = np.mean([curve.value for curve in curves], axis=0)
    promised = 1e-6 * (1.0 - np.exp(-((curves[0].lag / 2e-3) ** (2.0 * hurst))))
    # 12 x 400 cut-offs of independent heights: about sqrt(2 x 2 / 4800) = 3 %; four of them.
    assert np.abs(mean / promised - 1.0).max() < 0.12


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((1.2, 1e-3, 1e-3, 0.1, 1e-4, 0), "hurst must be at most 1"),
        ((0.8, -1.0, 1e-3, 0.1, 1e-4, 0), "xi_parallel must be greater than zero"),
        ((0.8, 1e-3, 1e-3, 0.1, 1e-1, 0), "must give 16 to"),
        ((0.8, 1e-3, 1e-3, 0.1, 1e-12, 0), "must give 16 to"),
        ((0.8, 1e-3, 1e-3, 0.1, 1e-4, -1), "seed must be a whole number"),
    ],
)
def test_bad_arguments_are_refused(arguments, says):
    with pytest.raises(InputError, match=says):
        self_affine_profile(*arguments)
