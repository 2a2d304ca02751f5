"""What one Maxwell element of unit modulus has of E' and E'', at any w tau without overflow.

    E'/E_i  = x^2 / (1 + x^2) = 1 / (1 + 1/x^2),   E''/E_i = x / (1 + x^2),   x = w tau

Source: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_BLOCK = 256
"""Frequencies at once: with a hundred terms an array of them is 200 kB."""


def storage_shape(phase: Array) -> Array:
    """Return E'/E_i [-] at w tau = `phase` [-], any sign, same shape."""
    size = np.abs(phase)
    square = np.minimum(size, 1.0) ** 2
    inverse_square = (1.0 / np.maximum(size, 1.0)) ** 2
    return np.where(size <= 1.0, square / (1.0 + square), 1.0 / (1.0 + inverse_square))


def loss_shape(phase: Array) -> Array:
    """Return E''/E_i [-] at w tau = `phase` [-], with its sign, same shape."""
    size = np.abs(phase)
    smaller = np.where(size <= 1.0, size, 1.0 / np.maximum(size, 1.0))
    return np.copysign(smaller / (1.0 + smaller**2), phase)


def complex_sum(omega: Array, times: Array, moduli: Array) -> ComplexArray:
    """Return sum E_i (E' + i E'')(w tau_i)/E_i [Pa] at `omega` [rad/s], same shape.

    `times` [s] and `moduli` [Pa] have shape (terms,). In blocks that stay in the processor's cache:
    a direct contact asks for as many frequencies as its grid has points, and memory would take
    longer than the sums.
    """
    flat = np.abs(omega).reshape(-1)
    found = np.empty(flat.size, dtype=np.complex128)
    for first in range(0, flat.size, _BLOCK):
        phase = np.outer(flat[first : first + _BLOCK], times)
        smaller = np.minimum(phase, 1.0 / np.maximum(phase, 1.0))
        square = smaller * smaller
        below = 1.0 + square
        part = found[first : first + _BLOCK]
        part.imag = (moduli * (smaller / below)).sum(-1)
        np.copyto(square, 1.0, where=phase > 1.0)
        part.real = (moduli * (square / below)).sum(-1)
    found.imag = np.copysign(found.imag, np.reshape(omega, -1))
    return found.reshape(np.shape(omega))
