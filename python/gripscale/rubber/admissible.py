"""The Prony series that fit a master curve as well as the best one does: what the data leave open.

A master curve fixes E*(w) within its band to about its noise, and beyond its ends less and less.
The series kept here are extremes: each has the least or the largest E' or E'' at some frequency
that the data allow. Their envelope is the uncertainty of E*(w); each of them is a rubber, so that
the same uncertainty of a friction is the spread of its predictions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.maxwell_shapes import loss_shape, storage_shape

Array = NDArray[np.float64]


@dataclass(frozen=True, init=False, eq=False)
class AdmissibleSeries:
    """Prony series on common relaxation times, one a row.

    Parameters
    ----------
    relaxation_times : array_like, shape (terms,)
        Relaxation times [s], above zero.
    equilibrium_moduli : array_like, shape (series,)
        E_inf of each series [Pa], above zero.
    moduli : array_like, shape (series, terms)
        Moduli of their Maxwell elements [Pa], not negative.
    belongs_to : str
        Fingerprint of the rubber's own series, which the first rubber they are given to leaves: the
        others tell nothing of another one.

    Raises
    ------
    InputError
        If a value is not finite or out of its range, or the shapes do not match.
    """

    relaxation_times: Array = field(repr=False)
    equilibrium_moduli: Array = field(repr=False)
    moduli: Array = field(repr=False)
    belongs_to: str = field(default="", repr=False)

    def __init__(
        self,
        relaxation_times: ArrayLike,
        equilibrium_moduli: ArrayLike,
        moduli: ArrayLike,
        belongs_to: str = "",
    ) -> None:
        times = checks.in_reason("relaxation_times", relaxation_times, unit="s")
        equilibrium = checks.in_reason("equilibrium_moduli", equilibrium_moduli, unit="Pa")
        shape = (len(equilibrium), len(times))
        expected = f"moduli must be {shape[0]} rows of {shape[1]} numbers [Pa]"
        elements = checks.array(moduli, expected)
        if elements.size != math.prod(shape):
            raise InputError(f"{expected}; got {checks.shown(moduli)}")
        elements = elements.reshape(shape)
        if not ((elements >= 0.0) & (elements <= checks.MOST)).all():
            raise InputError(f"moduli must not be negative [Pa]; got {elements.min():g}")
        for name, value in (
            ("relaxation_times", times),
            ("equilibrium_moduli", equilibrium),
            ("moduli", elements),
        ):
            value.setflags(write=False)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "belongs_to", str(belongs_to))

    def given_to(self, fingerprint: str) -> AdmissibleSeries:
        """Return them as those of the series with this fingerprint.

        Raises `InputError` if they belong to another.
        """
        if self.belongs_to not in ("", fingerprint):
            raise InputError(
                "admissible must be what fits beside this series; got that of other moduli or "
                "relaxation times: leave it out (admissible=None) where they are changed"
            )
        if self.belongs_to:
            return self
        return AdmissibleSeries(
            self.relaxation_times, self.equilibrium_moduli, self.moduli, fingerprint
        )

    def __len__(self) -> int:
        return len(self.equilibrium_moduli)

    def __eq__(self, other: object) -> bool:
        """Compare all numbers."""
        return isinstance(other, AdmissibleSeries) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[bytes, ...]:
        columns = self.relaxation_times, self.equilibrium_moduli, self.moduli
        return tuple(column.tobytes() for column in columns)

    def complex_moduli(self, omega: Array) -> NDArray[np.complex128]:
        """Return E*(w) of each series [Pa] at `omega` [rad/s], shape (series, *omega.shape)."""
        phase = omega[..., None] * self.relaxation_times
        storage = storage_shape(phase) @ self.moduli.T + self.equilibrium_moduli
        loss = loss_shape(phase) @ self.moduli.T
        return np.moveaxis(storage + 1j * loss, -1, 0)

    def shifted(self, a: float, b: float) -> AdmissibleSeries:
        """Return the series with times multiplied by `a` and moduli divided by `b` [-]."""
        return AdmissibleSeries(
            self.relaxation_times * a, self.equilibrium_moduli / b, self.moduli / b
        )

    def to_dict(self) -> dict[str, Any]:
        """Return all numbers as lists; whose they are is told by the rubber they stand beside."""
        return {
            "relaxation_times": self.relaxation_times.tolist(),
            "equilibrium_moduli": self.equilibrium_moduli.tolist(),
            "moduli": self.moduli.tolist(),
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> AdmissibleSeries:
        """Return the series of `to_dict`; raise `InputError` if a key is another."""
        known = {"relaxation_times", "equilibrium_moduli", "moduli"}
        if not isinstance(values, Mapping) or set(values) != known:
            raise InputError(
                f"admissible must have the keys {', '.join(known)}; got {checks.shown(values)}"
            )
        return cls(**values)
