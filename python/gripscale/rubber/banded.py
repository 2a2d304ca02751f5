"""A rubber whose moduli are changed within one band of frequency, as no Prony series could be.

    E*(w) = s E'(w) + i l E''(w)    for w within the band, else E' + i E''.

Derivatives by E' and E'' of a band are differences of such rubbers, which only slide steadily.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import fields

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.arrays import ComplexArray
from gripscale.core.checks import checked
from gripscale.core.errors import RubberWarning
from gripscale.rubber.material import Rubber

UNCHANGED = (0.0, 0.0, 1.0, 1.0)
"""Ends of no band, and factors that change nothing."""


class BandedRubber(Rubber, eq=False):
    """Rubber with factors of its moduli in a band.

    Parameters
    ----------
    low, high : float
        Ends of the band [rad/s], the first within; from zero on it also holds the relaxed modulus.
    storage_factor, loss_factor : float
        Of E' and E'' in the band [-].
    """

    low: float = checked(checks.not_negative, unit="rad/s", default=0.0)
    high: float = checked(checks.not_negative, unit="rad/s", infinite=True, default=math.inf)
    storage_factor: float = checked(checks.positive, default=1.0)
    loss_factor: float = checked(checks.positive, default=1.0)

    @classmethod
    def of(cls, rubber: Rubber, *band: float) -> BandedRubber:
        """Return `rubber` with low and high end of a band, factors of E' and of E'' in it."""
        values = {item.name: getattr(rubber, item.name) for item in fields(rubber)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RubberWarning)  # the rubber itself has warned
            return cls(**values, **dict(zip(_BAND, band, strict=True)))

    @property
    def band(self) -> tuple[float, ...]:
        """Ends [rad/s] and factors [-] of the band, as the kernel takes them."""
        return tuple(getattr(self, name) for name in _BAND)

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return E* [Pa] at `omega` [rad/s], as that of `Rubber`."""
        modulus, size = super().complex_modulus(omega), np.abs(omega)
        changed = self.storage_factor * modulus.real + 1j * self.loss_factor * modulus.imag
        return np.where((size >= self.low) & (size < self.high), changed, modulus)


_BAND = ("low", "high", "storage_factor", "loss_factor")
