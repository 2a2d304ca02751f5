"""The best estimate: factors multiplied, uncertainties in squares, what is missing named."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
import xarray as xr

from gripscale.analysis import Factor, LogNormalValue
from gripscale.analysis.best_estimate import FACTORS, best_estimate
from gripscale.analysis.samples import ratio

Make = Callable[..., xr.Dataset]

DIRECT = {
    "contact_fraction": 0.04,
    "friction": 0.2,
    "friction_from_dissipation": 0.2,
    "contact_fraction_error": 0.002,
    "friction_error": 0.01,
}


def test_missing_factors_are_named_and_widen_nothing(solved: Make, together: Make) -> None:
    best = best_estimate(together(direct=solved(DIRECT)))
    assert best.best_contact_fraction == pytest.approx(0.04)
    assert best.best_friction == pytest.approx(0.2)
    assert best.best_contact_fraction_uncertainty == pytest.approx(0.05)
    assert best.best_friction_uncertainty == pytest.approx(0.05)
    assert best.factor_label.values.tolist() == [factor.label for factor in FACTORS]
    assert best.best_friction_factor.isnull().all()


def test_factors_of_rungs_and_from_elsewhere(solved: Make, together: Make) -> None:
    finite, small = solved((0.102, 0.98), (0.206, 0.97)), solved((0.1, 1.0), (0.2, 1.0))
    rungs = together(direct=solved(DIRECT), windows_finite_strain=finite, windows_half_plane=small)
    supplied = Factor("isotropic_map", "map", LogNormalValue(0.5, 0.2), LogNormalValue(1.3, 0.1))
    best = best_estimate(rungs, [supplied])
    assert best.best_friction_factor.notnull().all()
    assert best.factor_label.values.tolist() == ["finite strain", "map"]
    value, uncertainty = ratio(finite, small, "friction_from_dissipation")
    assert value == pytest.approx(0.975)
    assert best.best_friction == pytest.approx(0.2 * 0.975 * 1.3)
    assert best.best_friction_uncertainty == pytest.approx(
        math.hypot(0.05, float(uncertainty), 0.1)
    )


def test_a_factor_on_one_quantity_only_is_not_included(solved: Make, together: Make) -> None:
    half = Factor("finite_strain", "finite strain", LogNormalValue(1.1, 0.1))
    best = best_estimate(together(direct=solved(DIRECT)), [half])
    assert best.best_contact_fraction == pytest.approx(0.04)
    assert best.best_contact_fraction_uncertainty == pytest.approx(0.05)


def test_there_is_none_without_a_direct_contact(solved: Make, together: Make) -> None:
    best = best_estimate(together(chain=solved((0.04, 0.2))))
    assert math.isnan(best.best_friction)
    assert best.sizes["factor"] == 0
    broken = together(direct=solved({"prediction_status": "tolerance not met"}))
    assert math.isnan(best_estimate(broken).best_friction)
    assert math.isnan(best_estimate(broken).best_friction_uncertainty)


def test_a_measured_map_needs_no_factor_to_a_map(solved: Make, together: Make) -> None:
    best = best_estimate(together(direct=solved(DIRECT)), of_map=True)
    assert best.factor_label.values.tolist() == ["finite strain"]
