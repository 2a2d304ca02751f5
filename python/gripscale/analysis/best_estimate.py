"""A best estimate: the profile as measured, times what else is known to matter.

    A/A_0 = (direct contact) x (finite strain/small strain) x (isotropic map/its lines)

and friction likewise. Each factor is a ratio of two models on the same surfaces, with its own
uncertainty; relative uncertainties of the independent factors add in squares (see
`gripscale.analysis.samples`). A factor nobody has computed is named and counts as not included: it
neither moves nor widens the estimate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.analysis.ladder import DIRECT
from gripscale.analysis.samples import in_quadrature, ratio, relative_uncertainty, usable


class LogNormalValue(NamedTuple):
    """A number and the standard deviation of its logarithm; NaN where that is not known."""

    value: float
    uncertainty: float = math.nan


UNKNOWN_VALUE = LogNormalValue(math.nan)
"""Of a factor nobody has computed."""


@dataclass(frozen=True)
class Factor:
    """A factor on contact fraction and friction, known from elsewhere."""

    name: str
    label: str
    contact_fraction: LogNormalValue = UNKNOWN_VALUE
    friction: LogNormalValue = UNKNOWN_VALUE


class FactorOf(NamedTuple):
    """A factor of the best estimate: its name, and which rungs it is the ratio of."""

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

ESTIMATED = {"contact_fraction": "contact_fraction", "friction": "friction_from_dissipation"}
"""What is estimated, and of which number of the samples its factors are ratios: of the two
frictions the one that a coarse grid changes least."""


def best_estimate(
    samples: xr.Dataset, supplied: Sequence[Factor] = (), *, of_map: bool = False
) -> xr.Dataset:
    """Return the best estimate of the solved rungs.

    `best_contact_fraction` and `best_friction` with their relative `_uncertainty`, NaN without a
    direct contact that converged; over `factor` the `_factor` on each with its
    `_factor_uncertainty`, NaN where it is not included, and `factor_label`. No factors without the
    rung of the direct contact. A `supplied` factor with the name of ours replaces it; a measured
    map is no line that needs a factor.
    """
    rungs = samples["rung"].values.tolist()
    factors: dict[str, FactorOf | Factor] = {}
    if DIRECT in rungs:
        factors = {factor.name: factor for factor in FACTORS if not (of_map and factor.over == MAP)}
        factors |= {factor.name: factor for factor in supplied}
    status = samples["prediction_status"].isel(rung=0, sample=0, drop=True)
    unknown = xr.full_like(status, math.nan, dtype=float)
    ratios = [
        {name: _ratio(factor, samples, name, unknown) for name in ESTIMATED}
        for factor in factors.values()
    ]
    included = [
        np.logical_and.reduce([number.notnull() for number, _ in parts.values()])
        for parts in ratios
    ]
    data = xr.Dataset({"factor_label": ("factor", [factor.label for factor in factors.values()])})
    for name in ESTIMATED:
        mean, error = unknown, unknown
        if DIRECT in rungs:
            direct = samples.sel(rung=DIRECT, drop=True)
            mean, error = usable(direct, name).mean("sample"), relative_uncertainty(direct, name)
        pairs = [
            [number.where(there) for number in parts[name]]
            for parts, there in zip(ratios, included, strict=True)
        ]
        value = uncertainty = unknown.expand_dims(factor=0)
        if pairs:
            value, uncertainty = (xr.concat(x, "factor") for x in zip(*pairs, strict=True))
        mean = mean * value.prod("factor")
        error = in_quadrature(error, *(pair[1] for pair in pairs)).where(mean.notnull())
        data[f"best_{name}"], data[f"best_{name}_uncertainty"] = mean, error
        data[f"best_{name}_factor"] = value
        data[f"best_{name}_factor_uncertainty"] = uncertainty
    return data


def _ratio(
    factor: FactorOf | Factor, samples: xr.Dataset, name: str, unknown: xr.DataArray
) -> tuple[xr.DataArray, xr.DataArray]:
    """Return a factor on `contact_fraction` or `friction`, and its uncertainty; or unknown."""
    if isinstance(factor, Factor):
        value: LogNormalValue = getattr(factor, name)
        return xr.full_like(unknown, value.value), xr.full_like(unknown, value.uncertainty)
    if not {factor.over, factor.under} <= set(samples["rung"].values.tolist()):
        return unknown, unknown
    over, under = (samples.sel(rung=rung, drop=True) for rung in (factor.over, factor.under))
    return ratio(over, under, ESTIMATED[name])
