"""The factor of large strain on a direct contact: a law measured on windows of profiles.

The finite-strain block over the half-space, on the same windows (`python -m studies.large_strain`),
follows the nominal pressure over the modulus, x = p_0/|E*|, and the contact fraction A of the
half-space:

    area:      ln f = 0.069 (x/A) (1 - A)^0.5,        friction:  ln g = -0.175 x / A^0.5.

E* is that of a seventh of the largest wave as it slides, softened and warmed. The scatter from
window to window grows as the mean does. No map was solved, and x was at most 1.1.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array
from gripscale.half_space.response import HalfSpace

_WAVE = 1.0 / 7.0  # wave of the modulus over the largest wave: 4 mm on the shipped road
# Mean of the logarithm and its standard deviation, over what both are proportional to.
AREA_GROWTH, AREA_SCATTER = 0.069, 0.08
FRICTION_GROWTH, FRICTION_SCATTER = -0.175, 0.16


def pressure_over_modulus(body: HalfSpace, pressure: float, largest_wavelength: float) -> float:
    """Return p_0/|E*| [-] of the rubber as it slides, under a pressure [Pa] on waves [m]."""
    number = 2.0 * math.pi / (_WAVE * largest_wavelength)
    if body.by_scale is None:
        return pressure / abs(complex(body.rubber.complex_modulus(body.speed * number)))
    return pressure / abs(complex(body.by_scale.complex_modulus(body.speed * number, number)))


def finite_over_small(
    quantity: str, pressed: ArrayLike, contact_fraction: ArrayLike
) -> tuple[Array, Array]:
    """Return the factor on "contact_fraction" or "friction", and the error of its logarithm [-].

    `pressed` is that of `pressure_over_modulus`, the contact fraction [-] that at small strain.
    """
    area = np.clip(np.asarray(contact_fraction, dtype=float), 1e-12, 1.0)
    size = pressed / np.sqrt(area)
    if quantity == "friction":
        return np.exp(FRICTION_GROWTH * size), FRICTION_SCATTER * size
    size = size * np.sqrt((1.0 - area) / area)
    return np.minimum(np.exp(AREA_GROWTH * size), 1.0 / area), AREA_SCATTER * size
