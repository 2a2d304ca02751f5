"""A best estimate: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic surface/its lines)

and friction likewise. The first factor is a ratio of two models on the same windows; where nobody
has computed it, it is assumed to be 1 within what windows and blocks of other roads showed. The
second is a law measured on synthetic surfaces (`gripscale.half_space.line_to_map`). The interval
(`intervals`) is for the mean over the road with the roughness down to the
cut-off, from the sampling of the road and the errors of grids and factors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.core.described import Described
from gripscale.experiment.design import Index, stack, variable_attributes
from gripscale.half_space import line_to_map
from gripscale.half_space.model import DirectContact
from gripscale.half_space.result import SHARES_BY_SLOPE
from gripscale.model import BASIS, STATUS, UPPER_HEIGHT
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.intervals import LogError, combined, half_width, interval_ends

DIRECT = DirectContact.name
"""Name of the model that every answer starts from."""


class LogNormalValue(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan


UNKNOWN_VALUE = LogNormalValue(math.nan)
"""Of a factor nobody has computed."""


@dataclass(frozen=True, repr=False)
class Factor(Described):
    """A factor on contact fraction and friction, known from elsewhere."""

    name: str
    label: str
    contact_fraction: LogNormalValue = UNKNOWN_VALUE
    friction: LogNormalValue = UNKNOWN_VALUE
    freedom: float = math.inf
    """Degrees of freedom of its uncertainties."""


FINITE_STRAIN = "windows_finite_strain", "windows_half_plane"
"""Rungs whose ratio is the factor of finite strain."""
ASSUMED_FINITE_STRAIN = Factor(
    "finite_strain", "finite strain, assumed", LogNormalValue(1.0, 0.03), LogNormalValue(1.0, 0.05)
)
"""Where these rungs were not solved: what windows and blocks of other roads showed."""
LINES_TO_SURFACE = "step from lines to a surface"
"""Label of the factor from measured lines to the isotropic surface they lie on."""
ISOTROPY_ASSUMED = "the step to a surface assumes an isotropic road"
"""What an answer with this factor rests on, where nothing tells of ridges."""
FactorNumbers = dict[str, tuple[xr.DataArray, LogError]]
"""A factor on each estimated quantity, with its error."""


class SampledErrors(NamedTuple):
    """Errors of a best estimate that samples of its inputs show."""

    errors: Mapping[str, Sequence[LogError]]
    """Of each estimated quantity."""
    of_road: bool
    """Whether they hold the sampling of the road, which then counts here and nowhere else."""


BASIS_SHARES = ("steep_share", "missing_share")
"""What else it rests on: of the friction on steep flanks, of the contact on filled gaps."""

ESTIMATED = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}
"""What is estimated, and of which number of the samples its factors are ratios: of the two
frictions the one that a coarse grid changes least."""


AREA_TERM = "best_adhesive_friction"
"""Name of the area term's friction over the contact area of a best estimate."""


def best_estimate(
    samples: xr.Dataset,
    supplied: Sequence[Factor] = (),
    *,
    sampled: SampledErrors | None = None,
) -> xr.Dataset:
    """Return the best estimate of the solved rungs.

    Samples that are lines have an `upper_height`, by which they step to their surface. `sampled`
    adds what is not known of the inputs to the interval. A `supplied` factor with the name of a
    known one replaces it.

    `best_contact_fraction` and `best_friction` have a relative standard `_uncertainty` and the
    relative `_half_width` of their 90 % interval, NaN without a direct contact that converged or
    where the profiles are too short to tell how well they represent the road (`_sampling_error`);
    over `factor` the `_factor` on each with its `_factor_uncertainty`, NaN if not included.
    `best_adhesive_friction` is there where an area term was asked for: its stress shears the area
    of the best estimate, and no other.
    """
    has_direct = DIRECT in samples["rung"].values
    status = samples["prediction_status"].isel(rung=0, sample=0, drop=True)
    unknown = xr.full_like(status, math.nan, dtype=float)
    factors: dict[str, tuple[str, FactorNumbers]] = {}
    if has_direct:
        factors["finite_strain"] = _finite_strain(samples, unknown)
        if _are_lines(samples):
            factors["isotropic_surface"] = LINES_TO_SURFACE, _of_surface(samples)
        for factor in supplied:
            factors[factor.name] = factor.label, _numbers_of(factor, unknown)
    labels = [label for label, _ in factors.values()]
    solved = [_where_all_known(numbers) for _, numbers in factors.values()]
    data = xr.Dataset({"factor_label": ("factor", np.array(labels, dtype=object))})
    direct = samples.sel(rung=DIRECT, drop=True) if has_direct else None
    for share in BASIS_SHARES:
        data[f"best_{share}"] = unknown
        if direct is not None and share in direct:
            data[f"best_{share}"] = reduce.usable(direct, share).mean("sample")
    for share in SHARES_BY_SLOPE:
        if direct is not None and share in direct:
            data[f"best_{share}"] = reduce.usable(direct, share).mean("sample")
    for name in ESTIMATED:
        mean, road, grid = unknown, LogError(unknown, unknown), unknown
        if direct is not None:
            mean, road = reduce.usable(direct, name).mean("sample"), reduce.road_error(direct, name)
            # even within the estimated error, and the same for all profiles
            grid = reduce.estimated_error(direct, name).fillna(0.0) / math.sqrt(3.0)
        errors = [road, _certain(grid)]
        if sampled is not None:
            errors = [*([] if sampled.of_road else [road]), _certain(grid), *sampled.errors[name]]
        data[f"best_{name}_sampling_error"] = road.sigma
        data[f"best_{name}_grid_error"] = grid
        value = uncertainty = unknown.expand_dims(factor=0)
        if solved:
            value = xr.concat([numbers[name][0] for numbers in solved], "factor")
            every = [numbers[name][1] for numbers in solved]
            uncertainty = xr.concat([error.sigma for error in every], "factor")
            errors += [LogError(error.sigma.fillna(0.0), error.freedom) for error in every]
        mean, error = mean * value.prod("factor"), combined(errors)
        data[f"best_{name}"] = mean
        data[f"best_{name}_uncertainty"] = error.sigma.where(mean.notnull())
        data[f"best_{name}_half_width"] = half_width(error).where(mean.notnull())
        data[f"best_{name}_factor"] = value
        data[f"best_{name}_factor_uncertainty"] = uncertainty
    if direct is not None and "adhesive_friction" in direct:
        term = reduce.usable(direct, "adhesive_friction").mean("sample")
        if bool(term.notnull().any()):
            data[AREA_TERM] = term * data["best_contact_fraction_factor"].prod("factor")
    return data


