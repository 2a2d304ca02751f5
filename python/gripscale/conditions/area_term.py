"""The area term of dry friction: the real contact area sheared at an interfacial stress.

    mu_adh = tau_f(v, T) A_r / (A_0 p_0)

Its parameters are fits to measured friction of one rubber on one surface; there are no defaults.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError

Array = NDArray[np.float64]

BOLTZMANN = 8.617333262e-5
"""k_B [eV/K]: CODATA 2018."""


@runtime_checkable
class InterfacialShearStress(Protocol):
    """tau_f of speed and temperature; a frozen dataclass of plain numbers."""

    @property
    def kind(self) -> str:
        """Word for it in case files and results."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s] and temperatures [K], broadcast together.

        Raises `InputError` if it depends on the temperature and none is given.
        """


@dataclass(frozen=True)
class ConstantStress:
    """The same shear stress at every speed and temperature.

    Parameters
    ----------
    stress_0 : float
        tau_f [Pa], not negative.
    """

    kind: ClassVar[str] = "constant"

    stress_0: float

    def __post_init__(self) -> None:
        _checked(self, stress_0="Pa")

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        return np.full(_speeds(speed).shape, self.stress_0)


@dataclass(frozen=True)
class GaussianStress:
    """A bell in the logarithm of the speed, which shifts with the temperature.

        tau_f = tau_0 exp(-c log10(v a_T / v_0)^2),   a_T = exp(eps/k_B (1/T - 1/T_0))

    Source: B. Lorenz, Y. R. Oh, S. K. Nam, S. H. Jeon & B. N. J. Persson, J. Chem. Phys. 142 (2015)
    194701, doi:10.1063/1.4919221.

    Parameters
    ----------
    stress_0 : float
        tau_0 [Pa], not negative.
    width : float
        c [-], above zero.
    speed_0 : float
        v_0 at T_0 [m/s], above zero.
    activation_energy : float
        eps [eV]; zero: the temperature does not matter.
    reference_temperature : float, optional
        T_0 [K]; needed with an activation energy.
    """

    kind: ClassVar[str] = "gaussian"

    stress_0: float
    width: float
    speed_0: float
    activation_energy: float = 0.0
    reference_temperature: float | None = None

    def __post_init__(self) -> None:
        _checked(self, stress_0="Pa", activation_energy="eV")
        for name, unit in (("width", ""), ("speed_0", "m/s")):
            object.__setattr__(self, name, checks.positive(name, getattr(self, name), unit=unit))
        if self.reference_temperature is not None:
            kelvin = checks.positive("reference_temperature", self.reference_temperature, unit="K")
            object.__setattr__(self, "reference_temperature", kelvin)
        elif self.activation_energy > 0.0:
            raise InputError(
                "reference_temperature must be given with an activation_energy; got none"
            )

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s] and temperatures [K], broadcast together."""
        with np.errstate(divide="ignore"):
            decades = np.log10(_speeds(speed) / self.speed_0)
        away = decades + self._log_shift(temperature)
        return np.asarray(self.stress_0 * np.exp(-self.width * away**2))

    def _log_shift(self, temperature: ArrayLike | None) -> Array:
        """Return log10 a_T [-], zero where the temperature does not matter."""
        if self.reference_temperature is None or self.activation_energy == 0.0:
            return np.zeros(())
        if temperature is None:
            raise InputError("temperature must be given for an area term that depends on it [K]")
        kelvin = checks.real("temperature", temperature, unit="K")
        if (kelvin < checks.LEAST).any():
            raise InputError(f"temperature must be greater than zero [K]; got {kelvin.min():g}")
        apart = 1.0 / kelvin - 1.0 / self.reference_temperature
        return np.asarray(self.activation_energy / BOLTZMANN * apart / math.log(10.0))


