"""Where along the contact energy is lost: a heat that adds up to the friction work exactly.

Every harmonic of the pressure loses the power l(q) (`rough.outcome`: the sum is the friction).
With phi(q) the phase of the harmonic, and only the half q_x > 0 of the spectrum,

    g(r) = sum_q sqrt(l(q)) exp(i phi(q) + i q . r),      mean |g|^2 = sum_q l(q)

so that |g|^2, the squared envelope of the part of the pressure that loses energy, is a density of
the loss that is nowhere negative and has the right mean. Its place follows from the pressure; how
harmonics of different wavelengths share their loss at one place is a choice.
"""

from __future__ import annotations

import numpy as np
import scipy.fft
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


def loss_pattern(pressure: ComplexArray, lost: Array) -> Array:
    """Return the loss along one period, shape (points,), its mean the sum of `lost`.

    Parameters
    ----------
    pressure : array, shape (points // 2 + 1,)
        Spectrum of the pressure, as `rfft` gives it.
    lost : array, shape (points // 2 + 1,)
        Loss of each harmonic; below zero is round-off.
    """
    points = 2 * (pressure.size - 1)
    size = np.abs(pressure)
    phase = np.divide(pressure, size, out=np.zeros_like(pressure), where=size > 0.0)
    envelope = np.zeros(points, dtype=complex)
    envelope[: pressure.size] = np.sqrt(np.maximum(lost, 0.0)) * phase
    return np.asarray(np.abs(scipy.fft.ifft(envelope) * points) ** 2)
