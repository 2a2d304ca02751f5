import numpy as np
import pytest

from gripscale.surface import HeightDifference
from gripscale.surface.height_difference import find_plateau, log_weights

LAG = np.geomspace(1e-4, 1.0, 81)


def test_the_level_is_the_median_of_what_has_settled():
    value = np.minimum(LAG / 1e-2, 1.0) ** 1.5
    value[-8:] = np.linspace(1.1, 1.3, 8)  # a drift over less than half a decade
    plateau = find_plateau(HeightDifference(LAG, value))
    # Less than half of the plateau drifts: its median is not moved at all.
    assert plateau.level == pytest.approx(1.0, rel=1e-12)


def test_it_begins_where_the_mean_of_the_rest_is_nearly_reached():
    value = np.minimum(LAG / 1e-2, 1.0) ** 1.5
    plateau = find_plateau(HeightDifference(LAG, value))
    # 90 % of 1 is reached at 0.9^(1/1.5) of the cut-off: between the last two lags before it.
    assert 0.88e-2 < plateau.lag < 1.001e-2


def test_the_curve_of_a_sine_settles_at_its_mean_over_phases():
    lag = np.geomspace(1e-4, 1.0, 400)
    value = 4.0 * (1.0 - np.cos(2.0 * np.pi * lag / 1e-2))
    plateau = find_plateau(HeightDifference(lag, value))
    # Cosines are positive as often as negative, but in log lag the first hump, from a quarter to
    # three quarters of a wave, is the widest: half a decade of two and a half, hence 20 %.
    assert plateau.level == pytest.approx(4.0, rel=0.2)
    assert plateau.lag == pytest.approx(0.25e-2, rel=0.1)


@pytest.mark.parametrize("exponent", [0.6, 1.0, 2.0])
def test_a_curve_that_rises_to_its_end_has_none(exponent):
    assert find_plateau(HeightDifference(LAG, LAG**exponent)) is None


def test_decades_count_alike():
    weight = log_weights(np.array([1.0, 10.0, 100.0, 1000.0]))
    assert weight == pytest.approx([0.5, 1.0, 1.0, 0.5])
    assert log_weights(np.array([3.0])) == pytest.approx([1.0])
