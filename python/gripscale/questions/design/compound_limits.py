"""Admissible changes of a compound: its Prony moduli within bounds that keep it a rubber.

The unknowns are r = E_i/E_i,0, each modulus of the Prony series (E_inf first) over that of today.
All limits are linear in r but that on a loss compliance, whose tangent is taken: the admissible
changes are a convex polytope (docs/derivations.md). Rolling resistance is tan(delta) and loss
compliance over a band of frequencies and temperatures; the worst counts (docs/compound-design.md).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from gripscale.core import Array, Checked, InputError, Mask, RubberWarning, checked, checks
from gripscale.core.units import ZERO_CELSIUS, celsius
from gripscale.rubber import Rubber
from gripscale.rubber.admissible import loss_shape, storage_shape
from gripscale.rubber.shift import EDGE

LIMITED_QUANTITIES = ("storage_modulus", "loss_factor", "loss_compliance")
_SYMBOLS = dict(zip(LIMITED_QUANTITIES, ("E'", "tan δ", "J''"), strict=True))
MEASURED_AT = "the temperature measured"  # where a rubber has no temperature shift
HANDLING = ZERO_CELSIUS + 20.0  # temperature of the storage modulus that is kept by default [K]
# Distance from a limit, relative to today's moduli, within which it counts as reached.
_AT_LIMIT = 1e-4


class PointLimit(Checked):
    """Range of a modulus at one frequency and temperature, relative to today's compound.

    Parameters
    ----------
    quantity : "storage_modulus", "loss_factor" or "loss_compliance"
        E', tan(delta) = E''/E' or J'' = E''/|E*|^2.
    low, high : float
        Range over today's value [-]; `low` of a compliance is zero, `high` may be infinite.
    frequency : float
        Frequency [Hz].
    temperature : float, optional
        Temperature [K]; by default that of the measurement.
    wanted : float, optional
        Temperature in whose place `temperature` stands because the shift ends there [K].
    """

    quantity: str = checked(checks.one_of, choices=LIMITED_QUANTITIES)
    low: float = checked(checks.not_negative)
    high: float = checked(checks.positive, infinite=True)
    frequency: float = checked(checks.positive, unit="Hz", default=10.0)
    temperature: float | None = checked(checks.positive, unit="K", default=None)
    wanted: float | None = checked(checks.positive, unit="K", default=None)

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self.low < self.high:
            raise InputError(f"low must be below high; got {self.low:g} and {self.high:g}")
        if self.quantity == "loss_compliance" and self.low > 0.0:
            raise InputError(f"low of a loss_compliance must be zero; got {self.low:g}")

    @property
    def condition(self) -> str:
        """Frequency and temperature in words."""
        where = MEASURED_AT if self.temperature is None else celsius(self.temperature)
        if self.wanted is not None:
            where += f" (the shift ends there, not at {celsius(self.wanted)})"
        return f"{self.frequency:g} Hz and {where}"

    def within_shift(self, rubber: Rubber) -> PointLimit:
        """Return the limit at the nearest temperature to which the rubber can be shifted."""
        kelvin = self.temperature
        if kelvin is None or rubber.shift is None:
            require_shift(rubber, kelvin, f"the limit on the {self.quantity}")
            return self
        low, high = rubber.shift.limits
        reached = min(max(kelvin, low), high)
        if abs(reached - kelvin) <= EDGE:
            return self
        return replace(self, temperature=reached, wanted=kelvin)

    def value(self, rubber: Rubber) -> float:
        """Return E' [Pa], tan(delta) [-] or J'' [1/Pa] of a rubber."""
        body = rubber_at(rubber, self.temperature)
        modulus = complex(body.complex_modulus(2.0 * math.pi * self.frequency))
        if self.quantity == "storage_modulus":
            return modulus.real
        stiffness = modulus.real if self.quantity == "loss_factor" else abs(modulus) ** 2
        return modulus.imag / stiffness

    def ratio(self, rubber: Rubber, today: Rubber) -> float:
        """Return the value of a rubber over that of today's [-]."""
        return self.value(rubber) / self.value(today)

    def __str__(self) -> str:
        symbol = _SYMBOLS[self.quantity]
        return f"{symbol} at {self.condition}, {self.low:g} to {self.high:g} times today's"


def _factor(name: str, value: float) -> float:
    factor = checks.positive(name, value)
    if not 1.0 < factor <= 1e3:
        raise InputError(f"{name} must be above 1, at most 1000; got {factor:g}")
    return factor


class CompoundLimits(Checked):
    """How far a compound may be changed.

    Parameters
    ----------
    largest_factor : float
        Largest factor, up or down, on each modulus of the Prony series.
    factor_per_decade : float
        Largest ratio of the factors of neighbouring relaxation times a decade apart.
    points : sequence of PointLimit
        Limits on E' and tan(delta). By default E' at 10 Hz and 20 C, or at the temperature measured
        where the rubber has no temperature shift, stays within 10 %.
    """

    largest_factor: float = checked(_factor, default=2.0)
    factor_per_decade: float = checked(_factor, default=2.0)
    points: tuple[PointLimit, ...] | None = None


