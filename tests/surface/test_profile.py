from dataclasses import replace

import numpy as np
import pytest

from gripscale.core.errors import InputError
from gripscale.surface import Measured, Profile

X = 1e-4 * np.arange(20)
Z = np.sin(np.arange(20.0))


def changed(values, at, to):
    values = values.copy()
    values[at] = to
    return values


def test_profile_knows_its_step_length_and_missing_points():
    profile = Profile(X, changed(Z, 3, np.nan), name="road")
    assert profile.step == pytest.approx(1e-4, rel=1e-12)
    assert profile.length == pytest.approx(19e-4, rel=1e-12)
    assert (len(profile), profile.missing) == (20, 1)
    assert "road" in repr(profile)


def test_profile_keeps_its_own_copy_that_cannot_be_written():
    z = Z.copy()
    profile = Profile(X, z)
    z[0] = 99.0
    assert profile.z[0] == Z[0]
    with pytest.raises(ValueError, match="read-only"):
        profile.z[0] = 1.0


def test_points_may_stand_a_twentieth_of_a_step_off_the_grid_but_not_more():
    Profile(X + 1000.0, Z)  # x far from zero: floating-point steps are coarse
    # The grid that fits best follows a point by a share of 1/20, its leverage among twenty points.
    Profile(changed(X, 10, X[10] + 0.05e-4), Z)
    with pytest.raises(InputError, match=r"after index 9 .*resample makes steps equal"):
        Profile(changed(X, 10, X[10] + 0.056e-4), Z)


def test_falling_distances_are_turned_round_and_it_is_said():
    profile = Profile(X[::-1], Z[::-1], notes=("by hand",))
    assert np.array_equal(profile.x, X)
    assert np.array_equal(profile.z, Z)
    assert profile.notes[0] == "by hand"
    assert "turned round" in profile.notes[1]
    assert Profile(profile.x, profile.z).notes == ()


def test_the_shortest_wavelength_carried_is_four_steps_or_what_the_instrument_says():
    assert Profile(X, Z).resolution_limit == pytest.approx(4e-4)
    assert Profile(X, Z, reliable=1e-4).resolution_limit == pytest.approx(4e-4)
    assert Profile(X, Z, reliable=7e-4).resolution_limit == 7e-4
    # Four steps a wave: the slope of a sine between neighbours is 2/pi sqrt(2) = 0.900 of its own.
    place = np.arange(4001)
    slopes = np.diff(np.sin(2.0 * np.pi * place / 4.0 + 0.3)) / (2.0 * np.pi / 4.0)
    assert np.sqrt(2.0 * np.mean(slopes**2)) == pytest.approx(0.900, abs=0.001)
    with pytest.raises(InputError, match="reliable must be greater than zero"):
        Profile(X, Z, reliable=0.0)
    with pytest.raises(InputError, match="each of notes must be a str; got int"):
        Profile(X, Z, notes=(3,))


@pytest.mark.parametrize(
    ("x", "z", "says"),
    [
        (X[:15], Z[:15], "at least 16 points; got 15"),
        (X, Z[:19], "same length; got 20 and 19"),
        (changed(X, 5, np.nan), Z, "got nan at index 5"),
        (changed(X, 5, X[4]), Z, "must increase .* at index 4 .* at index 5"),
        (changed(X, [3, 4], X[[4, 3]]), Z, "must increase .* at index 3 .* at index 4"),
        (X**2 + 1e-4 * X, Z, "equidistant"),
        (np.delete(X, 7), np.delete(Z, 7), "got a step of 0.0002 m after index 6"),
        (X, changed(Z, 2, np.inf), "got inf at index 2"),
        (X, np.full(20, np.nan), "20 points, all missing"),
        (X[:, None], Z, "got 2 dimensions"),
        ("road", Z, "list of finite numbers"),
    ],
)
def test_a_bad_profile_is_refused_by_name(x, z, says):
    with pytest.raises(InputError, match=says):
        Profile(x, z)


def test_the_same_measurement_counts_once():
    """Twice the same line would halve the error from the sampling of the surface."""
    x = 1e-3 * np.arange(50)
    first, second = (Profile(x, np.sin(k * x), name=f"station {k}") for k in (300, 400))
    Measured.of([first, second])
    with pytest.raises(
        InputError, match=r"heights of profile 1 again as profile 3 \(station 300\)"
    ):
        Measured.of([first, second, replace(first)])
