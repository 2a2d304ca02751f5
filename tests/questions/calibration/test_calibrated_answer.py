"""A case with the area term fitted to measured friction answers with the fitted friction.

The area that a fitted stress shears is that of the answer: with the step from lines to a surface,
which takes a third of it away. A fit beside the area of the lines misses by as much.
"""

from dataclasses import replace

import numpy as np
import pytest

import gripscale as gs
from gripscale.case import BelowMeasurement
from gripscale.conditions import (
    Conditions,
    ConstantStress,
    GaussianStress,
)
from gripscale.continuation import HurstExponent
from gripscale.experiment import MeasuredFriction
from gripscale.io import netcdf
from gripscale.io.table import significant
from gripscale.questions.calibration.question import SAME_FRICTION
from gripscale.questions.compare import comparison
from gripscale.surface import self_affine_profile
from tests.samples import SHIFTED_RUBBER, THERMAL, write_master_curve, write_road

LINES = [
    self_affine_profile(0.8, 3e-3, 8e-4, length=length, step=2e-4, seed=seed)
    for length, seed in ((0.1, 1), (0.14, 2))
]
"""Two of different lengths."""
TRUE = GaussianStress(4e6, 0.1, 0.05, 0.9, 293.15)
SPEEDS, KELVINS, PRESSURES = [0.03, 0.1, 0.3, 0.03, 0.3], [283.15] * 3 + [303.15] * 2, [3e5, 2e5]


LAW = '[conditions.shear_stress]\nkind = "constant"\nstress_0 = "9 MPa"\n'


def made(conditions, lines=LINES, **changed):
    """Return a case of lines under conditions, with other arguments where they are stated."""
    usual = {"pressure": 3e5, "speed": 0.1, "footprint": 0.05, "smallest_wavelength": 1e-3}
    arguments = {"waves": 3, "filled": False, "conditions": conditions, **usual, **changed}
    return gs.Case(lines, SHIFTED_RUBBER, **arguments)


def answer_at(law, at, heat="none"):
    """Return the answer of the case with `law` at a measured point."""
    conditions = Conditions(temperature=KELVINS[at], heat=heat, shear_stress=law)
    return gs.answer(made(conditions, speed=SPEEDS[at], pressure=PRESSURES[at % 2]))


def measured_at(friction):
    """Return friction of the measured points, with a little noise."""
    noisy = friction + np.random.default_rng(0).normal(0.0, 0.003, len(SPEEDS))
    pressure = np.resize(PRESSURES, len(SPEEDS))
    return MeasuredFriction(SPEEDS, noisy, [0.003] * len(SPEEDS), KELVINS, pressure=pressure)


FIXED = {"reference_temperature": 293.15}


@pytest.fixture(scope="module")
def calibrated():
    """The fit to the friction that the case itself has with a known law, and a little noise."""
    friction = np.array([answer_at(TRUE, at).friction for at in range(len(SPEEDS))])
    case = made(Conditions(temperature=293.15, heat="none"))
    return gs.calibrate(case, measured_at(friction), fixed=FIXED)


def test_the_answer_is_the_fitted_friction(calibrated):
    data = calibrated.data
    residual = np.abs(data.difference.values).max()
    assert residual < 0.01
    for at in range(len(SPEEDS)):
        answer = answer_at(calibrated.law, at)
        assert answer.hysteresis_friction == pytest.approx(float(data.hysteresis[at]), rel=1e-12)
        assert answer.contact_fraction == pytest.approx(float(data.contact_fraction[at]), rel=1e-12)
        assert answer.friction == pytest.approx(float(data.friction[at]), rel=1e-12)
        misfit = answer.friction - float(data.measured_friction[at])
        assert abs(misfit) <= residual + 1e-12


def test_the_area_is_not_that_of_the_lines(calibrated):
    answer = answer_at(calibrated.law, 0).data
    assert float(answer.answer_contact_fraction / answer.total_contact_fraction) < 0.8
    ratio = answer.answer_interface_friction / answer.total_adhesive_friction
    assert float(ratio) == pytest.approx(
        float(answer.answer_contact_fraction / answer.total_contact_fraction)
    )


