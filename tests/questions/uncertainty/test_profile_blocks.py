"""Blocks of profiles scatter as other stretches of the same road do, and make no steps."""

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.questions import ProfileBlocks
from gripscale.surface import height_difference, self_affine_profile

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
