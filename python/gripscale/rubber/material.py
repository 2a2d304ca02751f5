"""A linear viscoelastic, nearly incompressible rubber: a generalized Maxwell (Prony) solid.

    E(t)  = E_inf + sum_i E_i exp(-t/tau_i)
    E*(w) = E_inf + sum_i E_i i w tau_i / (1 + i w tau_i) = E'(w) + i E''(w)

Source: J. D. Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), ch. 3. Only shear relaxes:
G* = E*/3 and the bulk modulus K is constant; E is the modulus of the incompressible limit. The
admissible series are extremes that fit the same measurement: their envelope is the uncertainty of
E*(w). A plateau counts as measured where none of them leaves the modulus of the end of the data by
more than a fifth within the two decades beyond it.
"""

from __future__ import annotations

import hashlib
import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

import gripscale
from gripscale._kernel import relaxing_moduli
from gripscale.core import Checked, Pictured, checked, checks, shown_value
from gripscale.core.arrays import Array, ComplexArray, Mask, Quantity, Vector
from gripscale.core.errors import InputError, RubberWarning
from gripscale.core.units import ZERO_CELSIUS, celsius, readable
from gripscale.rubber.admissible import AdmissibleSeries
from gripscale.rubber.shift import Shift, shift_at, shift_from_dict, shown_state
from gripscale.rubber.strain_energy import STRAIN_ENERGIES, NeoHookean, StrainEnergy

if TYPE_CHECKING:
    from matplotlib.figure import Figure


BULK_MODULUS = 2e9  # that of rubber [Pa], where none was measured
# Below this no rubber and hardly a glassy polymer is: the bulk modulus is too small.
LEAST_POISSON_RATIO = 0.3


def poisson_ratio(bulk: ArrayLike, modulus: ArrayLike) -> Array:
    """Return nu = (3K - 2|G|) / (2 (3K + |G|)) [-] of K and |E*| = 3 |G| [Pa]."""
    bulk, shear = 3.0 * np.asarray(bulk), np.asarray(modulus) / 3.0
    return np.asarray((bulk - 2.0 * shear) / (2.0 * (bulk + shear)))


def plane_strain_modulus_of(modulus: ComplexArray, bulk: float) -> ComplexArray:
    """Return E/(1 - nu^2) = 4 G (3K + G) / (3K + 4 G) [Pa] of E* = 3 G and K [Pa], same shape."""
    shear = modulus / 3.0
    bulk = 3.0 * bulk
    return np.asarray(4.0 * shear * (bulk + shear) / (bulk + 4.0 * shear))


def least_bulk_modulus(modulus: float) -> float:
    """Return K [Pa] with which Poisson's ratio at |E*| [Pa] is 0.3, for a shear modulus of E/3."""
    shear = modulus / 3.0
    return 2.0 * shear * (1.0 + LEAST_POISSON_RATIO) / (3.0 - 6.0 * LEAST_POISSON_RATIO)


def too_compressible(bulk: float, modulus: float, where: str) -> str:
    """Return a sentence if Poisson's ratio at K and |E*| [Pa] is below 0.3, else nothing."""
    ratio = float(poisson_ratio(bulk, modulus))
    if ratio >= LEAST_POISSON_RATIO:
        return ""
    least = least_bulk_modulus(modulus)
    return (
        f"the bulk modulus, {bulk / 1e6:.4g} MPa, gives Poisson's ratio {ratio:.2f} {where}; "
        f"{least / 1e6:.4g} MPa would give {LEAST_POISSON_RATIO:g}"
    )


@lru_cache(maxsize=1024)
def warn_once(sentence: str) -> None:
    """Warn of a rubber made by hand; a second time of the same numbers nothing is said."""
    warnings.warn(sentence, RubberWarning, stacklevel=4)