@pytest.mark.verification
def test_the_answer_is_the_fitted_friction_with_the_heat_of_the_interface():
    """To the agreement of the fits, and a law of the mean temperature for the mean of the law."""
    points = range(len(SPEEDS))
    friction = np.array([answer_at(TRUE, at, THERMAL).friction for at in points])
    case = made(Conditions(temperature=293.15, heat=THERMAL))
    data = (fit := gs.calibrate(case, measured_at(friction), fixed=FIXED)).data
    assert (data.contact_temperature.values > np.array(KELVINS) + 0.1).all()
    residual = np.abs(data.difference.values).max()
    assert residual < 0.01
    answer = answer_at(fit.law, points[-1], THERMAL)
    assert answer.friction == pytest.approx(float(data.friction[-1]), abs=1.5 * SAME_FRICTION)
    assert answer.interface_friction > 0.2 * answer.friction


def test_the_answer_at_a_measured_point_is_that_of_the_case(tmp_path):
    case = made(Conditions(temperature=293.15, heat="none", shear_stress=TRUE), LINES[:1])
    measured = MeasuredFriction([0.1], [0.5], temperature=[293.15])
    compared = gs.compare(case, models=["direct"], measured=measured)
    residuals = comparison.at_measured(compared.ladder, tmp_path)
    total = float(residuals.friction.sel(model="answer", measurement=0))
    assert total == pytest.approx(gs.answer(case).friction)


def test_files_give_the_measured_friction_back(shell, tmp_path):
    write_road(tmp_path / "road.txt", LINES[0])
    frequency = np.geomspace(1e-1, 1e5, 30)
    modulus = SHIFTED_RUBBER.complex_modulus(2.0 * np.pi * frequency)
    write_master_curve(tmp_path / "dma.txt", frequency, modulus)
    case = tmp_path / "case.toml"
    text = (
        '[surface]\nfiles = ["road.txt"]\nscales = 3\nsmallest_wavelength = "1 mm"\n'
        '[rubber]\nfilled = false\nfile = "dma.txt"\nreference_temperature = "20 C"\n'
        '[load]\npressure = "3 bar"\nspeed = "0.1 m/s"\nfootprint = "50 mm"\n'
    )
    rows = []
    for speed in (0.03, 0.1, 0.3):
        case.write_text(f"{text}{LAW}".replace("0.1 m/s", f"{speed} m/s"), encoding="utf-8")
        rows.append(f"{speed},{gs.answer(gs.read_case(case)).friction:.3f}\n")
    (tmp_path / "mu.csv").write_text(f"speed [m/s],friction\n{''.join(rows)}", encoding="utf-8")
    measured = f'{text}[measured]\nfriction = "mu.csv"\n'
    case.write_text(measured, encoding="utf-8")
    run = shell("calibrate", case, "--law", "constant", "--output", tmp_path / "fit")
    fit = netcdf.load_dataset(tmp_path / "fit" / "calibration.nc")
    law = (tmp_path / "fit" / "shear_stress.toml").read_text(encoding="utf-8")
    case.write_text(f"{measured}{law}", encoding="utf-8")
    run = shell("run", case, "--output", tmp_path / "run", columns=500)
    answer = netcdf.load_dataset(tmp_path / "run" / "answer.nc")
    total = float(answer.answer_friction)
    assert total == pytest.approx(float(fit.friction[1]), rel=1e-5)  # six digits in the file
    # the table has three digits
    assert total == pytest.approx(float(fit.measured_friction[1]), abs=1e-3)
    assert f"μ = {significant(total)}: " in run.stdout


