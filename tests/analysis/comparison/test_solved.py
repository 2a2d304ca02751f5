"""Means, spreads and factors of rungs; a failed sample is in none of them and is told."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from gripscale.analysis import Sample, SolvedRung

Make = Callable[..., SolvedRung]


def failed(of: str = "") -> Sample:
    return Sample(math.nan, math.nan, math.nan, "tolerance not met", of)


def test_failed_sample_is_in_no_mean_and_is_told(solved: Make) -> None:
    rung = solved("a", (0.02, 0.3), failed(), (0.04, 0.5))
    assert rung.mean("contact_fraction") == pytest.approx(0.03)
    assert rung.spread("friction") == pytest.approx(np.std([0.3, 0.5], ddof=1))
    assert rung.status == "1 of 3 samples failed: tolerance not met"
    assert len(rung.converged) == 2
    alone = solved("b", failed())
    assert math.isnan(alone.mean("friction"))
    assert alone.status == "tolerance not met"
    assert math.isnan(rung.over(alone, "friction").value)


def test_uncertainty_is_scatter_and_estimated_error(solved: Make) -> None:
    two = [Sample(0.02, f, f, "converged", friction_error=0.03) for f in (0.3, 0.5)]
    scatter, error = np.std([0.3, 0.5], ddof=1) / math.sqrt(2) / 0.4, 0.03 / 0.4
    assert solved("a", *two).uncertain("friction").uncertainty == pytest.approx(
        math.hypot(scatter, error)
    )
    assert solved("a", two[0]).uncertain("friction").uncertainty == pytest.approx(0.1)
    assert math.isnan(solved("a", (0.02, 0.3)).uncertain("friction").uncertainty)


def test_seeds_of_one_profile_tell_nothing_of_another(solved: Make) -> None:
    drawn = [(0.02, 0.30 + 0.001 * seed, "first") for seed in range(10)]
    drawn += [(0.02, 0.50 + 0.001 * seed, "second") for seed in range(10)]
    found = solved("a", *drawn).uncertain("friction")
    assert found.value == pytest.approx(0.4045)
    assert found.uncertainty == pytest.approx(0.1 / 0.4045)
    alone = solved("a", *((area, mu, "") for area, mu, _ in drawn)).uncertain("friction")
    assert alone.uncertainty < 0.06


def test_pairs_are_compared_with_their_like(solved: Make) -> None:
    """Windows differ by a factor of four among themselves, and by 2 % between two models."""
    areas = np.array([0.02, 0.04, 0.08])
    names = ["window 1", "window 2", "window 3"]
    small = solved("small", *zip(areas, areas, names, strict=True))
    finite = solved("finite", *zip(areas * [1.02, 1.03, 1.01], areas, names, strict=True))
    found = finite.over(small, "contact_fraction")
    assert found.value == pytest.approx((areas @ [1.02, 1.03, 1.01]) / areas.sum())
    assert found.uncertainty == pytest.approx(0.01 / math.sqrt(3) / 1.02, rel=1e-6)
    shuffled = solved("finite", *zip(areas * 1.02, areas, names[::-1], strict=True))
    assert shuffled.over(small, "contact_fraction").uncertainty > 0.3


def test_pair_with_a_failed_half_is_left_out_of_both(solved: Make) -> None:
    own = solved("own", (0.022, 0.3, "1"), failed("2"))
    its = solved("its", (0.020, 0.3, "1"), (0.080, 0.3, "2"))
    assert own.over(its, "contact_fraction").value == pytest.approx(1.1)
    assert its.over(own, "contact_fraction").value == pytest.approx(1.0 / 1.1)
