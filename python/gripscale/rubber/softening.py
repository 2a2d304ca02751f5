"""Strain softening of filled rubber (the Payne effect): how E' and E'' fall with the strain.

    E'(w) -> f(e) E'(w),      E''(w) -> g(e) E''(w)

with e the amplitude of a uniaxial strain. A shear strain of amplitude s stores as much energy in an
incompressible solid as e = s / sqrt(3): G s^2 = E e^2. Where nothing says which it is, a strain is
taken half-way, e = s / 3^(1/4). Laws are that of G. Kraus, J. Appl. Polym. Sci.: Appl. Polym. Symp.
39 (1984) 75, tables of strain sweeps, and the mean of four published treads
(`studies/typical_tread.py`). docs/derivations.md has the equations, and how a series follows f and
g where a wave excites the rubber.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, Mask, checked, checks
from gripscale.rubber.admissible import loss_shape, storage_shape
from gripscale.rubber.material import Rubber
from gripscale.rubber.strain_sweeps import DEFORMATIONS, ONE_FREQUENCY, Deformation, StrainSweep
from gripscale.rubber.sweeps import TEMPERATURE_TOLERANCE, neighbours_of

# Strain of a sweep over the uniaxial strain of the same energy, by what the sweep says it is.
_OF_UNIAXIAL = {"tension": 1.0, "shear": 3.0**0.5, None: 3.0**0.25}
# Usual strain of a DMA measurement, which has to be small and above the noise [-].
USUAL_STRAIN = 1e-3
_SMOOTHING, KEEPING = 0.03, 0.02
_LEAST = 1.0 / 3.0  # smallest multiplier of E_inf over f


@dataclass(frozen=True)
class SofteningFactors:
    """Factors of both moduli at some strains, arrays of one shape."""

    storage: Array  # f(e), of E' [-]
    loss: Array  # g(e), of E'' [-]
    # Where the strain (or the temperature) lies beyond what was measured, the ends held.
    outside: Mask


@runtime_checkable
class SofteningLaw(Protocol):
    """Factors of both moduli against the strain; a frozen dataclass of plain numbers."""

    @property
    def kind(self) -> str:
        """Word for it in case files and results."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        One at and below the strain at which the rubber's moduli were measured.
        """

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters as plain values."""
        return {"kind": self.kind, **self.__dict__}


@dataclass(frozen=True)
class SoftenedSeries:
    """A rubber with both moduli softened where it is excited."""

    rubber: Rubber
    # Largest relative difference from f E' and g E'' at the lowest frequency asked for [-].
    misfit: float


def softened(rubber: Rubber, storage: float, loss: float, omega: ArrayLike) -> SoftenedSeries:
    """Return `rubber` with E' times `storage` and E'' times `loss` [-] at `omega` [rad/s].

    The factors f and g hold at these frequencies, shape (frequencies,); without any all moduli are
    multiplied by f (relaxed rubber). Raises `InputError` if a factor or a frequency is not above
    zero.
    """
    f, g = checks.positive("storage", storage), checks.positive("loss", loss)
    at = checks.positive_vector("omega", omega, unit="rad/s") if np.size(omega) else np.empty(0)
    if f == g or at.size == 0 or rubber.moduli.size == 0:
        return SoftenedSeries(_multiplied(rubber, np.full(rubber.moduli.size + 1, f)), 0.0)
    from scipy.optimize import nnls  # half a second, which reading a case does not pay

    at = np.sort(at)
    slowest_first = np.argsort(rubber.relaxation_times)[::-1]
    moduli = rubber.moduli[slowest_first]
    phase = np.outer(at, rubber.relaxation_times[slowest_first])
    whole = rubber.complex_modulus(at)
    nothing = np.zeros(at.size)
    # The share that each modulus, E_inf and then the slowest first, has in f E' and in g E''.
    real = np.column_stack([nothing + rubber.equilibrium_modulus, storage_shape(phase) * moduli])
    imaginary = np.column_stack([nothing, loss_shape(phase) * moduli])
    rows = np.vstack([real / (f * whole.real)[:, None], imaginary / (g * whole.imag)[:, None]])
    count = rows.shape[1]
    weight = np.tile(np.sqrt(at[0] / at), 2)
    steps = _SMOOTHING * np.diff(np.eye(count), axis=0)
    system = np.vstack([weight[:, None] * rows, steps, KEEPING * np.eye(count)])
    right = np.concatenate([weight, np.zeros(count - 1), np.full(count, KEEPING * f)])
    least = np.zeros(count)
    least[0] = _LEAST * f
    multiplier = nnls(system, right - system @ least)[0] + least
    misfit = np.abs(rows @ multiplier - 1.0).reshape(2, -1)[:, 0]
    in_order = np.empty(count)
    in_order[0], in_order[1 + slowest_first] = multiplier[0], multiplier[1:]
    return SoftenedSeries(_multiplied(rubber, in_order), float(misfit.max()))


