"""Means, spreads and factors of models; a failed sample is in none of them and is counted."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

from gripscale.questions.answer.samples import (
    converged,
    ratio,
    relative_uncertainty,
    spread,
    status,
    status_word,
    usable,
)

Make = Callable[..., xr.Dataset]


def failed(subject: str = "") -> dict[str, Any]:
    return {
        "prediction_status": "tolerance not met",
        "prediction_status_word": "tolerance not met",
        "subject": subject,
    }


def test_failed_sample_is_in_no_mean_and_is_counted(solved: Make) -> None:
    member = solved((0.02, 0.3), failed(), (0.04, 0.5))
    assert usable(member, "contact_fraction").mean() == pytest.approx(0.03)
    assert spread(usable(member, "friction")) == pytest.approx(np.std([0.3, 0.5], ddof=1))
    assert status(member) == "1 of 3 samples failed: tolerance not met"
    assert status_word(member) == "tolerance not met"
    assert int(converged(member).sum()) == 2
    alone = solved(failed())
    assert math.isnan(usable(alone, "friction").mean())
    assert status(alone) == "tolerance not met"
    assert math.isnan(ratio(member, alone, "friction")[0])


def test_uncertainty_is_scatter_and_estimated_error(solved: Make) -> None:
    two = [{"contact_fraction": 0.02, "friction": mu, "friction_error": 0.03} for mu in (0.3, 0.5)]
    scatter, error = np.std([0.3, 0.5], ddof=1) / math.sqrt(2) / 0.4, 0.03 / 0.4
    assert relative_uncertainty(solved(*two), "friction") == pytest.approx(
        math.hypot(scatter, error)
    )
    assert relative_uncertainty(solved(two[0]), "friction") == pytest.approx(0.1)
    assert math.isnan(relative_uncertainty(solved((0.02, 0.3)), "friction"))


def test_seeds_of_one_profile_tell_nothing_of_another(solved: Make) -> None:
    drawn = [(0.02, 0.30 + 0.001 * seed, "first") for seed in range(10)]
    drawn += [(0.02, 0.50 + 0.001 * seed, "second") for seed in range(10)]
    member = solved(*drawn)
    assert usable(member, "friction").mean() == pytest.approx(0.4045)
    assert relative_uncertainty(member, "friction") == pytest.approx(0.1 / 0.4045)
    alone = relative_uncertainty(solved(*((area, mu, "") for area, mu, _ in drawn)), "friction")
    assert alone < 0.06


def test_pairs_are_compared_with_their_like(solved: Make) -> None:
    """Windows differ by a factor of four among themselves, and by 2 % between two models."""
    areas = np.array([0.02, 0.04, 0.08])
    names = ["window 1", "window 2", "window 3"]
    small = solved(*zip(areas, areas, names, strict=True))
    finite = solved(*zip(areas * [1.02, 1.03, 1.01], areas, names, strict=True))
    value, error = ratio(finite, small, "contact_fraction")
    assert value == pytest.approx((areas @ [1.02, 1.03, 1.01]) / areas.sum())
    assert error.sigma == pytest.approx(0.01 / math.sqrt(3) / 1.02, rel=1e-6)
    assert error.freedom == 2
    shuffled = solved(*zip(areas * 1.02, areas, names[::-1], strict=True))
    assert ratio(shuffled, small, "contact_fraction")[1].sigma > 0.3


def test_pair_with_a_failed_half_is_left_out_of_both(solved: Make) -> None:
    upper = solved((0.022, 0.3, "1"), failed("2"))
    lower = solved((0.020, 0.3, "1"), (0.080, 0.3, "2"))
    assert ratio(upper, lower, "contact_fraction")[0] == pytest.approx(1.1)
    assert ratio(lower, upper, "contact_fraction")[0] == pytest.approx(1.0 / 1.1)
