"""Drawn Prony series: as wide as the noise of the measurement, wider where there is none."""

import numpy as np
import pytest

from gripscale import MasterCurve
from gripscale.questions import SeriesScatter
from gripscale.rubber import fit_prony_report
from tests.rubber.test_measured_rubber import TREADS, for_speed
from tests.samples import POWER_LAW as TRUE

FREQUENCY = np.geomspace(1e-1, 1e6, 60)
OMEGA = 2 * np.pi * np.geomspace(1.0, 1e5, 6)


def series(noise, seed):
    modulus = TRUE.complex_modulus(2 * np.pi * FREQUENCY)
    factors = np.exp(noise * np.random.default_rng(seed).standard_normal((2, FREQUENCY.size)))
    master = MasterCurve(FREQUENCY, modulus.real * factors[0], modulus.imag * factors[1])
    rubber, fit = fit_prony_report(master, terms=9)
    return SeriesScatter.of(master, fit, rubber.bulk_modulus), rubber


def drawn(scatter, omega, number=60):
    """Return E* of draws, shape (draws, frequencies)."""
    random = np.random.default_rng(1)
    found = [scatter.draw(random) for _ in range(number)]
    return np.array([one.storage(omega) + 1j * one.loss(omega) for one in found])


def spread(values):
    """Return standard deviations of ln E' and ln E'', shape (2, frequencies)."""
    return np.array([np.log(values.real).std(axis=0), np.log(values.imag).std(axis=0)])


def test_draws_scatter_as_fits_of_repeated_measurements():
    """Best series of 30 measurements (known to 13 %) against draws of 6 of them."""
    best = [series(0.05, seed)[0] for seed in range(30)]
    spectra = [one.problem.spectrum(one.best) for one in best]
    repeated = spread(np.array([s.storage(OMEGA) + 1j * s.loss(OMEGA) for s in spectra]))
    told = np.sqrt(np.mean([spread(drawn(one, OMEGA)) ** 2 for one in best[:6]], axis=0))
    np.testing.assert_allclose(told.mean(axis=1), repeated.mean(axis=1), rtol=0.35)


def test_twice_the_noise_is_twice_the_scatter():
    small, large = (spread(drawn(series(noise, 3)[0], OMEGA)).mean() for noise in (0.04, 0.08))
    assert large / small == pytest.approx(2.0, rel=0.25)


def test_beyond_the_ends_more_is_open():
    scatter, _ = series(0.03, 4)
    inside = spread(drawn(scatter, OMEGA))[1].max()
    beyond = spread(drawn(scatter, 2 * np.pi * np.array([1e7, 3e7])))[1]
    assert (beyond > 2.0 * inside).all()


def test_draws_stay_within_what_the_data_allow():
    """The band of the admissible series is three standard deviations: 99.7 % of draws.

    At frequencies where the extremes were sought; between them their envelope is narrower.
    """
    scatter, rubber = series(0.04, 5)
    omega = 2 * np.pi * np.geomspace(1e-1, 1e6, 5)[1:4]
    low, high = rubber.complex_modulus_band(omega)
    found = drawn(scatter, omega, 200)
    for part in (np.real, np.imag):
        inside = (part(found) >= 0.99 * part(low)) & (part(found) <= 1.01 * part(high))
        assert inside.mean() > 0.97


@pytest.mark.parametrize("name", TREADS)
def test_draws_lie_about_the_series_of_a_case(name):
    """Within their scatter where the case decides; draws of all rows are 4 and 6 % beside it."""
    fitted, band = for_speed(name, 0.3), np.geomspace(*TREADS[name][3], 6)
    scatter = SeriesScatter.of(fitted.master, fitted.fit, fitted.rubber.bulk_modulus)
    found = drawn(scatter, band, 20)
    beside = np.log(np.abs(found / fitted.rubber.complex_modulus(band)))
    assert abs(beside.mean()) < 0.02
    assert 0.005 < spread(found).mean() < 0.03