def _multiplied(rubber: Rubber, multiplier: Array) -> Rubber:
    kept = multiplier[1:] > 0.0
    return replace(
        rubber,
        equilibrium_modulus=rubber.equilibrium_modulus * float(multiplier[0]),
        moduli=(rubber.moduli * multiplier[1:])[kept],
        relaxation_times=rubber.relaxation_times[kept],
        admissible=None,
    )


class Kraus(Checked, SofteningLaw):
    """Kraus' law of the Payne effect, in the strain of the sweep it was fitted to.

    Raises `InputError` if a value is out of its range.
    """

    kind: ClassVar[str] = "kraus"

    storage_ratio: float = checked(checks.fraction)
    """Storage modulus at large strain over that at small, G'_inf / G'_0 [-]."""
    loss_ratio: float = checked(checks.fraction)
    """Loss modulus at large strain over its maximum, G''_inf / G''_m [-]."""
    critical_strain: float = checked(checks.positive, quantity="strain")
    """Strain s_c at which half of the storage modulus that breaks is broken [-]."""
    measured_at: float = checked(checks.positive, quantity="strain")
    """Strain of the DMA measurement, where nothing is softened [-]."""
    deformation: Deformation | None = checked(checks.one_of, choices=DEFORMATIONS, default=None)
    """Kind of both strains; None if not stated: half-way between tension and shear."""
    exponent: float = checked(checks.positive, default=0.5)
    """Exponent m of the law [-]."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-], at any temperature."""
        amplitude = in_deformation(strain, self.deformation)
        softer = self._moduli(np.maximum(amplitude, self.measured_at))
        measured = self._moduli(np.full(amplitude.shape, self.measured_at))
        storage, loss = (soft / hard for soft, hard in zip(softer, measured, strict=True))
        return SofteningFactors(storage, loss, np.zeros(amplitude.shape, dtype=bool))

    def _moduli(self, strain: Array) -> tuple[Array, Array]:
        """Return G'/G'_0 and G''/G''_m [-]."""
        power = (strain / self.critical_strain) ** self.exponent
        intact = 1.0 / (1.0 + (strain / self.critical_strain) ** (2.0 * self.exponent))
        peak = 2.0 * power / (1.0 + power**2)
        storage = self.storage_ratio + (1.0 - self.storage_ratio) * intact
        loss = self.loss_ratio + (1.0 - self.loss_ratio) * peak
        return np.asarray(storage), np.asarray(loss)


def in_deformation(strain: ArrayLike, deformation: Deformation | None) -> Array:
    """Return uniaxial strain amplitudes as those of a deformation with the same energy [-].

    Half-way between tension and shear, the geometric mean of both, for None.
    """
    return np.asarray(np.asarray(strain, dtype=float) * _OF_UNIAXIAL[deformation])


def rows_of_sweeps(name: str, values: Any) -> tuple[tuple[float, ...], ...]:
    """Return values above zero of each sweep; raise `InputError` if there is no sweep."""
    try:
        rows = list(values)
    except TypeError:
        rows = []
    if not rows:
        raise InputError(f"{name} must hold at least one sweep; got {checks.short_repr(values)}")
    return tuple(tuple(checks.positive_vector(name, row).tolist()) for row in rows)


