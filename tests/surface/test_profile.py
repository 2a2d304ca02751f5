"""Profiles and height maps: what they keep, and what they refuse."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripscale.core.errors import InputError
from gripscale.surface import HeightMap, Measured, Profile, height_difference
from gripscale.surface.profile import GRID_TOLERANCE, even_grid, uneven_step

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


def printed(x, decimals):
    return np.round(x, decimals)


@settings(max_examples=100, deadline=None)
@given(
    step=st.floats(4e-3, 0.9),
    start=st.floats(-500, 500),
    points=st.integers(16, 3000),
    kept=st.floats(0.6, 1.0),
    seed=st.integers(0, 999),
)
def test_printed_decimals_are_no_error_and_rows_left_out_are_found(step, start, points, kept, seed):
    """Distances printed to 0.001: up to a quarter of a step, two fifths of the rows left out."""
    there = np.random.default_rng(seed).random(points) < kept
    there[[0, 1, -1]] = True
    grid = even_grid(printed(start + step * np.arange(points), 3)[there], 1e-3)
    assert np.array_equal(grid.number, np.flatnonzero(there))
    assert grid.left_out == points - there.sum()


@pytest.mark.parametrize("step", [0.0374890, 0.0023])
def test_a_long_gap_does_not_shift_what_follows(step):
    place = np.delete(np.arange(20000), slice(7000, 12345))
    grid = even_grid(printed(step * place, 3), 1e-3)
    assert np.array_equal(grid.number, place)


def test_a_resolution_that_hides_the_step_is_no_excuse():
    x = np.round(0.3 * np.arange(60) + 0.04 * (np.arange(60) % 2), 2)
    assert even_grid(x, 0.01) is None
    assert even_grid(x, 0.1) is not None
    assert even_grid(x, 0.2) is None


@pytest.mark.parametrize("off", ["drift", "halves", "one point", "noise"])
def test_steps_that_truly_differ_are_refused(off):
    x = np.arange(200.0)
    x = {
        "drift": x + 1e-5 * x**2,
        "halves": np.concatenate((x, 200.0 + 1.005 * x)),
        "one point": x + 0.06 * (x == 77),
        "noise": x + np.random.default_rng(0).uniform(-0.2, 0.2, 200),
    }[off]
    assert even_grid(x) is None
    assert even_grid(x, 1e-6) is None


def test_the_first_step_that_is_not_usual_is_named():
    x = np.arange(20.0)
    assert uneven_step(np.delete(x, 7)) == 6
    assert uneven_step(np.where(x == 9, 4.0, x)) == 8


def test_departures_within_the_tolerance_hardly_count():
    """Uniform departures of d steps have the variance d^2/3, and a slope makes them heights."""
    place = np.arange(20000)
    share = 0.96 * GRID_TOLERANCE
    off = np.random.default_rng(1).uniform(-share, share, place.size)

    def first(at):
        measured = Profile(1e-4 * at, 1e-3 * np.sin(at / 50.0))
        return height_difference(measured).value[0]

    added = 2.0 * share**2 / 3.0
    # 20000 departures know their variance to a percent; their cross terms cancel to 4e-4
    assert first(place + off) / first(place) == pytest.approx(1.0 + added, abs=5e-4)
    assert added < 0.002


ALONG, ACROSS = np.arange(20) * 1e-4, np.arange(30) * 2e-4
HEIGHTS = np.outer(np.sin(ALONG * 1e4), np.cos(ACROSS * 1e4))


def test_a_map_knows_its_steps_and_gaps():
    z = HEIGHTS.copy()
    z[3, 4] = np.nan
    surface = HeightMap(ALONG, ACROSS, z, name="slab")
    assert surface.step == pytest.approx((1e-4, 2e-4))
    assert surface.length == pytest.approx((19e-4, 58e-4))
    assert surface.missing == 1
    assert repr(surface).splitlines() == [
        "HeightMap",
        "  name  slab",
        "  x     20 points, step 100 um, length 1.9 mm",
        "  y     30 points, step 200 um, length 5.8 mm",
        "  z     20 x 30 values from -1 m to 1 m, rms 486.5 mm, 1 missing",
    ]


def test_lines_of_a_map():
    z = HEIGHTS.copy()
    z[:, 4] = np.nan
    z[2, 5] = np.nan
    surface = HeightMap(ALONG, ACROSS, z, name="slab", source="slab.sur")
    along_x, along_y = surface.lines(), surface.lines("y")
    assert (len(along_x), len(along_y)) == (29, 20)  # the one without heights is left out
    assert along_x[4].name == "slab, line 5 along x"
    assert along_x[4].source == "slab.sur, line 5 along x"
    assert along_x[4].missing == 1
    np.testing.assert_array_equal(along_x[4].x, ALONG)
    np.testing.assert_array_equal(along_y[7].x, ACROSS)
    np.testing.assert_array_equal(along_y[7].z, z[7])
    assert HeightMap(ALONG, ACROSS, HEIGHTS).lines()[3].name == "line 3 along x"
    with pytest.raises(InputError, match="direction must be one of x, y; got 'z'"):
        surface.lines("z")


def test_a_map_turns_by_a_quarter():
    surface = HeightMap(ALONG, ACROSS, HEIGHTS + ALONG[:, None], name="slab")
    turned = surface.turned()
    assert turned.z.shape == (30, 20)
    np.testing.assert_array_equal(turned.x, ACROSS)
    # a point at (x, y) is at (y, -x) now
    i, j = 3, 8
    at = np.argmin(np.abs(turned.y + ALONG[i]))
    assert turned.z[j, at] == surface.z[i, j]
    whole = turned.turned().turned().turned()
    np.testing.assert_allclose(whole.x, ALONG)
    np.testing.assert_array_equal(whole.z, surface.z)


@pytest.mark.parametrize(
    ("x", "y", "z", "words"),
    [
        (ALONG[:1], ACROSS, HEIGHTS[:1], "at least 16 points a way; got 1 along x"),
        (ALONG, ACROSS[:15], HEIGHTS[:, :15], "got 15 along y"),
        (
            ALONG,
            ACROSS,
            HEIGHTS.T,
            r"z must have shape \(20, 30\), heights along x and then y; got \(30, 20\)",
        ),
        (ALONG, ACROSS, HEIGHTS[0], "two dimensions; got 1"),
        (ALONG, ACROSS, "rough", "z must be a table of heights"),
        (
            ALONG,
            ACROSS,
            np.full(HEIGHTS.shape, np.nan),
            "some heights; got 600 points, all missing",
        ),
        (ALONG, ACROSS, np.where(HEIGHTS > 0.9, np.inf, HEIGHTS), "numbers or NaN.*got inf"),
        (ALONG**2, ACROSS, HEIGHTS, "x must increase in equal steps"),
        (ALONG[::-1], ACROSS, HEIGHTS, "x must increase"),
        (np.where(ALONG > 0, ALONG, np.nan), ACROSS, HEIGHTS, "x must be a list of finite numbers"),
    ],
)
def test_what_is_no_map_is_refused(x, y, z, words):
    with pytest.raises(InputError, match=words):
        HeightMap(x, y, z)
