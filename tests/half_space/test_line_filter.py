"""Lines filtered in single precision: as by another code in double precision."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.fft

from gripscale._kernel import LineFilter

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


@pytest.mark.parametrize("points", [9, 135, 4099, 64 * 75, 34560])
def test_it_is_what_double_precision_does(points: int) -> None:
    transfer = transfer_of(points)
    values = np.random.default_rng(1).standard_normal(points).astype(np.float32)
    spectrum = scipy.fft.rfft(values.astype(float)) * transfer
    expected = scipy.fft.irfft(spectrum, points)
    found = LineFilter(points)(values, transfer)
    assert found.dtype == np.float32
    assert np.abs(found - expected).max() < ROUNDING * np.abs(expected).max()


def test_other_numbers_of_values_are_refused() -> None:
    values, transfer = np.zeros(64, np.float32), transfer_of(64)
    for wrong in ((values[1:], transfer), (values, transfer[1:])):
        with pytest.raises(ValueError, match="a value for each point"):
            LineFilter(64)(*wrong)
