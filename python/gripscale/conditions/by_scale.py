"""A rubber that is another one at every scale: what the direct contact is solved with.

A harmonic of wavenumber q meets the rubber at the temperature and the strain of its own scale,

    E*(w, q) = (f E'(a_T w) + i g E''(a_T w)) / b_T,     a_T, b_T, f and g of |q|

with f and g exact here: no series has to carry them. Between the scales at which they are known the
logarithms of the factors are linear in log |q|.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.rubber import Rubber

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

ROWS_AT_ONCE = 50_000


@dataclass(frozen=True)
class ScaleFactors:
    """Factors of the moduli at some wavenumbers, arrays of shape (scales,)."""

    wavenumber: Array
    """Rising [rad/m]."""
    shift: Array
    """a_T [-]."""
    stiffening: Array
    """1/b_T [-]."""
    storage: Array
    """f [-]."""
    loss: Array
    """g [-]."""

    def at(self, name: str, wavenumber: Array) -> Array:
        """Return a factor at `wavenumber` [rad/m], held beyond the ends."""
        logs = np.log(getattr(self, name))
        return np.asarray(np.exp(np.interp(np.log(wavenumber), np.log(self.wavenumber), logs)))


@dataclass(frozen=True)
class RubberByScale:
    """A rubber with factors of its moduli by scale."""

    rubber: Rubber
    factors: ScaleFactors

    def plane_strain_modulus(self, omega: ArrayLike, wavenumber: ArrayLike) -> ComplexArray:
        """Return E/(1 - nu^2) [Pa] at `omega` [rad/s] and |q| [rad/m], broadcast together.

        With G* = E*/3 of the scale and the bulk modulus of the rubber, as for the rubber itself.
        """
        frequency, number = np.broadcast_arrays(
            np.asarray(omega, dtype=float), np.asarray(wavenumber, dtype=float)
        )
        shape = frequency.shape
        frequency, number = frequency.reshape(-1), number.reshape(-1)
        parts = [
            self._part(frequency[at : at + ROWS_AT_ONCE], number[at : at + ROWS_AT_ONCE])
            for at in range(0, frequency.size, ROWS_AT_ONCE)
        ]
        shear = np.concatenate(parts).reshape(shape) / 3.0
        bulk = 3.0 * self.rubber.bulk_modulus
        return np.asarray(4.0 * shear * (bulk + shear) / (bulk + 4.0 * shear))

    def shift(self, wavenumber: Array) -> Array:
        """Return a_T [-] at |q| [rad/m], that of the longest scale for the mean."""
        return self.factors.at("shift", self._own(wavenumber))

    def _own(self, wavenumber: Array) -> Array:
        return np.where(wavenumber > 0.0, wavenumber, self.factors.wavenumber[0])

    def _part(self, omega: Array, wavenumber: Array) -> ComplexArray:
        own = self._own(wavenumber)
        at = {
            name: self.factors.at(name, own) for name in ("shift", "stiffening", "storage", "loss")
        }
        modulus = self.rubber.complex_modulus(omega * at["shift"]) * at["stiffening"]
        return np.asarray(at["storage"] * modulus.real + 1j * at["loss"] * modulus.imag)