class Rubber(Checked, Pictured, eq=False):
    """Generalized Maxwell solid with constant bulk modulus.

    Raises `InputError` if a value is missing, not finite, not positive, beyond 1e-100 to 1e100, the
    lengths differ, or `admissible` belongs to other moduli or times. Warns once
    (`RubberWarning`) if Poisson's ratio is below 0.3 at the fast end of `valid_band`, or at any
    frequency without one; of a rubber with `admissible` the report on its fit says so.

        >>> gs.Rubber("5 MPa", ["20 MPa"], ["1 ms"]).complex_modulus(1e3)
        array(15000000.+10000000.j)
    """

    equilibrium_modulus: float = checked(checks.positive, unit="Pa")
    """Young's modulus after infinite time, E_inf = 3 G_inf [Pa], above zero."""
    moduli: Vector = checked(checks.positive_vector, unit="Pa", default=(), repr=False)
    """Young's moduli of the Maxwell elements, E_i = 3 G_i [Pa], shape (terms,). Empty: elastic."""
    relaxation_times: Vector = checked(checks.positive_vector, unit="s", default=(), repr=False)
    """Their relaxation times [s], shape (terms,), above zero."""
    bulk_modulus: float = checked(checks.positive, unit="Pa", default=BULK_MODULUS)
    """Bulk modulus [Pa]; more than 2/9 of E_inf + sum E_i, so that Poisson's ratio is positive."""
    name: str = checked(checks.text, default="")
    source: str = checked(checks.text, default="")
    """What the rubber is and where its numbers come from."""
    valid_band: tuple[float, float] | None = checked(checks.interval, unit="rad/s", default=None)
    """Lowest and highest angular frequency the numbers rest on [rad/s]."""
    strain_energy: StrainEnergy = checked(checks.instance, kind=StrainEnergy, default=NeoHookean())
    """Strain energy of the permanent network at finite strain."""
    admissible: AdmissibleSeries | None = checked(
        checks.instance, kind=AdmissibleSeries, default=None, repr=False
    )
    """Other series that fit the same measurement: what it leaves open. It is refused with
    other moduli or times."""
    reference_temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Temperature the numbers hold for [K]."""
    shift: Shift | None = field(default=None, repr=False)
    """What they become at other temperatures (`at`); a law may take the rubber's temperature."""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._set(shift=shift_at(self.shift, self.reference_temperature))
        self._check_together()
        if self.admissible is not None:
            series = np.array([self.equilibrium_modulus, *self.moduli, *self.relaxation_times])
            fingerprint = hashlib.sha256(series.tobytes()).hexdigest()  # to the last bit
            self._set(admissible=self.admissible.given_to(fingerprint))
            return
        if self.valid_band is None:
            modulus, where = self.glassy_modulus, "at high frequency"
        else:
            fast = self.valid_band[1]
            modulus, where = abs(complex(self.complex_modulus(fast))), f"at {fast:.3g} rad/s"
        warning = too_compressible(self.bulk_modulus, modulus, where)
        if warning:
            warn_once(warning)

    def _check_together(self) -> None:
        checks.same_length(0, moduli=self.moduli, relaxation_times=self.relaxation_times)
        least = 2.0 / 9.0 * self.glassy_modulus
        if self.bulk_modulus <= least:
            raise InputError(
                f"bulk_modulus [Pa] must exceed 2/9 of E_inf + sum E_i, {least:g}, "
                f"to keep Poisson's ratio positive; got {self.bulk_modulus:g}"
            )

    def to_dict(self) -> dict[str, Any]:
        """Return all numbers and names, arrays as lists and the strain energy by its kind."""
        values = {item.name: getattr(self, item.name) for item in fields(self)}
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
        names = [item.name for item in fields(cls)]
        if set(values) | {"admissible", "reference_temperature", "shift"} != set(names):
            raise InputError(f"values must have the keys {', '.join(names)}; got {list(values)}")
        others, shift = values.get("admissible"), values.get("shift")
        energy = checks.of_kind(STRAIN_ENERGIES, "strain_energy", values["strain_energy"])
        parts = {
            "strain_energy": energy,
            "admissible": None if others is None else AdmissibleSeries.from_dict(others),
            "shift": None if shift is None else shift_from_dict(shift),
        }
        return cls(**{**values, **parts})

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield name, moduli, relaxation times, band and temperature."""
        yield "name", self.name or "unnamed"
        yield "E relaxed", readable(self.equilibrium_modulus, "Pa")
        yield "E at once", readable(self.glassy_modulus, "Pa")
        if self.moduli.size:
            yield "relaxation_times", shown_value(self.relaxation_times, "s")
        yield "bulk_modulus", readable(self.bulk_modulus, "Pa")
        yield "strain_energy", repr(self.strain_energy)
        if self.valid_band is not None:
            yield "valid_band", " to ".join(readable(end, "rad/s") for end in self.valid_band)
        yield from shown_state(self)

    @property
    def glassy_modulus(self) -> float:
        """Modulus at once after a step, E_inf + sum E_i [Pa]; of the glass if the data reach it."""
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
        frequency = checks.real("omega", omega, unit="rad/s")
        arrays = (frequency.reshape(-1), self.moduli, self.relaxation_times)
        relaxing = relaxing_moduli(*map(np.ascontiguousarray, arrays))
        return np.asarray(self.equilibrium_modulus + relaxing.reshape(frequency.shape))

    def complex_modulus_band(self, omega: ArrayLike) -> tuple[ComplexArray, ComplexArray]:
        """Return how low and how high E* [Pa] may be at angular frequencies `omega` [rad/s].

        The envelope of this series and the admissible ones: E' lies between the real parts, E''
        between the imaginary parts. Stated within the measured band and two decades beyond its
        ends; further out the series have no relaxation times. Raises `InputError` if `omega` is not
        finite, or the rubber has no admissible series.
        """
        modulus = self.complex_modulus(omega)
        if self.admissible is None:
            raise InputError(
                "admissible must be the series that also fit, as fit_prony finds them, for the "
                f"uncertainty of a modulus; got none with {self.name or 'this rubber'}"
            )
        others = self.admissible.complex_moduli(np.abs(np.asarray(omega, dtype=float)))
        others.imag *= np.sign(omega)
        every = np.concatenate([modulus[None], others])
        low, high = (np.asarray(f(every.real, 0) + 1j * f(every.imag, 0)) for f in (np.min, np.max))
        return low, high

    def admissible_rubbers(self) -> list[Rubber]:
        """Return each admissible series as a rubber; none if there are none."""
        if self.admissible is None:
            return []
        rubbers, times = [], self.admissible.relaxation_times
        values = {item.name: getattr(self, item.name) for item in fields(self)}
        series = zip(self.admissible.equilibrium_moduli, self.admissible.moduli, strict=True)
        for equilibrium, moduli in series:
            present = moduli > 0.0
            other = object.__new__(Rubber)  # what this rubber warned of is said already
            other._set(**values | {"equilibrium_modulus": float(equilibrium), "admissible": None})
            other._set(moduli=moduli[present], relaxation_times=times[present])
            other._check_together()
            rubbers.append(other)
        return rubbers

    def plot(self) -> Figure:
        """Draw moduli and loss factor by frequency; see `master_curve_figure`."""
        return gripscale.questions.master_curve_figure(self)

    def at(self, temperature: Quantity) -> Rubber:
        """Return the same rubber at another temperature [K].

        E*(w, T) = E*(a_T w, T_ref)/b_T: relaxation times are multiplied by a_T, the frequencies of
        `valid_band` divided by it, and all Young's moduli, E_inf as well as E_i, divided by b_T.
        The bulk modulus, which does not relax, and the strain energy's parameters, which have no
        dimension, stay. The shift is kept, so that `at` goes on from any temperature to any other.
        Raises `InputError` if the rubber has no shift, the shift no value at `temperature`, or the
        moduli there do not go with the bulk modulus.
        """
        kelvin = checks.positive("temperature", temperature, unit="K")
        if self.shift is None or self.reference_temperature is None:
            raise InputError(
                f"{self.name or 'this rubber'} is known at one temperature, not at "
                f"{kelvin - ZERO_CELSIUS:g} C: its time-temperature shift is missing; expected "
                "sweeps at several temperatures, or a shift such as "
                '{ kind = "wlf", c1 = 8.0, c2 = "120 K" } with its reference_temperature'
            )
        if kelvin == self.reference_temperature:
            return self
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
            raise InputError(f"time must not be negative [s]; got {checks.short_repr(elapsed)}")
        with np.errstate(over="ignore"):  # infinitely many relaxation times have passed
            decay = np.exp(-elapsed[..., None] / self.relaxation_times)
        return np.asarray(self.equilibrium_modulus + (self.moduli * decay).sum(-1))

    def poisson_ratio(self, omega: ArrayLike) -> Array:
        """Return nu = (3K - 2|G|) / (2 (3K + |G|)) [-] at `omega` [rad/s], with |G| = |E*|/3."""
        return poisson_ratio(self.bulk_modulus, np.abs(self.complex_modulus(omega)))

    def plane_strain_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return the complex E/(1 - nu^2) = 4 G* (3K + G*) / (3K + 4 G*) [Pa] at `omega` [rad/s].

        This is the stiffness of a half-plane in plane strain when shear relaxes (G* = E*/3) and the
        bulk modulus does not; 4/3 of E* when incompressible.
        """
        return plane_strain_modulus_of(self.complex_modulus(omega), self.bulk_modulus)

    def outside_band(self, omega: ArrayLike) -> Mask:
        """Return whether each `omega` [rad/s] lies outside `valid_band`; False if none is known."""
        frequency = np.abs(checks.real("omega", omega, unit="rad/s"))
        if self.valid_band is None:
            return np.zeros(frequency.shape, dtype=bool)
        low, high = self.valid_band
        return np.asarray((frequency < low) | (frequency > high))


