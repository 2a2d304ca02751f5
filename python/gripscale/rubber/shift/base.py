"""Time-temperature shift: what another temperature does to a linear viscoelastic modulus.

    E*(w, T) = E*(a_T w, T_ref) / b_T

A colder rubber is slower: a_T > 1 below T_ref, and relaxation times at T are a_T times those at
T_ref. Referred to any third temperature T_0,

    log a(T -> T_ref) = log a(T -> T_0) - log a(T_ref -> T_0),   b likewise,

so that shifts one after the other are one shift. Source: J. D. Ferry, Viscoelastic Properties of
Polymers, 3rd ed. (1980), ch. 11.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError

Array = NDArray[np.float64]

_MOST = 100.0
"""Largest log10 a_T that is a factor and no mistake: WLF has a pole."""

EDGE = 1e-6
"""Temperatures this little beyond a range [K] are within it: printed numbers are rounded."""


@dataclass(frozen=True, eq=False)
class Shift(ABC):
    """Shift factors a_T and b_T of one rubber; a frozen dataclass whose fields are its settings.

    A law states log10 a and log10 b of a temperature against one that it knows itself.
    """

    kind: ClassVar[str]
    """What files call the law."""

    @abstractmethod
    def _log_a(self, temperature: Array) -> Array:
        """Return log10 of a_T [-] up to a constant, at temperatures within `limits` [K]."""

    def _log_b(self, temperature: Array) -> Array:
        """Return log10 of b_T [-] up to a constant; zero unless the law shifts moduli."""
        return np.zeros_like(temperature)

    @property
    @abstractmethod
    def limits(self) -> tuple[float, float]:
        """Temperatures between which the law has values [K]; beyond them it refuses."""

    @property
    def range(self) -> tuple[float, float]:
        """Temperatures between which the numbers rest on a measurement or a statement [K]."""
        return self.limits

    def within(self, temperature: float) -> bool:
        """Return whether a temperature [K] lies within `range`."""
        low, high = self.range
        return low - EDGE <= temperature <= high + EDGE

    def bound(self, reference_temperature: float) -> Self:
        """Return the law with constants that hold for `reference_temperature` [K], if unbound."""
        del reference_temperature
        return self

    def log_a(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return log10 a_T [-] at `temperature` [K], same shape; above zero below the reference.

        Raises `InputError` if a temperature is beyond `limits`.
        """
        law = self.bound(reference_temperature)
        here, there = law._checked(temperature), law._checked(reference_temperature)
        return np.asarray(law._log_a(here) - law._log_a(there))

    def log_b(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return log10 b_T [-] at `temperature` [K], same shape; errors as `log_a`."""
        law = self.bound(reference_temperature)
        here, there = law._checked(temperature), law._checked(reference_temperature)
        return np.asarray(law._log_b(here) - law._log_b(there))

    def a(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return a_T [-] at `temperature` [K], same shape.

        Raises `InputError` as `log_a`, and where a_T is beyond 1e-100 to 1e100.
        """
        log_a = self.log_a(temperature, reference_temperature)
        if (np.abs(log_a) > _MOST).any():
            raise InputError(
                f"temperature must be one at which log10 a_T of the shift ({self.kind}) is at most "
                f"{_MOST:g}; got {float(np.abs(log_a).max()):.3g}"
            )
        return np.asarray(10.0**log_a)

    def b(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return b_T [-] at `temperature` [K], same shape; errors as `log_a`."""
        return np.asarray(10.0 ** self.log_b(temperature, reference_temperature))

    def _checked(self, temperature: ArrayLike) -> Array:
        try:
            kelvin = np.asarray(temperature, dtype=float)
        except (TypeError, ValueError, OverflowError) as error:
            raise InputError(
                f"temperature must be finite numbers [K]; got {checks.shown(temperature)}"
            ) from error
        low, high = self.limits
        bad = ~((kelvin >= low - EDGE) & (kelvin <= high + EDGE))
        if bad.any():
            raise InputError(
                f"temperature must lie within {low:.2f} to {high:.2f} K, where the shift "
                f"({self.kind}) has values; got {float(kelvin[bad].flat[0]):g}"
            )
        return np.asarray(np.clip(kelvin, low, high))

    def to_dict(self) -> dict[str, Any]:
        """Return the kind and all settings."""
        values = {one.name: _plain(getattr(self, one.name)) for one in fields(self)}
        return {"kind": self.kind, **values}

    def __eq__(self, other: object) -> bool:
        """Compare kind and all numbers."""
        return isinstance(other, Shift) and hash_key(self) == hash_key(other)

    def __hash__(self) -> int:
        return hash(hash_key(self))


def hash_key(law: Shift) -> tuple[object, ...]:
    """Return the kind and all numbers of a law."""
    values = (getattr(law, one.name) for one in fields(law))
    return law.kind, *(v.tobytes() if isinstance(v, np.ndarray) else v for v in values)


def _plain(value: Any) -> Any:
    if isinstance(value, np.ndarray):
        return value.tolist()
    return list(value) if isinstance(value, tuple) else value


def checked_range(value: object) -> tuple[float, float] | None:
    """Return two rising temperatures [K] or None; raise `InputError` if it is something else."""
    if value is None:
        return None
    low, high = _two(value)
    if low >= high:
        raise InputError(f"valid_range [K] must be a lower and a higher temperature; got {value!r}")
    return low, high


def _two(value: Any) -> tuple[float, float]:
    found = checks.positive_vector("valid_range", value, unit="K")
    if len(found) != 2:
        raise InputError(f"valid_range [K] must be two temperatures; got {checks.shown(value)}")
    return float(found[0]), float(found[1])
