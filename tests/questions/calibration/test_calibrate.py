"""The fit of the area term: what it finds, what it refuses to say, what it predicts."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from gripscale.conditions import (
    ConstantStress,
    GaussianStress,
    LeGalKlueppelStress,
)
from gripscale.core.errors import InputError
from gripscale.experiment import MeasuredFriction
from gripscale.io import netcdf
from gripscale.questions import Predicted
from gripscale.questions.calibration.question import shear_stress_table
from tests.samples import DOCS

from .synthetic import REFERENCE, TRUE, fitted, hysteresis, measurement

PLATEAUS = LeGalKlueppelStress(2e6, 3.0, 0.01, 0.8)
FLANK = np.geomspace(1e-6, 1e-4, 6)
"""Speeds far below the top of the bell."""


def numbers(law):
    """Return the parameters of a law by their names."""
    return {name: value for name, value in vars(law).items() if value is not None}


@pytest.mark.parametrize(
    ("law", "fixed"),
    [(ConstantStress(3e6), {}), (TRUE, REFERENCE), (PLATEAUS, {})],
)
def test_a_law_is_found_from_what_it_made(law, fixed):
    fit = fitted(*measurement(law, seed=None), law=law.kind, fixed=fixed)
    found, true = numbers(fit.law), numbers(law)
    assert found == pytest.approx(true, rel=1e-5)
    assert fit.data.friction.values == pytest.approx(fit.data.measured_friction.values, abs=1e-7)


def test_the_law_does_not_depend_on_where_it_is_referred_to():
    here, there = (
        fitted(*measurement(), fixed={"reference_temperature": kelvin}) for kelvin in (280.0, 310.0)
    )
    assert here.data.friction.values == pytest.approx(there.data.friction.values, abs=1e-5)
    assert here.estimates[3].low == pytest.approx(there.estimates[3].low, rel=2e-3)


def test_points_are_paired_in_the_order_of_the_caller():
    """The law is found from points with any order of speeds, and each keeps its place."""
    order, (rising, _) = np.random.default_rng(0).permutation(27), measurement(seed=None)
    columns = (rising.speed, rising.friction, rising.spread, rising.temperature)
    mixed = MeasuredFriction(*(column[order] for column in columns))
    fit = fitted(mixed, hysteresis(mixed.speed, mixed.temperature), fixed=REFERENCE)
    assert numbers(fit.law) == pytest.approx(numbers(TRUE), rel=1e-5)
    assert fit.data.friction.values == pytest.approx(mixed.friction, abs=1e-7)
    assert fit.data.measured_speed.values.tolist() == mixed.speed.tolist()


def test_predictions_at_other_pressures_are_refused():
    """Points in another order than those measured show where pressures differ."""
    measured = MeasuredFriction([1.0, 0.1, 10.0], [0.4] * 3, pressure=[1e5, 3e5, 2e5])
    predicted = Predicted([0.2] * 3, [0.03] * 3, [3e5, 1e5, 2e5], [293.15] * 3)
    with pytest.raises(InputError, match=r"index 0 100000 Pa was measured and 300000 Pa predicted"):
        fitted(measured, predicted, law="constant")


def test_points_weigh_by_their_spread():
    """A point of tiny spread is followed, wherever it is."""
    speed, spread = [0.1, 1.0, 10.0], [0.1, 1e-4, 0.1]
    predicted = Predicted([0.2] * 3, [0.03] * 3, [3e5] * 3, [293.15] * 3)
    measured = MeasuredFriction(speed, [0.4, 0.6, 0.4], spread)
    fit = fitted(measured, predicted, law="constant")
    assert fit.data.friction.values == pytest.approx(0.6, abs=1e-5)


def test_a_wrong_law_shows_in_what_is_left_out():
    right, wrong = (
        fitted(*measurement(), law=law, hold_out="temperature") for law in ("gaussian", "constant")
    )
    assert right.data.left_out.values.tolist() == [278.0, 293.0, 313.0]
    assert right.data.points.values.tolist() == [9, 9, 9]
    # the right law misses by the spread, and by what three parameters more cost; chi^2_9 / 9 is
    # below 2.4 with probability 0.99
    assert (right.data.rms_outside_in_spread < math.sqrt(2.4) + 0.5).all()
    assert (wrong.data.rms_outside_in_spread > 5.0).all()


def test_extrapolating_a_wrong_law_costs_more_than_following_the_data():
    """A bell can follow two plateaus where it sees them, and not beyond."""
    fit = fitted(
        *measurement(PLATEAUS, seed=None, temperatures=(293.15,)), law="gaussian", hold_out="speed"
    )
    first = fit.data.isel(left_out=0)
    assert first.rms_outside > 3.0 * first.rms_inside


def test_one_temperature_gives_no_activation_energy():
    fit = fitted(*measurement(temperatures=(293.15,)))
    assert isinstance(fit.law, GaussianStress)
    assert [one.name for one in fit.estimates] == ["stress_0", "width", "speed_0"]
    assert fit.law.reference_temperature is None
    assert "No activation energy" in fit.data.attrs["notes"]
    assert "activation_energy" not in shear_stress_table(fit).partition("[conditions")[2]


def test_what_one_temperature_cannot_say_is_not_predicted_for_another():
    fit = fitted(*measurement(temperatures=(283.15, 303.15)), hold_out="temperature")
    assert fit.data.rms_outside.isnull().all()
    why = "the other points do not determine activation_energy"
    assert fit.data.why_not.values.tolist() == [why] * 2


def test_a_flank_does_not_determine_the_top():
    fit = fitted(*measurement(speeds=FLANK, temperatures=(293.15,)))
    by_name = {one.name: one for one in fit.estimates}
    assert math.isnan(by_name["stress_0"].high)
    assert math.isnan(by_name["speed_0"].high)
    assert not by_name["speed_0"].determined
    assert "upper end not determined" in shear_stress_table(fit)


def test_one_speed_determines_the_height_of_the_bell_alone():
    """Three temperatures are three points of a parabola in eps/T.

    Its height is tau_0; c eps^2 is known, c and eps are not.
    """
    fit = fitted(*measurement(speeds=np.full(4, 0.02)))
    determined = {one.name for one in fit.estimates if one.determined}
    assert determined == {"stress_0"}


def test_fixed_parameters_stay():
    fit = fitted(*measurement(), fixed={"width": 0.15, **REFERENCE})
    assert isinstance(fit.law, GaussianStress)
    assert fit.law.width == 0.15
    assert [one.name for one in fit.estimates] == ["stress_0", "speed_0", "activation_energy"]
    assert "width = 0.15  # held" in shear_stress_table(fit)


def test_spreads_too_small_for_the_law_are_said():
    fit = fitted(*measurement(), law="constant")
    assert "times the stated spread" in fit.data.attrs["notes"]


def test_points_without_a_prediction_do_not_count():
    measured, predicted = measurement()
    friction, status = predicted.friction.copy(), ["converged"] * 27
    friction[3], status[3] = np.nan, "wave 2 did not converge"
    holes = replace(predicted, friction=friction, status=status)
    fit = fitted(measured, holes, hold_out="temperature")
    assert np.isnan(fit.data.friction).values.tolist() == [at == 3 for at in range(27)]
    assert fit.data.points.values.tolist() == [8, 9, 9]
    assert (
        "without a prediction, which do not count: 1, as wave 2 did not converge"
        in fit.data.attrs["notes"]
    )


def test_everything_is_in_the_dataset(tmp_path):
    fit = fitted(*measurement(), hold_out="speed")
    data = netcdf.load_dataset(netcdf.save(fit.data, tmp_path / "calibration.nc"))
    assert data.parameter.values.tolist() == [
        "stress_0", "width", "speed_0", "activation_energy",
    ]  # fmt: skip
    assert data.estimate.values == pytest.approx([one.value for one in fit.estimates])
    assert (data.hysteresis + data.area_term).values == pytest.approx(data.friction.values)
    assert np.diag(data.correlation) == pytest.approx(1.0)
    assert data.left_out.values == pytest.approx([1e-4, 1e-3, 1e-2, 1e-1, 1.0])


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"fixed": {"width": -1.0}}, "width must be greater than zero; got -1"),
        ({"law": "constant", "fixed": {"stress_0": 1e6}}, "must leave a parameter"),
        ({"fixed": {"activation_energy": 0.0, **REFERENCE}},
         "reference_temperature belongs to an activation_energy"),
    ],
)  # fmt: skip
def test_what_cannot_be_used_is_one_sentence(change, sentence):
    with pytest.raises(InputError, match=sentence):
        fitted(*measurement(), **change)


@pytest.mark.parametrize(
    ("friction", "more", "sentence"),
    [
        ([0.1, 0.1, 0.3], {},
         "hysteresis alone exceeds the measured friction at 2 of 3 points, by"),
        ([0.3, 0.3, 0.3], {"spread": [0.1, np.nan, 0.1]}, "spread must be stated for all"),
        ([0.3, 0.3, 0.3], {"spread": [0.1, 0.0, 0.1]},
         "spread must be above zero to weigh a point"),
        ([0.3, 0.3, 0.3], {"law": "gaussian"},
         "fitting stress_0, width, speed_0 needs more than 3 measured points; got 3"),
        ([0.3, 0.3, 0.3], {"hold_out": "temperature"}, "needs the temperature of every point"),
        ([0.3, 0.3, 0.3], {"hold_out": "temperature", "temperature": [293.0] * 3},
         "hold_out needs at least two groups to leave one of them out; got 1"),
    ],
)  # fmt: skip
def test_what_does_not_suffice_is_one_sentence(friction, more, sentence):
    columns = {name: more.pop(name) for name in ("spread", "temperature") if name in more}
    measured = MeasuredFriction([0.1, 1.0, 10.0], friction, **columns)
    predicted = Predicted([0.2] * 3, [0.03] * 3, [3e5] * 3, [293.15] * 3)
    with pytest.raises(InputError, match=sentence):
        fitted(measured, predicted, **({"law": "constant"} | more))


def test_the_page_lists_every_variable():
    page = (DOCS / "measured-friction.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"`(\w+)`", page))
    data = fitted(*measurement(), hold_out="speed").data
    assert set(map(str, data.variables)) <= listed
