"""The answer of a case with what is not known of its inputs, and the parts of its interval.

The number is that of `gripscale run`; the samples widen its interval, as docs/derivations.md says.
Drawn blocks of the profiles are the sampling of the road, which then counts among the samples.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.conditions.conditions import TENSION_OR_SHEAR, THERMAL_CONSTANTS, TREADS
from gripscale.core.arrays import Array
from gripscale.half_space.model import resolved_wavelength
from gripscale.io.table import Column, Table, percent
from gripscale.model import FRICTION_OUTSIDE_BAND, OUTSIDE_BAND, STATUS, STATUS_WORD, Load
from gripscale.questions.answer.direct_contact import direct_contact_totals
from gripscale.questions.answer.estimate import (
    DIRECT,
    ESTIMATED,
    LINES_TO_SURFACE,
    SampledErrors,
    answer_of_waves,
)
from gripscale.questions.answer.intervals import LogError, combined
from gripscale.questions.answer.samples import SAMPLED_QUANTITIES, running, usable
from gripscale.questions.answer.variables import (
    FRICTION_BELOW_MEASUREMENT,
    HYSTERESIS,
    SYMBOLS,
    of_hysteresis,
)
from gripscale.questions.uncertainty.sampling import SampleSet
from gripscale.questions.uncertainty.sources import GRID_PLACE, SOURCES, BlockDraw
from gripscale.questions.uncertainty.variance_shares import shares

# End of the name of the half width without errors of the inputs, as `gripscale run` states it.
OF_RUN = "half_width_of_run"
# Sources that are errors of the answer itself, too; and what no source does alone.
ROAD, GRID, REST = "profile", "grid", "together"
# What tables call `REST`: beside sources, and where the samples are too few to tell them apart.
NOT_ALONE, TOGETHER = "none of them alone", "all inputs together"


class SampledError(NamedTuple):
    """What samples say of the logarithm of one number [-]."""

    errors: list[LogError]  # independent errors, which add up in squares
    variance: dict[str, float]  # of each source, and `REST`
    share_error: dict[str, float]  # standard error of the variance of a source


def sampled_error(
    values: Array, case: float, logarithms: Mapping[str, Array], freedom: Mapping[str, float]
) -> SampledError:
    """Return the error that samples of a number show, and its parts; NaN for fewer than two.

    `case` is the number of the case itself; samples that are NaN do not count. `logarithms` are of
    what each source drew, as for `shares`, and `freedom` the degrees of freedom of those that have
    some.
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # without friction at rest
        logs = np.log(values / case)
    logs = logs[np.isfinite(logs)]
    if logs.size < 2:
        return SampledError([LogError(xr.DataArray(math.nan), xr.DataArray(math.nan))], {}, {})
    square, scatter = float(np.mean(logs**2)), float(np.var(logs))
    fit = shares(values, logarithms)
    variance: dict[str, float] = {}
    share_error: dict[str, float] = {}
    if fit is not None:
        explained = np.maximum(fit.share, 0.0)
        explained /= max(float(explained.sum()), 1.0)
        variance = dict(zip(logarithms, (explained * scatter).tolist(), strict=True))
        share_error = dict(zip(logarithms, (fit.error * scatter).tolist(), strict=True))
    variance[REST] = max(square - sum(variance.values()), 0.0)
    limits = {REST: min(freedom.values(), default=math.inf), **freedom}
    by_freedom: dict[float, float] = {}
    for name, part in variance.items():
        count = min(limits.get(name, math.inf), logs.size - 1.0)
        by_freedom[count] = by_freedom.get(count, 0.0) + part
    errors = [
        LogError(xr.DataArray(math.sqrt(part)), xr.DataArray(count))
        for count, part in by_freedom.items()
    ]
    return SampledError(errors, variance, share_error)


