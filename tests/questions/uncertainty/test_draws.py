"""Drawn series and blocks of road scatter as repeated measurements do; shares of their variance."""

import numpy as np
import pytest

from gripscale import MasterCurve
from gripscale.core.errors import InputError
from gripscale.questions import ProfileBlocks, SeriesScatter, shares
from gripscale.rubber import fit_prony_report
from gripscale.surface import height_difference, self_affine_profile
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


def evenly(samples, seed, count):
    """Return numbers spread evenly from -1 to 1, a column for each source: variance 1/3."""
    random = np.random.default_rng(seed)
    places = np.array([random.permutation(samples) for _ in range(count)])
    return (2.0 * (places + random.random(places.shape)) / samples - 1.0).T


def answer(x):
    """Return exp(3 x_0 + 2 x_1 + 3 x_2^2 + 2 x_3 x_4), x evenly spread from -1 to 1.

    Variances: 9/3, 4/3, 9 (1/5 - 1/9) = 4/5, and 4/9 of the interaction, which is nobody's own.
    """
    return np.exp(3 * x[:, 0] + 2 * x[:, 1] + 3 * x[:, 2] ** 2 + 2 * x[:, 3] * x[:, 4])


VARIANCES = np.array([3.0, 4 / 3, 0.8, 0.0, 0.0])
EXACT = VARIANCES / (VARIANCES.sum() + 4 / 9)


def estimated(samples, seed):
    x = evenly(samples, seed, 5)
    return shares(answer(x), {f"x{k}": x[:, [k]] for k in range(5)})


def test_known_indices_are_met():
    """With 4000 samples the standard error of a share is 0.01; four of them are let through."""
    found = estimated(4000, 1)
    assert (found.error < 0.015).all()
    np.testing.assert_allclose(found.share, EXACT, atol=0.04)
    assert 1.0 - found.share.sum() == pytest.approx(4 / 9 / (VARIANCES.sum() + 4 / 9), abs=0.02)


def of_repeats(evenly_spread):
    """Return the shares of 40 repeats of 100 samples, and the errors they tell."""
    found = []
    for seed in range(40):
        x = 2.0 * np.random.default_rng(seed).random((100, 5)) - 1.0
        x = evenly(100, seed, 5) if evenly_spread else x
        found.append(shares(answer(x), {f"x{k}": x[:, [k]] for k in range(5)}))
    return np.array([one.share for one in found]), np.mean([one.error for one in found], axis=0)


def test_the_error_is_that_of_repeated_independent_samples():
    """The jackknife against the scatter of 40 repeats, itself known to 1/sqrt(80) = 11 %."""
    found, told = of_repeats(evenly_spread=False)
    np.testing.assert_allclose(told[:3], found.std(axis=0, ddof=1)[:3], rtol=0.35)


def test_evenly_spread_samples_are_no_worse_than_their_error():
    """They scatter less than independent ones; no share is off by more than its repeats tell."""
    found, told = of_repeats(evenly_spread=True)
    scatter = found.std(axis=0, ddof=1)
    assert (scatter[:3] < 1.2 * told[:3]).all()
    bias = found.mean(axis=0) - EXACT
    assert (np.abs(bias) < 3.5 * scatter / np.sqrt(40)).all(), bias


def test_a_source_of_several_numbers_has_one_share():
    x = evenly(2000, 3, 4)
    y = np.exp(x[:, 0] + x[:, 1] + 2 * x[:, 2])
    found = shares(y, {"two": x[:, :2], "one": x[:, [2]], "none": x[:, [3]]})
    np.testing.assert_allclose(found.share, [1 / 3, 2 / 3, 0.0], atol=0.03)


def test_no_effect_is_not_told_from_nothing():
    x = evenly(60, 5, 3)
    noise = np.random.default_rng(5).standard_normal(60)
    found = shares(np.exp(x[:, 0] + x[:, 1] + noise), {f"x{k}": x[:, [k]] for k in range(3)})
    assert found.share[2] < 1.645 * found.error[2]


