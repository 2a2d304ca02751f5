"""What rests on a rubber beyond its measured band: shares and decades by hand, and refusal."""

import math
import re

import numpy as np
import pytest

from gripscale.core.errors import ExtrapolationError, InputError
from gripscale.rubber import Rubber
from gripscale.rubber.extrapolation import (
    UNKNOWN,
    Extrapolation,
    by_wavelength,
    of_frequencies,
    of_spectrum,
    of_sum,
    require_measured,
)

RUBBER = Rubber(6e6, [2e6], [1e-3], valid_band=(10.0, 1e3))


def test_frequencies_are_told_by_how_far_they_go():
    assert of_frequencies(RUBBER, [10.0, 1e3]) == Extrapolation(0.0, 0.0, 0.0)
    both = of_frequencies(RUBBER, [0.1, -5e4, 100.0])
    assert (both.share, both.below) == (1.0, pytest.approx(2.0))
    assert both.above == pytest.approx(math.log10(50.0))
    assert both.furthest == "up to 2 decades below and 1.7 decades above the measured band"
    assert of_frequencies(RUBBER, [0.0, 100.0]).furthest == ""


def test_without_a_band_nothing_is_known():
    bare = Rubber(6e6, [2e6], [1e-3])
    for found in (of_frequencies(bare, 1e9), of_spectrum(bare, [1.0], [1.0])):
        assert math.isnan(found.share)
        assert not found.anywhere


def test_a_spectrum_is_shared_exactly_and_its_tails_are_not_how_far_it_goes():
    """0.4 % at 1e9 rad/s is in the share; the furthest that counts is 1e4 rad/s, a decade above."""
    omega, friction = np.array([1e9, 30.0, 1e4, 100.0]), np.array([0.004, 0.3, 0.196, 0.5])
    found = of_spectrum(RUBBER, omega, friction)
    assert found.share == pytest.approx(0.2)
    assert (found.below, found.above) == (0.0, pytest.approx(1.0))
    assert math.isnan(of_spectrum(RUBBER, omega, 0.0 * friction).share)


def test_friction_by_wavelength_counts_at_its_frequency():
    """At 1 m/s waves of 2 pi/100, 2 pi/400 and 2 pi/1600 m; intervals at 100, 200 and 800 rad/s."""
    wavelength, running = 2 * np.pi / np.array([100.0, 400.0, 1600.0]), np.array([0.1, 0.3, 0.4])
    assert by_wavelength(RUBBER, 1.0, wavelength, running) == Extrapolation(0.0, 0.0, 0.0)
    found = by_wavelength(RUBBER, 2.0, wavelength, running)
    assert found.share == pytest.approx(0.25)
    assert found.above == pytest.approx(math.log10(1.6))
    slow = by_wavelength(RUBBER, 0.02, wavelength, running)
    assert slow.share == pytest.approx(0.75)
    assert (slow.below, slow.above) == (pytest.approx(math.log10(5.0)), 0.0)
    assert by_wavelength(RUBBER, 0.0, wavelength, running) == Extrapolation(0.0, 0.0, 0.0)


def test_a_sum_shares_by_friction_and_goes_as_far_as_any():
    parts = [Extrapolation(1.0, 0.0, 2.0), Extrapolation(0.0, 0.0, 0.0), Extrapolation(0.5, 1, 0)]
    assert of_sum(parts, [0.1, 0.2, 0.1]) == Extrapolation(pytest.approx(0.375), 1.0, 2.0)
    assert math.isnan(of_sum(parts, [0.1, math.nan, 0.1]).share)
    assert of_sum(parts[1:2], [0.0]) == Extrapolation(0.0, 0.0, 0.0)
    assert math.isnan(of_sum([UNKNOWN, parts[1]], [0.1, 0.1]).share)
    nothing = Extrapolation(math.nan, 0.0, 0.0)
    assert of_sum([nothing, parts[2]], [0.0, 0.1]).share == pytest.approx(0.5)


LENGTHS = np.array([10e-3, 3e-3, 1e-3])


@pytest.mark.parametrize(
    ("speed", "wave", "side"), [(1.0, "wave 3 of 3", "above"), (1e-2, "wave 1 of 3", "below")]
)
def test_refusal_names_the_wave_and_what_the_data_carry(speed, wave, side):
    with pytest.raises(ExtrapolationError, match=rf"^{wave} .*{side} the measured band") as told:
        require_measured(RUBBER, LENGTHS, speed)
    assert isinstance(told.value, InputError)
    text = str(told.value)
    assert f"{2 * math.pi * speed / LENGTHS[2 if side == 'above' else 0]:.3g} rad/s" in text
    assert "10 to 1e+03 rad/s" in text
    carried = float(re.search(r"carry at (?:most|least) (\S+) m/s", text)[1])
    limit = 1e-3 * float(re.search(r"wavelength of (\S+) mm", text)[1])
    # what is offered is within the band, and next to its end
    require_measured(RUBBER, LENGTHS, carried)
    require_measured(RUBBER, [limit], speed)
    away = 1.01 if side == "above" else 0.99
    for refused in ((LENGTHS, carried * away), ([limit / away], speed)):
        with pytest.raises(ExtrapolationError):
            require_measured(RUBBER, *refused)


def test_nothing_is_refused_at_rest_or_without_a_band():
    require_measured(RUBBER, LENGTHS, 0.0)
    require_measured(Rubber(6e6, [2e6], [1e-3]), LENGTHS, 1e9)
