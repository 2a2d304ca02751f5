"""Time-temperature shift: what another temperature does to a linear viscoelastic modulus.

    E*(w, T) = E*(a_T w, T_ref) / b_T
    WLF        log10 a_T = -c1 (T - T_0) / (c2 + T - T_0)
    Arrhenius  log10 a_T = H / (R ln 10) (1/T - 1/T_0)

A colder rubber is slower: a_T > 1 below T_ref, and relaxation times at T are a_T times those at
T_ref. Shifts one after the other are one shift. WLF holds above the glass transition and has a pole
at T_0 - c2. Sources: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 11; M.
L. Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701, doi:10.1021/ja01619a008.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, replace
from functools import cached_property, partial
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, Vector, checked, checks
from gripscale.core.units import ZERO_CELSIUS, celsius

_MOST = 100.0  # largest log10 a_T that is a factor and no mistake: WLF has a pole
# Temperatures this little beyond a range [K] are within it: printed numbers are rounded.
EDGE = 1e-6
GAS_CONSTANT = 8.314462618  # R [J/(mol K)]
# Distance from the pole of WLF at which it ends, over c2: log a_T is a thousand c1 there.
_FROM_POLE = 1e-3
_COLDEST, _HOTTEST = 1.0, 1e4  # ends of what a law is asked for [K]


class Shift(Checked, ABC, eq=False):
    """Shift factors a_T and b_T of one rubber; a frozen dataclass whose fields are its settings.

    A law states log10 a and log10 b of a temperature against a temperature of its own choice.
    """

    kind: ClassVar[str]
    """What files call the law."""
    cure: ClassVar[str] = ""
    """What to do about a temperature beyond `limits`, the end of a sentence."""

    @property
    def ends(self) -> str:
        """What ends at `limits`, as a clause."""
        return f"the shift ({self.kind}) has values"

    @abstractmethod
    def _log_a(self, temperature: Array) -> Array:
        """Return log10 of a_T [-] up to a constant, at temperatures within `limits` [K]."""

    def _log_b(self, temperature: Array) -> Array:
        """Return log10 of b_T [-] up to a constant; zero unless the law shifts moduli."""
        return np.zeros_like(temperature)

    @property
    def reference_temperature(self) -> float | None:
        """Temperature its constants hold for [K], if they hold for one."""
        return None

    @property
    def valid_range(self) -> tuple[float, float] | None:
        """Temperatures between which it was found [K], if they are known."""
        return None

    @property
    def limits(self) -> tuple[float, float]:
        """Temperatures between which the law has values [K]; beyond them it refuses."""
        return _COLDEST, _HOTTEST

    @property
    def range(self) -> tuple[float, float]:
        """Temperatures between which the numbers rest on a measurement or a statement [K]."""
        return self.valid_range or self.limits

    def within(self, temperature: float) -> bool:
        """Return whether a temperature [K] lies within `range`."""
        low, high = self.range
        return low - EDGE <= temperature <= high + EDGE

    def bound(self, reference_temperature: float) -> Self:
        """Return the law with `reference_temperature` [K], if it needs one and has none."""
        reference = {"reference_temperature": reference_temperature}
        needed = reference.keys() <= {item.name for item in fields(self)}
        return replace(self, **reference) if needed and not self.reference_temperature else self

    def log_a(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return log10 a_T [-] at `temperature` [K], same shape; `InputError` beyond `limits`."""
        law = self.bound(reference_temperature)
        here, there = map(law._in_limits, (temperature, reference_temperature))
        return np.asarray(law._log_a(here) - law._log_a(there))

    def log_b(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return log10 b_T [-] at `temperature` [K], same shape; errors as `log_a`."""
        law = self.bound(reference_temperature)
        here, there = map(law._in_limits, (temperature, reference_temperature))
        return np.asarray(law._log_b(here) - law._log_b(there))

    def a(self, temperature: ArrayLike, reference_temperature: float) -> Array:
        """Return a_T [-] at `temperature` [K], same shape; errors as `log_a`, and beyond 1e100."""
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

    def _in_limits(self, temperature: ArrayLike) -> Array:
        kelvin = checks.real("temperature", temperature, unit="K")
        low, high = self.limits
        bad = ~((kelvin >= low - EDGE) & (kelvin <= high + EDGE))
        if bad.any():
            raise InputError(self.beyond_limits("temperature", float(kelvin[bad].flat[0])))
        return np.asarray(np.clip(kelvin, low, high))

    def beyond_limits(self, what: str, kelvin: float) -> str:
        """Return the sentence that refuses a temperature [K] of `what` beyond `limits`."""
        low, high, got = (t - ZERO_CELSIUS for t in (*self.limits, kelvin))
        return (
            f"{what} must lie within {low:z.4g} to {high:z.4g} °C, where {self.ends}; got "
            f"{got:z.4g} °C ({kelvin:g} K){self.cure}"
        )

    @property
    def _reference(self) -> float:
        if self.reference_temperature is None:
            raise InputError(
                f"reference_temperature [K] of the shift ({self.kind}) must be given; got None"
            )
        return self.reference_temperature

    def to_dict(self) -> dict[str, Any]:
        """Return the kind and all settings, arrays and ranges as lists."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        several = (name for name, v in values.items() if isinstance(v, np.ndarray | tuple))
        return {"kind": self.kind, **values, **{n: list(map(float, values[n])) for n in several}}


class WLF(Shift, eq=False):
    """WLF, at the reference temperature of the rubber unless it states its own.

    Raises `InputError` if a value is not a number above zero.
    """

    c1: float = checked(checks.positive)
    """First constant of WLF [-]."""
    c2: float = checked(checks.positive, unit="K", quantity="temperature difference")
    """Second constant of WLF [K]."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Temperature T_0 the constants hold for [K]; that of the rubber by default."""
    valid_range: tuple[float, float] | None = checked(checks.interval, unit="K", default=None)
    """Temperatures between which the law was found [K]."""

    kind: ClassVar[str] = "wlf"

    def referred_to(self, reference_temperature: float) -> WLF:
        """Return the law with constants of another temperature [K]; `InputError` up to the pole."""
        second = self.c2 + float(self._in_limits(reference_temperature)) - self._reference
        return WLF(self.c1 * self.c2 / second, second, reference_temperature, self.valid_range)

    def _log_a(self, temperature: Array) -> Array:
        above = temperature - self._reference
        return np.asarray(-self.c1 * above / (self.c2 + above))

    @property
    def limits(self) -> tuple[float, float]:
        """From just above the pole [K]."""
        return max(self._reference - self.c2 * (1.0 - _FROM_POLE), _COLDEST), _HOTTEST


class Arrhenius(Shift, eq=False):
    """Arrhenius' law: one activation energy.

    Raises `InputError` if a value is not a number above zero.
    """

    activation_energy: float = checked(checks.positive, unit="J/mol")
    """Activation energy H [J/mol]."""
    valid_range: tuple[float, float] | None = checked(checks.interval, unit="K", default=None)
    """Temperatures between which the law was found [K]."""

    kind: ClassVar[str] = "arrhenius"

    def _log_a(self, temperature: Array) -> Array:
        return arrhenius(self.activation_energy, temperature)


class WLFArrhenius(Shift, eq=False):
    """WLF above the glass transition, Arrhenius below; continuous.

    Raises `InputError` if a value is not a number above zero, or the glass transition lies at or
    below the pole of WLF.
    """

    c1: float = checked(checks.positive)
    """First constant of WLF [-]."""
    c2: float = checked(checks.positive, unit="K", quantity="temperature difference")
    """Second constant of WLF [K]."""
    activation_energy: float = checked(checks.positive, unit="J/mol")
    """Activation energy below the glass transition [J/mol]."""
    glass_temperature: float = checked(checks.positive, unit="K")
    """Temperature where one law takes over from the other [K]."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Temperature T_0 the constants hold for [K]; that of the rubber by default."""
    valid_range: tuple[float, float] | None = checked(checks.interval, unit="K", default=None)
    """Temperatures between which the law was found [K]."""

    kind: ClassVar[str] = "wlf_arrhenius"

    def __post_init__(self) -> None:
        super().__post_init__()
        reference = self.reference_temperature
        if reference is not None and self.glass_temperature <= reference - self.c2:
            raise InputError(
                f"glass_temperature must lie above the pole of WLF, T_0 - c2 = "
                f"{reference - self.c2:g} K; got {self.glass_temperature:g}"
            )

    def _log_a(self, temperature: Array) -> Array:
        reference = self._reference
        above = np.maximum(temperature, self.glass_temperature) - reference
        below = arrhenius(self.activation_energy, np.minimum(temperature, self.glass_temperature))
        return np.asarray(-self.c1 * above / (self.c2 + above) + below)


def arrhenius(activation_energy: float, temperature: Array) -> Array:
    """Return H / (R ln 10 T) [-], at `temperature` [K]."""
    return np.asarray(activation_energy / (GAS_CONSTANT * math.log(10.0) * temperature))


# d log10 a_T / d ln T of the most fragile polymer at its glass transition (Q. Qin & G. B. McKenna,
# J. Non-Cryst. Solids 352 (2006) 2977: polyetherimide), and what scatter may add between two rows.
MOST_FRAGILE, _SCATTER = 214.0, 1.0


def standard_errors(name: str, value: ArrayLike) -> Array:
    """Return standard errors, NaN where unknown; raise `InputError` if one is negative."""
    errors = checks.vector(name, value, missing=True)
    checks.refuse_entries(errors, errors < 0.0, f"{name} must not be negative")
    return errors


class ShiftTable(Shift, eq=False):
    """Shift factors found at some temperatures: monotone cubics between, nothing beyond.

    Raises `InputError` if values are missing, not finite, out of range or of unlike length, or
    there is none.
    """

    temperature: Vector = checked(checks.positive_vector, unit="K", repr=False)
    """In any order [K], shape (rows,), no two alike."""
    horizontal: Vector = checked(checks.vector, repr=False)
    """log10 a_T [-], shape (rows,); what counts is the difference of two."""
    horizontal_error: Vector = checked(standard_errors, default=None, repr=False)
    """Standard errors of `horizontal` [-], shape (rows,), not negative, NaN where unknown."""
    vertical: Vector = checked(checks.vector, default=None, repr=False)
    """log10 b_T [-], shape (rows,); zero if not given."""
    vertical_error: Vector = checked(standard_errors, default=None, repr=False)
    """Standard errors of `vertical` [-], shape (rows,); zero without `vertical`."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """The temperature the errors are relative to [K]."""

    kind: ClassVar[str] = "table"
    cure: ClassVar[str] = (
        ': measure sweeps up to there, or state shift = { kind = "wlf", ... } in [rubber]'
    )

    @property
    def ends(self) -> str:
        """What ends at `limits`, as a clause."""
        return "the sweeps of the shift lie"

    @property
    def unity(self) -> float | None:
        """Temperature of the table whose a_T is one [K]: that of the curve it belongs to."""
        ones = self.temperature[np.abs(self.horizontal) < 1e-6]
        return self.reference_temperature or (float(ones[0]) if ones.size == 1 else None)

    def __post_init__(self) -> None:
        super().__post_init__()
        unknown, zero = np.full(len(self.temperature), np.nan), np.zeros(len(self.temperature))
        defaults = {"horizontal_error": unknown, "vertical_error": unknown}
        if self.vertical is None:
            defaults |= {"vertical": zero, "vertical_error": zero}
        self._set(**{name: v for name, v in defaults.items() if getattr(self, name) is None})
        columns = {item.name: getattr(self, item.name) for item in fields(self)[:5]}
        checks.same_length(1, **columns)
        order = np.argsort(self.temperature, kind="stable")
        self._set(**{name: column[order] for name, column in columns.items()})
        falls = np.diff(self.temperature) <= 0.0
        if falls.any():
            twice = self.temperature[int(np.argmax(falls))]
            raise InputError(f"temperature [K] must not repeat; got {twice:g} twice")
        steps, middle = np.diff(self.horizontal), 0.5 * np.diff(self.temperature)
        steepest = MOST_FRAGILE * 2.0 * middle / (self.temperature[:-1] + middle)
        steep = np.abs(steps) > _SCATTER + steepest
        if steep.any():
            at = int(np.argmax(steep))
            raise InputError(
                "horizontal must be log10 a_T, which changes by at most "
                f"{steepest[at]:.2g} from {self.temperature[at]:g} to "
                f"{self.temperature[at + 1]:g} K, with the most fragile polymer; got "
                f"{abs(steps[at]):.3g}"
            )

    def __len__(self) -> int:
        return len(self.temperature)

    @property
    def limits(self) -> tuple[float, float]:
        """The lowest and the highest temperature of the table [K]."""
        return float(self.temperature[0]), float(self.temperature[-1])

    def bound(self, reference_temperature: float) -> Self:
        """Return the table as it is: its factors need no reference temperature."""
        return self

    def _log_a(self, temperature: Array) -> Array:
        return np.asarray(self._curves[0](temperature))

    def _log_b(self, temperature: Array) -> Array:
        return np.asarray(self._curves[1](temperature))

    @cached_property
    def _curves(self) -> list[Callable[[Array], Array]]:
        both = self.horizontal, self.vertical
        if len(self) == 1:
            return [partial(np.full_like, fill_value=values[0]) for values in both]
        from scipy.interpolate import PchipInterpolator

        return [PchipInterpolator(self.temperature, values) for values in both]


SHIFTS: dict[str, type[Shift]] = {
    law.kind: law for law in (WLF, Arrhenius, WLFArrhenius, ShiftTable)
}
"""Every shift by its kind."""


def shift_from_dict(values: Mapping[str, Any]) -> Shift:
    """Return the shift of `Shift.to_dict`, such as {"kind": "wlf", "c1": 8.0, "c2": 120.0}.

    Raises `InputError` if the kind or a setting is unknown, or one that is needed is not there.
    """
    return checks.of_kind(SHIFTS, "shift", values)


def shift_at(shift: Shift | None, reference_temperature: float | None) -> Shift | None:
    """Return the shift bound to a reference temperature [K]; `InputError` where it cannot be."""
    if shift is None:
        return None
    if not isinstance(shift, Shift):
        raise InputError(f"shift must be a Shift, such as WLF; got {checks.short_repr(shift)}")
    if reference_temperature is None:
        raise InputError("reference_temperature [K] must be given with a shift; got None")
    bound = shift.bound(reference_temperature)
    bound.log_a(reference_temperature, reference_temperature)
    return bound


def shown_state(measured: Any) -> Iterator[tuple[str, str]]:
    """Yield temperature, shift and source of a rubber or a master curve, for `Described`."""
    kelvin, shift = measured.reference_temperature, measured.shift
    yield "temperature", "not stated" if kelvin is None else celsius(kelvin)
    yield "shift", "none" if shift is None else repr(shift).partition("\n")[0]
    if measured.source:
        yield "source", measured.source