def measured_answer(
    reference: xr.Dataset,
    case: Case,
    load: Load,
    curve: xr.Dataset | None,
    drawn: SampleSet | None = None,
    direct: xr.Dataset | None = None,
) -> xr.Dataset:
    """Return the answer of a case with a measured surface under one load, widened by samples.

    `reference` are the samples of `direct_contact_design`, `curve` is the `continued_curve` of the
    load. `direct` holds the `drawn` samples of the direct contact with `_case` of the case itself;
    None if only the chain was sampled, whose errors say nothing of the direct contact.
    `answer_..._half_width_of_run` is without samples; over `part` stand `part_label` and the
    standard errors `answer_..._part_error` that the interval is made of.
    """
    total = of_run = direct_contact_totals(reference, case, load, curve)
    errors, of_road = {}, False
    if drawn is not None and direct is not None and int(direct.contact_fraction.count()) > 1:
        # the grid of the answer is finer than that of the samples, and counts by itself
        ours = [s for s in drawn.sources if DIRECT in s.models and s.name != GRID]
        of_road = any(source.name == ROAD for source in ours)
        logarithms = {source.name: drawn.logarithms[source.name] for source in ours}
        freedom = {s.name: s.draw.freedom for s in ours if isinstance(s.draw, BlockDraw)}
        for name, measure in ESTIMATED.items():
            values = direct[measure]
            if GRID_PLACE in direct and f"{measure}_grid_error" in direct:
                error = direct[f"{measure}_grid_error"].fillna(0.0)
                values = values / np.exp(direct[GRID_PLACE] * error)
            usual = float(direct[f"{measure}_case"])
            errors[name] = sampled_error(values.values, usual, logarithms, freedom)
        sampled = {name: error.errors for name, error in errors.items()}
        total = direct_contact_totals(reference, case, load, curve, SampledErrors(sampled, of_road))
    correlation = case.surface.correlation
    limit = None if correlation is None else correlation.resolution_limit
    # roughness that ends at the limit has no friction below it: shorter waves are of the edges
    if limit is not None and resolved_wavelength(case.surface) <= 0.99 * limit:
        above = float(running(reference, "friction", np.array([limit]))[0])
        friction = float(usable(reference, "friction_from_dissipation").mean("sample"))
        share = 1.0 - above / friction if friction > 0.0 else math.nan
        total = total.assign({"resolution_limit": limit, FRICTION_BELOW_MEASUREMENT: share})
    return _with_parts(total, of_run, errors, of_road=of_road)


def chain_answer(chain: xr.Dataset, case: Case, load: Load, drawn: SampleSet) -> xr.Dataset:
    """Return the answer of a case of waves stated by hand: the chain, with the scatter of samples.

    As `measured_answer`, with no factors and nothing of a road.
    """
    totals = {name: chain[f"{name}_case"] for name in (*SAMPLED_QUANTITIES, "adhesive_friction")}
    further = {
        **dict.fromkeys(OUTSIDE_BAND, math.nan),
        FRICTION_OUTSIDE_BAND: chain["outside_band_case"],
        STATUS: chain.status_case,
        STATUS_WORD: chain.status_case_word,
    }
    numbers = xr.Dataset(totals | further)
    errors = {
        name: sampled_error(chain[name].values, float(numbers[name]), drawn.logarithms, {})
        for name in ESTIMATED
    }
    sigmas = {name: combined(error.errors) for name, error in errors.items()}
    answered = answer_of_waves(numbers, case, load, sigmas)
    return _with_parts(answered, answered, errors, of_road=True)


def _with_parts(
    total: xr.Dataset, of_run: xr.Dataset, sampled: Mapping[str, SampledError], *, of_road: bool
) -> xr.Dataset:
    # of each part the standard error, and that of its share in the variance; NaN if not known
    parts: dict[str, dict[str, tuple[float, float]]] = {name: {} for name in ESTIMATED}
    for name, of_number in parts.items():
        square = float(total[f"answer_{of_hysteresis(total, name)}_uncertainty"]) ** 2
        of_samples = sampled.get(name, SampledError([], {}, {}))
        rest = NOT_ALONE if len(of_samples.variance) > 1 else TOGETHER
        for source, variance in of_samples.variance.items():
            label = rest if source == REST else SOURCES[source].label
            error = of_samples.share_error.get(source, math.nan)
            error = error / square if square > 0.0 else math.nan
            of_number[label] = math.sqrt(variance), error
        if not of_road:
            road = float(total[f"answer_{name}_sampling_error"])
            of_number[SOURCES[ROAD].label] = road, math.nan
        factors = total[f"answer_{name}_factor_uncertainty"].values
        errors = [total[f"answer_{name}_grid_error"].item(), *factors.tolist()]
        labels = [f"factor: {label}" for label in total.factor_label.values]
        for label, error in zip(["grid of the answer", *labels], errors, strict=True):
            if math.isfinite(error):
                of_number[label] = error, math.nan
    every = list(dict.fromkeys(label for of_number in parts.values() for label in of_number))
    data = {"part_label": xr.Variable("part", np.array(every, dtype=object))}
    for name, of_number in parts.items():
        values = [of_number.get(label, (math.nan, math.nan)) for label in every]
        for end, column in zip(("error", "share_error"), np.transpose(values), strict=True):
            data[f"answer_{name}_part_{end}"] = xr.Variable("part", column, {"units": "1"})
    for name in (*(f"answer_{name}" for name in ESTIMATED), HYSTERESIS):
        if name in total:
            data[f"{name}_{OF_RUN}"] = of_run[f"{name}_half_width"].variable
    return total.assign(data)