class MeasuredModuli(Rubber, eq=False):
    """A rubber with the moduli its series was fitted to, which may belong to no linear solid."""

    @classmethod
    def of(cls, rubber: Rubber) -> MeasuredModuli:
        """Return it of a rubber that has the rows of its measurement."""
        return cls(**{item.name: getattr(rubber, item.name) for item in fields(rubber)})

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """Return E* [Pa]; between rows ln(measured/fitted) is linear, beyond them zero."""
        series, rows = super().complex_modulus(omega), self.admissible
        if rows is None or not rows.omega.size:
            return series
        fitted, position = super().complex_modulus(rows.omega), np.log(rows.omega)
        at = np.log(np.maximum(np.abs(omega), checks.LEAST))
        pairs = (rows.storage, fitted.real), (rows.loss, np.maximum(fitted.imag, checks.LEAST))
        storage, loss = (
            np.exp(np.interp(at, position, np.log(measured / series), left=0.0, right=0.0))
            for measured, series in pairs
        )
        return np.asarray(storage * series.real + 1j * loss * series.imag)


BEYOND = 100.0  # how far beyond the data uncertainty is stated: a factor of frequency, two decades
_CHANGE = 1.25


@dataclass(frozen=True)
class End:
    """One end of what is known of a rubber."""

    modulus: float  # storage modulus [Pa]: of the plateau, or at the last frequency measured
    plateau: bool  # whether it is the relaxed, or the glassy, modulus


