"""Filters and contacts of lines in single precision: as by other code."""

import numpy as np
import pytest
import scipy.fft

from gripscale._kernel import GapExtension, Line, gmres
from gripscale.half_space.active_set import PointsInContact
from gripscale.half_space.grid import Grid
from gripscale.half_space.response import HalfSpace, Response
from tests.samples import ZENER

from .test_sensitivity import line

ROUNDING = 2e-6
"""Of transforms in single precision: 6e-8 in each of some log2(N) = 16 stages, and margin."""


def transfer_of(points):
    """A complex transfer, real where a wave is its own opposite."""
    random = np.random.default_rng(points)
    found = random.standard_normal((2, points // 2 + 1))
    transfer = (found[0] + 1j * found[1]).astype(np.complex64)
    transfer[0] = transfer[0].real
    if points % 2 == 0:
        transfer[-1] = transfer[-1].real
    return transfer


@pytest.mark.parametrize("points", [9, 135, 4099, 64 * 75, 34560])
def test_it_is_what_double_precision_does(points):
    transfer = transfer_of(points)
    values = np.random.default_rng(1).standard_normal(points).astype(np.float32)
    spectrum = scipy.fft.rfft(values.astype(float)) * transfer
    expected = scipy.fft.irfft(spectrum, points)
    found = Line(points).filtered(values, transfer)
    assert found.dtype == np.float32
    assert np.abs(found - expected).max() < ROUNDING * np.abs(expected).max()


def points_of(loss):
    """Points in contact of a line at the frequency of most loss, and a pressure they lack."""
    rough = line(1024, 0.016, 1e-3)
    grid = Grid((1024,), (0.016,))
    response = Response.of(HalfSpace(ZENER, 0.3, loss=loss), grid, 1)
    where = np.flatnonzero(rough.z > np.quantile(rough.z, 0.8))
    points = PointsInContact(response, where)
    missing = points.missing(rough.z[where])
    return points, (missing / np.linalg.norm(missing)).astype(np.float32)


def solve_as_numpy_does(points, right):
    """Compare the solution of a kernel's system with that by the products of numpy."""
    found, residual = points.correction(right, 1e-2, 100)
    products = points.products
    expected, other_residual, other_products = gmres(points._image, right, 1e-2, 100)
    assert products == other_products
    # single precision
    assert found == pytest.approx(expected, abs=1e-4 * float(np.abs(expected).max()))
    assert residual == pytest.approx(other_residual, rel=1e-2)
    rest = float(np.linalg.norm(right - points._image(found)))
    assert rest == pytest.approx(residual, rel=0.05)


def test_its_system_is_that_of_numpy():
    solve_as_numpy_does(*points_of(1.0))


def test_a_system_that_does_not_fit_its_line_is_refused():
    transfer, numbers = transfer_of(64), (1.0, 1e-3, 5)
    line, short = (GapExtension.of_line(np.arange(n) == 3, None) for n in (64, 32))
    for places, points, extension in (
        ([64], 1, line),
        ([-1], 1, line),
        ([3, 4], 1, line),
        ([3], 1, short),
    ):
        with pytest.raises(ValueError, match="points and an extension of the line"):
            Line(64).close_gap(
                np.ones(points, np.float32),
                np.array(places),
                [transfer, transfer],
                extension,
                numbers,
            )
