import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import SineStack, height_difference
from tests.samples import sine_profile

from .surface_cases import geometric_stack


def test_factors_follow_from_geometric_waves():
    stack = geometric_stack(0.03, 1e-3, 3.5, 2.4, 5)
    assert stack.s_wavelength == pytest.approx(3.5, rel=1e-12)
    assert stack.s_amplitude == pytest.approx(2.4, rel=1e-12)
    assert stack.residual is None
    assert len(stack) == 5


def test_waves_that_are_not_geometric_have_no_factors():
    stack = SineStack(wavelength=[1e-2, 5e-3, 1e-3], amplitude=[1e-3, 5e-4, 2.5e-4])
    assert stack.s_wavelength is None
    assert stack.s_amplitude == pytest.approx(2.0)


def test_one_wave_has_no_factors_and_its_closed_form():
    stack = SineStack(wavelength=[1e-2], amplitude=[2e-3])
    assert stack.s_wavelength is None
    assert stack.slope == pytest.approx([0.4 * np.pi])
    # A^2 (1 - cos kl): zero at a whole wave, A^2 at a quarter, 2 A^2 at half.
    assert stack.height_difference([1e-2, 2.5e-3, 5e-3]) == pytest.approx(
        [0, 4e-6, 8e-6], abs=1e-20
    )
    # k^2 A^2 l^2 / 2 at small lags, where 1 - cos would have lost its digits.
    assert stack.height_difference([1e-10]) == pytest.approx(
        (0.4 * np.pi * 1e-10) ** 2 / 2, rel=1e-9
    )


def test_height_difference_is_that_of_a_profile_with_random_phases():
    stack = geometric_stack(7e-3, 1e-3, 3.1, 2.3, 3)
    curve = height_difference(sine_profile(stack, 0.5, 2e-5, 4), max_lag=5e-3)
    # Cross terms of two waves average as 1/(pi L |1/lambda_1 - 1/lambda_2|) = 2 % of 2 A_1 A_2,
    # end effects of one as lambda/(2 pi L): 0.2 %; relative to C_z both are below 3 %.
    assert np.abs(curve.value / stack.height_difference(curve.lag) - 1.0).max() < 0.03


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"wavelength": [1e-2, 1e-3], "amplitude": [1e-3]}, "same length"),
        ({"wavelength": [], "amplitude": []}, "at least 1"),
        ({"wavelength": [1e-3, 1e-2], "amplitude": [1e-3, 1e-3]}, "must decrease .* at index 1"),
        ({"wavelength": [1e-2, 1e-2], "amplitude": [1e-3, 1e-3]}, "must decrease"),
        ({"wavelength": [1e-2], "amplitude": [0.0]}, "amplitude must be greater than zero"),
        ({"wavelength": [np.nan], "amplitude": [1e-3]}, "wavelength must be a list of finite"),
        ({"wavelength": [1e-2, 5e-3], "amplitude": [1, 1], "s_wavelength": 3.0}, "s_wavelength"),
        ({"wavelength": [1e-2], "amplitude": [1e-3], "residual": -1.0}, "residual must not be neg"),
        (
            {"wavelength": [1e-2], "amplitude": [1e-3], "cut_off": 0.02},
            "exceed the last wave, 0.01 m",
        ),
    ],
)
def test_bad_waves_are_refused(arguments, says):
    with pytest.raises(InputError, match=says):
        SineStack(**arguments)
