"""The area term of dry friction: the real contact area sheared at an interfacial stress.

    mu_adh = tau_f(v, T) A_r / (A_0 p_0)

The parameters of a law are fits to measured friction of one rubber on one surface; only `DryTread`
has numbers of its own, from three treads on a dry road (`studies/dry_law.py`):

    ln tau_f = ln tau_0 - c log10(v/v_0)^2 + d s

with d the deviation of the tread from the mean and s the scatter between compounds.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, fields
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, checked, checks

# tau_0 [Pa], c, v_0 [m/s] of the compounds S100, S120 and S140, and s of a further one: its 90 %
# interval by Student's t, as three are few.
DRY_STRESS_0, DRY_WIDTH, DRY_SPEED_0, STRESS_SCATTER = 1.86e6, 0.098, 0.140, 0.24
DRY_SPEEDS = (1e-4, 1.0)
"""Range of the measured speeds [m/s]; the stress is held beyond."""
DRY_ASSUMPTIONS = (
    "Dry road: shear stress of three treads of one maker without resin on one road, 0.1 mm/s to "
    "1 m/s, 3 bar and 20 C assumed; resin raised it by 9 to 24 %."
)


def sliding_speeds(speed: ArrayLike) -> Array:
    """Return speeds [m/s]; raise `InputError` if one is negative or not a number."""
    speeds = checks.real("speed", speed, unit="m/s")
    if (speeds < 0.0).any():
        raise InputError(f"speed must not be negative [m/s]; got {speeds.min():g}")
    return speeds


class DryTread(Checked):
    """Mean of treads without resin on a dry road, or a deviation from it; at any temperature."""

    kind: ClassVar[str] = "dry_tread"

    deviation: float = checked(checks.number, default=0.0)
    """Standard deviations of ln tau_f from the mean of treads [-]."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape; held beyond those measured."""
        decades = np.log10(np.clip(sliding_speeds(speed), *DRY_SPEEDS) / DRY_SPEED_0)
        log = self.deviation * STRESS_SCATTER - DRY_WIDTH * decades**2
        return np.asarray(DRY_STRESS_0 * np.exp(log))


DRY_TREAD = DryTread()
"""The mean."""


BOLTZMANN = 8.617333262e-5  # k_B [eV/K]: CODATA 2018


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


def _numbers(name: str, value: Any, *, rule: Callable[..., Array], unit: str) -> tuple[float, ...]:
    """Return checked numbers as a tuple, which can be compared and stored."""
    return tuple(rule(name, value, unit=unit).tolist())


class FittedPoints(Checked):
    """Measured points that a law was fitted to, and how well the friction is known there."""

    contact: str = checked(checks.instance, kind=str)
    """Hash of surface, rubber and effects the law was fitted with."""
    speed: Sequence[float] = checked(_numbers, rule=checks.positive_vector, unit="m/s")
    """Sliding speed of each [m/s]."""
    contact_fraction: Sequence[float] = checked(_numbers, rule=checks.positive_vector, unit="")
    """Predicted A_r/A_0 of each [-]."""
    half_width: Sequence[float] = checked(_numbers, rule=checks.positive_vector, unit="")
    """Half of the 90 % interval of the friction of each, by fit and measurement [-]."""
    temperature: Sequence[float] | None = checked(
        _numbers, rule=checks.positive_vector, unit="K", default=None
    )
    """Of the rubber before each contact [K], where it is known."""


def _fitted_to(name: str, value: Any) -> FittedPoints:
    if isinstance(value, Mapping):
        return checks.from_mapping(FittedPoints, name, value)
    return checks.instance(name, value, FittedPoints)


class ConstantStress(Checked):
    """The same at every speed and temperature."""

    kind: ClassVar[str] = "constant"

    stress_0: float = checked(checks.not_negative, unit="Pa")
    """Interfacial shear stress [Pa]."""
    fitted_to: FittedPoints | None = checked(_fitted_to, default=None, repr=False)
    """What the law was fitted to, as `gripscale calibrate` writes it."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        return np.full(sliding_speeds(speed).shape, self.stress_0)


class GaussianStress(Checked):
    """A bell in the logarithm of the speed, which may shift with the temperature.

        tau_f = tau_0 exp(-c log10(v a_T / v_0)^2),   a_T = exp(eps/k_B (1/T - 1/T_0))

    Source: B. Lorenz, Y. R. Oh, S. K. Nam, S. H. Jeon & B. N. J. Persson, J. Chem. Phys. 142 (2015)
    194701, doi:10.1063/1.4919221.
    """

    kind: ClassVar[str] = "gaussian"

    stress_0: float = checked(checks.not_negative, unit="Pa")
    """Largest interfacial shear stress tau_0 [Pa]."""
    width: float = checked(checks.positive)
    """Factor c of the squared decades of speed: the larger, the narrower the bell [-]."""
    speed_0: float = checked(checks.positive, unit="m/s")
    """Speed v_0 of the largest stress, at the reference temperature [m/s]."""
    activation_energy: float = checked(checks.not_negative, unit="eV", default=0.0)
    """How that speed shifts with the temperature; 0: not at all [eV]."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Temperature T_0 that speed_0 holds for; needed with an activation energy [K]."""
    fitted_to: FittedPoints | None = checked(_fitted_to, default=None, repr=False)
    """What the law was fitted to, as `gripscale calibrate` writes it."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.reference_temperature is None and self.activation_energy > 0.0:
            raise InputError(
                "reference_temperature must be given with an activation_energy; got none"
            )

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s] and temperatures [K], broadcast together."""
        with np.errstate(divide="ignore"):
            shifted = np.log10(sliding_speeds(speed) / self.speed_0)
        if self.reference_temperature is not None and self.activation_energy > 0.0:
            if temperature is None:
                raise InputError("temperature must be given [K] for an area term with it")
            kelvin = checks.real("temperature", temperature, unit="K")
            if (kelvin < checks.LEAST).any():
                raise InputError(f"temperature must be greater than zero [K]; got {kelvin.min():g}")
            difference = 1.0 / kelvin - 1.0 / self.reference_temperature
            shift = self.activation_energy / BOLTZMANN * difference / math.log(10.0)
            shifted = shifted + shift
        return np.asarray(self.stress_0 * np.exp(-self.width * shifted**2))


