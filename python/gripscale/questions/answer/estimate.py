"""The estimate of an answer: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic surface/its lines)

and friction likewise. Both factors are laws (`gripscale.half_space.line_to_map`), of windows of
other roads and of synthetic surfaces; a comparison also solves the first. The interval
(`intervals`) is for the mean over the road with the roughness down to the cut-off, from the
sampling of the road and the errors of grids and factors.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.conditions.area_term import DRY_TREAD, STRESS_SCATTER
from gripscale.conditions.conditions import LOG_AREA, LOG_FRICTION, Conditions
from gripscale.continuation.curve import QUANTILE_90
from gripscale.core.described import Described
from gripscale.experiment.design import variable_attributes
from gripscale.half_space import line_to_map
from gripscale.half_space.model import DirectContact
from gripscale.half_space.result import SHARES_BY_SLOPE
from gripscale.model import LINE_UNDER_LOAD, Load
from gripscale.questions.answer import intervals, variables
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.calibrated import Contact, errors_left

DIRECT = DirectContact.name  # name of the model that every answer starts from


class LogNormalValue(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan


UNKNOWN_VALUE = LogNormalValue(math.nan)  # of a factor nobody has computed


@dataclass(frozen=True, repr=False)
class Factor(Described):
    """A factor on contact fraction and friction, known from elsewhere."""

    name: str
    label: str
    contact_fraction: LogNormalValue = UNKNOWN_VALUE
    friction: LogNormalValue = UNKNOWN_VALUE
    freedom: float = math.inf
    """Degrees of freedom of its uncertainties."""
    of_small_contact: bool = False  # its logarithms fall to nothing at full contact, as 1 - A


# Models whose ratio is the factor of finite strain.
FINITE_STRAIN = "windows_finite_strain", "windows_half_plane"
# Name of the factor that replaces it in an answer, and the label of both.
FACTOR_OF_STRAIN, LARGE_STRAIN_LABEL = "finite_strain", "large strain"
# Label of the factor from measured lines to the isotropic surface they lie on.
LINES_TO_SURFACE = "profile to surface"
# What an answer with this factor rests on, where nothing tells of ridges.
ISOTROPY_ASSUMED = "the step from profile to surface assumes an isotropic surface"
# A factor on each estimated quantity, with its error.
FactorNumbers = dict[str, tuple[xr.DataArray, intervals.LogError]]


class SampledErrors(NamedTuple):
    """Errors of an answer that samples of its inputs show."""

    errors: Mapping[str, Sequence[intervals.LogError]]  # of each estimated quantity
    # Whether they hold the sampling of the road, which then counts here and nowhere else.
    of_road: bool


# What is estimated, and of which number of the samples its factors are ratios: of the two frictions
# the one that a coarse grid changes least.
ESTIMATED = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}


def answer_of_samples(
    samples: xr.Dataset,
    supplied: Sequence[Factor] = (),
    *,
    sampled: SampledErrors | None = None,
    solved_finite_strain: FactorNumbers | None = None,
    conditions: Conditions | None = None,
    contacts: Sequence[Contact] = (),
) -> xr.Dataset:
    """Return the answer of the solved models.

    Samples that are lines have an `upper_height`, by which they step to their surface. `sampled`
    adds what is not known of the inputs to the interval. A `supplied` factor with the name of a
    known one replaces it, `solved_finite_strain` that of finite strain. Typical laws among the
    `conditions` add their errors. Where the area term was fitted to measured friction, `contacts`,
    one for each answer, say what of the errors is left (`calibrated`).

    The names are those of `variables`. Numbers are NaN without a direct contact that converged,
    intervals also where the profiles are too short to represent the surface, factors that are not
    included.
    """
    status = samples["prediction_status"].isel(model=0, sample=0, drop=True)
    unknown = xr.full_like(status, math.nan, dtype=float)
    if DIRECT not in samples["model"].values:
        return estimate_of_waves(
            xr.Dataset(dict.fromkeys((*ESTIMATED, "adhesive_friction"), unknown))
        )
    direct = samples.sel(model=DIRECT, drop=True)
    area, pressed = (reduce.mean(direct, n) for n in ("contact_fraction", "pressure_over_modulus"))
    strain = solved_finite_strain or _numbers(
        area, lambda name: line_to_map.finite_over_small(name, pressed.values, area.values)
    )
    factors = {FACTOR_OF_STRAIN: (LARGE_STRAIN_LABEL, strain)}
    data = xr.Dataset({f"answer_{share}": unknown for share in variables.BASIS_SHARES})
    heights = direct.get("upper_height")
    if heights is not None and bool(heights.notnull().any()):  # lines of a surface, no map
        means = (reduce.mean(direct, name.removeprefix("total_")) for name in LINE_UNDER_LOAD)
        line = line_to_map.LineUnderLoad(*(mean.values for mean in means))
        laws = line_to_map.SURFACE_OVER_LINES
        surface = _numbers(area, lambda name: laws[name](line, area.values), line_to_map.FREEDOM)
        factors["isotropic_surface"] = LINES_TO_SURFACE, surface
        data[variables.REACH] = unknown.copy(data=line.reach)
    factors |= _of_conditions(direct, conditions, unknown)
    for factor in supplied:
        free = 1.0 - area if factor.of_small_contact else 1.0
        law = partial(_supplied, factor, free)
        factors[factor.name] = factor.label, _numbers(unknown, law, factor.freedom)
    labels, solved = zip(*factors.values(), strict=True)
    values = {
        name: xr.concat([numbers[name][0] for numbers in solved], "factor") for name in ESTIMATED
    }
    # a factor that is not known of both quantities is not included
    included = values["contact_fraction"].notnull() & values["friction"].notnull()
    data["factor_label"] = ("factor", np.array(labels, dtype=object))
    shares = (share for share in (*variables.BASIS_SHARES, *SHARES_BY_SLOPE) if share in direct)
    data = data.assign({f"answer_{share}": reduce.mean(direct, share) for share in shares})
    errors_of_total: dict[str, intervals.LogError] = {}  # of the area term, where there is one
    remaining, fit = xr.ones_like(unknown), xr.zeros_like(unknown)
    if contacts:
        remaining, fit = errors_left(contacts, area * values["contact_fraction"].prod("factor"))
    for name in ESTIMATED:
        mean, road = reduce.mean(direct, name), reduce.road_error(direct, name)
        # even within the estimated error, and the same for all profiles
        grid = reduce.estimated_error(direct, name).fillna(0.0) / math.sqrt(3.0)
        errors = [_certain(grid)] if sampled and sampled.of_road else [road, _certain(grid)]
        of_inputs = [] if sampled is None else [*sampled.errors[name]]
        value, each = values[name].where(included), [numbers[name][1] for numbers in solved]
        sigma = xr.concat([error.sigma for error in each], "factor").where(included)
        errors += [
            intervals.LogError(sigma.isel(factor=at).fillna(0.0), error.freedom)
            for at, error in enumerate(each)
        ]
        error = intervals.combined([*errors, *of_inputs])
        data = data.assign(with_interval(name, mean * value.prod("factor"), error))
        if bool(direct.get("adhesive_friction", unknown).notnull().any()):
            parts = [intervals.LogError(remaining**0.5 * e.sigma, e.freedom) for e in errors]
            errors_of_total[name] = intervals.combined([*parts, *of_inputs])
        data[f"answer_{name}_sampling_error"] = road.sigma
        data[f"answer_{name}_grid_error"] = grid
        data[f"answer_{name}_factor"] = value
        data[f"answer_{name}_factor_uncertainty"] = sigma
    if "adhesive_friction" in direct:
        if errors_of_total:
            term = reduce.mean(direct, "adhesive_friction")
            term = term * data["answer_contact_fraction_factor"].prod("factor")
            # that between compounds for the typical stress; a stated one is taken as it is
            typical = conditions and conditions.shear_stress == DRY_TREAD
            scatter = STRESS_SCATTER if typical else 0.0
            data = with_interface(data, term, errors_of_total, scatter, fit)
        if getattr(conditions and conditions.shear_stress, "fitted_to", None) is not None:
            data[variables.ERROR_LEFT] = remaining
    return variables.described(data)


def with_large_strain(
    answer: xr.Dataset,
    samples: xr.Dataset,
    supplied: Sequence[Factor] = (),
    conditions: Conditions | None = None,
) -> xr.Dataset:
    """Return an answer with what it becomes by the solved factor of finite strain, if it is solved.

    The error of the factor is the scatter of the samples of both models and, evenly, as much again
    as it changes, for what the samples leave out.
    """
    solved = {DIRECT, *FINITE_STRAIN} <= set(samples["model"].values.tolist())
    if not solved or any(factor.name == FACTOR_OF_STRAIN for factor in supplied):
        return answer
    factor: FactorNumbers = {}
    over, under = (samples.sel(model=member, drop=True) for member in FINITE_STRAIN)
    for name, measure in ESTIMATED.items():
        value, error = reduce.ratio(over, under, measure)
        if not bool(value.notnull().all()):
            return answer
        changed = xr.apply_ufunc(lambda x: np.abs(np.log(x)), value.where(value > 0.0))
        factor[name] = value, intervals.combined([error, _certain(changed / math.sqrt(3.0))])
    large = answer_of_samples(samples, supplied, solved_finite_strain=factor, conditions=conditions)
    for name, text in variables.LARGE_STRAIN_NUMBERS.items():
        answered = name.replace(variables.LARGE_STRAIN, "answer_")
        if answered in large:
            answer = answer.assign({name: large[answered]})
            answer[name].attrs = variable_attributes(text)
    return answer


def large_strain_answer(data: xr.Dataset) -> xr.Dataset | None:
    """Return a result with large strain solved as its answer; None where it was not."""
    numbers = [name for name in variables.LARGE_STRAIN_NUMBERS if name in data]
    replaced = {name.replace(variables.LARGE_STRAIN, "answer_"): data[name] for name in numbers}
    return data.assign(replaced) if numbers else None


def with_interval(
    name: str, value: xr.DataArray, error: intervals.LogError
) -> dict[str, xr.DataArray]:
    """Return a number of an answer by its name, with its uncertainty and 90 % interval."""
    there, most = value.notnull(), intervals.UPPER_LIMITS.get(name, math.inf)
    value = value.clip(max=most)
    low, high = intervals.interval_ends(value, intervals.half_width(error).where(there), most)
    width = (high - low) / (2.0 * value.where(value > 0.0))
    numbers = {"": value, "_uncertainty": error.sigma.where(there), "_half_width": width}
    ends = {"_low": low, "_high": high}
    return {f"answer_{name}{end}": number for end, number in (numbers | ends).items()}


def with_interface(
    data: xr.Dataset,
    term: xr.DataArray,
    errors: Mapping[str, intervals.LogError],
    stress_error: float = 0.0,
    fit: xr.DataArray | float = 0.0,
) -> xr.Dataset:
    """Return an answer of the hysteresis with the friction of its area term, and that of both.

    Unchanged where the term is NaN. Errors of hysteresis and contact area have common sources, such
    as the surface: at worst they add up in full. That of the stress, of the logarithm, has none in
    common with them, nor that of its `fit`, the half width of a 90 % interval of the total.
    """
    if not bool(term.notnull().any()):
        return data
    total = (data["answer_friction"] + term).where(data["answer_friction"] > 0.0)  # not at rest
    share = term / total
    friction, area = errors["friction"], errors["contact_fraction"]
    sigma = (1.0 - share) * friction.sigma + share * area.sigma
    sigma = (sigma**2 + (share * stress_error) ** 2) ** 0.5
    freedom = xr.apply_ufunc(np.minimum, friction.freedom, area.freedom)
    of_fit = xr.apply_ufunc(np.arcsinh, fit / total) / QUANTILE_90
    error = intervals.combined([intervals.LogError(sigma, freedom), _certain(of_fit)])
    hysteresis = {
        name: data[name.replace("hysteresis_", "")]
        for name in variables.ANSWER_NUMBERS
        if variables.HYSTERESIS in name
    }
    both = with_interval("friction", total, error)
    return data.assign(hysteresis | {variables.INTERFACE: term} | both)


def _certain(sigma: xr.DataArray) -> intervals.LogError:
    """Return an error that is itself certain."""
    return intervals.LogError(sigma, xr.full_like(sigma, math.inf))


def _numbers(
    like: xr.DataArray, law: Callable[[str], tuple[Any, Any]], freedom: float = math.inf
) -> FactorNumbers:
    """Return a factor by its `law`: of each quantity the ratio and its standard error."""
    ones, numbers = xr.ones_like(like), {}
    for name in ESTIMATED:
        ratio, sigma = law(name)
        numbers[name] = ones * ratio, intervals.LogError(ones * sigma, ones * freedom)
    return numbers


def _supplied(factor: Factor, share: Any, name: str) -> tuple[Any, Any]:
    """Return a factor and its error, their logarithms times a share."""
    value, sigma = getattr(factor, name)
    return value**share, sigma * share


def _of_conditions(
    direct: xr.Dataset, conditions: Conditions | None, unknown: xr.DataArray
) -> dict[str, tuple[str, FactorNumbers]]:
    """Return factors of one with the errors of the strain rule and of what else is not known."""
    factors: dict[str, tuple[str, FactorNumbers]] = {}
    if conditions is not None and conditions.softening is not None:
        values = LogNormalValue(1.0, LOG_AREA), LogNormalValue(1.0, LOG_FRICTION)
        rule = dict(zip(ESTIMATED, values, strict=True))
        factors["strain_rule"] = "strain rule", _numbers(unknown, rule.__getitem__)
    if "condition" not in direct.dims:
        return factors
    for at, label in enumerate(direct.condition.values):
        numbers = {}
        for name in ESTIMATED:
            change = direct[f"{name}_condition_error"].isel(condition=at, drop=True).mean("sample")
            numbers[name] = xr.ones_like(change), _certain(abs(change))
        factors[str(label)] = str(label), numbers
    return factors


def estimate_of_waves(
    numbers: xr.Dataset, errors: Mapping[str, intervals.LogError] = MappingProxyType({})
) -> xr.Dataset:
    """Return the answer of sine waves by their chain, with no factors, as `answer_of_samples` does.

    `numbers` are its `sample_numbers` under one load or several. Without `errors` of what they
    depend on there is no interval.
    """
    unknown = xr.full_like(numbers["friction"], math.nan)
    errors = dict.fromkeys(ESTIMATED, intervals.LogError(unknown, unknown)) | dict(errors)
    best = xr.Dataset({"factor_label": ("factor", np.empty(0, dtype=object))})
    best = best.assign({f"answer_{share}": unknown for share in variables.BASIS_SHARES})
    for name in ESTIMATED:
        best = best.assign(with_interval(name, numbers[name], errors[name]))
        best[f"answer_{name}_sampling_error"] = best[f"answer_{name}_grid_error"] = unknown
        for part in ("factor", "factor_uncertainty"):
            best[f"answer_{name}_{part}"] = unknown.expand_dims(factor=0)
    return variables.described(with_interface(best, numbers["adhesive_friction"], errors))


def answer_of_waves(
    numbers: xr.Dataset,
    case: Case,
    load: Load,
    errors: Mapping[str, intervals.LogError] = MappingProxyType({}),
) -> xr.Dataset:
    """Return the numbers of a chain under a load as an answer; see `estimate_of_waves`."""
    best = estimate_of_waves(numbers, errors)
    best["cutoff_wavelength"] = case.surface.cutoff_wavelength
    totals = {name: float(numbers[name.removeprefix("total_")]) for name in model.TOTALS}
    answered = model.predicted_answer(
        best,
        totals,
        str(numbers[model.STATUS].item()),
        Chain.name,
        load,
        model.extrapolation_of(numbers),
        model.cut_off_exponents_of(numbers),
        status_word=str(numbers[model.STATUS_WORD].item()),
    )
    inputs: list[model.Doubtful] = [case.surface, case.measured_rubber]
    doubts = model.input_doubts(inputs, [load], case.units, case.softening_doubts)
    return answered.assign_attrs(case.attributes | doubts)