class SofteningTable(Checked, SofteningLaw):
    """Moduli of strain sweeps, interpolated in the logarithms of strain and modulus.

    Beyond the largest strain the last moduli are held and flagged; between two temperatures the
    factors are interpolated linearly, beyond them those of the nearest are held and flagged. Raises
    `InputError` if a value cannot be used, lengths differ, or `measured_at` lies outside a sweep.
    """

    kind: ClassVar[str] = "table"

    strain: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    """Amplitudes of each sweep [-], rising."""
    storage: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    loss: Sequence[Sequence[float]] = checked(rows_of_sweeps)
    """Moduli of each sweep, in any unit: only ratios count."""
    measured_at: float | None = checked(checks.positive, default=None)
    """Strain amplitude at which the master curve was measured [-]: both factors are one there. None
    if not stated: 0.1 %, or the end of a sweep that does not reach it."""
    deformation: Deformation | None = checked(checks.one_of, choices=DEFORMATIONS, default=None)
    """Kind of the strains; None if not stated: half-way between tension and shear."""
    temperature: Sequence[float] | None = checked(checks.positive_vector, unit="K", default=None)
    """Of each sweep [K], rising; needed if there are several."""
    amplitude_assumed: bool = checked(checks.flag, default=False)
    """Whether the amplitudes are single by assumption only."""

    def __post_init__(self) -> None:
        super().__post_init__()
        lengths = [list(map(len, sweeps)) for sweeps in (self.strain, self.storage, self.loss)]
        if lengths[0] != lengths[1] or lengths[0] != lengths[2]:
            raise InputError(
                "strain, storage and loss must have equally many values in every sweep; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        for strains in self.strain:
            if len(strains) < 2 or not (np.diff(strains) > 0.0).all():
                raise InputError(
                    "strain must rise over at least 2 values; "
                    f"got {checks.short_repr(list(strains))}"
                )
            if not strains[0] <= (self.measured_at or strains[0]) <= strains[-1]:
                raise InputError(
                    f"measured_at must lie within the strains of every sweep, {strains[0]:g} to "
                    f"{strains[-1]:g}; got {self.measured_at:g}"
                )
        count = len(self.strain)
        if self.temperature is not None:
            self._set(temperature=tuple(map(float, self.temperature)))
        kelvin = self.temperature
        if kelvin is None and count == 1:
            return
        if kelvin is None or len(kelvin) != count or not (np.diff(kelvin) > 0.0).all():
            raise InputError(
                f"temperature must be one for each of the {count} sweeps, rising; "
                f"got {checks.short_repr(kelvin)}"
            )

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Raises `InputError` if sweeps at several temperatures are asked without one.
        """
        amplitude = in_deformation(strain, self.deformation)
        weights, beyond = np.ones(1), False  # of the sweeps
        if self.temperature is not None and temperature is not None:
            kelvin = np.array(self.temperature)
            weights = np.array([np.interp(temperature, kelvin, row) for row in np.eye(kelvin.size)])
            beyond = not kelvin[0] <= temperature <= kelvin[-1]
        elif len(self.strain) > 1:
            raise InputError(
                "temperature must be given for softening measured at several temperatures"
            )
        sweeps = np.flatnonzero(weights).tolist()
        factors = sum(
            weights[at] * self.of_sweep(at, np.maximum(amplitude, self.reference(at)))
            for at in sweeps
        )
        outside = (amplitude > max(self.strain[at][-1] for at in sweeps)) | beyond
        return SofteningFactors(factors[0, ...], factors[1, ...], outside)

    def reference(self, sweep: int) -> float:
        """Return the strain at which the factors of a sweep are one [-]."""
        first, *_, last = self.strain[sweep]
        return min(max(self.measured_at or USUAL_STRAIN, first), last)

    def of_sweep(self, sweep: int, amplitude: ArrayLike) -> Array:
        """Return moduli of a sweep over those at its `reference`, shape (2, ...), E' and E''.

        `amplitude` [-] is of the deformation of the sweep.
        """
        strains = np.log(self.strain[sweep])
        moduli = (np.log(values[sweep]) for values in (self.storage, self.loss))
        at, origin = np.log(np.asarray(amplitude)), np.log(self.reference(sweep))
        logs = [np.interp(at, strains, y) - np.interp(origin, strains, y) for y in moduli]
        return np.asarray(np.exp(logs))


def softening_of_sweeps(
    sweeps: Sequence[StrainSweep], *, measured_at: float | None = None
) -> SofteningTable:
    """Return the softening of strain sweeps; `measured_at` is that of the master curve [-].

    Of several frequencies at one temperature the highest is used: nearly all waves of a contact
    excite the rubber faster than a sweep does. Raises `InputError` if sweeps differ in deformation,
    or several are at one temperature and frequency.
    """
    sweeps = checks.instances("sweeps", sweeps, StrainSweep)
    kinds = sorted({sweep.deformation or "not stated" for sweep in sweeps})
    if len(kinds) != 1:
        raise InputError(
            f"sweeps must be all in tension or all in shear; got {' and '.join(kinds)}"
        )
    colder = neighbours_of(np.array([s.temperature or 0.0 for s in sweeps]), TEMPERATURE_TOLERANCE)
    hertz = np.array([sweep.frequency or 0.0 for sweep in sweeps])
    fastest = np.array([hertz[colder == at].max() for at in colder]) / (1.0 + ONE_FREQUENCY)
    chosen = [sweep for sweep, fast in zip(sweeps, hertz >= fastest, strict=True) if fast]
    kelvins = [sweep.temperature for sweep in chosen]
    if len(chosen) > 1 and (None in kelvins or len(set(kelvins)) < len(kelvins)):
        raise InputError(
            "several strain sweeps must each be at a temperature or a frequency of its own; got "
            + "; ".join(sweep.condition for sweep in sweeps)
        )
    ordered = sorted(chosen, key=lambda sweep: sweep.temperature or 0.0)
    strain, storage, loss = (
        [getattr(s, name).tolist() for s in ordered] for name in ("strain", "storage", "loss")
    )
    temperatures = sorted(kelvin for kelvin in kelvins if kelvin is not None) or None
    assumed = any(sweep.amplitude_assumed for sweep in chosen)
    return SofteningTable(
        strain, storage, loss, measured_at, sweeps[0].deformation, temperatures, assumed
    )


def assumptions(law: SofteningLaw) -> Iterator[str]:
    """Yield what is assumed about a law because nothing states it, as sentences of a result."""
    if getattr(law, "deformation", "tension") is None:
        yield "strain taken half-way between tension and shear, a factor of 1.32 from either"
    if isinstance(law, SofteningTable) and law.measured_at is None:
        ends = sorted({law.reference(at) for at in range(len(law.strain))})
        yield f"moduli taken as measured at a strain of {' to '.join(f'{e:.2%}' for e in ends)}"
    if isinstance(law, SofteningTable) and law.amplitude_assumed:
        yield "strain amplitudes taken as single, from zero to peak"


STRAIN = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.236)
"""Single amplitudes [-]; at the first the modulus is that of the master curve."""
SWEPT = (273.15, 323.15)
"""Ends of the mean, which is linear in the temperature between them [K]."""
# Mean factors at both temperatures, and the standard deviations of their logarithms.
MEAN_STORAGE = (
    (1.000, 0.916, 0.784, 0.680, 0.565, 0.398, 0.278, 0.169),
    (1.000, 0.960, 0.883, 0.814, 0.729, 0.577, 0.434, 0.272),
)
MEAN_LOSS = (
    (1.000, 1.019, 0.997, 0.911, 0.774, 0.574, 0.414, 0.205),
    (1.000, 1.023, 1.015, 0.962, 0.872, 0.727, 0.590, 0.348),
)
STORAGE_SCATTER = (0.000, 0.032, 0.073, 0.113, 0.158, 0.226, 0.265, 0.334)
LOSS_SCATTER = (0.000, 0.012, 0.040, 0.092, 0.174, 0.307, 0.390, 0.532)


class TypicalTread(Checked, SofteningLaw):
    """Mean softening of four treads with published strain sweeps, or a deviation from it.

    Beyond the largest strain and the temperatures of the sweeps their ends are held and flagged.
    """

    kind: ClassVar[str] = "typical_tread"

    deviation: float = checked(checks.number, default=0.0)
    """Standard deviations from the mean of treads [-]; above zero the rubber is harder."""
    deformation: Deformation | None = checked(checks.one_of, choices=DEFORMATIONS, default=None)
    """Kind of the strains; None: not stated, as by the publisher of the sweeps."""

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Without a temperature that of the middle of the sweeps, 25 C, is taken.
        """
        kelvin = sum(SWEPT) / len(SWEPT) if temperature is None else temperature
        return _table(self.deviation, self.deformation).factors(strain, kelvin)


@lru_cache(maxsize=16)
def _table(deviation: float, deformation: Deformation | None) -> SofteningTable:
    storage, loss = (
        (np.array(mean) * np.exp(deviation * np.array(scatter))).tolist()
        for mean, scatter in ((MEAN_STORAGE, STORAGE_SCATTER), (MEAN_LOSS, LOSS_SCATTER))
    )
    return SofteningTable([STRAIN] * 2, storage, loss, STRAIN[0], deformation, SWEPT)


TYPICAL_TREAD = TypicalTread()
"""The mean."""
HARDER_TREAD, SOFTER_TREAD = TypicalTread(1.0), TypicalTread(-1.0)
"""One standard deviation from it."""
