"""What a height difference correlation leaves open of its sine waves."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import (
    HeightDifference,
    fit_sines,
    height_difference,
    self_affine_profile,
    sine_ambiguity,
)

from .surface_cases import exact_curve, geometric_stack

FIRST = 24e-3


def with_band(curve, decades):
    value, factor = curve.value, 10.0**decades
    return HeightDifference(curve.lag, value, lower=value / factor, upper=value * factor)


def test_an_exact_curve_leaves_one_stack():
    stack = geometric_stack(FIRST, 2.5e-3, 3.5, 2.4, 5)
    curve = with_band(exact_curve(stack, 4e-5, FIRST / 4, lags=40), 1e-4)
    found = sine_ambiguity(curve, fit_sines(curve, scales=5))
    assert len(found.stacks) == 1
    assert found.waves == (5, 5)
    assert found.stacks[0].residual < 1e-5
    assert found.s_wavelength == pytest.approx((3.5, 3.5), rel=1e-3)
    assert found.rms_slope == pytest.approx((stack.rms_slope, stack.rms_slope), rel=1e-3)
    assert found.band == pytest.approx(1e-4)


def test_a_wider_band_leaves_more():
    stack = geometric_stack(FIRST, 2.5e-3, 3.5, 2.4, 5)
    curve = exact_curve(stack, 4e-5, FIRST / 4, lags=40)
    fit = fit_sines(curve, scales=5)
    few, many = (sine_ambiguity(with_band(curve, band), fit) for band in (0.01, 0.2))
    assert len(few.stacks) < len(many.stacks) <= many.tried


def test_a_random_profile_does_not_say_how_many_waves():
    curve = height_difference(self_affine_profile(0.8, 2e-3, 0.6e-3, 0.4, 50e-6, 3))
    fit = fit_sines(curve, scales=5, cut_off=0.4e-3)
    found = sine_ambiguity(curve, fit)
    assert 0.02 < found.band < 0.3
    assert found.waves.low <= 4
    assert found.waves.high >= 7
    assert found.s_wavelength.low < fit.s_wavelength < found.s_wavelength.high
    # whatever their number, they must agree on what the curve does say: slopes to the cut-off
    assert found.rms_slope.high < 1.5 * found.rms_slope.low


@pytest.mark.parametrize(
    ("stack", "says"), [(geometric_stack(FIRST, 1e-3, 3.0, 2.0, 4), "got 4, not fitted")]
)
def test_a_stack_that_was_not_fitted_is_refused(stack, says):
    with pytest.raises(InputError, match=says):
        sine_ambiguity(exact_curve(stack, 4e-5, 6e-3), stack)


def test_one_wave_is_refused():
    curve = exact_curve(geometric_stack(FIRST, 1e-3, 3.0, 2.0, 1), 1e-4, 6e-3)
    with pytest.raises(InputError, match="got 1, fitted"):
        sine_ambiguity(curve, fit_sines(curve, scales=1))


def test_a_curve_without_a_band_is_taken_as_known():
    curve = exact_curve(geometric_stack(FIRST, 1e-3, 3.0, 2.0, 4), 1e-4, 6e-3)
    assert not np.isfinite(curve.upper).any()
    assert sine_ambiguity(curve, fit_sines(curve, scales=4)).band == 0.0
