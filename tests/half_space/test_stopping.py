"""Progress and stopping of a direct contact."""

from __future__ import annotations

import signal
import threading
import time

import pytest

from .rough_cases import isotropic_map, solve

LATE = 2.0
"""Seconds until a stop is heeded: the longest call into compiled code, some 10 ms on this grid, on
a machine with other work."""


def test_every_grid_is_told_as_it_is_solved():
    told = []
    found = solve(isotropic_map(128), tolerance=None, on_grid=told.append)
    assert told == found.grids
    assert [grid.points for grid in told] == [32, 64, 64, 128]


def test_every_iteration_is_told_within_its_grid():
    told, counts = [], []

    def grid_ends(record):
        told.append(list(counts))
        counts.clear()

    found = solve(
        isotropic_map(128),
        tolerance=None,
        on_grid=grid_ends,
        on_iteration=lambda number, wrong: counts.append((number, wrong)),
    )
    for record, iterations in zip(found.grids, told, strict=True):
        assert [number for number, _ in iterations] == list(range(1, record.iterations + 1))
        assert iterations[0][1] > iterations[-1][1] == 0  # settled: no point changes sides


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="needs POSIX timers")
def test_a_keyboard_interrupt_is_heeded_at_once_and_leaves_nothing_behind():
    assert threading.current_thread() is threading.main_thread()
    surface, told = isotropic_map(512, length=0.1024), []
    due = []

    def interrupt(grid):
        told.append(grid)
        if grid.points == 256 and not due:
            due.append(time.perf_counter() + 0.05)
            signal.setitimer(signal.ITIMER_REAL, 0.05)

    before = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            solve(surface, tolerance=None, on_grid=interrupt)
        late = time.perf_counter() - due[0]
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert 0.0 <= late < LATE
    assert told[-1].points == 256  # what was told stays with the caller
    assert solve(isotropic_map(64), tolerance=None).converged