# Share of a standard error that an equal, independent measurement leaves.
AGAIN = 1.0 / math.sqrt(2.0)
# What measures each source or factor, and the share of its standard error that it leaves. Noise of
# heights counts by its square.
_OF_SOURCES = {
    "profile": ("as much of the surface once more", AGAIN),
    "modulus": ("moduli once more", AGAIN),
    "cut_off": ("a finer profile, to where the roughness ends", 0.0),
    "cleaning": ("the profiles once more: spikes do not repeat", 0.0),
    "height_noise": ("each profile twice, averaged", AGAIN**2),
    "bulk_modulus": ("bulk modulus of the compound", 0.0),
    "equilibrium_modulus": ("relaxation, to the equilibrium modulus", 0.0),
    "temperature": ("temperature of the rubber, twice", AGAIN),
    "pressure": ("nominal pressure, twice", AGAIN),
}
_OF_FACTORS = {
    LINES_TO_SURFACE: "a map in place of lines; it shows a direction, too",
    TREADS: "strain sweeps of the compound",
    TENSION_OR_SHEAR: "whether the strain sweeps are in tension or in shear",
    THERMAL_CONSTANTS: "conductivity and heat capacity of the compound",
}
MEASUREMENTS = {SOURCES[name].label: each for name, each in _OF_SOURCES.items()}
MEASUREMENTS |= {f"factor: {label}": (text, 0.0) for label, text in _OF_FACTORS.items()}


def next_measurements(answer: xr.Dataset) -> Table | None:
    """Return measurements by how much of the interval of the friction they would take.

    `answer` is a result of `gripscale.uncertainty` at one load and in motion. None where the parts
    of its interval are not known by source.
    """
    labels = answer.part_label.values.tolist()
    if not {SOURCES[name].label for name in _OF_SOURCES} & set(labels):
        return None
    listed = [at for at, label in enumerate(labels) if label in MEASUREMENTS]
    texts, shares = zip(*(MEASUREMENTS[labels[at]] for at in listed), strict=True)
    both = ("friction", "contact_fraction")
    widths = {name: _widths(answer, name, listed, np.array(shares)) for name in both}
    order = np.argsort(widths["friction"][1:], kind="stable")
    columns = [Column("measurement", ["none", *(texts[k] for k in order)])]
    for name, width in widths.items():
        ranked = [width[0], *width[1:][order]]
        columns.append(Column(f"{name}_width", ranked, f"± of {SYMBOLS[name]}", format=percent))
    takes = 1.0 - widths["friction"][1:][order] / widths["friction"][0]
    columns.append(Column("takes", [0.0, *takes], format="{:.0%}".format))
    notes = ["Half widths of the 90 % interval."]
    return Table("next", columns, "What to measure next", notes, keys=1)


def _widths(answer: xr.Dataset, name: str, listed: list[int], share: Array) -> Array:
    sigma = answer[f"answer_{name}_part_error"].fillna(0.0).values[listed]
    number = f"answer_{of_hysteresis(answer, name)}"
    total = float(answer[f"{number}_uncertainty"])
    rest = np.sqrt(np.maximum(1.0 - (1.0 - share**2) * (sigma / total) ** 2, 0.0))
    log_width = math.asinh(float(answer[f"{number}_half_width"]))
    return np.asarray(np.sinh(log_width * np.append(1.0, rest)))
