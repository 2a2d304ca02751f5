"""What every law of strain softening looks like.

    E'(w) -> f(e) E'(w),      E''(w) -> g(e) E''(w)

with e the amplitude of a uniaxial strain. A shear strain of amplitude s stores as much energy in an
incompressible solid as e = s / sqrt(3): G s^2 = E e^2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.rubber.material import Rubber, loss_shape, storage_shape
from gripscale.rubber.strain_sweep import StrainSweep

Array = NDArray[np.float64]

Deformation = Literal["tension", "shear"]
UNIAXIAL_OF_SHEAR = 1.0 / np.sqrt(3.0)


@dataclass(frozen=True)
class SofteningFactors:
    """What is left of both moduli at some strains, arrays of one shape."""

    storage: Array
    """f(e), of E' [-]."""
    loss: Array
    """g(e), of E'' [-]."""
    outside: NDArray[np.bool_]
    """Where the strain (or the temperature) lies beyond what was measured, the ends held."""


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


# The softened rubber as a series: what the finite-strain block can be given.
#
# The block needs E_inf and E_i, and with f and g apart no series has f E' and g E'' at all
# frequencies. One that has them where a wave excites the rubber does: multipliers x_i >= 0 of all
# moduli minimise
#
#     sum_w w_1/w ((E'_x/(f E') - 1)^2 + (E''_x/(g E'') - 1)^2)
#         + smoothing^2 sum_i (x_i+1 - x_i)^2 + keeping^2 sum_i (x_i - f)^2
#
# over the frequencies w of the wave, w_1 its lowest. Slow terms, which carry E' and lose nothing
# there, follow f; E_inf keeps at least a third of f of it. What the series misses is stated.

SMOOTHING = 0.03
KEEPING = 0.02
LEAST = 1.0 / 3.0
"""Smallest multiplier of E_inf over f."""


@dataclass(frozen=True)
class SoftenedSeries:
    """A rubber with both moduli softened where it is excited."""

    rubber: Rubber
    misfit: float
    """Largest relative difference from f E' and g E'' at the lowest frequency asked for [-]."""
    misfit_of_all: float
    """The same at all frequencies asked for [-]."""


def softened(rubber: Rubber, storage: float, loss: float, omega: ArrayLike) -> SoftenedSeries:
    """Return `rubber` with E' times `storage` and E'' times `loss` at frequencies `omega`.

    Parameters
    ----------
    rubber : Rubber
        As measured, at small strain.
    storage, loss : float
        f and g [-], above zero.
    omega : array_like, shape (frequencies,)
        Where the factors must hold [rad/s]; none: all moduli times f (relaxed rubber).

    Raises
    ------
    InputError
        If a factor is not above zero or a frequency is not.
    """
    f, g = checks.positive("storage", storage), checks.positive("loss", loss)
    at = checks.positive_vector("omega", omega, unit="rad/s") if np.size(omega) else np.empty(0)
    if f == g or at.size == 0 or rubber.moduli.size == 0:
        return SoftenedSeries(_multiplied(rubber, np.full(rubber.moduli.size + 1, f)), 0.0, 0.0)
    order = np.argsort(rubber.relaxation_times)[::-1]
    rows = _rows(rubber, order, np.sort(at), f, g)
    multiplier = _multipliers(rows, np.sort(at), f)
    missed = np.abs(rows @ multiplier - 1.0).reshape(2, -1)
    own = np.empty(order.size + 1)
    own[0], own[1 + order] = multiplier[0], multiplier[1:]
    return SoftenedSeries(_multiplied(rubber, own), float(missed[:, 0].max()), float(missed.max()))


def _multipliers(rows: Array, omega: Array, f: float) -> Array:
    """Return x, of E_inf and then of the slowest term first."""
    from scipy.optimize import nnls  # half a second, which reading a case does not pay

    count = rows.shape[1]
    weight = np.tile(np.sqrt(omega[0] / omega), 2)
    steps = SMOOTHING * np.diff(np.eye(count), axis=0)
    system = np.vstack([weight[:, None] * rows, steps, KEEPING * np.eye(count)])
    right = np.concatenate([weight, np.zeros(count - 1), np.full(count, KEEPING * f)])
    least = np.zeros(count)
    least[0] = LEAST * f
    return np.asarray(nnls(system, right - system @ least)[0] + least)


