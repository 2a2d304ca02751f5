"""What changes the rubber on the way: its temperature, softening by strain, and its own heat."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.conditions.area_term import (
    InterfacialShearStress,
    adhesive_friction,
    shear_stress_from_dict,
    shear_stress_to_dict,
)
from gripscale.conditions.flash_temperature import ThermalProperties
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.rubber.softening import SofteningLaw, softened, softening_from_dict

Array = NDArray[np.float64]

StrainNorm = Literal["slope", "stretch"]
STRAIN_NORMS = ("slope", "stretch")

HARMONICS = np.geomspace(1.0, 16.0, 12)
"""Multiples of a wave's frequency at which the softened moduli are asked for."""


@dataclass(frozen=True)
class Conditions:
    """Effects beside the rubber as measured, each off unless asked for.

    Parameters
    ----------
    temperature : float, optional
        Of the rubber before the contact [K]; by default that of its master curve.
    softening : SofteningLaw, optional
        How E' and E'' fall with the strain.
    strain_norm : "slope" or "stretch"
        The strain of a wave: half the rms slope in its contact, the larger waves' included (the
        convention of B. N. J. Persson's theory, and the one the direct contact has), or the
        largest principal stretch less one anywhere in the block of this wave alone.
    heat : ThermalProperties, optional
        Warm the rubber by its own friction.
    shear_stress : InterfacialShearStress, optional
        The area term's.

    Raises
    ------
    InputError
        If a value cannot be used.
    """

    temperature: float | None = None
    softening: SofteningLaw | None = None
    strain_norm: StrainNorm = "slope"
    heat: ThermalProperties | None = None
    shear_stress: InterfacialShearStress | None = None

    def __post_init__(self) -> None:
        if self.temperature is not None:
            kelvin = checks.positive("temperature", self.temperature, unit="K")
            object.__setattr__(self, "temperature", kelvin)
        checks.one_of("strain_norm", self.strain_norm, STRAIN_NORMS)
        kinds = (
            ("softening", SofteningLaw, "a law of gripscale.rubber.softening"),
            ("heat", ThermalProperties, "ThermalProperties"),
            ("shear_stress", InterfacialShearStress, "a law of gripscale.conditions"),
        )
        for name, kind, expected in kinds:
            value = getattr(self, name)
            if value is not None and not isinstance(value, kind):
                raise InputError(f"{name} must be {expected}; got {checks.short_repr(value)}")

    def to_dict(self) -> dict[str, Any]:
        """Return every effect as plain values, None where it is off."""
        return {
            "temperature": self.temperature,
            "softening": None if self.softening is None else self.softening.to_dict(),
            "strain_norm": self.strain_norm,
            "heat": None if self.heat is None else asdict(self.heat),
            "shear_stress": None
            if self.shear_stress is None
            else shear_stress_to_dict(self.shear_stress),
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Conditions:
        """Return the conditions of `to_dict`; raise `InputError` if a value is another."""
        given = dict(values)
        made = {
            "softening": softening_from_dict,
            "heat": lambda heat: checks.from_mapping(ThermalProperties, "heat", heat),
            "shear_stress": shear_stress_from_dict,
        }
        for name, make in made.items():
            if given.get(name) is not None:
                given[name] = make(given[name])
        return checks.from_mapping(cls, "conditions", given)

    def adhesive_friction(
        self, contact_fraction: float, pressure: float, speed: float, temperature: float | None
    ) -> float:
        """Return the area term's friction [-], NaN where none was asked for or nothing slides.

        Of A_r/A_0 [-], the nominal pressure [Pa], the speed [m/s] and the temperature in the
        contact [K], None for that before it.
        """
        if self.shear_stress is None or speed == 0.0:
            return math.nan
        kelvin = self.temperature if temperature is None else temperature
        stress = float(self.shear_stress.stress(speed, kelvin))
        return adhesive_friction(stress, contact_fraction, pressure)

    @property
    def iterated(self) -> bool:
        """Whether the rubber depends on what is solved."""
        return self.softening is not None or self.heat is not None

    def temperature_of(self, rubber: Rubber) -> float | None:
        """Return the temperature before the contact [K], None if nobody knows it."""
        return rubber.reference_temperature if self.temperature is None else self.temperature

    def before(self, rubber: Rubber) -> Rubber:
        """Return `rubber` at the temperature before the contact.

        Raises `InputError` if there is a temperature, or heat, and the rubber has no shift.
        """
        if self.heat is not None and (rubber.shift is None or self.temperature_of(rubber) is None):
            raise InputError(
                "heat needs a rubber with reference_temperature and shift, as superpose gives "
                f"them; got none with {rubber.name or 'this rubber'}"
            )
        return rubber if self.temperature is None else rubber.at(self.temperature)

    def within_shift(self, rubber: Rubber, kelvin: ArrayLike) -> Array:
        """Return temperatures [K], those beyond what the shift of `rubber` has values for held."""
        if rubber.shift is None:
            return np.asarray(kelvin, dtype=float)
        return np.clip(kelvin, *rubber.shift.limits)


@dataclass(frozen=True)
class RubberState:
    """What the rubber has become at one place."""

    rubber: Rubber
    storage_factor: float
    """f, what is left of E' by strain [-]."""
    loss_factor: float
    """g, what is left of E'' by strain [-]."""
    series_misfit: float
    """Of the softened series at the frequency of the wave [-]."""
    beyond_sweep: bool
    """Whether the strain lies beyond what the softening was measured for."""
    beyond_shift: bool
    """Whether the temperature lies beyond those the shift rests on."""


def rubber_under(
    conditions: Conditions, rubber: Rubber, *, warming: float, strain: float, omega: float
) -> RubberState:
    """Return the rubber at one place of a contact.

    Parameters
    ----------
    conditions : Conditions
        What changes it.
    rubber : Rubber
        As measured.
    warming : float
        Above the temperature before the contact [K].
    strain : float
        Uniaxial amplitude [-].
    omega : float
        Lowest angular frequency there [rad/s]; zero at rest.
    """
    own, kelvin = conditions.before(rubber), conditions.temperature_of(rubber)
    if conditions.heat is not None and kelvin is not None:
        kelvin = float(conditions.within_shift(own, kelvin + warming))
        own = own.at(kelvin)
    beyond = own.shift_extrapolated
    if conditions.softening is None:
        return RubberState(own, 1.0, 1.0, 0.0, beyond_sweep=False, beyond_shift=beyond)
    left = conditions.softening.factors(strain, kelvin)
    f, g = float(left.storage), float(left.loss)
    series = softened(own, f, g, omega * HARMONICS if omega > 0.0 else ())
    return RubberState(series.rubber, f, g, series.misfit, bool(left.outside), beyond)


# A rubber that is another one at every scale: what the direct contact is solved with.
#
# A harmonic of wavenumber q meets the rubber at the temperature and the strain of its own scale,
#
#     E*(w, q) = (f E'(a_T w) + i g E''(a_T w)) / b_T,     a_T, b_T, f and g of |q|
#
# with f and g exact here: no series has to carry them. Between the scales at which they are known
# the logarithms of the factors are linear in log |q|.

ComplexArray = NDArray[np.complex128]

ROWS_AT_ONCE = 50_000


@dataclass(frozen=True)
class ScaleFactors:
    """Factors of the moduli at some wavenumbers, arrays of shape (scales,)."""

    wavenumber: Array
    """Rising [rad/m]."""
    shift: Array
    """a_T [-]."""
    stiffening: Array
    """1/b_T [-]."""
    storage: Array
    """f [-]."""
    loss: Array
    """g [-]."""

    def at(self, name: str, wavenumber: Array) -> Array:
        """Return a factor at `wavenumber` [rad/m], held beyond the ends."""
        logs = np.log(getattr(self, name))
        return np.asarray(np.exp(np.interp(np.log(wavenumber), np.log(self.wavenumber), logs)))


@dataclass(frozen=True)
class RubberByScale:
    """A rubber with factors of its moduli by scale."""

    rubber: Rubber
    factors: ScaleFactors

    def plane_strain_modulus(self, omega: ArrayLike, wavenumber: ArrayLike) -> ComplexArray:
        """Return E/(1 - nu^2) [Pa] at `omega` [rad/s] and |q| [rad/m], broadcast together.

        With G* = E*/3 of the scale and the bulk modulus of the rubber, as for the rubber itself.
        """
        frequency, number = np.broadcast_arrays(
            np.asarray(omega, dtype=float), np.asarray(wavenumber, dtype=float)
        )
        shape = frequency.shape
        frequency, number = frequency.reshape(-1), number.reshape(-1)
        parts = [
            self._part(frequency[at : at + ROWS_AT_ONCE], number[at : at + ROWS_AT_ONCE])
            for at in range(0, frequency.size, ROWS_AT_ONCE)
        ]
        shear = np.concatenate(parts).reshape(shape) / 3.0
        bulk = 3.0 * self.rubber.bulk_modulus
        return np.asarray(4.0 * shear * (bulk + shear) / (bulk + 4.0 * shear))

    def shift(self, wavenumber: Array) -> Array:
        """Return a_T [-] at |q| [rad/m], that of the longest scale for the mean."""
        return self.factors.at("shift", self._own(wavenumber))

    def _own(self, wavenumber: Array) -> Array:
        return np.where(wavenumber > 0.0, wavenumber, self.factors.wavenumber[0])

    def _part(self, omega: Array, wavenumber: Array) -> ComplexArray:
        own = self._own(wavenumber)
        at = {
            name: self.factors.at(name, own) for name in ("shift", "stiffening", "storage", "loss")
        }
        modulus = self.rubber.complex_modulus(omega * at["shift"]) * at["stiffening"]
        return np.asarray(at["storage"] * modulus.real + 1j * at["loss"] * modulus.imag)


# Temperature and strain at every scale of a direct contact, and the rubber they make.


@dataclass(frozen=True)
class StateByScale:
    """What the rubber has become at some wavenumbers, arrays of shape (scales,)."""

    wavenumber: Array
    """Rising [rad/m]."""
    warming: Array
    """Above the temperature before the contact [K]."""
    strain: Array
    """Uniaxial amplitude of the waves up to the wavenumber [-]."""
    storage_factor: Array
    """f, what is left of E' by strain [-]."""
    loss_factor: Array
    """g, what is left of E'' by strain [-]."""
    beyond_sweep: NDArray[np.bool_]
    """Where the strain lies beyond what the softening was measured for."""
    beyond_shift: NDArray[np.bool_]
    """Where the temperature lies beyond those the shift rests on."""
    rubber: RubberByScale
    """The rubber that is solved with."""


def state_by_scale(
    conditions: Conditions, rubber: Rubber, *, wavenumber: Array, warming: Array, strain: Array
) -> StateByScale:
    """Return the rubber under `conditions` with its temperature and strain at every scale.

    Parameters
    ----------
    conditions : Conditions
        What changes it.
    rubber : Rubber
        As measured.
    wavenumber : array, shape (scales,)
        Rising [rad/m].
    warming, strain : array, shape (scales,)
        Above the temperature before the contact [K], and uniaxial amplitude [-].
    """
    before, kelvin = conditions.before(rubber), conditions.temperature_of(rubber)
    one = np.ones(wavenumber.size)
    shift, stiffening = one, one
    storage, loss = one, one
    beyond = warm_beyond = np.zeros(wavenumber.size, dtype=bool)
    if conditions.heat is not None and kelvin is not None and before.shift is not None:
        warm = conditions.within_shift(before, kelvin + warming)
        shift = before.shift.a(warm, kelvin)
        stiffening = 1.0 / before.shift.b(warm, kelvin)
        warm_beyond = np.array([not before.shift.within(t) for t in kelvin + warming])
    if conditions.softening is not None:
        at = [kelvin] * wavenumber.size if kelvin is None else list(kelvin + warming)
        left = [conditions.softening.factors(float(e), t) for e, t in zip(strain, at, strict=True)]
        storage = np.array([float(one.storage) for one in left])
        loss = np.array([float(one.loss) for one in left])
        beyond = np.array([bool(one.outside) for one in left])
    factors = ScaleFactors(wavenumber, shift, stiffening, storage, loss)
    return StateByScale(
        wavenumber,
        warming,
        strain,
        storage,
        loss,
        beyond,
        warm_beyond,
        RubberByScale(before, factors),
    )
