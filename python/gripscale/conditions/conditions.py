"""Conditions that change the rubber: temperature, softening by strain, friction heat.

A wave of the chain has one temperature and one strain. In the direct contact a harmonic of
wavenumber q meets the rubber at the temperature and the strain of its scale,

    E*(w, q) = (f E'(a_T w) + i g E''(a_T w)) / b_T,     a_T, b_T, f and g functions of |q|,

whose logarithms are linear in log |q| between the scales. docs/derivations.md says which strain
softens a scale, and how far typical laws may be off.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from gripscale.conditions import area_term
from gripscale.conditions.flash_temperature import (
    COUNTERFACE_BY_KIND,
    THERMAL_SCATTER,
    ThermalProperties,
)
from gripscale.core import Array, Checked, ComplexArray, InputError, Mask, checked, checks, units
from gripscale.rubber import Rubber
from gripscale.rubber.softening import (
    SOFTER_TREAD,
    TYPICAL_TREAD,
    Kraus,
    SofteningLaw,
    SofteningTable,
    TypicalTread,
    softened,
)
from gripscale.surface.surface import SurfaceKind

StrainNorm = Literal["slope", "stretch"]
STRAIN_NORMS = ("slope", "stretch")

# Frequencies, over that of a wave, at which a Prony series is fitted to the softened moduli.
_HARMONICS = np.geomspace(1.0, 16.0, 12)
ROWS_AT_ONCE = 50_000


# In place of an effect that a case has by default: switched off on purpose.
OFF = "none"
DEFAULTED = ("softening", "heat")


def _effect(name: str, value: Any, *, kind: type, expected: str) -> Any:
    off = name in DEFAULTED and isinstance(value, str) and value == OFF
    if value is not None and not off and not isinstance(value, kind):
        raise InputError(f"{name} must be {expected}; got {checks.short_repr(value)}")
    return value


def _switched_off(name: str, values: Any) -> tuple[str, ...]:
    effects = values if isinstance(values, tuple) else checks.instances(name, values, str)
    return tuple(checks.one_of(name, effect, DEFAULTED) for effect in effects)


FLOODED = "flooded"


def water_film(water: object) -> float:
    """Return the film that `water` asks for [m]: infinite if flooded, zero if dry."""
    if isinstance(water, bool | np.bool_):
        return math.inf if water else 0.0
    if water in (FLOODED, math.inf):
        return math.inf
    try:
        film = units.parse_quantity(water, "length")
    except ValueError as error:
        raise InputError(
            f'water must be True, False, "{FLOODED}" or the thickness of a film: {error}'
        ) from error
    return checks.positive("water", film, unit="m")


SOFTENING_LAWS: dict[str, Any] = {law.kind: law for law in (Kraus, SofteningTable, TypicalTread)}


class Conditions(Checked):
    """Effects on the rubber as measured, the area term and water; each is off by default.

    Raises `InputError` if a value cannot be used.
    """

    temperature: float | None = checked(checks.positive, unit="K", default=None)
    """Of the rubber before the contact [K]; by default that of its master curve."""
    softening: SofteningLaw | None = checked(
        _effect, kind=SofteningLaw, expected="a law of gripscale.rubber.softening", default=None
    )
    """How E' and E'' fall with the strain."""
    strain_norm: StrainNorm = checked(checks.one_of, choices=STRAIN_NORMS, default="slope")
    """The strain of a wave of a chain. "slope": 0.4 times the rms slope in its contact, including
    the slopes of the larger waves (see docs/strain-rule.md, where the direct contact's is, too).
    "stretch": the largest principal stretch minus one in the block of this wave."""
    heat: ThermalProperties | None = checked(
        _effect, kind=ThermalProperties, expected="ThermalProperties", default=None
    )
    """With it the rubber warms by its friction."""
    shear_stress: area_term.InterfacialShearStress | None = checked(
        _effect,
        kind=area_term.InterfacialShearStress,
        expected="a law of gripscale.conditions",
        default=None,
    )
    """Interfacial shear stress of the area term."""
    water: float | None = checked(lambda _, value: water_film(value) or None, default=None)
    """Water that contact can trap, on a map: "flooded" or True, or the thickness of a film [m].
    Only the direct contact has it, and not together with softening or heat."""
    counterface: ThermalProperties | None = checked(
        _effect, kind=ThermalProperties, expected="ThermalProperties", default=None
    )
    """What takes up heat through the contact, with heat; None: it is insulating."""
    off: tuple[str, ...] = checked(_switched_off, default=())
    """Effects that are switched off on purpose, by the word "none" in their place: a case has none
    of them by default either."""

    def __post_init__(self) -> None:
        super().__post_init__()
        for effect in DEFAULTED:
            if getattr(self, effect) == OFF:
                self._set(**{effect: None}, off=(*self.off, effect))
        if self.water is not None and self.iterated:
            effect = "heat" if self.softening is None else "softening"
            raise InputError(
                f"water must be left out with {effect}, which is iterated with a dry contact; "
                "got both"
            )

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield each effect that is stated."""
        for name, text in super().shown_rows():
            flooded = name == "water" and self.water == math.inf
            yield name, FLOODED if flooded else text

    def to_dict(self) -> dict[str, Any]:
        """Return every effect as plain values, None where it is off."""
        return {
            "temperature": self.temperature,
            "softening": self.softening and self.softening.to_dict(),
            "strain_norm": self.strain_norm,
            "heat": self.heat and asdict(self.heat),
            "counterface": self.counterface and asdict(self.counterface),
            "shear_stress": self.shear_stress and area_term.shear_stress_to_dict(self.shear_stress),
            "water": FLOODED if self.water == math.inf else self.water,
            **({"off": list(self.off)} if self.off else {}),
        }

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Conditions:
        """Return the conditions of `to_dict`; raise `InputError` if a value cannot be used."""
        effects = dict(values)
        laws: dict[str, Callable[[Any], Any]] = {
            "softening": partial(checks.of_kind, SOFTENING_LAWS, "softening"),
            "heat": partial(checks.from_mapping, ThermalProperties, "heat"),
            "counterface": partial(checks.from_mapping, ThermalProperties, "counterface"),
            "shear_stress": area_term.shear_stress_from_dict,
        }
        for name, law in laws.items():
            if effects.get(name) is not None:
                effects[name] = law(effects[name])
        return checks.from_mapping(cls, "conditions", effects)

    def adhesive_friction(
        self, contact_fraction: float, pressure: float, speed: float, temperature: float | None
    ) -> float:
        """Return the friction of the area term [-]; NaN without an area term, and at rest.

        Arguments: A_r/A_0 [-], nominal pressure [Pa], sliding speed [m/s], and the temperature in
        the contact [K], None for the temperature before the contact.
        """
        if self.shear_stress is None or speed == 0.0:
            return math.nan
        kelvin = self.temperature if temperature is None else temperature
        stress = float(self.shear_stress.stress(speed, kelvin))
        return area_term.adhesive_friction(stress, contact_fraction, pressure)

    def without(self, *effects: str) -> Conditions:
        """Return the same with effects switched off on purpose."""
        nothing: dict[str, Any] = dict.fromkeys(effects)
        off = [name for name in effects if name in DEFAULTED]
        return replace(self, **nothing, off=tuple(dict.fromkeys([*self.off, *off])))

    @property
    def warming(self) -> Conditions:
        """The same with the law whose friction warms the interface: that of a probe is another."""
        law = self.shear_stress
        return replace(self, shear_stress=getattr(law, "warming_law", law))

    @property
    def dry(self) -> Conditions:
        """The same without water, for models that have no pools."""
        return replace(self, water=None)

    @property
    def iterated(self) -> bool:
        """Whether the rubber depends on the solution, which then is a fixed point."""
        return self.softening is not None or self.heat is not None

    def temperature_of(self, rubber: Rubber) -> float | None:
        """Return the temperature before the contact [K], None if it is not known."""
        return rubber.reference_temperature if self.temperature is None else self.temperature

    def before(self, rubber: Rubber) -> Rubber:
        """Return `rubber` at the temperature before the contact.

        Raises `InputError` for a temperature or heat if the rubber has no temperature shift.
        """
        if self.heat is not None and (rubber.shift is None or self.temperature_of(rubber) is None):
            raise InputError(
                "heat needs a rubber with reference_temperature and shift, as superpose gives "
                f"them; got none with {rubber.name or 'this rubber'}"
            )
        return rubber if self.temperature is None else rubber.at(self.temperature)

    def within_shift(self, rubber: Rubber, kelvin: ArrayLike) -> Array:
        """Return temperatures [K], clipped to the limits of the temperature shift of `rubber`."""
        if rubber.shift is None:
            return np.asarray(kelvin, dtype=float)
        return np.clip(kelvin, *rubber.shift.limits)


@dataclass(frozen=True)
class RubberState:
    """The rubber at one strain and temperature."""

    rubber: Rubber
    storage_modulus_ratio: float  # f, softened over measured E' [-]
    loss_modulus_ratio: float  # g, softened over measured E'' [-]
    series_misfit: float  # misfit of the softened Prony series at the frequency of the wave [-]
    strain_extrapolated: bool  # whether the strain lies outside the measured range of the softening
    # Whether the temperature lies outside the measured range of the shift.
    temperature_extrapolated: bool


def rubber_under(
    conditions: Conditions, rubber: Rubber, *, warming: float, strain: float, omega: float
) -> RubberState:
    """Return the rubber with one temperature rise `warming` [K] and one uniaxial amplitude [-].

    `omega` is the lowest angular frequency of the excitation [rad/s], zero at rest.
    """
    solid, kelvin = conditions.before(rubber), conditions.temperature_of(rubber)
    if conditions.heat is not None and kelvin is not None:
        kelvin = float(conditions.within_shift(solid, kelvin + warming))
        solid = solid.at(kelvin)
    f, g, misfit, outside = 1.0, 1.0, 0.0, False
    warm_outside = solid.shift_extrapolated
    if conditions.softening is not None:
        ratios = conditions.softening.factors(strain, kelvin)
        f, g, outside = float(ratios.storage), float(ratios.loss), bool(ratios.outside)
        series = softened(solid, f, g, omega * _HARMONICS if omega > 0.0 else ())
        solid, misfit = series.rubber, series.misfit
    return RubberState(solid, f, g, misfit, outside, warm_outside)


@dataclass(frozen=True)
class RubberByScale:
    """A rubber with factors of its moduli by scale, arrays of shape (scales,)."""

    rubber: Rubber
    wavenumber: Array  # rising [rad/m]
    a_t: Array  # a_T [-]
    stiffening: Array  # 1/b_T [-]
    storage: Array  # f [-]
    loss: Array  # g [-]

    def complex_modulus(self, omega: ArrayLike, wavenumber: ArrayLike) -> ComplexArray:
        """Return E* [Pa] at `omega` [rad/s] and |q| [rad/m], broadcast together."""
        frequency, number = np.broadcast_arrays(
            np.asarray(omega, dtype=float), np.asarray(wavenumber, dtype=float)
        )
        factors, parts = (self.a_t, self.stiffening * self.storage, self.stiffening * self.loss), []
        # in blocks, because the factors of all relaxation times are in memory at once
        for at in range(0, frequency.size, ROWS_AT_ONCE):
            rows = slice(at, at + ROWS_AT_ONCE)
            shift, storage, loss = self._at(number.reshape(-1)[rows], *factors)
            modulus = self.rubber.complex_modulus(frequency.reshape(-1)[rows] * shift)
            modulus.real *= storage
            modulus.imag *= loss
            parts.append(modulus)
        return np.concatenate(parts).reshape(frequency.shape)

    def shift(self, wavenumber: Array) -> Array:
        """Return a_T [-] at |q| [rad/m]; the mean, |q| = 0, has that of the longest scale."""
        return self._at(wavenumber, self.a_t)[0]

    def _at(self, wavenumber: Array, *factors: Array) -> list[Array]:
        """Return factors at wavenumbers [rad/m], held beyond the ends."""
        number = np.where(wavenumber > 0.0, wavenumber, self.wavenumber[0])
        at, logs = np.log(number), np.log(self.wavenumber)
        return [np.exp(np.interp(at, logs, np.log(factor))) for factor in factors]


@dataclass(frozen=True)
class StateByScale:
    """Temperature, strain and rubber at some wavenumbers, arrays of shape (scales,)."""

    wavenumber: Array  # rising [rad/m]
    warming: Array  # temperature rise over that before the contact [K]
    strain: Array  # uniaxial amplitude of the waves up to the wavenumber [-]
    storage_modulus_ratio: Array  # f, softened over measured E' [-]
    loss_modulus_ratio: Array  # g, softened over measured E'' [-]
    strain_extrapolated: Mask  # where the strain lies outside the measured range of the softening
    # Where the temperature lies outside the measured range of the shift.
    temperature_extrapolated: Mask
    rubber: RubberByScale  # the rubber of all scales


def state_by_scale(
    conditions: Conditions, rubber: Rubber, *, wavenumber: Array, warming: Array, strain: Array
) -> StateByScale:
    """Return the rubber under `conditions` with its temperature and strain at every scale.

    `wavenumber` rises [rad/m]; `warming` is the rise over the temperature before the contact [K],
    `strain` the uniaxial amplitude [-]. All arrays have the shape (scales,).
    """
    before, kelvin = conditions.before(rubber), conditions.temperature_of(rubber)
    shift = stiffening = storage = loss = np.ones(wavenumber.size)
    outside = warm_outside = np.zeros(wavenumber.size, dtype=bool)
    if conditions.heat is not None and kelvin is not None and before.shift is not None:
        warm = conditions.within_shift(before, kelvin + warming)
        shift = before.shift.a(warm, kelvin)
        stiffening = 1.0 / before.shift.b(warm, kelvin)
        warm_outside = np.array([not before.shift.within(t) for t in kelvin + warming])
    if conditions.softening is not None:
        at = [kelvin] * wavenumber.size if kelvin is None else list(kelvin + warming)
        ratios = [
            conditions.softening.factors(float(e), t) for e, t in zip(strain, at, strict=True)
        ]
        storage = np.array([float(ratio.storage) for ratio in ratios])
        loss = np.array([float(ratio.loss) for ratio in ratios])
        outside = np.array([bool(ratio.outside) for ratio in ratios])
    return StateByScale(
        wavenumber=wavenumber,
        warming=warming,
        strain=strain,
        storage_modulus_ratio=storage,
        loss_modulus_ratio=loss,
        strain_extrapolated=outside,
        temperature_extrapolated=warm_outside,
        rubber=RubberByScale(before, wavenumber, shift, stiffening, storage, loss),
    )


# What may not be known.
TREADS = "scatter between treads"
TENSION_OR_SHEAR = "sweeps in tension or in shear"
THERMAL_CONSTANTS = "typical thermal constants"
MASTER_CURVE_STRAIN = "strain of the master curve"
AMPLITUDE = "single or double amplitude of the sweeps"
MEASURED_LAWS = (Kraus, SofteningTable, TypicalTread)  # in tension or in shear


@dataclass(frozen=True)
class Alternative:
    """Conditions that may be true as well, or another warming by them."""

    label: str  # what is not known, in words
    conditions: Conditions
    warming: float = 1.0  # over that of the conditions as they are [-]
    # Standard error of the logarithm of a result over its change by these conditions [-].
    share: float = 1.0


def alternatives(conditions: Conditions) -> Iterator[Alternative]:
    """Yield what may be true as well, one for each thing that is not known."""
    softening, heat = conditions.softening, conditions.heat
    if isinstance(softening, TypicalTread):
        softer = replace(softening, deviation=softening.deviation + SOFTER_TREAD.deviation)
        yield Alternative(TREADS, replace(conditions, softening=softer))
    if isinstance(softening, MEASURED_LAWS) and softening.deformation is None:
        tension = replace(softening, deformation="tension")
        # either end is as likely, and the change is from the middle to one of them
        yield Alternative(TENSION_OR_SHEAR, replace(conditions, softening=tension))
    if isinstance(softening, SofteningTable):
        yield from _of_sweeps(conditions, softening)
    if heat == ThermalProperties():
        hotter = math.exp(THERMAL_SCATTER)
        yield Alternative(THERMAL_CONSTANTS, conditions, warming=hotter)


def _of_sweeps(conditions: Conditions, sweeps: SofteningTable) -> Iterator[Alternative]:
    """Yield what is not stated of the strains of a master curve and of sweeps."""
    if sweeps.measured_at is None:
        ends = [strains[0] for strains in sweeps.strain], [strains[-1] for strains in sweeps.strain]
        strain = min(max(math.e * sweeps.reference(0), *ends[0]), *ends[1])
        other = replace(sweeps, measured_at=strain)
        yield Alternative(MASTER_CURVE_STRAIN, replace(conditions, softening=other))
    if sweeps.amplitude_assumed:
        half = [[0.5 * strain for strain in strains] for strains in sweeps.strain]
        last = min(strains[-1] for strains in half)
        at = None if sweeps.measured_at is None else min(sweeps.measured_at, last)
        other = replace(sweeps, strain=half, measured_at=at)
        # one end is assumed: the change is from it to the other
        yield Alternative(AMPLITUDE, replace(conditions, softening=other), share=0.5)


DEPTH_FACTOR = 0.85
"""Strain of a scale over the mean strain at its depth under the contact [-]."""
LOG_AREA, LOG_FRICTION = 0.10, 0.05
"""Scatter of ln area and ln friction of a direct contact, the filler healing or not [-]."""
SLOPE_FACTOR = 0.4
"""Strain of a wave of a chain over the rms slope in its contact [-]."""


Interface = Literal["dry"]
DRY = get_args(Interface)


def with_defaults(
    conditions: Conditions | None,
    rubber: Rubber,
    *,
    filled: bool | None,
    interface: Interface | None,
    kind: SurfaceKind,
) -> Conditions | None:
    """Return conditions with what they leave open, or None if nothing changes rubber and contact.

    Filled rubber softens, one with a temperature shift warms by its friction, a dry road shears the
    real contact area. Raises `InputError` if an unfilled rubber is to soften.
    """
    effects = conditions or Conditions()
    if filled is False and effects.softening is not None:
        raise InputError("filled must be true with softening, which unfilled rubber has none of")
    if effects.water is None:
        if filled and effects.softening is None and "softening" not in effects.off:
            effects = replace(effects, softening=TYPICAL_TREAD)
        warms = rubber.shift is not None and effects.temperature_of(rubber) is not None
        if warms and effects.heat is None and "heat" not in effects.off:
            effects = replace(effects, heat=ThermalProperties())
        if effects.heat is not None and effects.counterface is None:
            effects = replace(effects, counterface=COUNTERFACE_BY_KIND[kind])
    if interface == "dry" and effects.shear_stress is None:
        effects = replace(effects, shear_stress=area_term.DRY_TREAD)
    return None if effects == Conditions() else effects