def _rows(rubber: Rubber, order: NDArray[np.intp], omega: Array, f: float, g: float) -> Array:
    """Return the share each modulus, E_inf and then the slowest first, has in f E' and g E''."""
    modulus = rubber.complex_modulus(omega)
    phase = np.outer(omega, rubber.relaxation_times[order])
    storage = np.column_stack(
        [
            np.full(omega.size, rubber.equilibrium_modulus),
            storage_shape(phase) * rubber.moduli[order],
        ]
    )
    loss = np.column_stack([np.zeros(omega.size), loss_shape(phase) * rubber.moduli[order]])
    return np.vstack([storage / (f * modulus.real)[:, None], loss / (g * modulus.imag)[:, None]])


def _multiplied(rubber: Rubber, multiplier: Array) -> Rubber:
    kept = multiplier[1:] > 0.0
    return replace(
        rubber,
        equilibrium_modulus=rubber.equilibrium_modulus * float(multiplier[0]),
        moduli=(rubber.moduli * multiplier[1:])[kept],
        relaxation_times=rubber.relaxation_times[kept],
        admissible=None,
    )


# Kraus' law of the Payne effect.
#
#     G'(s)  = G'_inf + (G'_0 - G'_inf) / (1 + (s/s_c)^(2m))
#     G''(s) = G''_inf + 2 (G''_m - G''_inf) (s/s_c)^m / (1 + (s/s_c)^(2m))
#
# Source: G. Kraus, J. Appl. Polym. Sci.: Appl. Polym. Symp. 39 (1984) 75. The exponent m is about
# 0.5 for carbon black.


@dataclass(frozen=True)
class Kraus:
    """Kraus' law, its parameters as ratios, in the strain of the sweep they were fitted to.

    Parameters
    ----------
    storage_ratio : float
        G'_inf / G'_0 [-], above zero, at most one.
    loss_ratio : float
        G''_inf / G''_m [-], above zero, at most one.
    critical_strain : float
        s_c, where half of the storage modulus that breaks is broken [-].
    measured_at : float
        Strain amplitude at which the master curve was measured [-]: both factors are one there.
    exponent : float
        m [-].
    deformation : "tension" or "shear"
        Kind of both strains.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    kind: ClassVar[str] = "kraus"

    storage_ratio: float
    loss_ratio: float
    critical_strain: float
    measured_at: float
    deformation: Deformation
    exponent: float = 0.5

    def __post_init__(self) -> None:
        for name in ("storage_ratio", "loss_ratio", "critical_strain", "measured_at", "exponent"):
            object.__setattr__(self, name, checks.positive(name, getattr(self, name)))
        for name in ("storage_ratio", "loss_ratio"):
            if getattr(self, name) > 1.0:
                raise InputError(f"{name} must not exceed 1; got {getattr(self, name):g}")
        checks.one_of("deformation", self.deformation, ["tension", "shear"])

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-], at any temperature."""
        own = np.asarray(strain, dtype=float)
        if self.deformation == "shear":
            own = own / UNIAXIAL_OF_SHEAR
        own = np.maximum(own, self.measured_at)
        at = np.full(own.shape, self.measured_at)
        return SofteningFactors(
            storage=self._storage(own) / self._storage(at),
            loss=self._loss(own) / self._loss(at),
            outside=np.zeros(own.shape, dtype=bool),
        )

    def to_dict(self) -> dict[str, Any]:
        """Return kind and parameters."""
        return {"kind": self.kind, **self.__dict__}

    def _storage(self, strain: Array) -> Array:
        left = 1.0 / (1.0 + (strain / self.critical_strain) ** (2.0 * self.exponent))
        return np.asarray(self.storage_ratio + (1.0 - self.storage_ratio) * left)

    def _loss(self, strain: Array) -> Array:
        power = (strain / self.critical_strain) ** self.exponent
        peak = 2.0 * power / (1.0 + power**2)
        return np.asarray(self.loss_ratio + (1.0 - self.loss_ratio) * peak)


