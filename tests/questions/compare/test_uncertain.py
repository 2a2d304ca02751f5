"""Relative uncertainties against drawn log-normal numbers, and what is unknown stays out."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

from gripscale.questions.answer.samples import in_quadrature, log_error_of_mean

UNKNOWN = xr.DataArray(math.nan)


def test_products_and_quotients_of_drawn_numbers() -> None:
    random = np.random.default_rng(1)
    errors = [xr.DataArray(0.1), xr.DataArray(0.25)]
    draws = [float(error) * random.standard_normal(400_000) for error in errors]
    uncertainty = float(in_quadrature(*errors))
    for logs in (draws[0] + draws[1], draws[0] - draws[1]):
        # the scatter of 400,000 draws: 0.27/sqrt(400000) = 4e-4 for mean and deviation
        assert uncertainty == pytest.approx(logs.std(), rel=5e-3)
        assert np.mean(np.abs(logs) < uncertainty) == pytest.approx(0.6827, abs=3e-3)


def test_mean_of_a_sample_scatters_by_its_uncertainty() -> None:
    random = np.random.default_rng(2)
    samples = 0.2 * np.exp(0.1 * random.standard_normal((4000, 9)))
    error = log_error_of_mean(xr.DataArray(samples, dims=("draw", "sample"))).mean()
    # of nine values the estimated deviation is 3 % low on average
    assert error == pytest.approx(np.log(samples.mean(axis=1)).std(), rel=0.05)


def test_unknown_parts_add_nothing() -> None:
    known = xr.DataArray(0.3), xr.DataArray(0.4)
    assert in_quadrature(known[0], UNKNOWN, known[1]) == pytest.approx(0.5)
    assert math.isnan(in_quadrature(UNKNOWN))
    for values in ([0.3], [0.0, 0.0], [0.3, -0.1], [math.nan, math.nan]):
        assert math.isnan(log_error_of_mean(xr.DataArray(values, dims="sample")))
    padded = [xr.DataArray(row, dims="sample") for row in ([0.3, 0.5], [0.3, 0.5, math.nan])]
    assert log_error_of_mean(padded[0]) == log_error_of_mean(padded[1])
