import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import resample

RANDOM = np.random.default_rng(5)
X = np.cumsum(RANDOM.uniform(0.5e-4, 1.5e-4, 400))
WAVE = 2e-3


def sine(x):
    return 1e-4 * np.sin(2.0 * np.pi * x / WAVE)


def test_a_line_stays_a_line():
    profile = resample(X, 3e-3 - 0.2 * X, 1e-4)
    assert profile.z == pytest.approx(3e-3 - 0.2 * profile.x, abs=1e-16)
    assert (profile.x[0], profile.step) == (X[0], pytest.approx(1e-4))
    assert X[-1] - 1e-4 < profile.x[-1] <= X[-1]
    assert profile.missing == 0


def test_a_sine_is_met_to_the_error_of_a_chord():
    profile = resample(X, sine(X), 0.3e-4)
    worst = np.abs(profile.z - sine(profile.x)).max()
    longest = np.diff(X).max()
    bound = 1e-4 * (2.0 * np.pi * longest / WAVE) ** 2 / 8.0
    assert 0.5 * bound < worst <= bound


def test_falling_distances_give_the_same_profile():
    up, down = resample(X, sine(X), 1e-4), resample(X[::-1], sine(X)[::-1], 1e-4)
    assert np.array_equal(up.z, down.z)
    assert len(up.notes) == 1
    assert "turned round" in down.notes[0]


def test_gaps_stay_missing():
    even = np.delete(1e-4 * np.arange(60), [20, 21, 22, 40])
    z = sine(even)
    z[5] = np.nan
    profile = resample(even, z, 1e-4)
    # a single point left out is bridged, three are not; a missing height stays what it is
    assert np.flatnonzero(np.isnan(profile.z)).tolist() == [5, 20, 21, 22]
    assert resample(even, z, 1e-4, bridge=5e-4).missing == 1
    assert resample(even, z, 1e-4, bridge=1e-4).missing == 5
    assert np.flatnonzero(np.isnan(resample(even, z, 0.5e-4).z)).tolist()[:3] == [9, 10, 11]


def test_it_carries_no_more_than_was_measured():
    assert resample(X, sine(X), 1e-5).resolution_limit == pytest.approx(4e-4, rel=0.1)
    assert resample(X, sine(X), 3e-4).resolution_limit == pytest.approx(12e-4)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"x": X[:-1]}, "same length, at least 16; got 399 and 400"),
        ({"x": np.where(np.arange(400) == 9, 0.0, X)}, "rise or fall .* side by side"),
        ({"x": X + np.nan}, "x must be a list of finite numbers"),
        ({"step": 0.0}, "step must be greater than zero"),
        ({"step": 0.01}, "step must give 16 to 10000000 points over .* gives 4"),
        ({"step": 1e-10}, "16 to 10000000 points"),
        ({"bridge": -1.0}, "bridge must be greater than zero"),
        ({"z": np.full(400, np.nan)}, "all missing"),
    ],
)
def test_bad_arguments_are_refused(change, says):
    with pytest.raises(InputError, match=says):
        resample(**({"x": X, "z": sine(X), "step": 1e-4} | change))
