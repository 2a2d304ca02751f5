"""Samples of models: means, scatter and factors, and numbers down to each wavelength.

A failed sample is in no mean and is counted; what is not known stays so.
"""

import math

import numpy as np
import pytest
import xarray as xr

from gripscale.questions.answer import samples
from gripscale.questions.answer.samples import (
    curve_at,
    in_quadrature,
    log_error_of_mean,
    ratio,
    relative_uncertainty,
    usable,
)


def failed(subject=""):
    names = ("prediction_status", "prediction_status_word")
    return {**dict.fromkeys(names, "tolerance not met"), "subject": subject}


def test_failed_sample_is_in_no_mean_and_is_counted(solved):
    member, alone = solved((0.02, 0.3), failed(), (0.04, 0.5)), solved(failed())
    assert usable(member, "contact_fraction").mean() == pytest.approx(0.03)
    spread = samples.spread(usable(member, "friction"))
    assert spread == pytest.approx(np.std([0.3, 0.5], ddof=1))
    assert samples.status(member) == "1 of 3 samples failed: tolerance not met"
    assert samples.status_word(member) == samples.status(alone) == "tolerance not met"
    assert int(samples.converged(member).sum()) == 2
    assert math.isnan(usable(alone, "friction").mean())
    assert math.isnan(ratio(member, alone, "friction")[0])


def test_uncertainty_is_scatter_and_estimated_error(solved):
    two = [{"contact_fraction": 0.02, "friction": mu, "friction_error": 0.03} for mu in (0.3, 0.5)]
    scatter, error = np.std([0.3, 0.5], ddof=1) / math.sqrt(2) / 0.4, 0.03 / 0.4
    both = relative_uncertainty(solved(*two), "friction")
    assert both == pytest.approx(math.hypot(scatter, error))
    assert relative_uncertainty(solved(two[0]), "friction") == pytest.approx(0.1)
    assert math.isnan(relative_uncertainty(solved((0.02, 0.3)), "friction"))


def test_seeds_of_one_profile_tell_nothing_of_another(solved):
    starts = {"first": 0.3, "second": 0.5}
    drawn = [(0.02, mu + 0.001 * seed, name) for name, mu in starts.items() for seed in range(10)]
    member = solved(*drawn)
    assert usable(member, "friction").mean() == pytest.approx(0.4045)
    assert relative_uncertainty(member, "friction") == pytest.approx(0.1 / 0.4045)
    alone = relative_uncertainty(solved(*((area, mu, "") for area, mu, _ in drawn)), "friction")
    assert alone < 0.06


def test_pairs_are_compared_with_their_like(solved):
    """Windows differ by a factor of four among themselves, and by 2 % between two models."""
    areas, names = np.array([0.02, 0.04, 0.08]), ["window 1", "window 2", "window 3"]
    small = solved(*zip(areas, areas, names, strict=True))
    finite = solved(*zip(areas * [1.02, 1.03, 1.01], areas, names, strict=True))
    value, error = ratio(finite, small, "contact_fraction")
    assert value == pytest.approx((areas @ [1.02, 1.03, 1.01]) / areas.sum())
    assert error.sigma == pytest.approx(0.01 / math.sqrt(3) / 1.02, rel=1e-6)
    assert error.freedom == 2
    shuffled = solved(*zip(areas * 1.02, areas, names[::-1], strict=True))
    assert ratio(shuffled, small, "contact_fraction")[1].sigma > 0.3


def test_pair_with_a_failed_half_is_left_out_of_both(solved):
    upper = solved((0.022, 0.3, "1"), failed("2"))
    lower = solved((0.020, 0.3, "1"), (0.080, 0.3, "2"))
    assert ratio(upper, lower, "contact_fraction")[0] == pytest.approx(1.1)
    assert ratio(lower, upper, "contact_fraction")[0] == pytest.approx(1.0 / 1.1)


def test_products_and_quotients_of_drawn_numbers():
    random = np.random.default_rng(1)
    errors = [xr.DataArray(0.1), xr.DataArray(0.25)]
    first, second = (float(error) * random.standard_normal(400_000) for error in errors)
    uncertainty = float(in_quadrature(*errors))
    for logs in (first + second, first - second):
        # the scatter of 400,000 draws: 0.27/sqrt(400000) = 4e-4 for mean and deviation
        assert uncertainty == pytest.approx(logs.std(), rel=5e-3)
        assert np.mean(np.abs(logs) < uncertainty) == pytest.approx(0.6827, abs=3e-3)


def test_mean_of_a_sample_scatters_by_its_uncertainty():
    draws = 0.2 * np.exp(0.1 * np.random.default_rng(2).standard_normal((4000, 9)))
    error = log_error_of_mean(xr.DataArray(draws, dims=("draw", "sample"))).mean()
    # of nine values the estimated deviation is 3 % low on average
    assert error == pytest.approx(np.log(draws.mean(axis=1)).std(), rel=0.05)


def test_unknown_parts_add_nothing():
    unknown, *known = (xr.DataArray(value) for value in (math.nan, 0.3, 0.4))
    assert in_quadrature(known[0], unknown, known[1]) == pytest.approx(0.5)
    assert math.isnan(in_quadrature(unknown))
    for values in ([0.3], [0.0, 0.0], [0.3, -0.1], [math.nan, math.nan]):
        assert math.isnan(log_error_of_mean(xr.DataArray(values, dims="sample")))
    padded = [xr.DataArray(row, dims="sample") for row in ([0.3, 0.5], [0.3, 0.5, math.nan])]
    assert log_error_of_mean(padded[0]) == log_error_of_mean(padded[1])


def test_waves_add_in_steps():
    at, waves = np.array([20e-3, 10e-3, 4e-3, 3e-3, 0.5e-3]), np.array([10e-3, 3e-3, 1e-3])
    friction = curve_at("friction", at, waves, np.array([0.1, 0.3, 0.4]), stepped=True)
    assert friction.tolist() == [0.0, 0.1, 0.1, 0.3, 0.4]
    area = curve_at("contact_fraction", at, waves, np.array([0.3, 0.1, 0.05]), stepped=True)
    assert area.tolist() == [1.0, 0.3, 0.3, 0.1, 0.05]


def test_octaves_are_interpolated_and_the_unknown_stays_unknown():
    split = np.array([16e-3, 8e-3, 4e-3, 2e-3, 1e-3, np.nan])
    at = np.array([32e-3, 16e-3, 8e-3, np.sqrt(32.0) * 1e-3, 0.5e-3])
    friction = np.array([0.0, 0.1, 0.3, 0.35, 0.4, np.nan])
    assert curve_at("friction", at, split, friction) == pytest.approx([0.0, 0.0, 0.1, 0.2, 0.4])
    area = curve_at("contact_fraction", at, split, np.array([np.nan, 0.4, 0.2, 0.1, *[np.nan] * 2]))
    np.testing.assert_allclose(area, [1.0, np.nan, 0.4, 0.3, 0.1])


def test_scale_of_wavelengths_holds_all():
    ends = samples.octaves(16e-3, 1e-3, 1e-3)
    assert ends == pytest.approx(1e-3 * 2.0 ** np.arange(4, -1, -1.0))
    assert samples.octaves(math.nan, math.nan, 1e-3).size == 0
