"""A best estimate: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic surface/its lines)

and friction likewise. The first factor is a ratio of two models on the same windows; where nobody
has computed it, it is assumed to be 1 within what windows and blocks of other roads showed. The
second is a law measured on synthetic surfaces (`gripscale.half_space.line_to_map`). The interval
(`gripscale.analysis.intervals`) is for the mean over the road with the roughness down to the
cut-off, from the sampling of the road and the errors of grids and factors.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.analysis.intervals import LogError, combined, half_width
from gripscale.analysis.ladder import DIRECT
from gripscale.analysis.samples import estimated_error, ratio, sampling_error, usable
from gripscale.half_space import line_to_map
from gripscale.surface import Profile


class LogNormalValue(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan


UNKNOWN_VALUE = LogNormalValue(math.nan)
"""Of a factor nobody has computed."""

ISOTROPIC_SURFACE = "isotropic_surface"
"""Name of the factor from lines to a surface."""


@dataclass(frozen=True)
class Factor:
    """A factor on contact fraction and friction, known from elsewhere."""

    name: str
    label: str
    contact_fraction: LogNormalValue = UNKNOWN_VALUE
    friction: LogNormalValue = UNKNOWN_VALUE
    freedom: float = math.inf
    """Degrees of freedom of its uncertainties."""


class FactorOf(NamedTuple):
    """A factor of the best estimate: its name, and which rungs it is the ratio of."""

    name: str
    label: str
    over: str
    under: str
    assumed: Factor
    """Where the rungs were not solved."""


FINITE_STRAIN = FactorOf(
    "finite_strain",
    "finite strain",
    "windows_finite_strain",
    "windows_half_plane",
    Factor(
        "finite_strain",
        "finite strain, assumed",
        LogNormalValue(1.0, 0.03),
        LogNormalValue(1.0, 0.05),
    ),
)


def isotropic_surface(profiles: Sequence[Profile], largest_wavelength: float) -> Factor:
    """Return the factor from measured lines to the isotropic surface they lie on.

    Raises `InputError` as `gripscale.half_space.line_to_map.upper_height` does.
    """
    reach = line_to_map.upper_height(profiles, largest_wavelength)
    area, friction = (
        LogNormalValue(law.at(reach), law.scatter)
        for law in (line_to_map.CONTACT_FRACTION, line_to_map.FRICTION)
    )
    label = "isotropic surface over its lines"
    return Factor(ISOTROPIC_SURFACE, label, area, friction, line_to_map.FREEDOM)


ESTIMATED = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}
"""What is estimated, and of which number of the samples its factors are ratios: of the two
frictions the one that a coarse grid changes least."""


def best_estimate(samples: xr.Dataset, supplied: Sequence[Factor] = ()) -> xr.Dataset:
    """Return the best estimate of the solved rungs.

    `best_contact_fraction` and `best_friction` with their relative standard `_uncertainty` and the
    relative `_half_width` of their 90 % interval, NaN without a direct contact that converged; no
    interval where the profiles are too short to tell how well they represent the road. Over
    `factor` the `_factor` on each with its `_factor_uncertainty`, NaN where it is not included, and
    `factor_label`. No factors without the rung of the direct contact. A `supplied` factor with the
    name of ours replaces it.
    """
    has_direct = DIRECT in samples["rung"].values
    factors: dict[str, FactorOf | Factor] = (
        {FINITE_STRAIN.name: FINITE_STRAIN} if has_direct else {}
    )
    if has_direct:
        factors |= {factor.name: factor for factor in supplied}
    status = samples["prediction_status"].isel(rung=0, sample=0, drop=True)
    unknown = xr.full_like(status, math.nan, dtype=float)
    solved = [_numbers(factor, samples, unknown) for factor in factors.values()]
    labels = [label for label, _ in solved]
    data = xr.Dataset({"factor_label": ("factor", np.array(labels, dtype=object))})
    for name in ESTIMATED:
        mean, errors = unknown, [LogError(unknown, unknown)]
        if has_direct:
            direct = samples.sel(rung=DIRECT, drop=True)
            mean = usable(direct, name).mean("sample")
            # even within the estimated error, and the same for all profiles
            grid = estimated_error(direct, name).fillna(0.0) / math.sqrt(3.0)
            errors = [sampling_error(direct, name), _certain(grid)]
        value = uncertainty = unknown.expand_dims(factor=0)
        if solved:
            value = xr.concat([numbers[name][0] for _, numbers in solved], "factor")
            every = [numbers[name][1] for _, numbers in solved]
            uncertainty = xr.concat([error.sigma for error in every], "factor")
            errors += [LogError(error.sigma.fillna(0.0), error.freedom) for error in every]
        mean, error = mean * value.prod("factor"), combined(errors)
        data[f"best_{name}"] = mean
        data[f"best_{name}_uncertainty"] = error.sigma.where(mean.notnull())
        data[f"best_{name}_half_width"] = half_width(error).where(mean.notnull())
        data[f"best_{name}_factor"] = value
        data[f"best_{name}_factor_uncertainty"] = uncertainty
    return data


def _certain(sigma: xr.DataArray) -> LogError:
    """Return an error that is itself certain."""
    return LogError(sigma, xr.full_like(sigma, math.inf))


def _numbers(
    factor: FactorOf | Factor, samples: xr.Dataset, unknown: xr.DataArray
) -> tuple[str, dict[str, tuple[xr.DataArray, LogError]]]:
    """Return the label of a factor, and the factor on each quantity with its error.

    NaN where it is not known of all quantities: then it is not included. Of a ratio of rungs the
    error is the scatter of their samples and, evenly, as much again as it changes, for what the
    samples leave out.
    """
    numbers: dict[str, tuple[xr.DataArray, LogError]] = {}
    if isinstance(factor, FactorOf):
        if {factor.over, factor.under} <= set(samples["rung"].values.tolist()):
            over, under = (
                samples.sel(rung=rung, drop=True) for rung in (factor.over, factor.under)
            )
            for name, measure in ESTIMATED.items():
                value, error = ratio(over, under, measure)
                changed = xr.apply_ufunc(lambda x: np.abs(np.log(x)), value.where(value > 0.0))
                numbers[name] = value, combined([error, _certain(changed / math.sqrt(3.0))])
        if any(bool(value.isnull().any()) for value, _ in numbers.values()) or not numbers:
            factor, numbers = factor.assumed, {}
    if isinstance(factor, Factor):
        for name in ESTIMATED:
            number: LogNormalValue = getattr(factor, name)
            sigma = xr.full_like(unknown, number.uncertainty)
            error = LogError(sigma, xr.full_like(unknown, factor.freedom))
            numbers[name] = xr.full_like(unknown, number.value), error
    there = np.logical_and.reduce([value.notnull() for value, _ in numbers.values()])
    return factor.label, {
        name: (value.where(there), LogError(error.sigma.where(there), error.freedom))
        for name, (value, error) in numbers.items()
    }
