"""Shares of variance against functions whose Sobol indices are known in closed form."""

import numpy as np
import pytest

from gripscale.questions import shares


def evenly(samples, seed, count):
    """Return numbers spread evenly from -1 to 1, a column for each source: variance 1/3."""
    random = np.random.default_rng(seed)
    places = np.array([random.permutation(samples) for _ in range(count)])
    return (2.0 * (places + random.random(places.shape)) / samples - 1.0).T


def answer(x):
    """Return exp(3 x_0 + 2 x_1 + 3 x_2^2 + 2 x_3 x_4), x evenly spread from -1 to 1.

    Variances: 9/3, 4/3, 9 (1/5 - 1/9) = 4/5, and 4/9 of the interaction, which is nobody's own.
    """
    return np.exp(3 * x[:, 0] + 2 * x[:, 1] + 3 * x[:, 2] ** 2 + 2 * x[:, 3] * x[:, 4])


VARIANCES = np.array([3.0, 4 / 3, 0.8, 0.0, 0.0])
EXACT = VARIANCES / (VARIANCES.sum() + 4 / 9)


def estimated(samples, seed):
    x = evenly(samples, seed, 5)
    return shares(answer(x), {f"x{k}": x[:, [k]] for k in range(5)})


def test_known_indices_are_met():
    """With 4000 samples the standard error of a share is 0.01; four of them are let through."""
    found = estimated(4000, 1)
    assert (found.error < 0.015).all()
    np.testing.assert_allclose(found.share, EXACT, atol=0.04)
    assert 1.0 - found.share.sum() == pytest.approx(4 / 9 / (VARIANCES.sum() + 4 / 9), abs=0.02)


def of_repeats(evenly_spread):
    """Return the shares of 40 repeats of 100 samples, and the errors they tell."""
    found = []
    for seed in range(40):
        x = 2.0 * np.random.default_rng(seed).random((100, 5)) - 1.0
        x = evenly(100, seed, 5) if evenly_spread else x
        found.append(shares(answer(x), {f"x{k}": x[:, [k]] for k in range(5)}))
    return np.array([one.share for one in found]), np.mean([one.error for one in found], axis=0)


def test_the_error_is_that_of_repeated_independent_samples():
    """The jackknife against the scatter of 40 repeats, itself known to 1/sqrt(80) = 11 %."""
    found, told = of_repeats(evenly_spread=False)
    np.testing.assert_allclose(told[:3], found.std(axis=0, ddof=1)[:3], rtol=0.35)


def test_evenly_spread_samples_are_no_worse_than_their_error():
    """They scatter less than independent ones; no share is off by more than its repeats tell."""
    found, told = of_repeats(evenly_spread=True)
    scatter = found.std(axis=0, ddof=1)
    assert (scatter[:3] < 1.2 * told[:3]).all()
    bias = found.mean(axis=0) - EXACT
    assert (np.abs(bias) < 3.5 * scatter / np.sqrt(40)).all(), bias


def test_a_source_of_several_numbers_has_one_share():
    x = evenly(2000, 3, 4)
    y = np.exp(x[:, 0] + x[:, 1] + 2 * x[:, 2])
    found = shares(y, {"two": x[:, :2], "one": x[:, [2]], "none": x[:, [3]]})
    np.testing.assert_allclose(found.share, [1 / 3, 2 / 3, 0.0], atol=0.03)


def test_no_effect_is_not_told_from_nothing():
    x = evenly(60, 5, 3)
    noise = np.random.default_rng(5).standard_normal(60)
    found = shares(np.exp(x[:, 0] + x[:, 1] + noise), {f"x{k}": x[:, [k]] for k in range(3)})
    assert found.share[2] < 1.645 * found.error[2]


def test_failed_samples_do_not_count():
    x = evenly(400, 6, 5)
    y = answer(x)
    whole = shares(y[40:], {f"x{k}": x[40:, [k]] for k in range(5)})
    y[:40] = np.nan
    found = shares(y, {f"x{k}": x[:, [k]] for k in range(5)})
    np.testing.assert_array_equal(found.share, whole.share)


@pytest.mark.parametrize("samples", [8, 0])
def test_too_few_samples_tell_nothing(samples):
    x = evenly(max(samples, 1), 7, 3)[:samples]
    assert shares(np.exp(x[:, 0]), {f"x{k}": x[:, [k]] for k in range(3)}) is None
