import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripscale.surface import Profile, height_difference
from gripscale.surface.profile import GRID_TOLERANCE, even_grid, uneven_step


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