def require_shift(rubber: Rubber, kelvin: float | None, what: str) -> None:
    """Raise `InputError` if the rubber cannot be had at a temperature [K] for `what`."""
    if kelvin is not None and rubber.shift is not None:
        low, high = rubber.shift.limits
        if not low - EDGE <= kelvin <= high + EDGE:
            raise InputError(rubber.shift.beyond_limits(f"the temperature of {what}", kelvin))
    elif kelvin is not None and not abs((rubber.reference_temperature or 0.0) - kelvin) <= 0.5:
        raise InputError(
            f"{what} at {kelvin - ZERO_CELSIUS:.4g} C needs a rubber with a temperature shift; got "
            f"none with {rubber.name or 'this rubber'}: state shift in [rubber], or take the "
            "temperature of the measurement"
        )


def rubber_at(rubber: Rubber, kelvin: float | None) -> Rubber:
    """Return the rubber at a temperature [K], None for that of the measurement.

    Not for threads: what is to be warned of a rubber was said of today's, and is held back here.
    """
    if kelvin is None or rubber.shift is None:
        return rubber
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)
        return rubber.at(kelvin)


def changed(rubber: Rubber, ratio: Array, name: str = "") -> Rubber:
    """Return the rubber with its moduli times `ratio` [-], shape (terms + 1,), E_inf first."""
    with warnings.catch_warnings():  # its glass is no stiffer than that of the rubber
        warnings.simplefilter("ignore", RubberWarning)
        return replace(
            rubber,
            equilibrium_modulus=rubber.equilibrium_modulus * float(ratio[0]),
            moduli=rubber.moduli * ratio[1:],
            admissible=None,  # that of today's series does not hold for another one
            name=name or rubber.name,
        )


def all_moduli(rubber: Rubber) -> Array:
    """Return the moduli of the Prony series [Pa], E_inf first."""
    return np.concatenate([[rubber.equilibrium_modulus], rubber.moduli])


def modulus_parts(rubber: Rubber, omega: Array) -> tuple[Array, Array]:
    """Return what each modulus, E_inf first, adds to E' and E'' [Pa], (frequency, terms + 1)."""
    phase = np.multiply.outer(np.asarray(omega, dtype=float), rubber.relaxation_times)
    relaxed = np.full((*phase.shape[:-1], 1), rubber.equilibrium_modulus)
    storage = np.concatenate([relaxed, storage_shape(phase) * rubber.moduli], axis=-1)
    loss = np.concatenate([0.0 * relaxed, loss_shape(phase) * rubber.moduli], axis=-1)
    return storage, loss