def _certain(sigma: xr.DataArray) -> LogError:
    """Return an error that is itself certain."""
    return LogError(sigma, xr.full_like(sigma, math.inf))


def _are_lines(samples: xr.Dataset) -> bool:
    """Return whether samples of the direct contact are lines of a surface, not a map."""
    heights = samples.get("upper_height")
    return heights is not None and bool(heights.sel(rung=DIRECT).notnull().any())


def _of_surface(samples: xr.Dataset) -> FactorNumbers:
    """Return the step from lines to their surface at the contact area of the lines."""
    direct = samples.sel(rung=DIRECT, drop=True)
    lines, *line = (
        reduce.usable(direct, name).mean("sample")
        for name in ("contact_fraction", "upper_height", "relative_load")
    )
    freedom = xr.full_like(lines, line_to_map.FREEDOM)
    laws = line_to_map.contact_fraction_ratio, line_to_map.friction_ratio
    numbers = {}
    for name, law in zip(ESTIMATED, laws, strict=True):
        surface = law(line_to_map.LineUnderLoad(*(number.values for number in line)), lines.values)
        sigma = lines.copy(data=surface.uncertainty)
        numbers[name] = lines.copy(data=surface.ratio), LogError(sigma, freedom)
    return numbers


def _finite_strain(samples: xr.Dataset, unknown: xr.DataArray) -> tuple[str, FactorNumbers]:
    """Return label and numbers of the factor of finite strain, assumed where it is not solved.

    Its error is the scatter of the samples of both rungs and, evenly, as much again as the factor
    changes, for what the samples leave out.
    """
    numbers: FactorNumbers = {}
    if set(FINITE_STRAIN) <= set(samples["rung"].values.tolist()):
        over, under = (samples.sel(rung=rung, drop=True) for rung in FINITE_STRAIN)
        for name, measure in ESTIMATED.items():
            value, error = reduce.ratio(over, under, measure)
            changed = xr.apply_ufunc(lambda x: np.abs(np.log(x)), value.where(value > 0.0))
            numbers[name] = value, combined([error, _certain(changed / math.sqrt(3.0))])
    if not numbers or any(bool(value.isnull().any()) for value, _ in numbers.values()):
        return ASSUMED_FINITE_STRAIN.label, _numbers_of(ASSUMED_FINITE_STRAIN, unknown)
    return "finite strain", numbers


def _numbers_of(factor: Factor, unknown: xr.DataArray) -> FactorNumbers:
    numbers = {}
    for name in ESTIMATED:
        number: LogNormalValue = getattr(factor, name)
        sigma = xr.full_like(unknown, number.uncertainty)
        error = LogError(sigma, xr.full_like(unknown, factor.freedom))
        numbers[name] = xr.full_like(unknown, number.value), error
    return numbers


