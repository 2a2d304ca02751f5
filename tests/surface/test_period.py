"""One period of a line: flanks no steeper than rubber follows, without ringing beside a step."""

from __future__ import annotations

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space import one_period

STEP = 2e-5
POSITION = STEP * np.arange(2000)
PLATEAU = np.where(np.abs(POSITION - 2e-2) < 5e-3, 5e-3, 0.0)


def test_a_step_becomes_a_flank_of_the_stated_slope():
    """The plateau is kept, its foot filled by the slope; waves of two steps change nothing else."""
    line = one_period(gs.Profile(POSITION, PLATEAU), 2.0 * STEP, steepest=4.0)
    z = np.interp(POSITION, line.x, line.z)
    z -= z.min()
    edge = 5e-3 - np.abs(POSITION - 2e-2)
    cone = np.clip(5e-3 + 4.0 * np.minimum(edge, 0.0), 0.0, 5e-3)
    # the plateau ends at its last point, up to a step inside
    np.testing.assert_allclose(z, cone, atol=4.0 * 1.1 * STEP)


def test_cut_off_waves_do_not_ring_beside_a_step():
    """A jump rings by 8.9 % of its height (Gibbs), a kink of slope 4 by 0.034 of slope times wave.

    The largest excess of the sum of the waves to L over a ramp that ends in a plateau:
    s L / (2 pi^2) times max of the remainder of the series of 1/n^2, which is below 0.7.
    """
    profile, cut = gs.Profile(POSITION, PLATEAU), 0.4e-3
    excess = {}
    for steepest in (4.0, np.inf):
        line = one_period(profile, cut, steepest=steepest)
        fine = np.fft.irfft(np.fft.rfft(line.z), 16 * len(line)) * 16.0
        middle = np.abs(np.linspace(0.0, 4e-2, fine.size, endpoint=False) - 2e-2) < 1e-3
        excess[steepest] = fine.max() - fine[middle].mean()
    assert excess[np.inf] == pytest.approx(0.089 * 5e-3, rel=0.1)
    assert excess[4.0] < 0.7 / (2.0 * np.pi**2) * 4.0 * cut


def test_gentle_lines_are_kept():
    """But for the straight line through the first and the last point, whose rise is a step's."""
    wave = gs.Profile(POSITION, 1e-4 * np.cos(2.0 * np.pi * POSITION / 4e-3))
    line = one_period(wave, 4.0 * STEP)
    step = wave.z[0] - wave.z[-1]
    np.testing.assert_allclose(line.z, one_period(wave, 4.0 * STEP, steepest=np.inf).z, atol=1e-15)
    np.testing.assert_allclose(line.z, wave.z, atol=2.0 * abs(step))


REFUSED = [
    ({"steepest": 0.0}, "steepest must be greater than zero; got 0"),
    ({"smallest_wavelength": 1e-5}, "smallest_wavelength must be at least two steps of the line"),
    ({"smallest_wavelength": 1.0}, "smallest_wavelength must be at most the period 0.04 m"),
]


@pytest.mark.parametrize(("change", "sentence"), REFUSED)
def test_bad_input_is_named(change, sentence):
    with pytest.raises(gs.InputError, match=sentence):
        one_period(gs.Profile(POSITION, PLATEAU), **change)
