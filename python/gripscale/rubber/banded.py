"""A rubber whose moduli are changed within one band of frequency, as no Prony series could be.

    E*(w) = s E'(w) + i l E''(w)    for w within the band, else E' + i E''.

Derivatives by E' and E'' of a band are differences of such rubbers, which only slide steadily.
"""

from __future__ import annotations

import warnings
from dataclasses import fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import checks
from gripscale.core.arrays import ComplexArray
from gripscale.core.checks import checked
from gripscale.core.errors import RubberWarning
from gripscale.rubber.material import Rubber


class Band(NamedTuple):
    """Frequencies with factors of the moduli, as the kernel takes them."""

    low: float = 0.0
    """Lower end, within [rad/s]; from zero on a band also holds the relaxed modulus."""
    high: float = 0.0
    """Upper end, beyond [rad/s]."""
    storage: float = 1.0
    """Factor of E' [-]."""
    loss: float = 1.0
    """Factor of E'' [-]."""


class BandedRubber(Rubber, eq=False):
    """Rubber with factors of its moduli in a band."""

    band: Band = checked(checks.instance, kind=Band, default=Band())

    @classmethod
    def of(cls, rubber: Rubber, band: Band) -> BandedRubber:
        """Return `rubber` with factors of its moduli in a band."""
        values = {item.name: getattr(rubber, item.name) for item in fields(rubber)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RubberWarning)  # the rubber itself has warned
            return cls(**values | {"band": band})

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return E* [Pa] at `omega` [rad/s], as that of `Rubber`."""
        modulus, size, band = super().complex_modulus(omega), np.abs(omega), self.band
        changed = band.storage * modulus.real + 1j * band.loss * modulus.imag
        return np.where((size >= band.low) & (size < band.high), changed, modulus)
