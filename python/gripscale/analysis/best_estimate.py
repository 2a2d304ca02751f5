"""A best estimate: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic map/its lines)

and friction likewise. Each factor is a ratio of two models on the same surfaces, with its own
uncertainty; relative uncertainties of the independent factors add in squares (see `uncertain`). A
factor nobody has computed is named and counts as not included: it neither moves nor widens the
estimate.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from gripscale.analysis.ladder import DIRECT, Rung
from gripscale.conditions.conditions import Conditions
from gripscale.model import (
    ADHESIVE_FRICTION,
    NOT_TOLD,
    CutOffExponents,
    cut_off_exponents_of,
    extrapolation_of,
)
from gripscale.model import of_mean as exponents_of_mean
from gripscale.rubber.extrapolation import UNKNOWN, Extrapolation, of_sum

# Area and friction down to each wavelength, as the models tell it, on one scale of wavelengths.
#
# The chain adds a wave at a time, in steps. The direct contact splits its friction by octave
# (its area is that of another contact, without the shorter waves), the theories integrate: both are
# interpolated in the logarithm of the wavelength.

Array = NDArray[np.float64]

ROUNDING = 1e-6
"""Relative difference below which two wavelengths are the same."""


@dataclass(frozen=True, eq=False)
class Curve:
    """Contact fraction and friction down to each wavelength.

    Parameters
    ----------
    wavelength : array, shape (n,)
        Falling [m].
    contact_fraction, friction : array, shape (n,)
        Of the waves not shorter [-]; NaN where unknown.
    stepped : bool
        Whether each wavelength is one wave, and nothing lies between.
    """

    wavelength: Array = field(repr=False)
    contact_fraction: Array = field(repr=False)
    friction: Array = field(repr=False)
    stepped: bool

    def at(self, name: str, wavelength: Array) -> Array:
        """Return `contact_fraction` or `friction` down to each `wavelength` [m].

        Above the longest wave nothing of the surface is seen yet; below the shortest nothing more
        comes; NaN where the model knows the wave and not the number.
        """
        values = getattr(self, name)
        known = np.isfinite(values)
        if not known.any():
            return np.full(wavelength.size, np.nan)
        before, first = _BEFORE[name], self.wavelength[0] * (1.0 + ROUNDING)
        own, values = self.wavelength[known], values[known]
        if self.stepped:
            count = (own[None, :] >= wavelength[:, None] * (1.0 - ROUNDING)).sum(axis=1)
            return np.asarray(np.append(before, values)[count])
        found = np.interp(-np.log(wavelength), -np.log(own), values)
        found = np.where(wavelength > own[0] * (1.0 + ROUNDING), np.nan, found)
        return np.where(wavelength > first, before, found)


_BEFORE = {"contact_fraction": 1.0, "friction": 0.0}
"""Of a smooth surface."""


def curve_of(answer: xr.Dataset) -> Curve | None:
    """Return what a model told by wavelength, or None if it told nothing."""
    if "octave_running_friction" in answer:
        names = ("contact_fraction_without_shorter", "octave_running_friction")
        weight = answer["weight"].values
        area, friction = (weight @ answer[name].transpose("profile", ...).values for name in names)
        return Curve(answer["wavelength"].values, area, friction, stepped=False)
    if "running_friction" not in answer:
        return None
    friction = answer["running_friction"].values
    known = answer.get("running_contact_fraction")
    area = np.full(friction.size, np.nan) if known is None else known.values
    return Curve(answer["wavelength"].values, area, friction, stepped="amplitude" in answer)


def octaves(curves: Iterable[Curve], smallest: float) -> Array:
    """Return the lower ends of octaves [m], falling, that hold all `curves`, `smallest` among them.

    Empty without curves.
    """
    ends = np.array([[one.wavelength[0], one.wavelength[-1]] for one in curves])
    if not ends.size:
        return np.empty(0)
    first = np.floor(np.log2(ends[:, 0].max() / smallest) + ROUNDING)
    last = np.floor(np.log2(ends[:, 1].min() / smallest) + ROUNDING)
    return np.asarray(smallest * 2.0 ** np.arange(first, last - 1.0, -1.0))


# One answer of one model, as the comparison takes it from the Dataset the model gave.

CONVERGED = "converged"
QUANTITIES = ("contact_fraction", "friction", "friction_from_dissipation")
"""Totals every sample has, as `gripscale.model.TOTALS` without `total_`."""


@dataclass(frozen=True, eq=False)
class Sample:
    """One solution of a rung: its totals with their estimated errors, or why there are none."""

    contact_fraction: float
    friction: float
    """From the contact traction."""
    friction_from_dissipation: float
    status: str
    of: str = ""
    """What it is a sample of."""
    contact_fraction_error: float = math.nan
    """Estimated by the model [-], absolute; NaN if it gives none."""
    friction_error: float = math.nan
    """The same of the friction coefficient."""
    adhesive_friction: float = math.nan
    """Of the area term [-]; NaN where none was asked for or the model knows none."""
    extrapolation: Extrapolation = UNKNOWN
    """What of it rests on the rubber beyond its measured frequencies."""
    cut_off_exponents: CutOffExponents = NOT_TOLD
    """How it changes with the smallest wavelength."""
    curve: Curve | None = None
    """Down to each wavelength, where the model tells it."""
    seconds: float = 0.0

    @property
    def converged(self) -> bool:
        """Whether the numbers may be used."""
        return self.status == CONVERGED


def sample_of(
    answer: xr.Dataset,
    of: str = "",
    conditions: Conditions | None = None,
    temperature: float | None = None,
) -> Sample:
    """Return the sample in the `answer` of a model.

    Where the model does not know the area term of `conditions`, it is that of its contact area at
    the `temperature` before the contact [K].
    At rest there is no friction: what rounding leaves of it becomes zero.
    """
    rest = float(answer["nominal_speed"]) == 0.0
    totals = {name: float(answer[f"total_{name}"]) for name in QUANTITIES}
    if rest:
        totals |= {name: 0.0 * value for name, value in totals.items() if "friction" in name}
    return Sample(
        **totals,
        status=str(answer["prediction_status"].item()),
        of=of,
        contact_fraction_error=_error(answer, "contact_fraction"),
        friction_error=math.nan if rest else _error(answer, "friction"),
        adhesive_friction=_adhesive(answer, conditions, temperature),
        extrapolation=extrapolation_of(answer),
        cut_off_exponents=cut_off_exponents_of(answer),
        curve=curve_of(answer),
        seconds=float(answer.attrs.get("seconds", 0.0)),
    )


def _adhesive(
    answer: xr.Dataset, conditions: Conditions | None, temperature: float | None
) -> float:
    if ADHESIVE_FRICTION in answer or conditions is None:
        return float(answer.get(ADHESIVE_FRICTION, math.nan))
    names = ("total_contact_fraction", "nominal_pressure", "nominal_speed")
    area, pressure, speed = (float(answer[name]) for name in names)
    return conditions.adhesive_friction(area, pressure, speed, temperature)


def _error(answer: xr.Dataset, name: str) -> float:
    """Return the estimated error of a total: of profiles by weight, of waves added up.

    Waves: their relative errors add up in the product of areas, their errors in the sum of
    frictions; all in the same direction, because the same mesh makes them.
    """
    errors = answer.get(f"{name}_error")
    if errors is None:
        return math.nan
    values = np.abs(errors.values)
    if errors.dims == ("profile",):
        return float(answer["weight"].values @ values)
    if errors.dims == ("scale",):
        relative = name == "contact_fraction"
        each = values / answer[name].values if relative else values
        return float(each.sum() * (answer[f"total_{name}"] if relative else 1.0))
    return float(values)


# Numbers above zero with a relative uncertainty, multiplied and divided.
#
#     y = y_1^(+-1) y_2^(+-1) ...,      sigma^2 = sigma_1^2 + sigma_2^2 + ...
#
# with sigma the standard deviation of log y: products of independent log-normal numbers (J.
# Aitchison & J. A. C. Brown, The Lognormal Distribution (1957), sec. 2.3). A number between y
# exp(-sigma) and y exp(sigma) is within one standard uncertainty.


class LogNormalValue(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan

    @property
    def low(self) -> float:
        """The number less one standard uncertainty."""
        return self.value * math.exp(-self.uncertainty)

    @property
    def high(self) -> float:
        """The number plus one standard uncertainty."""
        return self.value * math.exp(self.uncertainty)

    def times(self, other: LogNormalValue) -> LogNormalValue:
        """Return the product with an independent number."""
        return LogNormalValue(
            self.value * other.value, add_in_quadrature([self.uncertainty, other.uncertainty])
        )

    def over(self, other: LogNormalValue) -> LogNormalValue:
        """Return the quotient by an independent number; NaN if that is zero."""
        value = self.value / other.value if other.value else math.nan
        return LogNormalValue(value, add_in_quadrature([self.uncertainty, other.uncertainty]))


UNKNOWN_VALUE = LogNormalValue(math.nan)
"""Nothing known."""


def add_in_quadrature(uncertainties: Iterable[float]) -> float:
    """Return the root of the sum of squares of those known; NaN if none is."""
    known = [one for one in uncertainties if not math.isnan(one)]
    return math.hypot(*known) if known else math.nan


def of_mean(values: ArrayLike) -> float:
    """Return the standard deviation of the logarithm of the mean of `values`, from their scatter.

    NaN for fewer than two values and for values not above zero.
    """
    sample = np.asarray(values, dtype=float)
    if sample.size < 2 or not (sample > 0.0).all():
        return math.nan
    return float(np.std(sample, ddof=1) / math.sqrt(sample.size) / sample.mean())


# A rung with its answers: means, what they scatter by, and what is known of their errors.


@dataclass(frozen=True, eq=False)
class SolvedRung:
    """What one model says, over its samples (profiles, seeds of random phases).

    Numbers are those of the samples that converged; `status` says of the others, if there are any.
    """

    rung: Rung
    samples: Sequence[Sample] = field(repr=False)

    @property
    def name(self) -> str:
        """Word for it in result files."""
        return self.rung.name

    @property
    def label(self) -> str:
        """In words."""
        return self.rung.label

    @property
    def converged(self) -> list[Sample]:
        """The samples that may be used."""
        return [sample for sample in self.samples if sample.converged]

    @property
    def status(self) -> str:
        """`converged`, or how many samples did not and what the first of them says."""
        bad = [sample.status for sample in self.samples if not sample.converged]
        if not bad:
            return CONVERGED
        count = len(self.samples)
        return bad[0] if count == 1 else f"{len(bad)} of {count} samples failed: {bad[0]}"

    @property
    def seconds(self) -> float:
        """Time its samples took to solve [s], added up."""
        return sum(sample.seconds for sample in self.samples)

    @property
    def extrapolation(self) -> Extrapolation:
        """What of the samples that may be used rests on the rubber beyond its measured band."""
        parts = [sample.extrapolation for sample in self.converged]
        return of_sum(parts, self.values("friction"))

    @property
    def cut_off_exponents(self) -> CutOffExponents:
        """How the means change with the smallest wavelength."""
        parts = [sample.cut_off_exponents for sample in self.converged]
        return exponents_of_mean(parts, self.values("contact_fraction"), self.values("friction"))

    def mean(self, name: str) -> float:
        """Return the mean of a number of the samples, such as `friction`; NaN if none converged."""
        return float(self.values(name).mean()) if self.converged else math.nan

    def spread(self, name: str) -> float:
        """Return the standard deviation over the samples; NaN for a single one."""
        values = self.values(name)
        return float(np.std(values, ddof=1)) if values.size > 1 else math.nan

    def values(self, name: str) -> NDArray[np.float64]:
        """Return a number of each sample that converged."""
        return np.array([getattr(sample, name) for sample in self.converged], dtype=float)

    def uncertain(self, name: str) -> LogNormalValue:
        """Return the mean with its uncertainty: scatter of the samples and estimated errors.

        Of several things sampled (profiles) the scatter is that of their means: what is drawn of
        one of them again and again tells nothing of the others.
        """
        scatter = of_mean(self._independent(name))
        return LogNormalValue(self.mean(name), add_in_quadrature([scatter, self._error(name)]))

    def over(self, other: SolvedRung, name: str) -> LogNormalValue:
        """Return the factor from `other` to this rung.

        Where both have one sample each of the same things, only what those have in both counts and
        the uncertainty is from the scatter of their ratios; else from the scatter of both.
        """
        if not self.pairs_with(other):
            return self.uncertain(name).over(other.uncertain(name))
        both = [
            (getattr(own, name), getattr(its, name))
            for own, its in zip(self.samples, other.samples, strict=True)
            if own.converged and its.converged
        ]
        if not both:
            return LogNormalValue(math.nan)
        own, its = np.array(both).T
        ratio = own.mean() / its.mean() if its.mean() else math.nan
        scatter = of_mean(own / its) if (its > 0.0).all() else math.nan
        return LogNormalValue(
            ratio, add_in_quadrature([scatter, self._error(name), other._error(name)])
        )

    def pairs_with(self, other: SolvedRung) -> bool:
        """Return whether both rungs have one sample each of the same two things or more."""
        own, its = ([sample.of for sample in one.samples] for one in (self, other))
        return len(own) > 1 and own == its and len(set(own)) == len(own)

    def _independent(self, name: str) -> NDArray[np.float64]:
        """Return the mean of each thing sampled, or the samples of a single one."""
        things = dict.fromkeys(sample.of for sample in self.converged)
        if len(things) < 2:
            return self.values(name)
        each = ([s for s in self.converged if s.of == thing] for thing in things)
        return np.array([np.mean([getattr(s, name) for s in group]) for group in each])

    def _error(self, name: str) -> float:
        """Return the mean error of the samples as their models estimate it, relative."""
        errors = self.values(f"{name.removesuffix('_from_dissipation')}_error")
        mean = self.mean(name)
        known = errors[np.isfinite(errors)]
        return float(known.mean() / abs(mean)) if known.size and mean else math.nan


class FactorOf(NamedTuple):
    """A factor of the best estimate: what it is, and which rungs it is the ratio of."""

    name: str
    label: str
    over: str
    under: str


MAP = "map"
"""The rung of synthetic maps."""

FACTORS = (
    FactorOf("finite_strain", "finite strain", "windows_finite_strain", "windows_half_plane"),
    FactorOf("isotropic_map", "isotropic map over its lines", MAP, "map_lines"),
)
"""All factors; a new one is added here."""


@dataclass(frozen=True)
class Factor:
    """A factor on contact fraction and friction; `UNKNOWN` where it is not included."""

    name: str
    label: str
    contact_fraction: LogNormalValue = UNKNOWN_VALUE
    friction: LogNormalValue = UNKNOWN_VALUE

    @property
    def included(self) -> bool:
        """Whether both numbers are known."""
        numbers = (self.contact_fraction.value, self.friction.value)
        return all(value == value for value in numbers)


@dataclass(frozen=True)
class BestEstimate:
    """Contact fraction and friction with their relative uncertainties, and what they are made of.

    Parameters
    ----------
    base : Factor
        The direct contact of the profile as measured: numbers, not ratios.
    factors : sequence of Factor
        What they are multiplied by, as far as included.
    """

    base: Factor
    factors: Sequence[Factor]

    @property
    def contact_fraction(self) -> LogNormalValue:
        """Real over nominal contact area [-], the product of what is included."""
        parts = [factor.contact_fraction for factor in self.included]
        return reduce(LogNormalValue.times, parts, self.base.contact_fraction)

    @property
    def friction(self) -> LogNormalValue:
        """Friction coefficient [-], the product of what is included."""
        parts = [factor.friction for factor in self.included]
        return reduce(LogNormalValue.times, parts, self.base.friction)

    @property
    def included(self) -> list[Factor]:
        """The factors that are known."""
        return [factor for factor in self.factors if factor.included]

    @property
    def missing(self) -> list[Factor]:
        """The factors nobody has computed."""
        return [factor for factor in self.factors if not factor.included]


def best_estimate(
    rungs: Mapping[str, SolvedRung], supplied: Sequence[Factor] = (), *, of_map: bool = False
) -> BestEstimate | None:
    """Return the best estimate of the rungs, or None without a direct contact that converged.

    Parameters
    ----------
    rungs : mapping
        The solved rungs by name.
    supplied : sequence of Factor
        Factors known from elsewhere; one with the name of ours replaces it.
    of_map : bool
        Whether a map was measured, which is no line that needs a factor.
    """
    direct = rungs.get(DIRECT)
    if direct is None or not direct.converged:
        return None
    base = Factor(
        DIRECT, direct.label, direct.uncertain("contact_fraction"), direct.uncertain("friction")
    )
    needed = [one for one in FACTORS if not (of_map and one.over == MAP)]
    factors = {one.name: _ratio(one, rungs) for one in needed}
    factors |= {one.name: one for one in supplied}
    return BestEstimate(base, list(factors.values()))


def _ratio(of: FactorOf, rungs: Mapping[str, SolvedRung]) -> Factor:
    over, under = rungs.get(of.over), rungs.get(of.under)
    if over is None or under is None:
        return Factor(of.name, of.label)
    # of the two frictions the one that a coarse grid changes least
    ratios = (over.over(under, name) for name in ("contact_fraction", "friction_from_dissipation"))
    return Factor(of.name, of.label, *ratios)
