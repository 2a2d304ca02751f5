"""What one Maxwell element of unit modulus has of E' and E'', at any w tau without overflow.

    E'/E_i  = x^2 / (1 + x^2) = 1 / (1 + 1/x^2),   E''/E_i = x / (1 + x^2),   x = w tau

Source: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 3.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


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
