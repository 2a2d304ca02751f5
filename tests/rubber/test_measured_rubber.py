"""The fit of a rubber for a case: where its waves excite it the series has the measured moduli."""

from functools import cache

import numpy as np
import pytest

from gripscale.rubber import fit_prony_report, read_master_curve
from gripscale.rubber.material import MeasuredModuli
from gripscale.rubber.measured_rubber import MeasuredRubber, row_weights
from tests.samples import EXAMPLES, MEASURED_DMA

# Waves of the shipped road down to 0.1 mm: an octave apart, about equal slopes.
WAVELENGTH = 1e-3 * np.array([28.7, 12.8, 5.70, 2.54, 1.13, 0.504, 0.224, 0.1])
SLOPE = np.sqrt([0.096, 0.103, 0.111, 0.119, 0.128, 0.137, 0.147, 0.158])
# File, temperature, a_T of the case, and where nine tenths of d ln mu / d ln E' and E'' lie on that
# road at 0.3 m/s [rad/s], by the adjoint of its direct contact (S100 softened and warmed).
TREADS = {
    "tread": (MEASURED_DMA, "20 C", 1.0, (75.0, 2.4e4)),
    "S100": (
        EXAMPLES / "data" / "friction" / "S100_master_curve.csv",
        "40 C",
        92.5,
        (7.5e3, 7.5e5),
    ),
}


@cache
def measured(name):
    path, kelvin, _, _ = TREADS[name]
    master = read_master_curve(path, reference_temperature=kelvin)
    rubber, fit = fit_prony_report(master)
    return MeasuredRubber(rubber, "", master, fit)


def for_speed(name, speed):
    omega = 2.0 * np.pi * TREADS[name][2] * speed / WAVELENGTH
    return measured(name).fitted_for(omega, SLOPE)


def mean_misfit(rubber, rows, band):
    """Return the mean relative errors of E', E'' and the loss factor in a band [-]."""
    inside = (rows.omega >= band[0]) & (rows.omega <= band[1])
    modulus = rubber.complex_modulus(rows.omega)
    storage, loss = (modulus.real / rows.storage)[inside], (modulus.imag / rows.loss)[inside]
    return np.array([storage.mean(), loss.mean(), (loss / storage).mean()]) - 1.0


@pytest.mark.parametrize("name", TREADS)
def test_where_a_case_decides_its_series_has_the_measured_moduli(name):
    """Asked 2 %, within the scatter of the rows; evenly weighted it is 6 to 14 %."""
    even, fitted, band = measured(name), for_speed(name, 0.3), TREADS[name][3]
    rows = even.fit.problem.rows
    assert np.abs(mean_misfit(fitted.rubber, rows, band)).max() < 0.02
    assert np.abs(mean_misfit(even.rubber, rows, band)).min() > 0.05
    assert fitted.fit.rms_storage > even.fit.rms_storage  # the report is that of its series
    assert (fitted.rubber.moduli > 0.0).all()


def test_the_weights_follow_the_speed():
    rows = measured("tread").fit.problem.rows
    slow, fast = (
        row_weights(rows, 2.0 * np.pi * speed / WAVELENGTH, SLOPE) for speed in (3e-3, 30.0)
    )
    # four decades of speed; weights lie between those of a row that decides nothing and all
    assert np.log10(rows.omega[fast.argmax()] / rows.omega[slow.argmax()]) == pytest.approx(4, 0.1)
    for weight in (slow, fast):
        assert weight.max() == pytest.approx(101.0)
        assert 1.0 <= weight.min() < 1.2
    off = mean_misfit(for_speed("tread", 3e-3).rubber, rows, TREADS["tread"][3])
    assert np.abs(off).max() > 0.05  # of another load


def test_at_rest_all_rows_count_alike_whatever_was_fitted_before():
    """Bit by bit, so that stored results are found again; so is a fit for the same load."""
    even, fitted = measured("tread"), for_speed("tread", 0.3)
    again = fitted.fitted_for(np.zeros(8), SLOPE)
    np.testing.assert_array_equal(again.rubber.moduli, even.rubber.moduli)
    assert again.fit.rms_loss == even.fit.rms_loss
    other = fitted.fitted_for(np.full(8, 7.0), SLOPE)
    omega = 2.0 * np.pi * 0.3 / WAVELENGTH
    np.testing.assert_array_equal(
        other.fitted_for(omega, SLOPE).rubber.moduli, fitted.rubber.moduli
    )


def test_a_rubber_without_a_measurement_stays():
    made = MeasuredRubber(measured("tread").rubber, "by hand")
    assert made.fitted_for(np.ones(8), SLOPE) is made


def test_the_measured_moduli_are_those_of_the_rows_and_beyond_them_of_the_series():
    rubber = for_speed("tread", 0.3).rubber
    rows, moduli = rubber.admissible, MeasuredModuli.of(rubber)
    once = np.diff(rows.omega, prepend=0.0) > 0.0
    once &= np.diff(rows.omega, append=np.inf) > 0.0
    found = moduli.complex_modulus(rows.omega[once])
    np.testing.assert_allclose(found.real, rows.storage[once], rtol=1e-12)
    np.testing.assert_allclose(found.imag, rows.loss[once], rtol=1e-12)
    beyond = np.array([0.0, 1e-6, 1e18])
    np.testing.assert_array_equal(moduli.complex_modulus(beyond), rubber.complex_modulus(beyond))
    assert moduli.complex_modulus(-30.0) == np.conj(moduli.complex_modulus(30.0))
