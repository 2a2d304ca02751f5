"""Predicted beside measured friction: differences, in units of the spread, and their mean."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gripscale.conditions import ConstantStress
from gripscale.core.errors import InputError
from gripscale.core.units import DISPLAY_UNITS
from gripscale.experiment import MeasuredFriction
from gripscale.io.table import as_text
from gripscale.questions import Predicted, residuals
from gripscale.questions.calibration.question import residual_table

MEASURED = MeasuredFriction(
    [0.1, 1.0, 10.0], [0.5, 0.6, 0.7], [0.1, np.nan, 0.05], [293.15] * 3, pressure=[2e5, 3e5, 3e5]
)
NEAR = Predicted([0.4, 0.6, 0.8], [0.04, 0.03, 0.03], [2e5, 3e5, 3e5], [293.15] * 3)
FAR = Predicted([0.2, np.nan, 0.1], [0.04, np.nan, 0.03], [2e5, 3e5, 3e5], [293.15] * 3)


def test_differences_of_the_hysteresis() -> None:
    data = residuals(MEASURED, {"near": NEAR, "far": FAR})
    assert data.model.values.tolist() == ["near", "far"]
    assert data.difference.values[0] == pytest.approx([-0.1, 0.0, 0.1])
    np.testing.assert_allclose(data.difference_in_spread.values[0], [-1.0, np.nan, 2.0])
    # of the points that have an answer, and a spread
    far = math.sqrt((0.3**2 + 0.6**2) / 2)
    assert data.rms_difference.values == pytest.approx([math.sqrt(0.02 / 3), far])
    assert data.rms_difference_in_spread.values == pytest.approx(
        [math.sqrt(2.5), math.sqrt((3.0**2 + 12.0**2) / 2)]
    )
    assert "area_term" not in data


def test_an_area_term_is_added() -> None:
    data = residuals(MEASURED, {"near": NEAR, "far": FAR}, ConstantStress(1e6))
    np.testing.assert_allclose(data.area_term.values[0], [0.2, 0.1, 0.1])
    np.testing.assert_allclose(data.friction.values[0], [0.6, 0.7, 0.9])
    np.testing.assert_allclose(data.friction.values[1], [0.4, np.nan, 0.2])
    assert data.measured_pressure.values.tolist() == [2e5, 3e5, 3e5]


def test_the_table_shows_every_number() -> None:
    """In the units of the case it is compared with: here bar."""
    beside = residuals(MEASURED, {"near": NEAR}, ConstantStress(1e6))
    text = as_text(residual_table(beside.assign_attrs({DISPLAY_UNITS: '{"pressure": "bar"}'})))
    rows = [line.split() for line in text.splitlines()]
    assert ["0.100", "20.0", "2.00", "0.500", "0.100", "0.400", "0.600", "+0.100", "+1.0"] in rows
    assert ["1.00", "20.0", "3.00", "0.600", "-", "0.600", "0.700", "+0.100", "-"] in rows
    assert "Root mean square of Δμ, near: 0.141, 2.9 times the spread." in text


def test_a_table_without_what_is_not_known() -> None:
    bare = MeasuredFriction([0.1, 1.0, 10.0], [0.5, 0.6, 0.7])
    text = as_text(residual_table(residuals(bare, {"near": NEAR})))
    assert "°C" not in text
    assert "spread" not in text
    assert ["0.100", "0.500", "0.400", "-0.100"] in [line.split() for line in text.splitlines()]


def test_bad_predictions_are_one_sentence() -> None:
    with pytest.raises(InputError, match=r"at least one model; got \{\}"):
        residuals(MEASURED, {})
    short = Predicted([0.1], [0.03], [3e5], [293.15])
    with pytest.raises(InputError, match="short must be predicted at the 3 points measured; got 1"):
        residuals(MEASURED, {"short": short})
