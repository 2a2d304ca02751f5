"""Lines filtered as many short transforms: the same as one long transform, to single precision."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.fft

from gripscale.half_space.grid import SHORTEST, LineConvolution

ROUNDING = 2e-6
"""Of transforms in single precision: 6e-8 in each of some log2(N) = 16 stages, and margin."""


def transfer_of(points: int) -> np.ndarray:
    """A complex transfer, real where a wave is its own opposite."""
    random = np.random.default_rng(points)
    found = random.standard_normal((2, points // 2 + 1))
    transfer = (found[0] + 1j * found[1]).astype(np.complex64)
    transfer[0] = transfer[0].real
    if points % 2 == 0:
        transfer[-1] = transfer[-1].real
    return transfer


@pytest.mark.parametrize("points", [4096, 64 * 75, 128 * 45, 34560])
def test_it_is_what_one_long_transform_does(points: int) -> None:
    transfer = transfer_of(points)
    values = np.random.default_rng(1).standard_normal(points).astype(np.float32)
    short = LineConvolution.of(transfer, points)
    assert short is not None
    spectrum = scipy.fft.rfft(values.astype(float)) * transfer
    expected = scipy.fft.irfft(spectrum, points)
    assert np.abs(short(values) - expected).max() < ROUNDING * np.abs(expected).max()


def test_there_is_none_where_it_does_not_pay() -> None:
    assert LineConvolution.of(transfer_of(SHORTEST // 2), SHORTEST // 2) is None
    assert LineConvolution.of(transfer_of(4099), 4099) is None
