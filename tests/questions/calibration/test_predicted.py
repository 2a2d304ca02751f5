"""What models say at measured points is what they say when asked for each point by itself."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
import xarray as xr

import gripscale as gs
from gripscale import model
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions, ConstantStress, GaussianStress, ThermalProperties
from gripscale.core.errors import InputError
from gripscale.core.units import DISPLAY_UNITS
from gripscale.experiment import Bench, MeasuredFriction, Store, solve_design
from gripscale.experiment.measured_friction import TemperatureProbe
from gripscale.half_space.model import DirectContact
from gripscale.io.table import as_text
from gripscale.questions import Predicted, averaged, measured_design, predicted_of, residuals
from gripscale.questions.calibration.question import residual_table
from gripscale.surface import Measured, Surface
from gripscale.theory.half_plane import HalfPlane
from tests.samples import SHIFTED_LOAD as LOAD
from tests.samples import SHIFTED_RUBBER as RUBBER
from tests.samples import SHIFTED_SINES as SINES

LAW = GaussianStress(6e6, 0.1, 6e-3, 0.97, 293.15)
HEAT = ThermalProperties(0.25, 1150.0, 1500.0)
CHAIN = Chain(HalfPlane(points=64))
MEASURED = MeasuredFriction(
    [0.1, 1.0, 1.0],
    [0.5, 0.6, 0.7],
    temperature=[303.15, 313.15, np.nan],
    pressure=[2e5, np.nan, np.nan],
)


def predictions_at(measured, predicting, rubber, surface, load, store):
    """Return what a model predicts at each measured point."""
    design = measured_design(measured, predicting, rubber, surface, load)
    return predicted_of(solve_design(design, Bench(store)))


TURNS = 2.0 * np.pi * np.arange(256) / 256
LINE = gs.Profile(np.arange(256) * 4e-5, 2e-4 * np.cos(3 * TURNS) + 3e-5 * np.cos(17 * TURNS))


@pytest.mark.parametrize("heat", [None, HEAT])
def test_each_point_is_the_prediction_at_its_speed_temperature_and_pressure(tmp_path, heat):
    chain = CHAIN.with_conditions(Conditions(temperature=298.15, heat=heat))
    found = predictions_at(MEASURED, chain, RUBBER, Surface(SINES, ""), LOAD, Store(tmp_path))
    assert found.pressure.tolist() == [2e5, 3e5, 3e5]
    term = found.area_term(LAW, MEASURED.speed)
    for at, kelvin in enumerate([303.15, 313.15, 298.15]):
        alone = gs.solve_chain(
            RUBBER, SINES, solver=HalfPlane(points=64), pressure=found.pressure[at],
            speed=MEASURED.speed[at], footprint=0.05,
            conditions=Conditions(temperature=kelvin, heat=heat, shear_stress=TemperatureProbe()),
        )  # fmt: skip
        assert found.friction[at] == alone.friction
        assert found.contact_fraction[at] == alone.contact_fraction
        contact = alone.scales[-1].details.get("contact_temperature", kelvin)
        assert found.temperature[at] == pytest.approx(contact, rel=1e-12)
        # the probe's answer is T to rounding; the law is steep: d ln tau / d T is below 0.1 per K
        stress = float(LAW.stress(MEASURED.speed[at], contact))
        exact = stress * alone.contact_fraction / found.pressure[at]
        assert term[at] == pytest.approx(exact, rel=1e-9)


def test_the_direct_contact_of_a_line(tmp_path):
    surface = Surface(SINES, "", measured=Measured.of([LINE]))
    direct = DirectContact(2e-4, 0.2, periodic=True, conditions=Conditions(heat=HEAT))
    one = MeasuredFriction([1.0], [0.5], temperature=[303.15])
    found = predictions_at(one, direct, RUBBER, surface, LOAD, Store(tmp_path))
    alone = gs.solve_rough_contact(
        RUBBER, LINE, pressure=3e5, speed=1.0, smallest_wavelength=2e-4, tolerance=0.2,
        periodic=True, footprint=0.05,
        conditions=Conditions(temperature=303.15, heat=HEAT, shear_stress=TemperatureProbe()),
    )  # fmt: skip
    assert found.friction[0] == alone.friction
    assert found.temperature[0] > 303.2
    stress = float(LAW.stress(1.0, found.temperature[0]))
    exact = stress * alone.contact_fraction / 3e5
    assert found.area_term(LAW, one.speed)[0] == pytest.approx(exact, rel=1e-9)


@dataclass(frozen=True)
class Thermometer(model.Model):
    """A model without conditions: friction is the reference temperature of its rubber."""

    name: ClassVar[str] = "thermometer"

    def predict(self, rubber, surface, load, **_):
        totals = dict.fromkeys(model.TOTALS, rubber.reference_temperature or 0.0)
        status = "converged" if load.speed > 0.5 else "too slow"
        return model.predicted_answer(xr.Dataset(), totals, status, self.name, load)


def test_a_model_without_conditions_gets_the_rubber_at_the_temperature(tmp_path):
    surface = Surface(SINES, "")
    found = predictions_at(MEASURED, Thermometer(), RUBBER, surface, LOAD, Store(tmp_path))
    assert found.friction.tolist() == [303.15, 313.15, 293.15]
    assert found.temperature.tolist() == [303.15, 313.15, 293.15]
    assert list(found.status) == ["too slow", "converged", "converged"]


def test_another_temperature_needs_a_shift(tmp_path):
    plain = gs.Rubber(5e6, [3e6], [1e-3])
    with pytest.raises(InputError, match="time-temperature shift is missing"):
        predictions_at(MEASURED, CHAIN, plain, Surface(SINES, ""), LOAD, Store(tmp_path))


def test_without_any_temperature_none_is_needed(tmp_path):
    plain, surface = gs.Rubber(5e6, [3e6], [1e-3]), Surface(SINES, "")
    one = MeasuredFriction([1.0], [0.5])
    found = predictions_at(one, CHAIN, plain, surface, LOAD, Store(tmp_path))
    assert np.isnan(found.temperature).all()
    with pytest.raises(InputError, match="temperature must be given"):
        found.area_term(LAW, one.speed)


def test_samples_of_a_model_are_averaged():
    one = Predicted([0.2, 0.3], [0.02, 0.03], [3e5] * 2, [300.0, 310.0], [0.0, 0.1])
    other = Predicted(
        [0.4, np.nan], [0.06, np.nan], [3e5] * 2, [320.0, np.nan], [0.2, np.nan],
        ["converged", "no contact"],
    )  # fmt: skip
    both = averaged([one, other])
    np.testing.assert_allclose(both.friction, [0.3, np.nan])
    np.testing.assert_allclose(both.contact_fraction, [0.04, np.nan])
    np.testing.assert_allclose(both.temperature, [315.0, np.nan])  # by area, 1 to 3
    np.testing.assert_allclose(both.outside_band, [0.1, np.nan])
    assert list(both.status) == ["converged", "no contact"]
    assert list(both.status_word) == ["converged", ""]
    # a law linear in the temperature gives the mean of both terms
    term = averaged([one]).area_term(TemperatureProbe(), np.ones(2))[0]
    mean = 0.5 * (term + other.area_term(TemperatureProbe(), np.ones(2))[0])
    assert both.area_term(TemperatureProbe(), np.ones(2))[0] == pytest.approx(mean)
    with pytest.raises(InputError, match="at least one Predicted; got"):
        averaged([])
    with pytest.raises(InputError, match="same pressures"):
        averaged([one, Predicted([0.2], [0.02], [3e5], [300.0])])


def test_lengths_must_agree():
    with pytest.raises(InputError, match="must have the same length; got 1, 1, 2, 1, 1, 1 and 1"):
        Predicted([0.1], [0.03], [3e5, 3e5], [293.15])


POINTS = MeasuredFriction(
    [0.1, 1.0, 10.0], [0.5, 0.6, 0.7], [0.1, np.nan, 0.05], [293.15] * 3, pressure=[2e5, 3e5, 3e5]
)
NEAR = Predicted([0.4, 0.6, 0.8], [0.04, 0.03, 0.03], [2e5, 3e5, 3e5], [293.15] * 3)
FAR = Predicted([0.2, np.nan, 0.1], [0.04, np.nan, 0.03], [2e5, 3e5, 3e5], [293.15] * 3)


def test_differences_of_the_hysteresis():
    data = residuals(POINTS, {"near": NEAR, "far": FAR})
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


def test_an_area_term_is_added():
    data = residuals(POINTS, {"near": NEAR, "far": FAR}, ConstantStress(1e6))
    np.testing.assert_allclose(data.area_term.values[0], [0.2, 0.1, 0.1])
    np.testing.assert_allclose(data.friction.values[0], [0.6, 0.7, 0.9])
    np.testing.assert_allclose(data.friction.values[1], [0.4, np.nan, 0.2])
    assert data.measured_pressure.values.tolist() == [2e5, 3e5, 3e5]


def test_the_table_shows_every_number():
    """In the units of the case it is compared with: here bar."""
    beside = residuals(POINTS, {"near": NEAR}, ConstantStress(1e6))
    text = as_text(residual_table(beside.assign_attrs({DISPLAY_UNITS: '{"pressure": "bar"}'})))
    rows = [line.split() for line in text.splitlines()]
    assert ["0.100", "20.0", "2.00", "0.500", "0.100", "0.400", "0.600", "+0.100", "+1.0"] in rows
    assert ["1.00", "20.0", "3.00", "0.600", "-", "0.600", "0.700", "+0.100", "-"] in rows
    assert "Root mean square of Δμ, near: 0.141, 2.9 times the spread." in text


def test_a_table_without_what_is_not_known():
    bare = MeasuredFriction([0.1, 1.0, 10.0], [0.5, 0.6, 0.7])
    text = as_text(residual_table(residuals(bare, {"near": NEAR})))
    assert "°C" not in text
    assert "spread" not in text
    assert ["0.100", "0.500", "0.400", "-0.100"] in [line.split() for line in text.splitlines()]


def test_bad_predictions_are_one_sentence():
    with pytest.raises(InputError, match=r"at least one model; got \{\}"):
        residuals(POINTS, {})
    short = Predicted([0.1], [0.03], [3e5], [293.15])
    with pytest.raises(InputError, match="short must be predicted at the 3 points measured; got 1"):
        residuals(POINTS, {"short": short})
