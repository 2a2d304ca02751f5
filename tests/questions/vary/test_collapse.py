"""How far curves lie apart: on curves that are known, with points of any distance and place."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gripscale.questions.vary.speed_and_temperature import PRECISE, ROUGH, collapse
from gripscale.rubber import Rubber

RUBBER = Rubber(5e6, np.geomspace(3e6, 3e8, 10), np.geomspace(1e-1, 1e-9, 10))


def friction(speed: np.ndarray) -> np.ndarray:
    """Return a curve as rough as friction may be: the loss factor of a series, one term a decade.

    Of a wave in full contact at small strain friction is smoother by a factor |E*|.
    """
    return RUBBER.loss_factor(2.0 * np.pi * speed / 1e-3)


def speeds(per_decade: int, start: float, decades: int = 5) -> np.ndarray:
    return start * 10.0 ** (np.arange(decades * per_decade + 1) / per_decade)


@pytest.mark.parametrize("per_decade", [2, 3, 4, 6, 8, 12])
def test_points_of_one_curve_read_as_one_however_far_apart(per_decade: int) -> None:
    for start in np.geomspace(1.01e-4, 9e-4, 23):
        x = speeds(per_decade, 1e-4), speeds(per_decade, start)
        found = collapse([(one, friction(one)) for one in x])
        coarse = found.interpolation_error > PRECISE[0]
        assert not found.distance > (found.interpolation_error if coarse else 1e-3)
        assert not found.interpolation_error > ROUGH[2]
        assert found.overlapping > 0
        if per_decade >= 8:
            assert found.points > 0.9 * found.overlapping


def test_what_is_estimated_bounds_what_interpolation_misses() -> None:
    one = speeds(6, 1e-4)
    misses, estimates = [], []
    for start in np.geomspace(1.01e-4, 9e-4, 23):
        other = speeds(6, start)
        found = collapse([(one, friction(one)), (other, friction(other))])
        misses.append(found.distance)
        estimates.append(found.interpolation_error)
    assert np.nanmax(misses) < 1.5 * np.nanmax(estimates)


def test_common_points_are_compared_as_they_are() -> None:
    x = speeds(1, 1e-4)
    shared = collapse([(x, friction(x)), (100.0 * x, friction(100.0 * x))])
    assert shared.distance < 1e-12
    assert shared.interpolation_error == 0.0
    # two decades of five on one point a decade: four common points, seen from both sides
    assert (shared.points, shared.overlapping) == (8, 8)


def test_curves_apart_are_told_by_how_much() -> None:
    x = speeds(8, 1e-4), speeds(8, 1.7e-4)
    found = collapse([(x[0], friction(x[0])), (x[1], 1.05 * friction(x[1]))])
    assert found.distance == pytest.approx(0.05, abs=1.5e-3)
    drifting = x[1] ** 0.02 * friction(x[1])
    assert collapse([(x[0], friction(x[0])), (x[1], drifting)]).distance > 0.1


def test_nothing_is_said_where_nothing_can_be_compared() -> None:
    coarse = collapse([(x := speeds(1, 1e-4), friction(x)), (3.0 * x, friction(3.0 * x))])
    assert math.isnan(coarse.distance)
    assert (coarse.points, coarse.overlapping) == (0, 10)
    apart = collapse([(x, friction(x)), (1e6 * x, friction(1e6 * x))])
    assert (math.isnan(apart.distance), apart.overlapping) == (True, 0)
    nothing = collapse([(x, np.full(x.size, np.nan)), (x, friction(x))])
    assert nothing.overlapping == 0


def test_missing_and_vanishing_values_are_left_out() -> None:
    x = speeds(8, 1e-4)
    y = friction(x)
    y[3], y[10] = np.nan, 0.0
    found = collapse([(x, y), (x, friction(x))])
    assert found.distance <= 1e-3
