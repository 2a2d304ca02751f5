"""A comparison as a labelled Dataset: numbers over `rung`, and over the axis that was varied."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.core import provenance
from gripscale.core.labels import labelled
from gripscale.experiment.measured_friction import MeasuredFriction, measured_variables
from gripscale.half_space.line_to_map import upper_height_of
from gripscale.half_space.model import resolved_wavelength
from gripscale.model import input_doubts
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.best_estimate import BASIS_SHARES, Factor, best_estimate
from gripscale.questions.compare.ladder import ComparisonSetup, Rung
from gripscale.questions.vary.axis import Axis
from gripscale.questions.vary.study import coordinates
from gripscale.rubber.measured_rubber import MeasuredRubber

_SOURCE = "gripscale compare"
_WORDS = dict(zip(reduce.SMOOTH, ("contact fraction", "friction coefficient"), strict=True))
"""The two numbers that are compared."""


@dataclass(frozen=True, eq=False)
class SolvedLadder:
    """The rungs of one case with their samples, under one load or over a varied input."""

    case: Case
    setups: Sequence[ComparisonSetup]
    """What was compared: one, or one a value of `axis`."""
    rungs: Sequence[Rung]
    """Those with samples, in order."""
    samples: xr.Dataset
    """Their answers over the axis, `rung` and `sample`, see `samples`."""
    axis: Axis | None = None
    """The varied input."""
    measured: MeasuredFriction | None = None
    """Friction measured elsewhere, to be put beside the models."""
    factors: Sequence[Factor] = ()
    """Factors of the best estimate known from elsewhere."""
    rubbers: Sequence[MeasuredRubber] = ()
    """What the rubbers of the setups come from, and what is doubtful of them."""

    @property
    def converged(self) -> bool:
        """Whether every sample of every rung may be used."""
        return bool((reduce.converged(self.samples) | (self.samples.prediction_status == "")).all())

    @cached_property
    def data(self) -> xr.Dataset:
        """Everything as a labelled Dataset over the axis and `rung`."""
        return comparison_dataset(self)


def comparison_dataset(comparison: SolvedLadder) -> xr.Dataset:
    """Return means, scatter, factors and the best estimate of the rungs of a comparison."""
    samples, setups, axis = comparison.samples, comparison.setups, comparison.axis
    outer = () if axis is None else (axis.name,)
    wavelength = np.empty(0)
    if "curve_wavelength" in samples:  # octaves that hold the curves of all samples
        smallest = min(setup.surface.cutoff_wavelength for setup in setups)
        ends = reduce.usable(samples, "curve_wavelength")
        wavelength = reduce.octaves(float(ends.max()), float(ends.min()), smallest)
    data: dict[str, xr.Variable] = {}

    def add(name: str, values: xr.DataArray, long_name: str, *dims: str, unit: str = "1") -> None:
        ordered = values.transpose(*outer, *dims)
        data[name] = labelled(ordered.dims, ordered.values, unit, long_name, _SOURCE)

    def add_by_load(name: str, values: Any, long_name: str, *dims: str, unit: str = "1") -> None:
        array = np.asarray(values if outer else values[0])
        add(name, xr.DataArray(array, dims=(*outer, *dims)), long_name, *dims, unit=unit)

    for name in reduce.SAMPLED_QUANTITIES:
        text = f"{model.TOTALS[f'total_{name}']}, mean of the samples"
        add(f"total_{name}", reduce.usable(samples, name).mean("sample"), text, "rung")
    reach = upper_height_of(setups[0].surface)
    best = best_estimate(samples, comparison.factors, upper_height=reach)
    for name, text in zip(BASIS_SHARES, list(model.BASIS.values())[-2:], strict=True):
        add(f"best_{name}", best[f"best_{name}"], text)
    cut_offs = [resolved_wavelength(setup.surface) for setup in setups]
    add_by_load("cutoff_wavelength", cut_offs, "shortest wavelength of the roughness", unit="m")
    for name, text in _WORDS.items():
        values = reduce.usable(samples, name)
        about = "relative standard uncertainty of the"
        add(f"{name}_spread", reduce.spread(values), f"standard deviation of the {text}", "rung")
        error = reduce.usable(samples, f"{name}_error").mean("sample")
        add(f"{name}_error", error, f"error of the {text} as the model estimates it", "rung")
        rungs = [samples.isel(rung=at) for at in range(samples.sizes["rung"])]
        uncertainty = xr.concat([reduce.relative_uncertainty(rung, name) for rung in rungs], "rung")
        add(f"{name}_uncertainty", uncertainty, f"{about} mean {text}", "rung")
        factors = [_factor(comparison, at, name) for at in range(len(rungs))]
        value, uncertainty = (xr.concat(parts, "rung") for parts in zip(*factors, strict=True))
        add(f"{name}_factor", value, f"{text} over that of the rung it follows", "rung")
        text_of_factor = f"{about} factor on the {text}"
        add(f"{name}_factor_uncertainty", uncertainty, text_of_factor, "rung")
        add(f"sample_{name}", values, f"{text} by sample", "rung", "sample")
        curves = reduce.running(samples, name, wavelength)
        add(f"running_{name}", curves, f"{text} down to the wavelength", "rung", "wavelength")
        add(f"best_{name}", best[f"best_{name}"], f"best estimate of the {text}")
        add(f"best_{name}_uncertainty", best[f"best_{name}_uncertainty"], f"{about} best estimate")
        for part, long_name in (
            ("sampling_error", f"{about} {text}, from the sampling of the road"),
            ("grid_error", f"{about} {text}, from the grid of the direct contact"),
            ("half_width", f"relative half width of the 90 % interval of the {text}"),
        ):
            add(f"best_{name}_{part}", best[f"best_{name}_{part}"], long_name)
        text = f"factor on the {text}, NaN if not included"
        add(f"best_{name}_factor", best[f"best_{name}_factor"], text, "factor")
        uncertainty = best[f"best_{name}_factor_uncertainty"]
        add(f"best_{name}_factor_uncertainty", uncertainty, f"{about} factor", "factor")
    adhesive = reduce.usable(samples, "adhesive_friction").mean("sample")
    if adhesive.notnull().any():
        add(model.ADHESIVE_FRICTION, adhesive, "friction coefficient of the area term", "rung")
    beyond, exponents = reduce.outside_band(samples), reduce.cut_off_exponents(samples)
    for name, (_, text) in (model.OUTSIDE_BAND | model.CUT_OFF_EXPONENTS).items():
        add(name, (beyond if name in beyond else exponents)[name], text, "rung")
    text = "why an exponent of the cut-off is not known"
    add(model.WHY_NO_EXPONENT, exponents[model.WHY_NO_EXPONENT], text, "rung")
    add_by_load(
        "outside_band",
        [
            setup.rubber.outside_band(2.0 * np.pi * setup.load.speed / wavelength).astype(np.int8)
            for setup in setups
        ],
        "1 where the wavelength excites the rubber outside the measured frequencies",
        "wavelength",
    )
    count = (samples.prediction_status != "").sum("sample")
    add("samples", count, "number of samples", "rung")
    count = reduce.converged(samples).sum("sample")
    add("converged_samples", count, "number of samples that converged", "rung")
    add("status", reduce.status(samples), "converged, or what failed", "rung")
    add("status_word", reduce.status_word(samples), "word of the status", "rung")
    add("seconds", samples.seconds.sum("sample"), "time its samples took", "rung", unit="s")
    pressures = [setup.load.pressure for setup in setups]
    add_by_load("nominal_pressure", pressures, "nominal pressure", unit="Pa")
    speeds = [setup.load.speed for setup in setups]
    add_by_load("nominal_speed", speeds, "sliding speed", unit="m/s")
    words = {
        "label": "the model in words",
        "group": "what it can be asked for with",
        "follows": "rung it is compared with",
        "change": "what changes from that rung",
    }
    for name, text in words.items():
        column = [getattr(rung, name) for rung in comparison.rungs]
        data[name] = labelled("rung", np.array(column, dtype=object), "1", text, _SOURCE)
    labels, text = best.factor_label.values, "factors of the best estimate"
    data["factor_label"] = labelled("factor", labels, "1", text, _SOURCE)
    measured = comparison.measured
    if measured is not None:
        data |= measured_variables(measured)
    coords: dict[str, Any] = {}
    if axis is not None:
        coords |= coordinates([axis], comparison.case.units)
    text = "lower end of the octave"
    coords["wavelength"] = labelled("wavelength", wavelength, "m", text, _SOURCE)
    conditions = setups[0].conditions
    return xr.Dataset(
        data,
        {"rung": [rung.name for rung in comparison.rungs], **coords},
        {
            "title": "Contact and friction by model",
            **comparison.case.attributes,
            **input_doubts(
                [setups[0].surface, *comparison.rubbers],
                [setup.load for setup in setups],
                comparison.case.units,
            ),
            "case_file": comparison.case.origin.name,
            "conditions": json.dumps(conditions and conditions.to_dict()),
            "seeds": setups[0].seeds,
            "tolerance": setups[0].tolerance,
            "measured_source": "" if measured is None else measured.source,
            **provenance.version_attributes(),
        },
    )


def _factor(comparison: SolvedLadder, at: int, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the factor from the rung that the one at `at` follows; NaN if it is not there."""
    samples = comparison.samples
    before = comparison.rungs[at].follows
    if before not in samples["rung"].values:
        unknown = reduce.usable(samples.isel(rung=at, drop=True), name).mean("sample") * np.nan
        return unknown, unknown
    value, error = reduce.ratio(
        samples.isel(rung=at, drop=True), samples.sel(rung=before, drop=True), name
    )
    return value, error.sigma