def _where_all_known(numbers: FactorNumbers) -> FactorNumbers:
    """Return a factor with NaN where it is not known of all quantities: it is not included."""
    there = np.logical_and.reduce([value.notnull() for value, _ in numbers.values()])
    return {
        name: (value.where(there), LogError(error.sigma.where(there), error.freedom))
        for name, (value, error) in numbers.items()
    }


_WORDS = {"contact_fraction": "real contact area A_r/A_0", "friction": "friction μ"}
OF_A_POINT = {
    "": "best estimate of the {}",
    "_low": "low end of the 90 % interval of the {}",
    "_high": "high end of the 90 % interval of the {}",
    "_half_width": "relative half width of the 90 % interval of the {}",
    "_sampling_error": "relative standard error of the {} from the sampling of the road",
    "_factor": "factor on the {} of the direct contact, NaN if not included",
    "_factor_uncertainty": "relative standard uncertainty of a factor on the {}",
}
"""What is kept of the best estimate of a prediction: end of its name, and meaning."""
POINT_ESTIMATES = frozenset(
    ["factor_label", *(f"best_{name}{end}" for name in ESTIMATED for end in OF_A_POINT)]
)
"""Names that `with_best_estimate` adds for the rubber that slides."""
BEST_ESTIMATES = POINT_ESTIMATES - {"factor_label"} | {
    *(f"best_{name}{end}" for name in ESTIMATED for end in ("_uncertainty", "_grid_error")),
    *(f"best_{share}" for share in (*BASIS_SHARES, *SHARES_BY_SLOPE)),
}
"""Names of all numbers of a best estimate."""


def with_best_estimate(data: xr.Dataset) -> xr.Dataset:
    """Return predictions of the direct contact with the best estimate of each.

    The result has `best_contact_fraction` and `best_friction` over the axes of the study, the ends
    `_low` and `_high` of their 90 % intervals and the further numbers of `OF_A_POINT`, and of
    rubber at rest `static_best_contact_fraction` and so on. NaN where the direct contact has no
    result, or the surface is too short for an interval.

    Parameters
    ----------
    data : xarray.Dataset
        A study (`gripscale.questions.Study`); one of another model is returned as it is.
    """
    if UPPER_HEIGHT not in data:  # no direct contact
        return data
    data = data.drop_dims("factor", errors="ignore")
    for prefix in ("", "static_"):
        total = data.get(f"{prefix}total_contact_fraction")
        if total is None:
            continue
        parts: dict[Index, xr.Dataset] = {}
        for index in np.ndindex(total.shape):
            row = data.isel(dict(zip(total.dims, index, strict=True)))
            parts[index] = _of_prediction(row, prefix)
        sizes = {str(dim): size for dim, size in total.sizes.items()}
        stacked = stack({at: part.drop_vars("factor_label") for at, part in parts.items()}, sizes)
        data = data.assign({f"{prefix}{name}": stacked[name] for name in stacked})
        label = parts[(0,) * total.ndim]["factor_label"]
        data["factor_label"] = label.assign_attrs(
            variable_attributes("factors of the best estimate")
        )
    return data


def _of_prediction(row: xr.Dataset, prefix: str) -> xr.Dataset:
    """Return the best estimate of one prediction of a study, a sample of all its profiles."""
    names = [*reduce.SAMPLED_QUANTITIES, *(f"{name}_error" for name in reduce.SMOOTH)]
    names.append("adhesive_friction")
    names += [name.removeprefix("total_") for name in BASIS]
    numbers = {name: float(row.get(f"{prefix}total_{name}", math.nan)) for name in names}
    if prefix or float(row.get("speed", row.attrs["nominal_speed"])) == 0.0:
        numbers |= dict.fromkeys(["friction", "friction_from_dissipation"], 0.0)
    sample = xr.Dataset({name: (("rung", "sample"), [[value]]) for name, value in numbers.items()})
    sample[STATUS] = ("rung", "sample"), np.array([[row[f"{prefix}{STATUS}"].item()]], dtype=object)
    sample = sample.assign_coords(
        rung=[DIRECT], subject=(("rung", "sample"), np.array([["surface"]], dtype=object))
    )
    best = best_estimate(sample)
    kept = best[["factor_label"]]
    for name in ("contact_fraction",) if prefix else ESTIMATED:
        value = best[f"best_{name}"]
        ends = interval_ends(value, best[f"best_{name}_half_width"])
        best = best.assign(dict(zip((f"best_{name}_low", f"best_{name}_high"), ends, strict=True)))
        for end, text in OF_A_POINT.items():
            part = best[f"best_{name}{end}"].reset_coords(drop=True)
            kept[f"best_{name}{end}"] = part.assign_attrs(
                variable_attributes(text.format(_WORDS[name]))
            )
    if AREA_TERM in best:
        text = "friction coefficient of the area term over the best estimate of the contact area"
        kept[AREA_TERM] = best[AREA_TERM].assign_attrs(variable_attributes(text))
    return kept
