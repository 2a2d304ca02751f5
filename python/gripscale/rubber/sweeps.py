"""Frequency sweeps of one rubber, each at a temperature of its own: what a laboratory delivers."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.units import ZERO_CELSIUS

Array = NDArray[np.float64]

TOLERANCE = 1.0
"""Temperatures of one sweep follow each other within this [K]: instruments print 19.9 and 20.1."""
_WIDEST = 3.0
"""Largest span of a sweep's temperatures over the tolerance; a ramp runs on."""


@dataclass(frozen=True)
class Sweep:
    """One frequency sweep: rows in order of rising frequency."""

    temperature: float
    """Mean temperature of the rows [K]."""
    frequency: Array
    """Frequency [Hz], shape (rows,)."""
    storage: Array
    """E' [Pa]."""
    loss: Array
    """E'' [Pa]."""

    def __len__(self) -> int:
        return len(self.frequency)


@dataclass(frozen=True, init=False, eq=False)
class Sweeps:
    """Frequency sweeps at several temperatures, from rows in any order.

    Rows whose temperatures follow each other within `tolerance` are one sweep, at their mean.

    Parameters
    ----------
    temperature : array_like, shape (rows,)
        Temperature as measured [K].
    frequency : array_like, shape (rows,)
        Frequency [Hz].
    storage, loss : array_like, shape (rows,)
        E' and E'' of the nearly incompressible solid (3 G' and 3 G'') [Pa].
    tolerance : float
        Largest step between neighbouring temperatures of one sweep [K].
    name, source : str
        What was measured and where the numbers come from.

    Raises
    ------
    InputError
        If a value is not finite, not positive or beyond 1e-100 to 1e100, the lengths differ, there
        is no row, or temperatures run on without a gap, as on a ramp.
    """

    temperature: Array = field(repr=False)
    frequency: Array = field(repr=False)
    storage: Array = field(repr=False)
    loss: Array = field(repr=False)
    tolerance: float = TOLERANCE
    name: str = ""
    source: str = ""

    def __init__(
        self,
        temperature: ArrayLike,
        frequency: ArrayLike,
        storage: ArrayLike,
        loss: ArrayLike,
        tolerance: float = TOLERANCE,
        name: str = "",
        source: str = "",
    ) -> None:
        columns = checked_rows(temperature, frequency, storage, loss)
        tolerance = checks.not_negative("tolerance", tolerance, unit="K")
        order = np.lexsort((columns["frequency"], _groups(columns["temperature"], tolerance)))
        for key, column in columns.items():
            ordered = column[order]
            ordered.setflags(write=False)
            object.__setattr__(self, key, ordered)
        object.__setattr__(self, "tolerance", tolerance)
        object.__setattr__(self, "name", checks.text("name", name))
        object.__setattr__(self, "source", checks.text("source", source))
        self._refuse_ramp()

    def _refuse_ramp(self) -> None:
        for rows in self._rows():
            inside = self.temperature[rows]
            if np.ptp(inside) > _WIDEST * self.tolerance:
                raise InputError(
                    f"temperature [K] must step from sweep to sweep by more than {self.tolerance:g}"
                    f" K; got {len(inside)} rows from {inside.min():.2f} to {inside.max():.2f} K "
                    "without a gap; a ramp needs nominal temperatures (temperature_step)"
                )

    def _rows(self) -> list[slice]:
        group = _groups(self.temperature, self.tolerance)
        cuts = [0, *(np.flatnonzero(np.diff(group)) + 1).tolist(), len(group)]
        return [slice(a, b) for a, b in pairwise(cuts)]

    def __len__(self) -> int:
        """Return the number of sweeps."""
        return len(self._rows())

    def __iter__(self) -> Iterator[Sweep]:
        """Yield the sweeps, the coldest first."""
        for rows in self._rows():
            yield Sweep(
                float(self.temperature[rows].mean()),
                self.frequency[rows],
                self.storage[rows],
                self.loss[rows],
            )

    def __eq__(self, other: object) -> bool:
        """Compare all numbers and names."""
        return isinstance(other, Sweeps) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        columns = self.temperature, self.frequency, self.storage, self.loss
        return *(column.tobytes() for column in columns), self.tolerance, self.name, self.source

    def between(self, lowest: float, highest: float) -> Sweeps:
        """Return the rows from a lowest to a highest frequency [Hz].

        For instruments whose own resonance is in the last rows of every sweep. Raises `InputError`
        if there is none.
        """
        low, high = checks.not_negative("lowest", lowest), checks.positive("highest", highest)
        kept = (self.frequency >= low) & (self.frequency <= high)
        columns = (self.temperature, self.frequency, self.storage, self.loss)
        temperature, frequency, storage, loss = (column[kept] for column in columns)
        if not kept.any():
            raise InputError(
                f"lowest and highest [Hz] must enclose a measured frequency; got {low:g} and "
                f"{high:g}"
            )
        return Sweeps(temperature, frequency, storage, loss, self.tolerance, self.name, self.source)

    @property
    def temperatures(self) -> Array:
        """Mean temperature of each sweep, rising [K], shape (sweeps,)."""
        return np.array([sweep.temperature for sweep in self])

    @property
    def loss_factor(self) -> Array:
        """E''/E' [-], shape (rows,)."""
        return self.loss / self.storage

    def summary(self) -> str:
        """Return the sweeps in a line of text."""
        celsius = self.temperatures - ZERO_CELSIUS
        where = f"{len(self)} sweeps from {celsius[0]:.1f} to {celsius[-1]:.1f} °C"
        if len(self) == 1:
            where = f"one sweep at {celsius[0]:.1f} °C"
        return (
            f"{where}, "
            f"{self.frequency.min():.3g} to {self.frequency.max():.3g} Hz, "
            f"{len(self.frequency)} rows"
        )


def checked_rows(
    temperature: ArrayLike, frequency: ArrayLike, storage: ArrayLike, loss: ArrayLike
) -> dict[str, Array]:
    """Return the four columns of measured rows; raise `InputError` as `Sweeps` does."""
    columns = {
        "temperature": checks.in_reason("temperature", temperature, unit="K"),
        "frequency": checks.in_reason("frequency", frequency, unit="Hz"),
        "storage": checks.in_reason("storage", storage, unit="Pa"),
        "loss": checks.in_reason("loss", loss, unit="Pa"),
    }
    lengths = [len(column) for column in columns.values()]
    if len(set(lengths)) != 1 or lengths[0] == 0:
        raise InputError(
            "temperature, frequency, storage and loss must have the same length of at least 1; "
            f"got {', '.join(map(str, lengths))}"
        )
    return columns


def _groups(temperature: Array, tolerance: float) -> NDArray[np.intp]:
    """Return which sweep each row belongs to, counted from the coldest."""
    order = np.argsort(temperature, kind="stable")
    group = np.empty(len(temperature), dtype=np.intp)
    group[order] = np.cumsum(np.diff(temperature[order], prepend=temperature[order[0]]) > tolerance)
    return group
