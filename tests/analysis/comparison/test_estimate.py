"""The best estimate: factors multiplied, uncertainties in squares, what is missing named."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from gripscale.analysis import Factor, LogNormalValue, Sample, SolvedRung
from gripscale.analysis.best_estimate import FACTORS, best_estimate

Make = Callable[..., SolvedRung]


def test_missing_factors_are_named_and_widen_nothing(solved: Make) -> None:
    direct = solved("direct", Sample(0.04, 0.2, 0.2, "converged", "", 0.002, 0.01))
    made = best_estimate({"direct": direct})
    assert made is not None
    assert made.contact_fraction == pytest.approx((0.04, 0.05))
    assert made.friction == pytest.approx((0.2, 0.05))
    assert [one.name for one in made.missing] == [one.name for one in FACTORS]
    assert made.included == []


def test_factors_of_rungs_and_from_elsewhere(solved: Make) -> None:
    direct = solved("direct", Sample(0.04, 0.2, 0.2, "converged", "", 0.002, 0.01))
    windows = {
        "windows_finite_strain": solved("windows_finite_strain", (0.102, 0.98), (0.206, 0.97)),
        "windows_half_plane": solved("windows_half_plane", (0.1, 1.0), (0.2, 1.0)),
    }
    supplied = Factor("isotropic_map", "map", LogNormalValue(0.5, 0.2), LogNormalValue(1.3, 0.1))
    made = best_estimate({"direct": direct, **windows}, [supplied])
    assert made is not None
    assert made.missing == []
    ratio = windows["windows_finite_strain"].over(windows["windows_half_plane"], "friction")
    assert ratio.value == pytest.approx(0.975)
    assert made.friction.value == pytest.approx(0.2 * 0.975 * 1.3)
    assert made.friction.uncertainty == pytest.approx(math.hypot(0.05, ratio.uncertainty, 0.1))


def test_there_is_none_without_a_direct_contact(solved: Make) -> None:
    assert best_estimate({}) is None
    broken = solved("direct", Sample(math.nan, math.nan, math.nan, "tolerance not met"))
    assert best_estimate({"direct": broken}) is None


def test_a_measured_map_needs_no_factor_to_a_map(solved: Make) -> None:
    direct = solved("direct", Sample(0.04, 0.2, 0.2, "converged", "", 0.002, 0.01))
    made = best_estimate({"direct": direct}, of_map=True)
    assert made is not None
    assert [one.name for one in made.missing] == ["finite_strain"]
