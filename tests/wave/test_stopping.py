"""A solve ends when it is told to, at any size: by Ctrl-C, the end of its job, a time limit."""

import _thread
import math
import os
import signal
import threading
import time
from contextlib import closing

import pytest

import gripscale as gs
from gripscale.core.parallel import Stopped, in_threads
from tests.samples import FAST_RUBBER as RUBBER

LOAD = {"wavelength": 1e-3, "amplitude": 1.5e-4, "pressure": 3e6, "speed": 1.0, "load_time": 1e-3}

LATE = 1.0
"""Seconds until a stop is heeded: 0.05 to the next question and some 0.05 for the longest piece of
work, on a machine with other work."""


def long_solve(columns):
    """Solve on a mesh that takes seconds: 2048 columns some five of processor time."""
    return gs.solve_scale(RUBBER, **LOAD, columns=columns, rows=128)


@pytest.mark.parametrize(("columns", "after"), [(2048, 0.3), (4094, 1.5)])
def test_a_keyboard_interrupt_is_heeded_at_once(columns, after):
    """On the finest mesh allowed, too: half of 4094 columns is an odd number of awkward factors."""
    assert threading.current_thread() is threading.main_thread()
    due = []

    def interrupt():
        due.append(time.perf_counter())
        _thread.interrupt_main()

    timer = threading.Timer(after, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        long_solve(columns)
    late = time.perf_counter() - due[0]
    timer.join()
    assert 0.0 <= late < LATE


def test_jobs_in_threads_end_with_the_one_that_waits_for_them():
    ended = []

    def job(stop):
        try:
            return long_solve(2048)
        except Stopped:
            ended.append(time.perf_counter())
            raise

    # A signal wakes what waits; `interrupt_main` would be seen at the end of the wait.
    timer = threading.Timer(0.5, os.kill, [os.getpid(), signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt), closing(in_threads([job, job, job], 2)) as stream:
        next(stream)
    closed = time.perf_counter()
    timer.join()
    assert len(ended) == 2  # the third never began
    assert all(closed - LATE < end <= closed for end in ended)


def test_a_time_limit_leaves_the_mesh_that_was_solved():
    """64 columns take hundredths of a second, 4096 ten seconds."""
    whole = gs.solve_scale(RUBBER, **LOAD, columns=64, rows=20)
    start = time.perf_counter()
    result = gs.solve_scale(RUBBER, **LOAD, columns=4096, rows=80, time_limit=1.0)
    assert time.perf_counter() - start < 1.0 + LATE
    assert result.status == "time limit"
    assert not result.converged
    columns = result.details["columns"]
    assert 32 <= columns < 4096
    assert result.details["load_reached"] == 1.0
    # The errors of a mesh as coarse as 32 columns.
    assert result.friction == pytest.approx(whole.friction, rel=0.05)
    assert result.contact_fraction == pytest.approx(whole.contact_fraction, abs=0.05)


def test_a_time_limit_on_the_first_mesh_leaves_the_pressure_that_was_reached():
    result = gs.solve_scale(RUBBER, **LOAD, columns=1022, rows=68, time_limit=1e-4)
    assert result.status == "time limit"
    assert result.details["load_reached"] == 0.0
    assert math.isnan(result.friction)
    assert result.why == "time limit at 0 % of the pressure"
    assert result.details["no_error_estimate"] == "nothing was solved"


def test_enough_time_changes_nothing():
    mesh = {"columns": 64, "rows": 12}
    free = gs.solve_scale(RUBBER, **LOAD, **mesh)
    limited = gs.solve_scale(RUBBER, **LOAD, **mesh, time_limit=1e99)
    assert limited.converged
    assert limited.friction == free.friction


def test_sliding_in_time_ends_with_the_moments_before():
    stages = [gs.Stage(duration=1.0, speed=1.0, pressure=3e6)]
    wave = {"wavelength": 1e-3, "amplitude": 1.5e-4, "columns": 48, "rows": 8}
    start = time.perf_counter()
    run = gs.solve_transient(RUBBER, **wave, stages=stages, time_limit=0.5)
    assert time.perf_counter() - start < 0.5 + LATE
    assert run.status == "time limit"
    assert 1 <= len(run.time) < 48_000
