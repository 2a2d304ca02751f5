"""Uncertain numbers against drawn log-normal ones, and what is unknown stays out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gripscale.analysis import LogNormalValue
from gripscale.analysis.best_estimate import add_in_quadrature, of_mean


def test_products_and_quotients_of_drawn_numbers() -> None:
    random = np.random.default_rng(1)
    first, second = LogNormalValue(0.04, 0.1), LogNormalValue(0.5, 0.25)
    draws = [
        one.value * np.exp(one.uncertainty * random.standard_normal(400_000))
        for one in (first, second)
    ]
    for made, drawn in (
        (first.times(second), draws[0] * draws[1]),
        (first.over(second), draws[0] / draws[1]),
    ):
        logs = np.log(drawn)
        # the scatter of 400,000 draws: 0.27/sqrt(400000) = 4e-4 for mean and deviation
        assert math.log(made.value) == pytest.approx(logs.mean(), abs=2e-3)
        assert made.uncertainty == pytest.approx(logs.std(), rel=5e-3)
        assert np.mean((made.low < drawn) & (drawn < made.high)) == pytest.approx(0.6827, abs=3e-3)


def test_mean_of_a_sample_scatters_by_its_uncertainty() -> None:
    random = np.random.default_rng(2)
    samples = 0.2 * np.exp(0.1 * random.standard_normal((4000, 9)))
    told = np.mean([of_mean(sample) for sample in samples])
    # of nine values the estimated deviation is 3 % low on average
    assert told == pytest.approx(np.log(samples.mean(axis=1)).std(), rel=0.05)


def test_unknown_parts_add_nothing() -> None:
    assert add_in_quadrature([0.3, math.nan, 0.4]) == pytest.approx(0.5)
    assert math.isnan(add_in_quadrature([math.nan]))
    assert LogNormalValue(2.0).times(LogNormalValue(3.0, 0.1)) == LogNormalValue(6.0, 0.1)
    assert math.isnan(LogNormalValue(1.0, 0.1).over(LogNormalValue(0.0, 0.1)).value)
    assert math.isnan(of_mean([0.3]))
    assert math.isnan(of_mean([0.0, 0.0]))
