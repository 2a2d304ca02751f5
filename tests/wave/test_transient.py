"""Sliding in time: a programme does what it says."""

import numpy as np
import pytest

import gripscale as gs
from gripscale import Stage, TransientResult, solve_transient
from tests.verification.transient_cases import PASSAGE, PLAIN, SPEED

MESH = {"columns": 96, "rows": 14}


def test_a_steady_start_stays_steady():
    steady = PLAIN.steady(**MESH)
    run = PLAIN.run(PLAIN.stage(0.25), start=steady, **MESH)
    assert np.ptp(run.friction) < 0.005 * steady.friction
    assert run.friction[0] == pytest.approx(steady.friction, rel=0.005)


def test_start_stop_and_reversal():
    stages = PLAIN.stage(2), PLAIN.stage(3, 0.0), PLAIN.stage(2, -SPEED)
    run = PLAIN.run(*stages, columns=64, rows=12)
    assert run.converged
    forward = run.friction[run.speed > 0][-1]
    dwell = run.friction[run.speed == 0][-1]
    backward = run.friction[run.speed < 0][-1]
    assert run.friction[0] == pytest.approx(0.0, abs=1e-9)  # pressed at once: symmetric
    # 3 passages at rest are 30 relaxation times: the asymmetry is gone.
    assert abs(dwell) < 0.01 * forward
    # Sliding back mirrors sliding forth, on a mesh that is its own mirror image.
    assert backward == pytest.approx(-forward, rel=1e-3)
    assert run.distance[-1] == pytest.approx(0.0, abs=1e-12)
    # The last stretch is the way back alone, though it passes the same places as the way forth.
    mean, least, largest = run.cycle()["friction"]
    assert largest < 0.0
    assert largest - least < 0.01 * abs(mean)
    assert run.time[-1] == pytest.approx(7 * PASSAGE)


def test_cycle_of_a_made_up_course():
    """Friction over a distance of four wavelengths."""
    distance = np.linspace(0.0, 4.0, 401)
    same = np.ones_like(distance)
    moments = dict.fromkeys(("speed", "pressure", "contact_fraction", "indentation"), same)
    course = {"time": distance, "distance": distance, "wavelength": 1.0, "newton_iterations": 0}
    friction = 0.5 + 0.1 * np.sin(2 * np.pi * distance)
    run = TransientResult(friction=friction, status="converged", **course, **moments)
    assert run.cycle()["friction"] == pytest.approx((0.5, 0.4, 0.6), abs=1e-3)


@pytest.mark.parametrize(
    ("stages", "message"),
    [
        ([], "stages must be a list of at least one Stage"),
        ([(0.0, 1.0, 1e5)], "duration must be greater than zero"),
        ([(1.0, float("nan"), 1e5)], "speed must be a finite number"),
        ([(1.0, 1.0, -1e5)], "pressure must be greater than zero"),
    ],
)
def test_a_bad_programme_is_refused(stages, message):
    with pytest.raises(gs.InputError, match=message):
        solve_transient(
            gs.Rubber(3e6),
            wavelength=1e-3,
            amplitude=1e-4,
            stages=[Stage(*stage) for stage in stages],
        )
