"""Intervals hold drawn truths as often as they say."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from gripscale.questions.answer.estimate import with_interval
from gripscale.questions.answer.intervals import LEVEL, LogError, combined, half_width

DRAWS = 20_000


def test_interval_of_a_product_holds_the_truth_nine_times_in_ten() -> None:
    """Two factors whose errors are estimated from 4 and 12 values, one whose error is certain."""
    random = np.random.default_rng(7)
    logs, errors = np.zeros(DRAWS), []
    for sigma, count in ((0.1, 4), (0.06, 12)):
        draws = sigma * random.standard_normal((DRAWS, count))
        logs += draws.mean(axis=1)
        scatter = draws.std(axis=1, ddof=1) / math.sqrt(count)
        freedom = np.full(DRAWS, count - 1.0)
        errors.append(LogError(*(xr.DataArray(v, dims="draw") for v in (scatter, freedom))))
    logs += 0.04 * random.standard_normal(DRAWS)
    certain = xr.DataArray(np.full(DRAWS, 0.04), dims="draw")
    errors.append(LogError(certain, xr.full_like(certain, math.inf)))
    width = np.arcsinh(half_width(combined(errors)))
    share = float((np.abs(logs) < width.values).mean())
    # Welch and Satterthwaite is an approximation: one in a hundred; the draws add 0.2 %
    assert share == pytest.approx(LEVEL, abs=0.01)


def error(sigma: float, freedom: float) -> LogError:
    return LogError(xr.DataArray(sigma), xr.DataArray(freedom))


def test_closed_forms() -> None:
    one, certain = error(0.1, 5.0), error(0.1, math.inf)
    assert combined([one]) == (pytest.approx(0.1), pytest.approx(5.0))
    assert half_width(one) == pytest.approx(math.sinh(0.1 * stats.t.ppf(0.95, 5)))
    width = math.sinh(0.1 * math.sqrt(2.0) * stats.norm.ppf(0.95))
    assert half_width(combined([certain, certain])) == pytest.approx(width)


def test_what_is_not_known_is_not_left_out() -> None:
    assert math.isnan(half_width(combined([error(0.1, 5.0), error(math.nan, math.nan)])))
    assert math.isnan(half_width(error(0.1, 0.0)))


def test_no_interval_of_an_area_holds_more_than_all_of_it() -> None:
    """Of 0.97 with an error of 5 %; the friction, which has no such limit, keeps its interval."""

    def ends(name: str, value: float) -> list[float]:
        numbers = with_interval(name, xr.DataArray(value), error(0.05, math.inf))
        return [float(numbers[f"answer_{name}{end}"]) for end in ("_low", "", "_high")]

    width = math.exp(0.05 * 1.645)
    assert ends("friction", 0.97) == pytest.approx([0.97 / width, 0.97, 0.97 * width], rel=1e-4)
    assert ends("contact_fraction", 0.97) == pytest.approx([0.97 / width, 0.97, 1.0], rel=1e-4)
    assert ends("contact_fraction", 1.02)[1:] == [1.0, 1.0]
