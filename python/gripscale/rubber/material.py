"""A linear viscoelastic, nearly incompressible rubber: a generalized Maxwell (Prony) solid.

    E(t)  = E_inf + sum_i E_i exp(-t/tau_i)
    E*(w) = E_inf + sum_i E_i i w tau_i / (1 + i w tau_i) = E'(w) + i E''(w)

Source: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 3.

Only shear relaxes: G* = E*/3 and the bulk modulus K is constant. E is the modulus of the
incompressible limit; the few per cent by which a finite K changes it enter through Poisson's ratio.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.rubber import material_checks
from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.compressibility import too_compressible, warn_once
from gripscale.rubber.maxwell_shapes import complex_sum
from gripscale.rubber.shift import Shift, shift_at, shift_from_dict
from gripscale.rubber.strain_energy import NeoHookean, StrainEnergy, strain_energy_from_dict

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

DEFAULT_ENERGY = NeoHookean()


@dataclass(frozen=True, init=False, eq=False)
class Rubber:
    """Generalized Maxwell solid with constant bulk modulus.

    Parameters
    ----------
    equilibrium_modulus : float
        Young's modulus after infinite time, E_inf = 3 G_inf [Pa], above zero.
    moduli : array_like, shape (terms,)
        Young's moduli of the Maxwell elements, E_i = 3 G_i [Pa], above zero. Empty: elastic.
    relaxation_times : array_like, shape (terms,)
        Their relaxation times [s], above zero.
    bulk_modulus : float
        Bulk modulus [Pa]; more than 2/9 of E_inf + sum E_i, so that Poisson's ratio stays positive
        at every frequency.
    name, source : str
        What the rubber is and where its numbers come from.
    valid_band : tuple of two floats, optional
        Lowest and highest angular frequency the numbers rest on [rad/s].
    strain_energy : StrainEnergy
        Strain energy of the permanent network at finite strain.
    admissible : AdmissibleSeries, optional
        Other series that fit the same measurement: what it leaves open. It is of this series only,
        and refused with others: whoever changes moduli or times leaves it out, or states another.
    reference_temperature : float, optional
        Temperature the numbers hold for [K].
    shift : Shift, optional
        What they become at other temperatures (`at`); a law without a reference temperature of its
        own takes that of the rubber.

    Raises
    ------
    InputError
        If a value is missing, not finite, not positive, beyond 1e-100 to 1e100, the lengths
        differ, or `admissible` belongs to other moduli or times.

    Warns
    -----
    RubberWarning
        Once, if Poisson's ratio is below 0.3 at the fast end of `valid_band`, or at any frequency
        without one. Of a rubber with `admissible` the report on its fit says so.
    """

    equilibrium_modulus: float
    moduli: Array = field(repr=False)
    relaxation_times: Array = field(repr=False)
    bulk_modulus: float = 2e9
    name: str = ""
    source: str = ""
    valid_band: tuple[float, float] | None = None
    strain_energy: StrainEnergy = DEFAULT_ENERGY
    admissible: AdmissibleSeries | None = field(default=None, repr=False)
    reference_temperature: float | None = None
    shift: Shift | None = field(default=None, repr=False)

    def __init__(
        self,
        equilibrium_modulus: float,
        moduli: ArrayLike = (),
        relaxation_times: ArrayLike = (),
        bulk_modulus: float = 2e9,
        name: str = "",
        source: str = "",
        valid_band: tuple[float, float] | None = None,
        strain_energy: StrainEnergy = DEFAULT_ENERGY,
        admissible: AdmissibleSeries | None = None,
        reference_temperature: float | None = None,
        shift: Shift | None = None,
    ) -> None:
        values = {
            "equilibrium_modulus": material_checks.modulus(
                "equilibrium_modulus", equilibrium_modulus
            ),
            "moduli": material_checks.read_only(checks.in_reason("moduli", moduli, unit="Pa")),
            "relaxation_times": material_checks.read_only(
                checks.in_reason("relaxation_times", relaxation_times, unit="s")
            ),
            "bulk_modulus": material_checks.modulus("bulk_modulus", bulk_modulus),
            "name": checks.text("name", name),
            "source": checks.text("source", source),
            "valid_band": material_checks.band(valid_band),
            "strain_energy": material_checks.energy(strain_energy),
            "admissible": material_checks.admissible(admissible),
            "reference_temperature": material_checks.temperature(reference_temperature),
            "shift": shift_at(shift, reference_temperature),
        }
        self._set(**values)
        self._check_together()
        if self.admissible is None:
            self._warn_of_compressibility()
        else:
            self._set(admissible=self.admissible.given_to(self._fingerprint()))

    def _set(self, **values: Any) -> None:
        for key, value in values.items():
            object.__setattr__(self, key, value)

    def _fingerprint(self) -> str:
        """Return a text that only this series has: its moduli and times, to the last bit."""
        series = np.array([self.equilibrium_modulus, *self.moduli, *self.relaxation_times])
        return hashlib.sha256(series.tobytes()).hexdigest()

    def _warn_of_compressibility(self) -> None:
        if self.valid_band is None:
            modulus, where = self.glassy_modulus, "at high frequency"
        else:
            fast = self.valid_band[1]
            modulus, where = abs(complex(self.complex_modulus(fast))), f"at {fast:.3g} rad/s"
        told = too_compressible(self.bulk_modulus, modulus, where)
        if told:
            warn_once(told)

    def _check_together(self) -> None:
        if len(self.moduli) != len(self.relaxation_times):
            raise InputError(
                "moduli and relaxation_times must have the same length; "
                f"got {len(self.moduli)} and {len(self.relaxation_times)}"
            )
        least = 2.0 / 9.0 * self.glassy_modulus
        if self.bulk_modulus <= least:
            raise InputError(
                f"bulk_modulus [Pa] must exceed 2/9 of E_inf + sum E_i, {least:g}, "
                f"to keep Poisson's ratio positive; got {self.bulk_modulus:g}"
            )

    def __eq__(self, other: object) -> bool:
        """Compare all numbers and names."""
        return isinstance(other, Rubber) and self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[object, ...]:
        return (
            self.equilibrium_modulus,
            self.moduli.tobytes(),
            self.relaxation_times.tobytes(),
            self.bulk_modulus,
            self.name,
            self.source,
            self.valid_band,
            self.strain_energy,
            self.admissible,
            self.reference_temperature,
            self.shift,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return all numbers and names, arrays as lists and the strain energy by its kind."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        energy = self.strain_energy
        return values | {
            "moduli": self.moduli.tolist(),
            "relaxation_times": self.relaxation_times.tolist(),
            "valid_band": None if self.valid_band is None else list(self.valid_band),
            "strain_energy": {"kind": energy.kind, **energy.parameters()},
            "admissible": None if self.admissible is None else self.admissible.to_dict(),
            "shift": None if self.shift is None else self.shift.to_dict(),
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Rubber:
        """Return the rubber of `to_dict`, exactly; raise `InputError` if a key is another.

        `admissible`, `reference_temperature` and `shift` may be absent, as in files of older
        versions.
        """
        known = [field.name for field in fields(cls)]
        if set(values) | {"admissible", "reference_temperature", "shift"} != set(known):
            raise InputError(f"values must have the keys {', '.join(known)}; got {list(values)}")
        others, shift = values.get("admissible"), values.get("shift")
        parts = {
            "strain_energy": strain_energy_from_dict(values["strain_energy"]),
            "admissible": None if others is None else AdmissibleSeries.from_dict(others),
            "shift": None if shift is None else shift_from_dict(shift),
        }
        return cls(**{**values, **parts})

    @property
    def glassy_modulus(self) -> float:
        """Young's modulus of the series at once after a step, E_inf + sum E_i [Pa].

        The modulus of the glass only where the data reach it.
        """
        return float(self.equilibrium_modulus + self.moduli.sum())

    @property
    def equilibrium_shear_modulus(self) -> float:
        """Shear modulus after infinite time, E_inf / 3 [Pa]."""
        return self.equilibrium_modulus / 3.0

    @property
    def shear_moduli(self) -> Array:
        """Shear moduli of the Maxwell elements, E_i / 3 [Pa], shape (terms,)."""
        return self.moduli / 3.0

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return E*(w) = E' + i E'' [Pa] at angular frequencies `omega` [rad/s], same shape.

        A negative frequency gives the complex conjugate. Raises `InputError` unless finite and
        below 1e100.
        """
        frequency = material_checks.finite("omega", omega, "rad/s")
        relaxing = complex_sum(frequency, self.relaxation_times, self.moduli)
        return np.asarray(self.equilibrium_modulus + relaxing)

    def complex_modulus_band(self, omega: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
        """Return how low and how high E* [Pa] may be at angular frequencies `omega` [rad/s].

        The envelope of this series and the admissible ones: E' lies between the real parts, E''
        between the imaginary parts. Stated within the measured band and two decades beyond its
        ends; further out the series have no relaxation times.

        Raises
        ------
        InputError
            If `omega` is not finite, or the rubber has no admissible series.
        """
        own = self.complex_modulus(omega)
        if self.admissible is None:
            raise InputError(
                "admissible must be the series that also fit, as fit_prony finds them, for the "
                f"uncertainty of a modulus; got none with {self.name or 'this rubber'}"
            )
        others = self.admissible.complex_moduli(np.abs(np.asarray(omega, dtype=float)))
        others.imag *= np.sign(omega)
        every = np.concatenate([own[None], others])
        low = every.real.min(axis=0) + 1j * every.imag.min(axis=0)
        high = every.real.max(axis=0) + 1j * every.imag.max(axis=0)
        return np.asarray(low), np.asarray(high)

    def admissible_rubbers(self) -> list[Rubber]:
        """Return each admissible series as a rubber; none if there are none."""
        if self.admissible is None:
            return []
        series = zip(self.admissible.equilibrium_moduli, self.admissible.moduli, strict=True)
        times = self.admissible.relaxation_times
        return [
            self._with_series(float(equilibrium), moduli[moduli > 0.0], times[moduli > 0.0])
            for equilibrium, moduli in series
        ]

    def _with_series(self, equilibrium: float, moduli: Array, times: Array) -> Rubber:
        """Return this rubber with another series that fits; what it warned of is said already."""
        other = object.__new__(Rubber)
        other._set(**{field.name: getattr(self, field.name) for field in fields(self)})
        other._set(
            equilibrium_modulus=equilibrium,
            moduli=material_checks.read_only(moduli),
            relaxation_times=material_checks.read_only(times),
            admissible=None,
        )
        other._check_together()
        return other

    def at(self, temperature: float) -> Rubber:
        """Return the same rubber at another temperature [K].

        E*(w, T) = E*(a_T w, T_ref)/b_T: relaxation times are multiplied by a_T, the frequencies of
        `valid_band` divided by it, and all Young's moduli, E_inf as well as E_i, divided by b_T.
        The bulk modulus, which does not relax, and the strain energy's parameters, which have no
        dimension, stay. The shift is kept, so that `at` goes on from any temperature to any other.

        Raises
        ------
        InputError
            If the rubber has no shift, the shift no value at `temperature`, or the moduli there do
            not go with the bulk modulus.
        """
        kelvin = checks.positive("temperature", temperature, unit="K")
        if self.shift is None or self.reference_temperature is None:
            raise InputError(
                "shift and reference_temperature must be those of the rubber for it to be had at "
                f"{kelvin:g} K; got none with {self.name or 'this rubber'}"
            )
        a = float(self.shift.a(kelvin, self.reference_temperature))
        b = float(self.shift.b(kelvin, self.reference_temperature))
        band = self.valid_band and (self.valid_band[0] / a, self.valid_band[1] / a)
        return replace(
            self,
            equilibrium_modulus=self.equilibrium_modulus / b,
            moduli=self.moduli / b,
            relaxation_times=self.relaxation_times * a,
            valid_band=band,
            admissible=None if self.admissible is None else self.admissible.shifted(a, b),
            reference_temperature=kelvin,
        )

    @property
    def shift_extrapolated(self) -> bool:
        """Whether the temperature lies beyond those the shift rests on (`Shift.range`)."""
        if self.shift is None or self.reference_temperature is None:
            return False
        return not self.shift.within(self.reference_temperature)

    def loss_factor(self, omega: ArrayLike) -> Array:
        """Return tan(delta) = E''/E' [-] at angular frequencies `omega` [rad/s], same shape."""
        modulus = self.complex_modulus(omega)
        return np.asarray(modulus.imag / modulus.real)

    def relaxation_modulus(self, time: ArrayLike) -> Array:
        """Return E(t) [Pa] at `time` [s] after a step, same shape; infinity gives equilibrium.

        Raises `InputError` for a negative time or NaN.
        """
        elapsed = checks.array(time, "time must be numbers, not negative [s]")
        if not (elapsed >= 0.0).all():
            raise InputError(f"time must not be negative [s]; got {checks.shown(elapsed)}")
        with np.errstate(over="ignore"):  # infinitely many relaxation times have passed
            decay = np.exp(-elapsed[..., None] / self.relaxation_times)
        return np.asarray(self.equilibrium_modulus + (self.moduli * decay).sum(-1))

    def poisson_ratio(self, omega: ArrayLike) -> Array:
        """Return nu = (3K - 2|G|) / (2 (3K + |G|)) [-] at `omega` [rad/s], with |G| = |E*|/3."""
        shear = np.abs(self.complex_modulus(omega)) / 3.0
        bulk = self.bulk_modulus
        return np.asarray((3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear)))

    def plane_strain_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return the complex E/(1 - nu^2) = 4 G* (3K + G*) / (3K + 4 G*) [Pa] at `omega` [rad/s].

        This is the stiffness of a half-plane in plane strain when shear relaxes (G* = E*/3) and the
        bulk modulus does not; 4/3 of E* when incompressible.
        """
        shear = self.complex_modulus(omega) / 3.0
        bulk = 3.0 * self.bulk_modulus
        return np.asarray(4.0 * shear * (bulk + shear) / (bulk + 4.0 * shear))

    def outside_band(self, omega: ArrayLike) -> NDArray[np.bool_]:
        """Return whether each `omega` [rad/s] lies outside `valid_band`; False if none is known."""
        frequency = np.abs(material_checks.finite("omega", omega, "rad/s"))
        if self.valid_band is None:
            return np.zeros(frequency.shape, dtype=bool)
        low, high = self.valid_band
        return np.asarray((frequency < low) | (frequency > high))
