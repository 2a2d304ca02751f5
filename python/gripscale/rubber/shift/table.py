"""Shift factors as found, temperature by temperature, with their standard errors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift.base import Array, Shift


@dataclass(frozen=True, init=False, eq=False)
class ShiftTable(Shift):
    """log10 a_T and log10 b_T at given temperatures: monotone cubics between, nothing beyond.

    Parameters
    ----------
    temperature : array_like, shape (rows,)
        In any order [K], no two alike.
    horizontal : array_like, shape (rows,)
        log10 a_T [-]; what counts is the difference of two.
    horizontal_error : array_like, shape (rows,), optional
        Standard errors of `horizontal` [-], not negative, NaN where unknown.
    vertical : array_like, shape (rows,), optional
        log10 b_T [-]; zero if not given.
    vertical_error : array_like, shape (rows,), optional
        Standard errors of `vertical` [-], as for `horizontal_error`; zero without `vertical`.
    reference_temperature : float, optional
        The temperature the errors are relative to [K].

    Raises
    ------
    InputError
        If values are missing, not finite, out of range or of unlike length, or there is none.
    """

    temperature: Array = field(repr=False)
    horizontal: Array = field(repr=False)
    horizontal_error: Array = field(repr=False)
    vertical: Array = field(repr=False)
    vertical_error: Array = field(repr=False)
    reference_temperature: float | None = None

    kind: ClassVar[str] = "table"

    def __init__(
        self,
        temperature: ArrayLike,
        horizontal: ArrayLike,
        horizontal_error: ArrayLike | None = None,
        vertical: ArrayLike | None = None,
        vertical_error: ArrayLike | None = None,
        reference_temperature: float | None = None,
    ) -> None:
        kelvin = checks.in_reason("temperature", temperature, unit="K")
        rows = len(kelvin)
        none = np.zeros(rows)
        unknown = np.full(rows, np.nan)
        columns = {
            "horizontal": checks.vector("horizontal", horizontal),
            "horizontal_error": _errors("horizontal_error", horizontal_error, unknown),
            "vertical": none if vertical is None else checks.vector("vertical", vertical),
            "vertical_error": _errors(
                "vertical_error", vertical_error, none if vertical is None else unknown
            ),
        }
        lengths = [rows, *map(len, columns.values())]
        if rows == 0 or len(set(lengths)) != 1:
            raise InputError(
                "temperature, horizontal, vertical and their errors must have the same length of "
                f"at least 1; got {', '.join(map(str, lengths))}"
            )
        order = np.argsort(kelvin, kind="stable")
        kelvin = kelvin[order]
        if (np.diff(kelvin) <= 0.0).any():
            twice = kelvin[int(np.argmax(np.diff(kelvin) <= 0.0))]
            raise InputError(f"temperature [K] must not repeat; got {twice:g} twice")
        if reference_temperature is not None:
            reference_temperature = checks.positive(
                "reference_temperature", reference_temperature, unit="K"
            )
        ordered = {key: column[order] for key, column in columns.items()}
        for key, column in {"temperature": kelvin, **ordered}.items():
            column.setflags(write=False)
            object.__setattr__(self, key, column)
        object.__setattr__(self, "reference_temperature", reference_temperature)

    def __len__(self) -> int:
        return len(self.temperature)

    @property
    def limits(self) -> tuple[float, float]:
        """The lowest and the highest temperature of the table [K]."""
        return float(self.temperature[0]), float(self.temperature[-1])

    def horizontal_error_at(self, temperature: ArrayLike) -> Array:
        """Return the standard error of log10 a_T [-] at `temperature` [K], same shape.

        Straight lines between those of the table; `InputError` beyond it.
        """
        return np.interp(self._checked(temperature), self.temperature, self.horizontal_error)

    def _log_a(self, temperature: Array) -> Array:
        return self._between(self.horizontal, temperature)

    def _log_b(self, temperature: Array) -> Array:
        return self._between(self.vertical, temperature)

    def _between(self, values: Array, temperature: Array) -> Array:
        if len(self) == 1:
            return np.full(temperature.shape, values[0])
        from scipy.interpolate import PchipInterpolator

        return np.asarray(PchipInterpolator(self.temperature, values)(temperature))


def _errors(name: str, given: ArrayLike | None, otherwise: Array) -> Array:
    if given is None:
        return otherwise
    errors = checks.vector(name, given, missing=True)
    if (errors < 0.0).any():
        raise InputError(f"{name} must not be negative; got {np.nanmin(errors):g}")
    return errors
