"""A dynamic-mechanical master curve: storage and loss modulus against frequency."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift import Shift, shift_at

Array = NDArray[np.float64]


@dataclass(frozen=True, init=False, eq=False)
class MasterCurve:
    """Storage and loss modulus in uniaxial deformation, sorted by ascending frequency.

    Parameters
    ----------
    frequency : array_like, shape (rows,)
        Frequency [Hz], above zero, in any order; equal frequencies may occur (overlapping sets).
    storage, loss : array_like, shape (rows,)
        E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa], above zero.
    reference_temperature : float, optional
        Temperature the curve holds for [K].
    name, source : str
        What was measured and where the numbers come from.
    shift : Shift, optional
        What the curve becomes at other temperatures; a law without a reference temperature of its
        own takes that of the curve.

    Raises
    ------
    InputError
        If a value is not finite, not positive or beyond 1e-100 to 1e100, the lengths differ or
        there are fewer than 2 rows.
    """

    frequency: Array = field(repr=False)
    storage: Array = field(repr=False)
    loss: Array = field(repr=False)
    reference_temperature: float | None = None
    name: str = ""
    source: str = ""
    shift: Shift | None = field(default=None, repr=False)

    def __init__(
        self,
        frequency: ArrayLike,
        storage: ArrayLike,
        loss: ArrayLike,
        reference_temperature: float | None = None,
        name: str = "",
        source: str = "",
        shift: Shift | None = None,
    ) -> None:
        columns = {
            "frequency": checks.in_reason("frequency", frequency, unit="Hz"),
            "storage": checks.in_reason("storage", storage, unit="Pa"),
            "loss": checks.in_reason("loss", loss, unit="Pa"),
        }
        lengths = [len(column) for column in columns.values()]
        if len(set(lengths)) != 1 or lengths[0] < 2:
            raise InputError(
                "frequency, storage and loss must have the same length of at least 2; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        if reference_temperature is not None:
            reference_temperature = checks.positive(
                "reference_temperature", reference_temperature, unit="K"
            )
        order = np.argsort(columns["frequency"], kind="stable")
        for key, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, key, ordered)
        object.__setattr__(self, "reference_temperature", reference_temperature)
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "source", checks.text("source", source))
        object.__setattr__(self, "shift", shift_at(shift, reference_temperature))

    def __len__(self) -> int:
        return len(self.frequency)

    @property
    def angular_frequency(self) -> Array:
        """Angular frequency 2 pi f [rad/s], shape (rows,)."""
        return 2.0 * np.pi * self.frequency

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage

    @property
    def decades(self) -> float:
        """Width of the measured band [decades]."""
        return float(np.log10(self.frequency[-1] / self.frequency[0]))
