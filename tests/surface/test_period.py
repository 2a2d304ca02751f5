"""One period of a line: flanks no steeper than rubber follows, without ringing beside a step."""

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space import one_period
from gripscale.surface.low_pass import upper_envelope

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


@pytest.mark.parametrize("cut", [1.6e-3, 0.4e-3, 0.08e-3])
def test_a_cut_off_does_not_ring_beside_a_step(cut):
    """A sharp cut overshoots by 8.9 % of the step; the Gaussian not, but for 1/16 of the waves that
    four points in the cut-off do not carry: 0.6 % of a jump, less of a flank."""
    for steepest in (4.0, np.inf):
        line = one_period(gs.Profile(POSITION, PLATEAU), cut, steepest=steepest)
        fine = np.fft.irfft(np.fft.rfft(line.z), 16 * len(line)) * 16.0
        middle = np.abs(np.linspace(0.0, 4e-2, fine.size, endpoint=False) - 2e-2) < 1e-3
        assert abs(fine.max() - fine[middle].mean()) < 0.006 * 5e-3


def test_a_map_of_cones_is_its_own_envelope():
    """A point above a plane becomes a cone, over the periods too; what is gentle stays as it is."""
    z = np.zeros((40, 50))
    z[3, 45] = 1e-3
    raised = upper_envelope(z, (2e-5, 3e-5), 2.0)
    along, across = np.meshgrid(np.arange(40), np.arange(50), indexing="ij")
    x = 2e-5 * np.minimum((along - 3) % 40, (3 - along) % 40)
    y = 3e-5 * np.minimum((across - 45) % 50, (45 - across) % 50)
    straight = np.maximum(1e-3 - 2.0 * np.hypot(x, y), 0.0)
    # distances along the grid and its diagonals are up to 13 % longer where steps are as 2 to 3
    assert (raised <= straight + 1e-15).all()
    assert (raised >= np.maximum(1e-3 - 2.0 * 1.135 * np.hypot(x, y), 0.0) - 1e-15).all()
    np.testing.assert_allclose(
        upper_envelope(raised, (2e-5, 3e-5), 2.0), raised, rtol=0.0, atol=1e-15
    )
    gentle = 1e-5 * np.sin(2.0 * np.pi * along / 40)
    assert (upper_envelope(gentle, (2e-5, 3e-5), 2.0) == gentle).all()


def test_gentle_lines_are_kept():
    """But for the straight line through the first and the last point, whose rise is a step's."""
    wave = gs.Profile(POSITION, 1e-4 * np.cos(2.0 * np.pi * POSITION / 4e-3))
    line = one_period(wave)
    step = wave.z[0] - wave.z[-1]
    np.testing.assert_allclose(line.z, one_period(wave, steepest=np.inf).z, atol=1e-15)
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
