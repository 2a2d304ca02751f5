"""Progress and stopping of a direct contact."""

import itertools
import signal
import threading
import time

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space.active_set import COARSE_ACCURACY, Accuracy, solve_grid
from gripscale.half_space.grid import Grid
from gripscale.half_space.grid_sequence import GridSequence
from gripscale.half_space.response import Response, half_space

from .rough_cases import isotropic_map, solve

LATE = 2.0
"""Seconds until a stop is heeded: the longest call into compiled code, some 10 ms on this grid, on
a machine with other work."""


def test_every_grid_is_kept_in_the_order_it_was_solved():
    found = solve(isotropic_map(128), tolerance=None)
    assert [grid.points for grid in found.grids] == [32, 64, 64, 128]


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs POSIX timers")
def test_a_keyboard_interrupt_is_heeded_at_once_and_leaves_nothing_behind(monkeypatch):
    assert threading.current_thread() is threading.main_thread()
    surface, solved, due = isotropic_map(512, length=0.1024), GridSequence.solve, []

    def interrupt(sequence, *given):
        contact = solved(sequence, *given)
        if contact.record.points == 256 and not due:
            due.append(time.perf_counter() + 0.05)
            signal.setitimer(signal.ITIMER_REAL, 0.05)
        return contact

    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with monkeypatch.context() as patch:
            patch.setattr(GridSequence, "solve", interrupt)
            with pytest.raises(KeyboardInterrupt):
                solve(surface, tolerance=None)
        late = time.perf_counter() - due[0]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert 0.0 <= late < LATE
    assert solve(isotropic_map(64), tolerance=None).converged


def test_a_time_limit_keeps_the_last_grid_that_was_solved(monkeypatch):
    """The limit ends the third of four grids; a first grid that it ends is none."""
    surface, whole, seen = isotropic_map(128), solve(isotropic_map(128), tolerance=None), []
    now = itertools.count()
    monkeypatch.setattr(time, "monotonic", lambda: next(now) if len(seen) == 2 else 0)
    ended = solve(surface, tolerance=None, time_limit=2.0, on_grid=seen.append)
    assert ended.status == "time limit"
    assert not ended.converged
    assert ended.grids == whole.grids[:2]
    assert ended.pressure.shape == (64, 64)
    with pytest.raises(gs.ConvergenceError, match="before its first grid was solved"):
        solve(surface, tolerance=None, time_limit=1.0, on_grid=seen.append)
    with pytest.raises(gs.InputError, match="time_limit must be greater than zero"):
        solve(surface, time_limit=0.0)


def test_products_of_all_steps_towards_a_lossy_rubber_are_counted():
    """Where the contact does not settle at once, the loss angle is raised in steps."""
    body, grid = half_space(gs.rubber.styrene_butadiene(), 1.0), Grid((64,), (1e-3,))
    height, start = 1e-4 * np.cos(2.0 * np.pi * np.arange(64) / 64), np.full(64, 1e4)
    response = Response.of(body, grid, 1)
    alone = solve_grid(response, height, start)
    stepped = GridSequence(body, None, 1e4, 1)._through_losses(response, height, alone)
    assert stepped.products > alone.products + 8
    assert stepped.iterations >= alone.iterations + 8  # of each of the eight steps at least one
    assert np.array_equal(stepped.active, alone.active)


@pytest.mark.parametrize("accuracy", [COARSE_ACCURACY, Accuracy(1e-3, 1e-2)])
def test_a_contact_of_less_accuracy_takes_fewer_products(accuracy):
    """It stops with points on the wrong side, no more than may be, and with pressure missing."""
    points, length = 4096, 0.1
    waves = np.fft.rfft(np.random.default_rng(3).standard_normal(points))
    waves *= np.fmax(np.arange(waves.size), 4.0) ** -1.3 * (np.arange(waves.size) < points // 4)
    height = 1e-3 * np.fft.irfft(waves, points) / np.fft.irfft(waves, points).std()
    body = half_space(gs.rubber.styrene_butadiene(), 0.3)
    response, start = Response.of(body, Grid((points,), (length,)), 1), np.full(points, 3e5)
    exact, near = solve_grid(response, height, start), solve_grid(response, height, start, accuracy)
    assert exact.settled
    assert near.settled
    assert near.products < 0.9 * exact.products
    assert near.missing <= accuracy.missing
    touching = np.count_nonzero(exact.active)
    differ = np.count_nonzero(near.active != exact.active)
    assert differ <= 2.0 * accuracy.wrong * touching  # of those, some were wrong before
    assert near.pressure.mean() == pytest.approx(3e5, rel=1e-6)
    assert abs(np.count_nonzero(near.active) / touching - 1.0) < accuracy.wrong
