"""Filters and contacts of maps in single precision: as by other code."""

import numpy as np
import pytest
import scipy.fft

from gripscale._kernel import GapExtension, Map
from gripscale.half_space.active_set import FAR, PointsInContact
from gripscale.half_space.grid import Grid
from gripscale.half_space.response import HalfSpace, Response
from tests.samples import ZENER

from .rough_cases import isotropic_map
from .test_line import ROUNDING, solve_as_numpy_does


def never() -> None:
    pass


def noise(*shape: int) -> np.ndarray:
    return np.random.default_rng(shape[0]).standard_normal(shape, dtype=np.float32)


@pytest.mark.parametrize("shape", [(1, 1), (9, 12), (33, 17), (64, 75), (300, 256)])
@pytest.mark.parametrize("threads", [1, 2])
def test_it_is_what_double_precision_does(shape: tuple[int, int], threads: int) -> None:
    values, weights = noise(*shape), noise(*shape[::-1]).T
    spectrum = scipy.fft.rfft2(weights.astype(float))
    expected = scipy.fft.irfft2(scipy.fft.rfft2(values.astype(float)) * spectrum, shape)
    found = Map(*shape, threads, never).filtered(values, spectrum.astype(np.complex64))
    assert np.abs(found - expected).max() < ROUNDING * np.abs(expected).max()


def test_threads_change_no_bit() -> None:
    """A map of 300 x 256 points is worth several threads."""
    values, factors = noise(300, 256), noise(300, 129) + 1j * noise(300, 129)[::-1]
    one, two = (Map(300, 256, n, never).filtered(values, factors) for n in (1, 2))
    np.testing.assert_array_equal(one, two)


def test_its_system_is_that_of_numpy() -> None:
    """Of the upper fifth of a map at the frequency of most loss, and a pressure that is missing."""
    rough = isotropic_map(96)
    response = Response.of(HalfSpace(ZENER, 0.3), Grid(rough.z.shape, (0.016, 0.016)), 2)
    height = rough.z.reshape(-1)
    where = np.flatnonzero(height > np.quantile(height, 0.8))
    points = PointsInContact(response, where)
    missing = points.missing(height[where])
    solve_as_numpy_does(points, (missing / np.linalg.norm(missing)).astype(np.float32))


def test_an_exception_of_the_caller_ends_it() -> None:
    class Stopped(Exception):
        pass

    def stop() -> None:
        raise Stopped

    filters = Map(1024, 1024, 1, stop)
    factors = np.ones((1024, 513), np.complex64)
    active = noise(1024, 1024) > 0.0
    where, extension = np.flatnonzero(active), GapExtension.of_map(active, FAR)
    right = noise(where.size) / np.float32(where.size**0.5)
    with pytest.raises(Stopped):
        filters.close_gap(right, where, [factors, factors], extension, (1.0, 0.0, 100))


def test_what_does_not_fit_its_map_is_refused() -> None:
    filters, factors = Map(8, 6, 1, never), np.ones((8, 4), dtype=np.complex64)
    with pytest.raises(ValueError, match="a value for each point"):
        filters.filtered(np.ones((8, 5), np.float32), factors)
    with pytest.raises(ValueError, match="a factor for each wave"):
        filters.filtered(np.ones((8, 6), np.float32), factors[1:])
    here = GapExtension.of_map(np.arange(48).reshape(8, 6) == 3, FAR)
    turned = GapExtension.of_map(np.arange(48).reshape(6, 8) == 3, FAR)
    line = GapExtension.of_line(np.arange(48) == 3, None)
    for places, count, extension in (
        ([48], 1, here),
        ([-1], 1, here),
        ([4, 3], 2, here),
        ([3, 4], 1, here),
        ([3], 1, turned),
        ([3], 1, line),
    ):
        system = np.ones(count, np.float32), np.array(places), [factors, factors], extension
        with pytest.raises(ValueError, match="points and an extension of the map"):
            filters.close_gap(*system, (1.0, 1e-3, 5))
