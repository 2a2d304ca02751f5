"""Time-temperature shift: what another temperature does to a linear viscoelastic modulus.

    E*(w, T) = E*(a_T w, T_ref) / b_T

A colder rubber is slower: a_T > 1 below T_ref, and relaxation times at T are a_T times those at
T_ref. Referred to any third temperature T_0,

    log a(T -> T_ref) = log a(T -> T_0) - log a(T_ref -> T_0),   b likewise,

so that shifts one after the other are one shift. Source: J. D. Ferry, Viscoelastic Properties of
Polymers, 3rd ed. (1980), ch. 11.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError

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
                f"temperature must be finite numbers [K]; got {checks.short_repr(temperature)}"
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
        raise InputError(
            f"valid_range [K] must be two temperatures; got {checks.short_repr(value)}"
        )
    return float(found[0]), float(found[1])


# Williams, Landel and Ferry's shift, and Arrhenius' below the glass transition.
#
#     WLF        log10 a_T = -c1 (T - T_0) / (c2 + T - T_0)
#     Arrhenius  log10 a_T = H / (R ln 10) (1/T - 1/T_0)
#
# The first holds above the glass transition and has a pole at T_0 - c2. Referred to another
# temperature T_1 the same law has c2' = c2 + T_1 - T_0 and c1' = c1 c2 / c2'. Sources: M. L.
# Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701, doi:10.1021/ja01619a008;
# J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 11.

GAS_CONSTANT = 8.314462618
"""R [J/(mol K)]."""
_FROM_POLE = 1e-3
"""Distance from the pole of WLF at which it ends, over c2: log a_T is a thousand c1 there."""
_COLDEST, _HOTTEST = 1.0, 1e4
"""Ends of what a law is asked for [K]."""


class _Formula(Shift):
    """A law with constants; those of WLF hold for a reference temperature."""

    reference_temperature: float | None = None
    valid_range: tuple[float, float] | None

    @property
    def range(self) -> tuple[float, float]:
        """`valid_range`, or where the law has values [K]."""
        return self.valid_range or self.limits

    @property
    def limits(self) -> tuple[float, float]:
        """Above absolute zero [K]."""
        return _COLDEST, _HOTTEST

    def _set(self, **units: str) -> None:
        """Check the constants, each named with its unit, and what all formulas have."""
        for name, unit in units.items():
            object.__setattr__(self, name, checks.positive(name, getattr(self, name), unit=unit))
        object.__setattr__(self, "valid_range", checked_range(self.valid_range))

    @property
    def _reference(self) -> float:
        if self.reference_temperature is None:
            raise InputError(
                f"reference_temperature [K] of the shift ({self.kind}) must be given; got None"
            )
        return self.reference_temperature


@dataclass(frozen=True, eq=False)
class WLF(_Formula):
    """WLF shift.

    Parameters
    ----------
    c1 : float
        c1 [-], above zero.
    c2 : float
        c2 [K], above zero.
    reference_temperature : float, optional
        T_0, the temperature the constants hold for [K]. Without it they hold for the reference
        temperature of whatever they are given to: of the rubber, of the master curve.
    valid_range : tuple of two floats, optional
        Temperatures between which the constants were found [K].

    Raises
    ------
    InputError
        If a value is not a number above zero.
    """

    c1: float
    c2: float
    reference_temperature: float | None = None
    valid_range: tuple[float, float] | None = None

    kind: ClassVar[str] = "wlf"

    def __post_init__(self) -> None:
        self._set(c1="", c2="K", **_if_given(self.reference_temperature))

    def bound(self, reference_temperature: float) -> Self:
        """Return the law with `reference_temperature` [K], if it has none of its own."""
        if self.reference_temperature is not None:
            return self
        return replace(self, reference_temperature=reference_temperature)

    def referred_to(self, reference_temperature: float) -> WLF:
        """Return the same law with the constants that hold for another temperature [K].

        Raises `InputError` if that is at or below the pole.
        """
        own = self._reference
        second = self.c2 + float(self._checked(reference_temperature)) - own
        return WLF(self.c1 * self.c2 / second, second, reference_temperature, self.valid_range)

    def _log_a(self, temperature: Array) -> Array:
        above = temperature - self._reference
        return np.asarray(-self.c1 * above / (self.c2 + above))

    @property
    def limits(self) -> tuple[float, float]:
        """From just above the pole [K]."""
        return max(self._reference - self.c2 * (1.0 - _FROM_POLE), _COLDEST), _HOTTEST


@dataclass(frozen=True, eq=False)
class Arrhenius(_Formula):
    """Arrhenius shift: one activation energy.

    Parameters
    ----------
    activation_energy : float
        H [J/mol], above zero.
    valid_range : tuple of two floats, optional
        Temperatures between which it was found [K].

    Raises
    ------
    InputError
        If a value is not a number above zero.
    """

    activation_energy: float
    valid_range: tuple[float, float] | None = None

    kind: ClassVar[str] = "arrhenius"

    def __post_init__(self) -> None:
        self._set(activation_energy="J/mol")

    def _log_a(self, temperature: Array) -> Array:
        return arrhenius(self.activation_energy, temperature)


@dataclass(frozen=True, eq=False)
class WLFArrhenius(_Formula):
    """WLF above the glass transition, Arrhenius below; continuous.

    Parameters
    ----------
    c1, c2 : float
        Constants of WLF [-] and [K], above zero.
    activation_energy : float
        H of the glass [J/mol], above zero.
    glass_temperature : float
        T_g, where one law takes over from the other [K]; above the pole of WLF.
    reference_temperature : float, optional
        T_0 of c1 and c2 [K]; as for `WLF`.
    valid_range : tuple of two floats, optional
        Temperatures between which the constants were found [K].

    Raises
    ------
    InputError
        If a value is not a number above zero, or T_g lies at or below the pole of WLF.
    """

    c1: float
    c2: float
    activation_energy: float
    glass_temperature: float
    reference_temperature: float | None = None
    valid_range: tuple[float, float] | None = None

    kind: ClassVar[str] = "wlf_arrhenius"

    def __post_init__(self) -> None:
        constants = {"c1": "", "c2": "K", "activation_energy": "J/mol", "glass_temperature": "K"}
        self._set(**constants, **_if_given(self.reference_temperature))
        if self.reference_temperature is not None:
            self._require_glass_above_pole(self.reference_temperature)

    def bound(self, reference_temperature: float) -> Self:
        """Return the law with `reference_temperature` [K], if it has none of its own."""
        if self.reference_temperature is not None:
            return self
        return replace(self, reference_temperature=reference_temperature)

    def _require_glass_above_pole(self, reference: float) -> None:
        if self.glass_temperature <= reference - self.c2:
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


def _if_given(reference: float | None) -> dict[str, str]:
    return {} if reference is None else {"reference_temperature": "K"}


# Shift factors as found, temperature by temperature, with their standard errors.


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
        kelvin = checks.in_limits("temperature", temperature, unit="K")
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


# Time-temperature shifts: formulas, tables, and the kind by which files name them.

SHIFTS: dict[str, type[Shift]] = {
    law.kind: law for law in (WLF, Arrhenius, WLFArrhenius, ShiftTable)
}
"""Every shift by its kind."""


def shift_from_dict(values: Mapping[str, Any]) -> Shift:
    """Return the shift of `Shift.to_dict`, such as {"kind": "wlf", "c1": 8.0, "c2": 120.0}.

    Raises `InputError` if the kind is unknown, a setting is unknown or one that is needed is not
    there.
    """
    if not isinstance(values, Mapping):
        raise InputError(f"shift must be a mapping with its kind; got {checks.short_repr(values)}")
    settings = dict(values)
    law = SHIFTS[checks.one_of("kind", settings.pop("kind", None), SHIFTS)]
    checks.allowed_names(
        f"setting of the shift {law.kind}", settings, [one.name for one in fields(law)]
    )
    try:
        return law(**settings)
    except TypeError as error:
        raise InputError(f"the shift {law.kind} lacks a setting ({error})") from error


def shift_at(shift: Shift | None, reference_temperature: float | None) -> Shift | None:
    """Return the shift of something that holds for a reference temperature [K].

    Raises `InputError` if it is no shift, or the temperature is not known or beyond its limits.
    """
    if shift is None:
        return None
    if not isinstance(shift, Shift):
        raise InputError(f"shift must be a Shift, such as WLF; got {checks.short_repr(shift)}")
    if reference_temperature is None:
        raise InputError("reference_temperature [K] must be given with a shift; got None")
    bound = shift.bound(reference_temperature)
    bound.log_a(reference_temperature, reference_temperature)
    return bound