class LeGalKlueppelStress(Checked):
    """A rise from one plateau to another as the interface turns glassy (Le Gal and Klueppel).

        tau_f = tau_0 (1 + (E_glass/E_inf) / (1 + (v_c/v)^n))

    Source: A. Le Gal & M. Klueppel, J. Phys.: Condens. Matter 20 (2008) 015007,
    doi:10.1088/0953-8984/20/01/015007.
    """

    kind: ClassVar[str] = "le_gal_klueppel"

    stress_0: float = checked(checks.not_negative, unit="Pa")
    """Interfacial shear stress tau_0 at slow sliding [Pa]."""
    ratio: float = checked(checks.not_negative)
    """Gain of the stress at high speed, over stress_0: glassy over relaxed modulus [-]."""
    critical_speed: float = checked(checks.positive, unit="m/s")
    """Speed v_c at which half of that is gained [m/s]."""
    exponent: float = checked(checks.positive)
    """Exponent n of the speed: how steeply it is gained [-]."""
    fitted_to: FittedPoints | None = checked(_fitted_to, default=None, repr=False)
    """What the law was fitted to, as `gripscale calibrate` writes it."""

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        with np.errstate(divide="ignore", over="ignore"):
            slowness = (self.critical_speed / sliding_speeds(speed)) ** self.exponent
        return np.asarray(self.stress_0 * (1.0 + self.ratio / (1.0 + slowness)))


class TableStress(Checked):
    """Measured at some speeds; interpolated in log speed, constant beyond them."""

    kind: ClassVar[str] = "table"

    speed: Sequence[float] = checked(_numbers, rule=checks.increasing_vector, unit="m/s")
    """The speeds, rising [m/s]."""
    stress_at: Sequence[float] = checked(_numbers, rule=checks.not_negative_vector, unit="Pa")
    """Interfacial shear stress at each [Pa]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.same_length(2, speed=np.array(self.speed), stress_at=np.array(self.stress_at))

    def stress(self, speed: ArrayLike, temperature: ArrayLike | None = None) -> Array:
        """Return tau_f [Pa] at speeds [m/s], same shape."""
        with np.errstate(divide="ignore"):
            at = np.log(sliding_speeds(speed))
        return np.asarray(np.interp(at, np.log(self.speed), self.stress_at))


# Every law of the interfacial shear stress by its kind.
SHEAR_STRESSES: dict[str, Any] = {
    law.kind: law
    for law in (ConstantStress, GaussianStress, LeGalKlueppelStress, TableStress, DryTread)
}


def shear_stress_from_dict(values: Mapping[str, Any]) -> InterfacialShearStress:
    """Return the law of {"kind": "gaussian", "stress_0": ..., ...}.

    Raises `InputError` if the kind is unknown, a parameter is missing, unknown or cannot be used.
    """
    law: InterfacialShearStress = checks.of_kind(SHEAR_STRESSES, "shear_stress", values)
    return law


def shear_stress_to_dict(law: InterfacialShearStress) -> dict[str, Any]:
    """Return kind and parameters of a law as plain values."""
    values = {f.name: getattr(law, f.name) for f in fields(law)}  # type: ignore[arg-type]
    for name, value in values.items():
        if isinstance(value, FittedPoints):
            values[name] = asdict(value)
        elif hasattr(value, "stress"):
            values[name] = shear_stress_to_dict(value)
    return {"kind": law.kind} | values


def adhesive_friction(shear_stress: float, contact_fraction: float, pressure: float) -> float:
    """Return mu_adh [-] of a shear stress [Pa], A_r/A_0 [-], which may be NaN, and pressure [Pa].

    Raises `InputError` if a value cannot be used.
    """
    if isinstance(contact_fraction, float) and math.isnan(contact_fraction):
        return math.nan
    stress = checks.not_negative("shear_stress", shear_stress, unit="Pa")
    fraction = checks.number("contact_fraction", contact_fraction)
    return stress * fraction / checks.positive("pressure", pressure, unit="Pa")