def test_failed_samples_do_not_count():
    x = evenly(400, 6, 5)
    y = answer(x)
    whole = shares(y[40:], {f"x{k}": x[40:, [k]] for k in range(5)})
    y[:40] = np.nan
    found = shares(y, {f"x{k}": x[:, [k]] for k in range(5)})
    np.testing.assert_array_equal(found.share, whole.share)


@pytest.mark.parametrize("samples", [8, 0])
def test_too_few_samples_tell_nothing(samples):
    x = evenly(max(samples, 1), 7, 3)[:samples]
    assert shares(np.exp(x[:, 0]), {f"x{k}": x[:, [k]] for k in range(3)}) is None


WAVE = 9e-3


def road(seed, length=0.6):
    return self_affine_profile(0.8, 3e-3, 8e-4, length, 2e-4, seed)


@pytest.fixture(scope="module")
def blocks():
    return ProfileBlocks([road(0)], WAVE)


def logs(hdc, lags=(1e-3, 3e-3, 9e-3)):
    return np.interp(np.log(lags), np.log(hdc.lag), np.log(hdc.value))


def test_all_blocks_once_are_the_measured_correlation(blocks):
    whole = height_difference(road(0))
    found = blocks.correlation(np.arange(len(blocks)))
    np.testing.assert_allclose(found.value, whole.value, rtol=1e-12)


def test_draws_scatter_as_other_roads():
    """Standard deviations of ln C_z over 60 roads, and over draws in the mean of 12 of them.

    That of 60 is known to 9 %, the mean of 12 bootstrap variances of 16 blocks to about as much.
    """
    scatter = np.std([logs(height_difference(road(s))) for s in range(60)], axis=0, ddof=1)
    variances = []
    for seed in range(12):
        cut, random = ProfileBlocks([road(seed)], WAVE), np.random.default_rng(seed)
        drawn = [logs(cut.correlation(cut.draw(random))) for _ in range(100)]
        variances.append(np.var(drawn, axis=0, ddof=1))
    np.testing.assert_allclose(np.sqrt(np.mean(variances, axis=0)), scatter, rtol=0.35)


def test_lines_of_blocks_keep_the_correlation_and_make_no_steps(blocks):
    random, measured = np.random.default_rng(2), road(0)
    steepest = np.abs(np.diff(measured.z)).max()
    found = []
    for _ in range(40):
        (line,) = blocks.lines(blocks.draw(random))
        assert np.abs(np.diff(line.z)).max() < 1.5 * steepest
        found.append(logs(height_difference(line)))
    assert line.length == pytest.approx(measured.length * (1 - 1 / len(blocks)), rel=0.02)
    mean, error = np.mean(found, axis=0), np.std(found, axis=0) / np.sqrt(40)
    away = mean - logs(height_difference(measured))
    assert (np.abs(away) < 3.5 * error + 0.02).all(), (away, error)


def test_two_profiles_become_two_lines():
    cut = ProfileBlocks([road(0), road(1)], WAVE)
    lines = cut.lines(cut.draw(np.random.default_rng(0)))
    assert len(lines) == 2
    assert sum(len(line) for line in lines) < 2 * len(road(0))


def test_missing_heights_stay_missing():
    line = road(0)
    z = line.z.copy()
    z[::50] = np.nan
    cut = ProfileBlocks([type(line)(line.x, z)], WAVE)
    (drawn,) = cut.lines(cut.draw(np.random.default_rng(0)))
    assert 0.015 < drawn.missing / len(drawn) < 0.03


def test_too_short_profiles_are_refused():
    with pytest.raises(InputError, match="4 blocks as long as the largest wave"):
        ProfileBlocks([road(0, length=0.03)], WAVE)
    with pytest.raises(InputError, match="block_length"):
        ProfileBlocks([road(0)], WAVE, block_length=-1.0)
