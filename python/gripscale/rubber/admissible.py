"""What a measurement leaves open of a Prony series: its rows, and extreme series that fit them.

Shapes are those of one Maxwell element of unit modulus, with x = w tau,

    E'/E_i = x^2 / (1 + x^2) = 1 / (1 + 1/x^2),   E''/E_i = x / (1 + x^2)
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any

import numpy as np

from gripscale.core import Array, Checked, ComplexArray, InputError, Vector, checked, checks


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


# What files hold of admissible series.
_SERIES = ("relaxation_times", "equilibrium_moduli", "moduli")
_ROWS = ("omega", "storage", "loss")


class AdmissibleSeries(Checked, eq=False):
    """Prony series on common relaxation times, one a row; `InputError` for other shapes."""

    relaxation_times: Vector = checked(checks.positive_vector, unit="s", repr=False)
    """Relaxation times [s], shape (terms,), above zero."""
    equilibrium_moduli: Vector = checked(checks.positive_vector, unit="Pa", repr=False)
    """E_inf of each series [Pa], shape (series,), above zero."""
    moduli: Vector = field(repr=False)
    """Moduli of their Maxwell elements [Pa], shape (series, terms), not negative."""
    omega: Vector = checked(checks.positive_vector, unit="rad/s", default=(), repr=False)
    """Angular frequency of the measured rows they fit [rad/s], rising; empty if not known."""
    storage: Vector = checked(checks.positive_vector, unit="Pa", default=(), repr=False)
    loss: Vector = checked(checks.positive_vector, unit="Pa", default=(), repr=False)
    """E' and E'' of the rows [Pa]."""
    belongs_to: str = field(default="", repr=False, compare=False)
    """Fingerprint of the rubber's own series, set by the first rubber that gets these."""

    def __post_init__(self) -> None:
        super().__post_init__()
        shape = (len(self.equilibrium_moduli), len(self.relaxation_times))
        expected = f"moduli must be {shape[0]} rows of {shape[1]} numbers [Pa]"
        elements = checks.array(self.moduli, expected)
        if elements.size != math.prod(shape):
            raise InputError(f"{expected}; got {checks.short_repr(self.moduli)}")
        if not ((elements >= 0.0) & (elements <= checks.MOST)).all():
            raise InputError(f"moduli must not be negative [Pa]; got {elements.min():g}")
        self._set(moduli=elements.reshape(shape))
        checks.same_length(0, **{name: getattr(self, name) for name in _ROWS})

    def given_to(self, fingerprint: str) -> AdmissibleSeries:
        """Return them as those of this fingerprint; `InputError` if they belong to another."""
        if self.belongs_to not in ("", fingerprint):
            raise InputError(
                "admissible must belong to this series; got that of other moduli or relaxation "
                "times: leave it out (admissible=None) where they are changed"
            )
        return self if self.belongs_to else replace(self, belongs_to=fingerprint)

    def __len__(self) -> int:
        return len(self.equilibrium_moduli)

    def complex_moduli(self, omega: Array) -> ComplexArray:
        """Return E*(w) of each series [Pa] at `omega` [rad/s], shape (series, *omega.shape)."""
        phase = omega[..., None] * self.relaxation_times
        storage = storage_shape(phase) @ self.moduli.T + self.equilibrium_moduli
        loss = loss_shape(phase) @ self.moduli.T
        return np.moveaxis(storage + 1j * loss, -1, 0)

    def shifted(self, a: float, b: float) -> AdmissibleSeries:
        """Return the series with times multiplied by `a` and moduli divided by `b` [-]."""
        series = self.relaxation_times * a, self.equilibrium_moduli / b, self.moduli / b
        return AdmissibleSeries(*series, self.omega / a, self.storage / b, self.loss / b)

    def to_dict(self) -> dict[str, Any]:
        """Return all numbers as lists; the rubber they belong to is not stored."""
        return {name: getattr(self, name).tolist() for name in (*_SERIES, *_ROWS)}

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> AdmissibleSeries:
        """Return the series of `to_dict`; raise `InputError` if a key is another.

        The rows may be absent, as in files of older versions.
        """
        keys = ", ".join(_SERIES)
        if isinstance(values, Mapping) and set(values) in ({*_SERIES}, {*_SERIES, *_ROWS}):
            return cls(**values)
        raise InputError(f"admissible must have the keys {keys}; got {checks.short_repr(values)}")
