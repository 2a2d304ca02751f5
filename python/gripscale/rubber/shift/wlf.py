"""Williams, Landel and Ferry's shift, and Arrhenius' below the glass transition.

    WLF        log10 a_T = -c1 (T - T_0) / (c2 + T - T_0)
    Arrhenius  log10 a_T = H / (R ln 10) (1/T - 1/T_0)

The first holds above the glass transition and has a pole at T_0 - c2. Referred to another
temperature T_1 the same law has c2' = c2 + T_1 - T_0 and c1' = c1 c2 / c2'. Sources: M. L.
Williams, R. F. Landel & J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701, doi:10.1021/ja01619a008;
J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 11.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber.shift.base import Array, Shift, checked_range

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