# Strain softening as measured: a strain sweep, or one for each of several temperatures.


@dataclass(frozen=True)
class SofteningTable:
    """Moduli of strain sweeps, interpolated in the logarithms of strain and modulus.

    Beyond the largest strain the last moduli are held and flagged; between two temperatures the
    factors are interpolated linearly, beyond them those of the nearest are held and flagged.

    Parameters
    ----------
    strain : sequence of sequences of floats
        Amplitudes of each sweep [-], rising.
    storage, loss : sequence of sequences of floats
        Moduli of each sweep, in any unit: only ratios count.
    measured_at : float
        Strain amplitude at which the master curve was measured [-]: both factors are one there.
    deformation : "tension" or "shear"
        Kind of the strains.
    temperature : sequence of floats, optional
        Of each sweep [K], rising; needed if there are several.

    Raises
    ------
    InputError
        If a value cannot be used, lengths differ, or `measured_at` lies outside a sweep.
    """

    kind: ClassVar[str] = "table"

    strain: Sequence[Sequence[float]]
    storage: Sequence[Sequence[float]]
    loss: Sequence[Sequence[float]]
    measured_at: float
    deformation: Deformation
    temperature: Sequence[float] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "measured_at", checks.positive("measured_at", self.measured_at))
        checks.one_of("deformation", self.deformation, ["tension", "shear"])
        for name in ("strain", "storage", "loss"):
            object.__setattr__(self, name, _sweeps(name, getattr(self, name)))
        self._check_sweeps()
        if self.temperature is not None:
            kelvin = checks.positive_vector("temperature", self.temperature, unit="K")
            object.__setattr__(self, "temperature", tuple(kelvin.tolist()))
        self._check_temperatures()

    def factors(self, strain: ArrayLike, temperature: float | None = None) -> SofteningFactors:
        """Return f and g at uniaxial strain amplitudes `strain` [-] and a temperature [K].

        Raises `InputError` if sweeps at several temperatures are asked without one.
        """
        amplitude = np.asarray(strain, dtype=float)
        if self.deformation == "shear":
            amplitude = amplitude / UNIAXIAL_OF_SHEAR
        share, beyond = self._place(temperature)
        used = [(float(w), n) for n, w in enumerate(share) if w > 0.0]
        out = [(w, *self._one(n, amplitude)) for w, n in used]
        return SofteningFactors(
            storage=np.asarray(sum(w * f for w, f, _ in out)),
            loss=np.asarray(sum(w * g for w, _, g in out)),
            outside=(amplitude > max(self.strain[n][-1] for _, n in used)) | beyond,
        )

    def to_dict(self) -> dict[str, Any]:
        """Return kind and numbers."""
        return {"kind": self.kind, **self.__dict__}

    def _one(self, number: int, strain: Array) -> tuple[Array, Array]:
        at = np.log(np.maximum(strain, self.measured_at))
        own = np.log(self.strain[number])

        def ratio(modulus: Sequence[float]) -> Array:
            logs = np.log(modulus)
            reference = np.interp(np.log(self.measured_at), own, logs)
            return np.asarray(np.exp(np.interp(at, own, logs) - reference))

        return ratio(self.storage[number]), ratio(self.loss[number])

    def _place(self, temperature: float | None) -> tuple[Array, bool]:
        """Return the weight of each sweep, and whether the temperature lies beyond them."""
        count = len(self.strain)
        if self.temperature is None or (count == 1 and temperature is None):
            return np.ones(1), False
        if temperature is None:
            raise InputError(
                "temperature must be given for softening measured at several temperatures"
            )
        own = np.array(self.temperature)
        beyond = not own[0] <= temperature <= own[-1]
        rows = np.eye(count)
        return np.array([np.interp(temperature, own, row) for row in rows]), beyond

    def _check_sweeps(self) -> None:
        lengths = [
            [len(one) for one in sweeps] for sweeps in (self.strain, self.storage, self.loss)
        ]
        if lengths[0] != lengths[1] or lengths[0] != lengths[2]:
            raise InputError(
                "strain, storage and loss must have equally many values in every sweep; "
                f"got {lengths[0]}, {lengths[1]} and {lengths[2]}"
            )
        for one in self.strain:
            if len(one) < 2 or not (np.diff(one) > 0.0).all():
                raise InputError(
                    f"strain must rise over at least 2 values; got {checks.short_repr(list(one))}"
                )
            if not one[0] <= self.measured_at <= one[-1]:
                raise InputError(
                    f"measured_at must lie within the strains of every sweep, {one[0]:g} to "
                    f"{one[-1]:g}; got {self.measured_at:g}"
                )

    def _check_temperatures(self) -> None:
        count, kelvin = len(self.strain), self.temperature
        if kelvin is None and count == 1:
            return
        if kelvin is None or len(kelvin) != count or not (np.diff(kelvin) > 0.0).all():
            raise InputError(
                f"temperature must be one for each of the {count} sweeps, rising; "
                f"got {checks.short_repr(kelvin)}"
            )