def test_roughness_below_the_measurement_is_in_the_fitted_area():
    line = self_affine_profile(0.8, 3e-3, 8e-4, length=0.15, step=2e-4, seed=1)
    continued = BelowMeasurement(4e-4, HurstExponent(0.8))  # the line is too short to foretell it

    def case(law=None):
        conditions = Conditions(heat="none", shear_stress=law)
        return made(conditions, line, below_measurement=continued)

    truth = gs.answer(case(ConstantStress(4e6)))
    measured = MeasuredFriction([0.1, 0.1], [truth.friction] * 2)
    result = gs.calibrate(case(), measured, law="constant")
    assert result.estimates[0].value == pytest.approx(4e6, rel=1e-6)
    assert gs.answer(case(result.law)).friction == pytest.approx(truth.friction, rel=1e-9)


def test_the_interval_at_the_points_is_that_of_fit_and_measurement(calibrated):
    """At most twice their errors; without the record of its points that of the whole answer."""
    law, data = calibrated.law, calibrated.data
    error = np.hypot(data.friction_band.values / 1.645, 0.003 * max(data.attrs["scatter"], 1.0))
    for at in (0, len(SPEEDS) - 1):
        answer, forgetful = (answer_at(each, at) for each in (law, replace(law, fitted_to=None)))
        low, high = answer.friction_interval
        assert high - low <= 2.0 * 2.0 * error[at]
        assert low < float(data.measured_friction[at]) < high
        assert answer.contact_fraction_interval == forgetful.contact_fraction_interval
        before = np.subtract(*forgetful.friction_interval[::-1])
        assert before > 5.0 * (high - low)


def relative_width(law, **changes):
    """Return ln(high/low) of the friction at the last point, with other inputs of the case."""
    conditions = Conditions(
        temperature=changes.pop("temperature", KELVINS[-1]), heat="none", shear_stress=law
    )
    case = made(conditions, **{"speed": SPEEDS[-1], "pressure": 3e5} | changes)
    low, high = gs.answer(case).friction_interval
    return float(np.log(high / low))


@pytest.fixture(scope="module")
def near(calibrated):
    return relative_width(calibrated.law)


@pytest.mark.parametrize(
    "changes", [{"speed": 3.0}, {"temperature": 313.15}, {"pressure": 3e6}, {"footprint": 0.06}]
)
def test_away_from_the_points_the_interval_is_that_of_the_answer(calibrated, near, changes):
    """A decade or 10 K away, at several times the area, or on another contact."""
    wide = relative_width(calibrated.law, **changes)
    today = relative_width(replace(calibrated.law, fitted_to=None), **changes)
    assert wide == pytest.approx(today, rel=0.02)
    assert wide > 3.0 * near


def test_between_near_and_away_the_variance_rises_in_proportion(calibrated):
    law, forgetful = calibrated.law, replace(calibrated.law, fitted_to=None)
    squares = []
    for speed in (0.3, 0.3 * 10.0**0.25, 0.3 * 10.0**0.5):
        ratio = relative_width(law, speed=speed) / relative_width(forgetful, speed=speed)
        squares.append(ratio**2)
    assert np.diff(squares) == pytest.approx(0.3, abs=0.06)  # 0.25, and the change of the area


def test_a_variation_and_a_comparison_know_the_fit(calibrated):
    conditions = Conditions(temperature=KELVINS[-1], heat="none", shear_stress=calibrated.law)
    case = made(conditions, speed=0.3)
    width = np.subtract(*gs.answer(case).friction_interval[::-1])
    varied = gs.vary(case, speed=[0.3, 3.0]).data
    widths = (varied.answer_friction_high - varied.answer_friction_low).values
    assert widths[0] == pytest.approx(width, rel=0.01)
    assert widths[1] > 3.0 * width
    compared = gs.compare(case, models=["direct"]).data
    high, low = (float(compared[f"answer_friction_{end}"]) for end in ("high", "low"))
    assert high - low == pytest.approx(width, rel=1e-6)


def test_the_record_of_the_points_is_saved_with_the_case(calibrated, tmp_path):
    conditions = Conditions(temperature=293.15, heat="none", shear_stress=calibrated.law)
    made(conditions).save(tmp_path / "case.toml")
    read = gs.read_case(tmp_path / "case.toml").conditions
    assert read.shear_stress == calibrated.law
    assert calibrated.law.fitted_to is not None