@dataclass(frozen=True)
class AdmissibleChanges:
    """The polytope of admissible changes of a rubber: rows r <= 1 and bounds on each modulus."""

    rubber: Rubber = field(repr=False)
    limits: CompoundLimits
    points: tuple[PointLimit, ...] = ()  # ranges of the moduli
    rolling: tuple[PointLimit, ...] = ()  # limits of rolling resistance

    @classmethod
    def of(
        cls, rubber: Rubber, limits: CompoundLimits, rolling: Sequence[PointLimit] = ()
    ) -> AdmissibleChanges:
        """Return the changes within `limits` and those of rolling resistance."""
        kelvin = None if rubber.shift is None else HANDLING
        stiff = PointLimit("storage_modulus", 0.9, 1.1, temperature=kelvin)
        points = (stiff,) if limits.points is None else limits.points
        reached = tuple(point.within_shift(rubber) for point in points)
        return cls(rubber, limits, reached, tuple(rolling))

    @property
    def bounds(self) -> tuple[float, float]:
        """Least and largest ratio of each modulus [-]."""
        return 1.0 / self.limits.largest_factor, self.limits.largest_factor

    @cached_property
    def neighbours(self) -> tuple[NDArray[np.intp], Array]:
        """Indices of moduli next to one another, shape (pairs, 2), and their distance [decades].

        E_inf is a decade beyond the slowest relaxation.
        """
        order = np.argsort(self.rubber.relaxation_times)
        decades = np.diff(np.log10(self.rubber.relaxation_times[order]))
        pairs = np.column_stack([1 + order, np.append(1 + order[1:], 0)])
        return pairs, np.append(decades, 1.0)

    @cached_property
    def smooth_rows(self) -> Array:
        """Rows whose product with r is at most zero: neighbours change alike."""
        pairs, distance = self.neighbours
        first, second = np.eye(1 + self.rubber.moduli.size)[pairs.T]
        steepest = self.limits.factor_per_decade ** distance[:, None]
        rows = np.stack([first - steepest * second, second - steepest * first], axis=1)
        return rows.reshape(-1, rows.shape[-1])

    def point_rows(self, point: PointLimit) -> list[tuple[Array, float]]:
        """Return rows whose product with r is at most a number, for one limit of the moduli."""
        body = rubber_at(self.rubber, point.temperature)
        storage, loss = modulus_parts(body, np.array(2.0 * math.pi * point.frequency))
        storage, loss = storage / storage.sum(), loss / storage.sum()
        today = float(loss.sum())
        if point.quantity == "storage_modulus":
            low, high = (-storage, -point.low), (storage, point.high)
        elif point.quantity == "loss_factor":
            low = point.low * today * storage - loss, 0.0
            high = loss - point.high * today * storage, 0.0
        elif math.isfinite(point.high):
            angle = math.atan(point.high * today)
            least = math.sin(angle) ** 2 * (1.0 + today**2) / (point.high * today)
            return [(math.cos(2.0 * angle) * loss - math.sin(2.0 * angle) * storage, -least)]
        else:
            return []
        return [low, high] if math.isfinite(point.high) else [low]

    @cached_property
    def rows(self) -> tuple[Array, Array]:
        """Rows and what their product with r must not exceed: all limits but the bounds."""
        parts = [(row, 0.0) for row in self.smooth_rows]
        for point in (*self.points, *self.rolling):
            parts += self.point_rows(point)
        parts.append((all_moduli(self.rubber) / self.rubber.glassy_modulus, 1.0))
        matrix, most = zip(*parts, strict=True)
        return np.array(matrix), np.array(most)

    def violation(self, ratio: Array) -> float:
        """Return by how much the worst limit is exceeded, relative to today; zero if none is."""
        matrix, most = self.rows
        low, high = self.bounds
        excess = [(matrix @ ratio - most).max(), (low - ratio).max(), (ratio - high).max()]
        return max(0.0, *map(float, excess))

    @property
    def possible(self) -> bool:
        """Whether any change is admissible."""
        return self.best(np.zeros(1 + self.rubber.moduli.size)) is not None

    def best(self, gradient: Array) -> Array | None:
        """Return the admissible r with the largest gradient . r, None if nothing is admissible."""
        from scipy.optimize import linprog

        matrix, most = self.rows
        solved = linprog(-gradient, A_ub=matrix, b_ub=most, bounds=[self.bounds], method="highs")
        return np.asarray(solved.x) if solved.success else None

    def at_bound(self, ratio: Array) -> Mask:
        """Return which moduli are at a bound or as far from a neighbour as they may be."""
        low, high = self.bounds
        reached = (ratio - low < _AT_LIMIT) | (high - ratio < _AT_LIMIT)
        tight = (self.smooth_rows @ ratio > -_AT_LIMIT).reshape(-1, 2).any(axis=1)
        reached[self.neighbours[0][tight].reshape(-1)] = True
        return np.asarray(reached)


# About one turn of a car's wheel at motorway speed, and its harmonics [Hz].
FREQUENCIES = (10.0, 50.0)
# Of a rolling tread, the usual one of the laboratory first [K].
TEMPERATURES = tuple(ZERO_CELSIUS + degrees for degrees in (60.0, 40.0, 50.0, 70.0))


def rolling_band(rubber: Rubber) -> tuple[PointLimit, ...]:
    """Return what stands for rolling resistance, at most today's; tan(delta) at 10 Hz first.

    A rubber without a temperature shift has the frequencies alone; where its shift ends, the
    nearest temperature stands for those beyond.
    """
    temperatures = (None,) if rubber.shift is None else TEMPERATURES
    losses = ("loss_factor", "loss_compliance")
    points: dict[object, PointLimit] = {}
    for kelvin, frequency, quantity in product(temperatures, FREQUENCIES, losses):
        point = PointLimit(quantity, 0.0, 1.0, frequency, kelvin).within_shift(rubber)
        points.setdefault((quantity, frequency, point.temperature), point)
    return tuple(points.values())


def rolling_ratio(band: Sequence[PointLimit], rubber: Rubber, today: Rubber) -> float:
    """Return the rolling resistance of a compound over today's [-]: the worst of the band."""
    return max(point.ratio(rubber, today) for point in band)


def band_in_words(band: Sequence[PointLimit]) -> str:
    """Return the conditions of a band, such as "10 to 50 Hz and 40 to 70 °C"."""
    kelvins = sorted(point.temperature for point in band if point.temperature is not None)
    where = celsius(kelvins[-1]) if kelvins else MEASURED_AT
    if len(set(kelvins)) > 1:
        where = f"{kelvins[0] - ZERO_CELSIUS:g} to {where}"
    beyond = " (the shift ends there)" if any(point.wanted for point in band) else ""
    return f"{FREQUENCIES[0]:g} to {FREQUENCIES[-1]:g} Hz and {where}{beyond}"
