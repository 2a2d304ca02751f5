"""The Prony fit on series known beforehand, with noise and planted outliers, and on real data."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripscale.core.errors import InputError, RubberWarning
from gripscale.rubber import MasterCurve, Rubber, fit_prony, fit_prony_report, read_master_curve
from tests.rubber.truths import curve_of
from tests.samples import MEASURED_DMA as TREAD


def broad_rubber():
    """A rubber whose spectrum rises by a factor of two a decade over nine decades."""
    times = np.logspace(-8, 0, 9)
    return Rubber(2e6, 1e6 * 2.0 ** np.arange(8, -1, -1), times, bulk_modulus=2e9)


def sample(rubber, low, high, rows, noise=0.0):
    return curve_of(rubber.complex_modulus, np.geomspace(low, high, rows), noise, seed=7)


def misfit(fitted, truth, low, high):
    """Largest error of E* over |E*| on a fine grid."""
    omega = np.geomspace(low, high, 400)
    exact = truth.complex_modulus(omega)
    return float(np.max(np.abs(fitted.complex_modulus(omega) - exact) / np.abs(exact)))


def test_a_series_on_its_own_times_is_recovered():
    """Exact data, times of the fit equal to those of the series, no smoothing: exact but for
    rounding, whose gain is the condition of the problem (about 1e4)."""
    truth = broad_rubber()
    curve = sample(truth, 1e0, 1e8, 81)
    fitted = fit_prony(curve, terms=9, smoothing=0.0, extrapolate_decades=0.0)
    assert fitted.relaxation_times == pytest.approx(truth.relaxation_times, rel=1e-9)
    assert fitted.moduli == pytest.approx(truth.moduli, rel=1e-8)
    assert fitted.equilibrium_modulus == pytest.approx(2e6, rel=1e-8)


@given(st.lists(st.floats(1e5, 3e6), min_size=9, max_size=9), st.floats(5e5, 5e6))
@settings(max_examples=25, deadline=None, derandomize=True)
def test_any_broad_spectrum_is_fitted(moduli, equilibrium):
    """Neighbouring moduli may differ 30-fold. The elements of the fit sit up to a third of a
    decade from the true ones, which moves a lone step of E* by a few per cent: 5 %."""
    truth = Rubber(equilibrium, moduli, np.logspace(-8, 0, 9))
    fitted = fit_prony(sample(truth, 1.0, 1e8, 81))
    assert misfit(fitted, truth, 1.0, 1e8) < 0.05
    assert (fitted.moduli > 0.0).all()


@pytest.mark.parametrize(
    "truth",
    [
        Rubber(1e6, [1e7], [1e-3]),
        Rubber(1e6, [5e6, 2e7, 1e8], [1e-1, 2e-4, 3e-7]),
        broad_rubber(),
        Rubber(1e6, [2e6, 3e7, 5e5, 2e7, 1e6, 3e7], [3e-1, 2e-2, 1.7e-3, 1.4e-4, 1e-5, 1.3e-6]),
    ],
    ids=["one term", "three terms", "one a decade", "unequal"],
)
def test_clean_data_of_few_terms_are_met_to_a_per_cent(truth):
    """Terms at the times of a smooth spectrum miss E'' by up to 27 %, a sharp spectrum by 0.5 %."""
    fitted, report = fit_prony_report(sample(truth, 1.0, 1e8, 81))
    omega = np.geomspace(1.0, 1e8, 400)
    ratio = [fitted.complex_modulus(omega), truth.complex_modulus(omega)]
    assert ratio[0].real == pytest.approx(ratio[1].real, rel=0.01)
    assert ratio[0].imag == pytest.approx(ratio[1].imag, rel=0.01)
    assert report.consistent


@pytest.mark.parametrize("noise", [0.02, 0.05])
def test_planted_outliers_and_only_these_are_found(noise):
    """Factors of 0.3 to 3 are 20 times the scatter of 5 %; none of 120 clean rows is 8 times."""
    truth = broad_rubber()
    clean = sample(truth, 1.0, 1e8, 120, noise)
    storage, loss = clean.storage.copy(), clean.loss.copy()
    storage[40] *= 0.3
    loss[80] *= 3.0
    loss[-1] *= 2.5
    storage[0] *= 2.0
    fitted, report = fit_prony_report(MasterCurve(clean.frequency, storage, loss))
    assert report.outlier_frequency == pytest.approx(clean.frequency[[0, 40, 80, 119]])
    # noise averages over some 10 rows per free modulus; the ends have one neighbour only
    assert misfit(fitted, truth, 10.0, 1e7) < 2.0 * noise
    assert report.storage_scatter == pytest.approx(noise, rel=0.5)
    _, kept = fit_prony_report(
        MasterCurve(clean.frequency, storage, loss), outlier_threshold=np.inf
    )
    assert kept.outlier_frequency.size == 0


def test_one_relaxation_time_is_no_outlier():
    """A Zener solid has the sharpest curvature there is; its peak must not be thrown away."""
    truth = Rubber(1e6, [9e6], [3e-3])
    fitted, report = fit_prony_report(sample(truth, 1.0, 1e5, 51, 0.01))
    assert report.outlier_frequency.size == 0
    assert misfit(fitted, truth, 1.0, 1e5) < 0.03


def test_the_measured_tread_curve():
    """Real data; bounds a little above what was found (9.0 %, 8.7 %, 14.4 %).

    Far above the scatter of 3 and 5 %: the measured E' rises less than the measured E'' demands,
    so no series does better (the same with 40 terms, times two decades beyond the band).
    """
    curve = read_master_curve(TREAD)
    rubber, report = fit_prony_report(curve)
    assert report.outlier_frequency == pytest.approx([0.418, 9.89e10, 2.13e11, 4.59e11, 9.89e12])
    assert report.rms_storage < 0.095
    assert report.rms_loss < 0.095
    assert report.rms_loss_factor < 0.15
    assert not report.consistent
    assert report.terms == 23
    assert len(report.candidates) == 7
    free = fit_prony_report(curve, terms=40, smoothing=0.0, extrapolate_decades=2.0)[1]
    assert free.rms_storage > 0.085
    assert "E' and E'' do not belong to one linear solid (Kramers-Kronig)" in report.summary()
    slow, broad = report.inconsistencies[:2]
    assert (slow.low, slow.high) == pytest.approx((0.0263, 2.72), rel=0.01)
    assert (broad.low, broad.high) == pytest.approx((135, 2.65e9), rel=0.01)
    # the drawing shows E' of the fit 12 % low at the slow end, 13 % high at 1e4 to 1e5 rad/s
    assert (slow.storage, broad.storage) == pytest.approx((-0.12, 0.13), abs=0.01)
    assert "9.89e+10" in report.summary()
    assert rubber.valid_band == pytest.approx((2 * np.pi * 4.18e-3, 2 * np.pi * 4.59e12))
    assert rubber.equilibrium_modulus < 6.68e6 < float(rubber.complex_modulus(1.0).real)
    # spot values of the data within the misfit stated above
    assert rubber.complex_modulus(2 * np.pi * 1e2).real == pytest.approx(12.3e6, rel=0.12)
    assert rubber.loss_factor(2 * np.pi * 7.93e7) == pytest.approx(0.702, rel=0.15)


def test_smoothing_removes_the_spikes_of_a_bare_fit():
    """With 28 terms the bare fit has neighbours more than a decade apart or none at all."""
    curve = read_master_curve(TREAD)
    bare, smooth = (
        fit_prony_report(curve, terms=28, smoothing=s, extrapolate_decades=0.0) for s in (0.0, 0.3)
    )
    assert len(smooth[0].moduli) == 28
    assert np.abs(np.diff(np.log10(smooth[0].moduli))).max() < 1.0
    assert len(bare[0].moduli) < 28 or np.abs(np.diff(np.log10(bare[0].moduli))).max() > 1.0
    # and the fit is no worse for it, by half a point of per cent
    assert smooth[1].rms_storage < bare[1].rms_storage + 0.005
    assert smooth[1].rms_loss < bare[1].rms_loss + 0.005


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"terms": 0}, "terms must be a whole number from 1 to 200"),
        ({"terms": 2.5}, "terms must be a whole number"),
        ({"outlier_threshold": 0.0}, "outlier_threshold must be greater than zero"),
        ({"extrapolate_decades": -1.0}, "extrapolate_decades must not be negative"),
        ({"extrapolate_decades": 21.0}, "extrapolate_decades must be at most 20; got 21"),
        ({"smoothing": 1e90}, r"smoothing must be at most 1e.06; got 1e.90"),
        (
            {"bulk_modulus": 1e300},
            "bulk_modulus must be a finite number .* of at most 1e.100; got 1e.300",
        ),
        ({"smoothing": -0.1}, "smoothing must not be negative"),
        ({"bulk_modulus": 1e6}, "bulk_modulus .* 2/9 of the largest measured E', 3.8.*e.08"),
        ({"bulk_modulus": 10**400}, "bulk_modulus must be a finite number .* more than 80 digits"),
    ],
)
def test_bad_options(options, message):
    with pytest.raises(InputError, match=message):
        fit_prony(sample(broad_rubber(), 1.0, 1e8, 30), **options)


def test_too_little_data():
    with pytest.raises(InputError, match=r"at least 4 rows .* got 2 over 1 decades"):
        fit_prony(MasterCurve([1.0, 10.0], [1e6, 2e6], [1e5, 1e5]))
    with pytest.raises(InputError, match="got 4 over 0 decades"):
        fit_prony(MasterCurve([1.0] * 4, [1e6] * 4, [1e5] * 4))


def test_few_rows_still_give_a_rubber():
    truth = Rubber(1e6, [9e6], [1e-2])
    fitted, report = fit_prony_report(sample(truth, 1.0, 1e4, 5))
    assert report.candidates == ()
    assert misfit(fitted, truth, 10.0, 1e3) < 0.1


@pytest.mark.filterwarnings("always::gripscale.RubberWarning")
def test_a_fit_in_python_warns_of_what_the_terminal_prints():
    soft = MasterCurve([0.1, 1.0, 10.0, 100.0], [2.0, 2.5, 3.0, 3.5], [0.2, 0.3, 0.3, 0.4])
    with pytest.warns(RubberWarning) as caught:
        fit_prony(soft)
    sentences = " ".join(str(warning.message) for warning in caught)
    _, report = fit_prony_report(soft)
    assert "The largest E', 3.5e-06 MPa, is that of no rubber" in sentences
    assert "the temperature of the moduli is not known" in sentences
    assert len(caught) == len(report.doubts) + len(report.findings) + 1
    assert {Path(warning.filename).name for warning in caught} == {"test_prony_fit.py"}