@dataclass(frozen=True)
class LeGalKlueppelStress:
    """A stress that rises from one plateau to another as the interface turns glassy.

        tau_f = tau_0 (1 + (E_glass/E_inf) / (1 + (v_c/v)^n))

    Source: A. Le Gal & M. Klueppel, J. Phys.: Condens. Matter 20 (2008) 015007,
    doi:10.1088/0953-8984/20/01/015007.

    Parameters
    ----------
    stress_0 : float
        tau_0, at slow sliding [Pa], not negative.
    ratio : float
        What the stress gains at high speed, over tau_0: the ratio of glassy to relaxed modulus [-].
    critical_speed : float
        v_c [m/s], above zero.
    exponent : float
        n [-], above zero.
    """

    kind: ClassVar[str] = "le_gal_klueppel"

    stress_0: float
    ratio: float
    critical_speed: float
    exponent: float

    def __post_init__(self) -> None:
        _checked(self, stress_0="Pa", ratio="")
        for name, unit in (("critical_speed", "m/s"), ("exponent", "")):
            object.__setattr__(self, name, checks.positive(name, getattr(self, name), unit=unit))

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        with np.errstate(divide="ignore", over="ignore"):
            slower = (self.critical_speed / _speeds(speed)) ** self.exponent
        return np.asarray(self.stress_0 * (1.0 + self.ratio / (1.0 + slower)))


@dataclass(frozen=True)
class TableStress:
    """A shear stress measured at some speeds, interpolated in log speed, held beyond its ends.

    Parameters
    ----------
    speed : sequence of floats
        [m/s], rising.
    stress_at : sequence of floats
        tau_f there [Pa], not negative.
    """

    kind: ClassVar[str] = "table"

    speed: Sequence[float]
    stress_at: Sequence[float]

    def __post_init__(self) -> None:
        speeds = checks.positive_vector("speed", self.speed, unit="m/s")
        stresses = checks.vector("stress_at", self.stress_at, unit="Pa")
        if speeds.size < 2 or speeds.size != stresses.size or not (np.diff(speeds) > 0.0).all():
            raise InputError(
                "speed must rise over at least 2 values, with one stress_at each; "
                f"got {speeds.size} and {stresses.size}"
            )
        if (stresses < 0.0).any():
            raise InputError(f"stress_at must not be negative [Pa]; got {stresses.min():g}")
        object.__setattr__(self, "speed", tuple(speeds.tolist()))
        object.__setattr__(self, "stress_at", tuple(stresses.tolist()))

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        with np.errstate(divide="ignore"):
            at = np.log(_speeds(speed))
        return np.asarray(np.interp(at, np.log(self.speed), self.stress_at))


SHEAR_STRESSES: dict[str, Any] = {
    law.kind: law for law in (ConstantStress, GaussianStress, LeGalKlueppelStress, TableStress)
}
"""Every law of the interfacial shear stress by its kind."""


def shear_stress_from_dict(values: Mapping[str, Any]) -> InterfacialShearStress:
    """Return the law of {"kind": "gaussian", "stress_0": ..., ...}.

    Raises `InputError` if the kind is unknown, a parameter is missing, unknown or cannot be used.
    """
    given = dict(values)
    kind = checks.one_of("kind", given.pop("kind", None), SHEAR_STRESSES)
    law: InterfacialShearStress = checks.from_mapping(SHEAR_STRESSES[kind], kind, given)
    return law


def shear_stress_to_dict(law: InterfacialShearStress) -> dict[str, Any]:
    """Return kind and parameters of a law as plain values."""
    return {"kind": law.kind} | {f.name: getattr(law, f.name) for f in fields(law)}  # type: ignore[arg-type]


def adhesive_friction(shear_stress: float, contact_fraction: float, pressure: float) -> float:
    """Return mu_adh [-] of a shear stress [Pa], A_r/A_0 [-] and the nominal pressure [Pa].

    NaN where the contact is NaN, that of a wave that did not converge.
    Raises `InputError` if a value cannot be used.
    """
    if isinstance(contact_fraction, float) and math.isnan(contact_fraction):
        return math.nan
    stress = checks.not_negative("shear_stress", shear_stress, unit="Pa")
    fraction = checks.number("contact_fraction", contact_fraction)
    return stress * fraction / checks.positive("pressure", pressure, unit="Pa")


def _speeds(speed: ArrayLike) -> Array:
    """Return speeds [m/s]; raise `InputError` if one is no number from zero."""
    found = checks.real("speed", speed, unit="m/s")
    if (found < 0.0).any():
        raise InputError(f"speed must not be negative [m/s]; got {found.min():g}")
    return found


def _checked(law: Any, **units: str) -> None:
    for name, unit in units.items():
        value = checks.not_negative(name, getattr(law, name), unit=unit)
        object.__setattr__(law, name, value)