def slow_end(rubber: Rubber) -> End:
    """Return the relaxed modulus, or what was measured last on the way to it."""
    return _end(rubber, rubber.equilibrium_modulus, 0)


def fast_end(rubber: Rubber) -> End:
    """Return the glassy modulus, or what was measured last on the way to it."""
    return _end(rubber, rubber.glassy_modulus, 1)


def _end(rubber: Rubber, limit: float, side: int) -> End:
    """Return the `limit` where the admissible series hardly leave the modulus measured last."""
    if rubber.valid_band is None:
        return End(limit, True)
    omega = rubber.valid_band[side]
    last = float(rubber.complex_modulus(omega).real)
    if rubber.admissible is None:
        return End(last, False)
    beyond = omega * (1.0 / BEYOND, BEYOND)[side]
    furthest = float(rubber.complex_modulus_band(beyond)[side].real)
    plateau = max(furthest / last, last / furthest) <= _CHANGE
    return End(limit if plateau else last, plateau)


# Mean pressure over relaxation modulus that is let through: far beyond, no contact is partial; at
# slopes near one, three is full.
MOST_PRESSURE = 10.0


def require_load_bearing(rubber: Rubber, pressure: float, load_time: float) -> None:
    """Raise `InputError` unless E(t) after `load_time` [s] carries a pressure; infinity is rest."""
    checks.instance("rubber", rubber, Rubber)
    modulus = float(rubber.relaxation_modulus(load_time))
    if pressure <= MOST_PRESSURE * modulus:
        return
    name, what, instead = f"the relaxation modulus after {load_time:.3g} s", "the rubber", ""
    if load_time == 0.0:
        name = "the modulus at the highest frequencies"
    if math.isinf(load_time):
        name, what = "equilibrium_modulus", "the rubber, a melt at rest,"
        instead = "; leave out the static contact, in a case by a speed above zero"
    raise InputError(
        f"the pressure squeezes {what} flat: {name} [Pa] must be at least "
        f"1/{MOST_PRESSURE:g} of the pressure, {pressure / MOST_PRESSURE:.3g}; "
        f"got {modulus:.3g}{instead}"
    )


_SAME = 0.5  # temperatures that differ by less are one [K]: 20 °C and 293 K


def temperature_doubts(rubbers: Mapping[str, Rubber]) -> tuple[str, ...]:
    """Return what is doubtful about comparing rubbers, a sentence each; empty if nothing is.

    `rubbers` are named by their keys. They may hold for different temperatures, some without one
    beside others that state it, or for one beyond those that their shift rests on.
    """
    kelvins = {
        name: rubber.reference_temperature
        for name, rubber in rubbers.items()
        if rubber.reference_temperature is not None
    }
    sentences = []
    if kelvins and max(kelvins.values()) - min(kelvins.values()) > _SAME:
        each = ", ".join(f"{name} {celsius(k, '.1f')}" for name, k in kelvins.items())
        sentences.append(f"the rubbers hold for different temperatures: {each}")
    if kelvins and len(kelvins) < len(rubbers):
        others = ", ".join(name for name in rubbers if name not in kelvins)
        sentences.append(
            f"the temperature of {others} is not known, that of {', '.join(kelvins)} is"
        )
    beyond = [name for name, rubber in rubbers.items() if rubber.shift_extrapolated]
    if beyond:
        sentences.append(f"beyond the temperatures of its shift: {', '.join(beyond)}")
    return tuple(sentences)