def _sweeps(name: str, values: Any) -> tuple[tuple[float, ...], ...]:
    try:
        rows = list(values)
    except TypeError:
        rows = []
    if not rows:
        raise InputError(f"{name} must hold at least one sweep; got {checks.short_repr(values)}")
    return tuple(tuple(checks.positive_vector(name, row).tolist()) for row in rows)


# Softening from measured strain sweeps.


def softening_of_sweeps(sweeps: Sequence[StrainSweep], *, measured_at: float) -> SofteningTable:
    """Return the softening that strain sweeps at one or several temperatures show.

    Parameters
    ----------
    sweeps : sequence of StrainSweep
        In any order; of several, each with another temperature.
    measured_at : float
        Strain amplitude at which the master curve was measured [-], in the deformation of the
        sweeps and within each of them.

    Raises
    ------
    InputError
        If sweeps are of different deformations, several are without or at one temperature, or
        `measured_at` lies outside a sweep.
    """
    sweeps = checks.instances("sweeps", sweeps, StrainSweep)
    kinds = sorted({sweep.deformation for sweep in sweeps})
    if len(kinds) != 1:
        told = " and ".join(kinds) or "none"
        raise InputError(f"sweeps must be at least one, all uniaxial or all shear; got {told}")
    known = [sweep.temperature for sweep in sweeps]
    if len(sweeps) > 1 and (None in known or len(set(known)) < len(known)):
        raise InputError(
            "several strain sweeps must each be at a temperature of its own; got "
            + ", ".join("none" if kelvin is None else f"{kelvin:g} K" for kelvin in known)
        )
    ordered = sorted(sweeps, key=lambda sweep: sweep.temperature or 0.0)
    deformation: Deformation = "shear" if kinds[0] == "shear" else "tension"
    return SofteningTable(
        strain=[sweep.strain.tolist() for sweep in ordered],
        storage=[sweep.storage.tolist() for sweep in ordered],
        loss=[sweep.loss.tolist() for sweep in ordered],
        measured_at=measured_at,
        deformation=deformation,
        temperature=None if None in known else [float(sweep.temperature or 0) for sweep in ordered],
    )


# Strain softening of filled rubber (the Payne effect): how E' and E'' fall with the strain.

SOFTENING_LAWS: dict[str, Any] = {law.kind: law for law in (Kraus, SofteningTable)}
"""Every law by its kind."""


def softening_from_dict(values: Mapping[str, Any]) -> SofteningLaw:
    """Return the law of `to_dict`.

    Raises `InputError` if the kind is unknown or a value cannot be used.
    """
    given = dict(values)
    kind = checks.one_of("kind", given.pop("kind", None), SOFTENING_LAWS)
    law: SofteningLaw = checks.from_mapping(SOFTENING_LAWS[kind], kind, given)
    return law
