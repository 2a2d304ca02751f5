"""The interval of 90 % holds the true value in 90 % of the measurements: that is what it claims.

Of 50 measurements 45 are expected. With 41 to 49 of them the claim passes with probability 0.97
for one parameter (binomial: 0.0245 for 40 or fewer, 0.0052 for all 50).
"""

import numpy as np
import pytest
import scipy.stats

from gripscale.conditions import LeGalKlueppelStress
from gripscale.questions.calibration.calibration_law import points_of, problem_of
from gripscale.questions.calibration.profile_likelihood import best, intervals

from .synthetic import REFERENCE, TRUTH, fitted, measurement

SETS = 50
FEWEST, MOST = 41, 49


def held(fits, truth):
    """Return in how many fits the interval of each parameter holds its true value."""
    return {
        name: sum(
            one.low <= true <= one.high for fit in fits for one in fit.estimates if one.name == name
        )
        for name, true in truth.items()
    }


def test_the_band_is_one_of_binomial_probability_097():
    counts = scipy.stats.binom(SETS, 0.9)
    assert counts.cdf(MOST) - counts.cdf(FEWEST - 1) == pytest.approx(0.970, abs=0.001)


def test_intervals_hold_the_true_parameters_as_often_as_they_say():
    """Where the profile is below its threshold, at a tenth of the time of the intervals.

    With half the spread the excess would be four times as large: ends at 1.645/2 standard errors
    hold 0.59 of the true values.
    """
    ratios = {name: np.empty(SETS) for name in TRUTH}
    for seed in range(SETS):
        problem = problem_of("gaussian", points_of(*measurement(seed=seed)), REFERENCE)
        optimum = best(problem)
        for place, one in enumerate(problem.free):
            excess, _ = optimum.excess(place, one.scaled(TRUTH[one.name]))
            ratios[one.name][seed] = excess / optimum.threshold
    for name, ratio in ratios.items():
        assert FEWEST <= (ratio < 1.0).sum() <= MOST, name
        assert (4.0 * ratio < 1.0).sum() < FEWEST, name


@pytest.mark.verification
@pytest.mark.parametrize("stated", [True, False])
def test_intervals_over_many_measurements(stated):
    """Of 400, 360 are expected; 342 to 377 hold with probability 0.997 for one parameter."""
    fits = [
        fitted(*measurement(seed=1000 + seed, stated=stated), fixed=REFERENCE)
        for seed in range(400)
    ]
    for name, count in held(fits, TRUTH).items():
        assert 342 <= count <= 377, (name, count)


@pytest.mark.verification
def test_intervals_of_the_other_law():
    truth = {"stress_0": 2e6, "ratio": 3.0, "critical_speed": 0.01, "exponent": 0.8}
    law = LeGalKlueppelStress(**truth)
    fits = [fitted(*measurement(law, seed=seed), law="le_gal_klueppel") for seed in range(200)]
    for name, count in held(fits, truth).items():
        assert 166 <= count <= 192, (name, count)  # probability 0.997


def test_an_interval_ends_where_the_profile_says():
    problem = problem_of("gaussian", points_of(*measurement()), REFERENCE)
    optimum, ends = intervals(problem)
    threshold = optimum.threshold
    assert threshold == pytest.approx(2.7055, abs=1e-4)  # chi^2 of one degree, 90 %
    for place, interval in enumerate(ends):
        for end in interval:
            # the distance to an end is known to 1e-3, its square to twice that
            assert optimum.excess(place, end)[0] == pytest.approx(threshold, rel=4e-3)


def test_the_profile_of_a_factor_is_a_parabola():
    """A parameter that only multiplies, not in logarithms: linear least squares in closed form."""
    measured, predicted = measurement()
    fit = fitted(measured, predicted, law="constant")
    one = fit.estimates[0]
    weight = predicted.leverage / measured.spread
    error = 1.0 / np.sqrt(weight @ weight)
    best = (weight @ ((measured.friction - predicted.friction) / measured.spread)) * error**2
    assert one.value == pytest.approx(best, rel=1e-7)
    assert one.standard_error == pytest.approx(error, rel=1e-5)
    half = np.sqrt(2.7055) * error
    assert (one.low, one.high) == pytest.approx((best - half, best + half), rel=1e-4)
    band = np.sqrt(2.7055) * error * predicted.leverage
    assert fit.data.friction_band.values == pytest.approx(band, rel=1e-3)


def test_without_spreads_the_residuals_give_them():
    measured, predicted = measurement(stated=False)
    fit = fitted(measured, predicted, law="constant")
    one, freedom = fit.estimates[0], measured.speed.size - 1
    apart = fit.data.difference.values
    scatter = np.sqrt(apart @ apart / freedom)
    assert fit.data.attrs["scatter"] == pytest.approx(scatter)
    error = scatter / np.sqrt(predicted.leverage @ predicted.leverage)
    assert one.standard_error == pytest.approx(error, rel=1e-5)
    half = scipy.stats.t.ppf(0.95, freedom) * error
    assert (one.low, one.high) == pytest.approx((one.value - half, one.value + half), rel=1e-4)


def test_well_determined_intervals_are_the_standard_errors():
    """Where the valley is nearly straight half an interval is 1.645 standard errors."""
    for one in fitted(*measurement(seed=None), fixed=REFERENCE).estimates:
        assert 0.5 * (one.high - one.low) == pytest.approx(1.645 * one.standard_error, rel=0.05)
