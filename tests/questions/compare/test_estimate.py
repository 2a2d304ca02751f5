"""The answer: factors multiplied, uncertainties in squares, what is missing named."""

import math

import numpy as np
import pytest
import xarray as xr
from scipy import stats

from gripscale.half_space.line_to_map import finite_over_small
from gripscale.questions import Factor, LogNormalValue
from gripscale.questions.answer.estimate import (
    ESTIMATED,
    LARGE_STRAIN_LABEL,
    answer_of_samples,
    large_strain_answer,
    with_interval,
    with_large_strain,
)
from gripscale.questions.answer.intervals import LEVEL, LogError, combined, half_width
from gripscale.questions.answer.samples import ratio

NUMBERS = {"contact_fraction": 0.04, "friction": 0.2, "friction_from_dissipation": 0.2}
DIRECT = NUMBERS | {"contact_fraction_error": 0.002, "friction_error": 0.01}
GRID = 0.05 / math.sqrt(3.0)
"""Of the direct contact: even within its estimated error of 5 %."""
ERRORS = {"contact_fraction_sampling_error": 0.03, "friction_sampling_error": 0.04}
SAMPLING = {**ERRORS, "freedom": 40.0}
PRESSED = {"pressure_over_modulus": 0.05}
"""Nominal pressure over modulus."""


def test_finite_strain_follows_its_law_where_no_window_was_solved(solved, together):
    best = answer_of_samples(together(direct=solved(DIRECT | SAMPLING | PRESSED)))
    area, friction = (finite_over_small(name, 0.05, 0.04) for name in ESTIMATED)
    assert best.answer_contact_fraction == pytest.approx(0.04 * area[0])
    assert best.answer_friction == pytest.approx(0.2 * friction[0])
    assert best.factor_label.values.tolist() == [LARGE_STRAIN_LABEL]
    sigma = math.hypot(0.03, GRID, area[1])
    assert best.answer_contact_fraction_uncertainty == pytest.approx(sigma)
    sigma = math.hypot(0.04, GRID, friction[1])
    assert best.answer_friction_uncertainty == pytest.approx(sigma)
    width = math.sinh(stats.t.ppf(0.95, sigma**4 / (0.04**4 / 40.0)) * sigma)
    assert best.answer_friction_half_width == pytest.approx(width)


def test_the_law_is_not_included_where_no_pressure_over_modulus_is_known(solved, together):
    """Nor is there an interval without samples of the road."""
    best = answer_of_samples(together(direct=solved(DIRECT)))
    assert best.answer_friction == pytest.approx(0.2)
    assert math.isnan(best.answer_friction_factor.item())
    assert math.isnan(best.answer_friction_half_width)


def test_windows_leave_the_answer_and_say_what_it_becomes(solved, together):
    finite, small = solved((0.102, 0.98), (0.206, 0.97)), solved((0.1, 1.0), (0.2, 1.0))
    direct = solved(DIRECT | SAMPLING)
    models = together(direct=direct, windows_finite_strain=finite, windows_half_plane=small)
    supplied = Factor("map", "map", LogNormalValue(0.5, 0.2), LogNormalValue(1.3, 0.1), 6.0)
    answer = answer_of_samples(models, [supplied])
    assert answer.answer_friction == pytest.approx(0.2 * 1.3)
    assert answer.factor_label.values.tolist() == ["large strain", "map"]
    assert large_strain_answer(answer) is None
    both = with_large_strain(answer, models, [supplied])
    assert both.answer_friction == answer.answer_friction
    best = large_strain_answer(both)
    value, error = ratio(finite, small, "friction_from_dissipation")
    assert value == pytest.approx(0.975)
    assert best.answer_friction == pytest.approx(0.2 * 0.975 * 1.3)
    left_out = abs(math.log(0.975)) / math.sqrt(3.0)
    parts = (0.04, GRID, float(error.sigma), left_out, 0.1)
    assert best.answer_friction_uncertainty == pytest.approx(math.hypot(*parts))


def test_a_supplied_factor_replaces_ours(solved, together):
    ours = Factor("finite_strain", "x", LogNormalValue(0.9, 0.01), LogNormalValue(0.8, 0.01))
    windows = dict.fromkeys(("windows_finite_strain", "windows_half_plane"), solved((0.1, 1.0)))
    models = together(direct=solved(DIRECT | SAMPLING), **windows)
    best = answer_of_samples(models, [ours])
    assert best.answer_friction == pytest.approx(0.16)
    assert best.factor_label.values.tolist() == ["x"]
    assert large_strain_answer(with_large_strain(best, models, [ours])) is None


def test_a_factor_on_one_quantity_only_is_not_included(solved, together):
    half = Factor("map", "map", LogNormalValue(1.1, 0.1))
    best = answer_of_samples(together(direct=solved(DIRECT | SAMPLING)), [half])
    without = answer_of_samples(together(direct=solved(DIRECT | SAMPLING)))
    assert best.answer_contact_fraction == pytest.approx(0.04)
    assert best.answer_contact_fraction_half_width == without.answer_contact_fraction_half_width


def test_there_is_none_without_a_direct_contact(solved, together):
    best = answer_of_samples(together(chain=solved((0.04, 0.2))))
    assert math.isnan(best.answer_friction)
    assert best.sizes["factor"] == 0
    broken = answer_of_samples(together(direct=solved({"prediction_status": "tolerance not met"})))
    assert math.isnan(broken.answer_friction)
    assert math.isnan(broken.answer_friction_half_width)


DRAWS = 20_000


def test_interval_of_a_product_holds_the_truth_nine_times_in_ten():
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


def error(sigma, freedom):
    return LogError(xr.DataArray(sigma), xr.DataArray(freedom))


def test_closed_forms():
    one, certain = error(0.1, 5.0), error(0.1, math.inf)
    assert combined([one]) == (pytest.approx(0.1), pytest.approx(5.0))
    assert half_width(one) == pytest.approx(math.sinh(0.1 * stats.t.ppf(0.95, 5)))
    width = math.sinh(0.1 * math.sqrt(2.0) * stats.norm.ppf(0.95))
    assert half_width(combined([certain, certain])) == pytest.approx(width)


def test_what_is_not_known_is_not_left_out():
    assert math.isnan(half_width(combined([error(0.1, 5.0), error(math.nan, math.nan)])))
    assert math.isnan(half_width(error(0.1, 0.0)))


def test_no_interval_of_an_area_holds_more_than_all_of_it():
    """Of 0.97 with an error of 5 %; the friction, which has no such limit, keeps its interval."""

    def ends(name, value):
        numbers = with_interval(name, xr.DataArray(value), error(0.05, math.inf))
        return [float(numbers[f"answer_{name}{end}"]) for end in ("_low", "", "_high")]

    width = math.exp(0.05 * 1.645)
    assert ends("friction", 0.97) == pytest.approx([0.97 / width, 0.97, 0.97 * width], rel=1e-4)
    assert ends("contact_fraction", 0.97) == pytest.approx([0.97 / width, 0.97, 1.0], rel=1e-4)
    assert ends("contact_fraction", 1.02)[1:] == [1.0, 1.0]
