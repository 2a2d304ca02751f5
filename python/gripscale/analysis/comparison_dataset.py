"""A comparison as a labelled Dataset: numbers over `rung`, and over the axis that was varied."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.analysis.best_estimate import (
    QUANTITIES,
    UNKNOWN_VALUE,
    BestEstimate,
    Factor,
    LogNormalValue,
    SolvedRung,
    best_estimate,
    octaves,
)
from gripscale.analysis.ladder import ComparisonSetup
from gripscale.analysis.measured_comparison import measured_variables
from gripscale.analysis.measured_friction import MeasuredFriction
from gripscale.case.read import CaseFile
from gripscale.core import provenance
from gripscale.experiment.axis import Axis
from gripscale.experiment.study import coordinates
from gripscale.model import (
    ADHESIVE_FRICTION,
    CUT_OFF_EXPONENTS,
    OUTSIDE_BAND,
    TOTALS,
    WHY_NO_EXPONENT,
)
from gripscale.wave.result import labelled

if TYPE_CHECKING:
    import xarray as xr


# The solved rungs of one case under one load, and what follows from them.


@dataclass(frozen=True, eq=False)
class SolvedLadder:
    """The rungs of one case under one load, in order."""

    file: CaseFile
    subject: ComparisonSetup
    rungs: Sequence[SolvedRung]
    measured: MeasuredFriction | None = None
    """Friction measured elsewhere, to be put beside the models."""
    factors: Sequence[Factor] = field(default=())
    """Factors of the best estimate known from elsewhere."""

    @property
    def by_name(self) -> dict[str, SolvedRung]:
        """The rungs by name."""
        return {rung.name: rung for rung in self.rungs}

    @property
    def converged(self) -> bool:
        """Whether every sample of every rung may be used."""
        return all(len(rung.converged) == len(rung.samples) for rung in self.rungs)

    @cached_property
    def best_estimate(self) -> BestEstimate | None:
        """The best estimate, or None without a direct contact that converged."""
        measured = self.subject.surface.measured
        of_map = measured is not None and measured.map is not None
        return best_estimate(self.by_name, self.factors, of_map=of_map)

    def factor(self, rung: SolvedRung, name: str) -> LogNormalValue:
        """Return the factor on `name` from the rung that `rung` follows; NaN if it is not there."""
        before = self.by_name.get(rung.rung.follows)
        return UNKNOWN_VALUE if before is None else rung.over(before, name)


SOURCE = "gripscale compare"
WORDS = {"contact_fraction": "contact fraction", "friction": "friction coefficient"}
"""The two numbers that are compared."""


def to_dataset(comparisons: Sequence[SolvedLadder], axis: Axis | None = None) -> xr.Dataset:
    """Return the comparisons over `axis` and `rung`, or a single one over `rung`."""
    first = comparisons[0]
    wavelength = _wavelengths(comparisons)
    most = max(len(rung.samples) for one in comparisons for rung in one.rungs)
    parts = [xr.Dataset(_numbers(one, wavelength, most)) for one in comparisons]
    data = parts[0]
    if axis is not None:
        data = xr.concat(parts, dim=axis.name).assign_coords(coordinates([axis], first.file.text))
    data = data.assign(_words(first)).assign_coords(
        rung=[rung.name for rung in first.rungs],
        wavelength=labelled("wavelength", wavelength, "m", "lower end of the octave", SOURCE),
    )
    conditions = first.subject.conditions
    if first.measured is not None:
        data = data.assign(measured_variables(first.measured))
    return data.assign_attrs(
        title="Contact and friction by model",
        case=first.file.text,
        case_file=str(first.file.path),
        conditions=json.dumps(conditions and conditions.to_dict()),
        seeds=first.subject.seeds,
        tolerance=first.subject.tolerance,
        measured_source="" if first.measured is None else first.measured.source,
        **provenance.attributes(),
    )


def _numbers(one: SolvedLadder, wavelength: NDArray[np.float64], most: int) -> dict[str, Any]:
    """Return what belongs to one load."""
    rungs, load = one.rungs, one.subject.load
    data: dict[str, Any] = {}
    for name in QUANTITIES:
        data[f"total_{name}"] = _by_rung(
            [rung.mean(name) for rung in rungs], f"{TOTALS[f'total_{name}']}, mean of the samples"
        )
    for name, text in WORDS.items():
        data |= _of_quantity(one, name, text, wavelength, most)
    adhesive = [rung.mean("adhesive_friction") for rung in rungs]
    if np.isfinite(adhesive).any():
        data[ADHESIVE_FRICTION] = _by_rung(adhesive, "friction coefficient of the area term")
    beyond = [rung.extrapolation for rung in rungs]
    for name, (part, text) in OUTSIDE_BAND.items():
        data[name] = _by_rung([getattr(each, part) for each in beyond], text)
    exponents = [rung.cut_off_exponents for rung in rungs]
    for name, (part, text) in CUT_OFF_EXPONENTS.items():
        data[name] = _by_rung([getattr(each, part) for each in exponents], text)
    data[WHY_NO_EXPONENT] = _by_rung(
        [each.why_not for each in exponents], "why an exponent of the cut-off is not known"
    )
    excited = 2.0 * np.pi * load.speed / wavelength
    data["outside_band"] = labelled(
        "wavelength",
        one.subject.rubber.outside_band(excited).astype(np.int8),
        "1",
        "1 where the wavelength excites the rubber outside the measured frequencies",
        SOURCE,
    )
    data["samples"] = _by_rung([len(rung.samples) for rung in rungs], "number of samples")
    data["converged_samples"] = _by_rung(
        [len(rung.converged) for rung in rungs], "number of samples that converged"
    )
    data["status"] = _by_rung([rung.status for rung in rungs], "converged, or what failed")
    seconds = [rung.seconds for rung in rungs]
    data["seconds"] = labelled("rung", seconds, "s", "time its samples took", SOURCE)
    data["nominal_pressure"] = labelled((), load.pressure, "Pa", "nominal pressure", SOURCE)
    data["nominal_speed"] = labelled((), load.speed, "m/s", "sliding speed", SOURCE)
    return data


def _of_quantity(
    one: SolvedLadder, name: str, text: str, wavelength: NDArray[np.float64], most: int
) -> dict[str, Any]:
    """Return samples, spread, errors, factors, curve and best estimate of a quantity."""
    rungs = one.rungs
    factors = [one.factor(rung, name) for rung in rungs]
    uncertain = [rung.uncertain(name).uncertainty for rung in rungs]
    curves = [_running(rung, name, wavelength) for rung in rungs]
    errors = [_mean_of_known(rung.values(f"{name}_error")) for rung in rungs]
    padded = [_padded(rung, name, most) for rung in rungs]
    best = one.best_estimate
    mine = best and getattr(best, name)
    steps = best.factors if best else []
    about = "relative standard uncertainty of the"
    return {
        f"{name}_spread": _by_rung(
            [rung.spread(name) for rung in rungs], f"standard deviation of the {text}"
        ),
        f"{name}_error": _by_rung(errors, f"error of the {text} as the model estimates it"),
        f"{name}_uncertainty": _by_rung(uncertain, f"{about} mean {text}"),
        f"{name}_factor": _by_rung(
            [one.value for one in factors], f"{text} over that of the rung it follows"
        ),
        f"{name}_factor_uncertainty": _by_rung(
            [one.uncertainty for one in factors], f"{about} factor on the {text}"
        ),
        f"sample_{name}": labelled(("rung", "sample"), padded, "1", f"{text} by sample", SOURCE),
        f"running_{name}": labelled(
            ("rung", "wavelength"), curves, "1", f"{text} down to the wavelength", SOURCE
        ),
        f"best_{name}": labelled(
            (), mine.value if mine else math.nan, "1", f"best estimate of the {text}", SOURCE
        ),
        f"best_{name}_uncertainty": labelled(
            (), mine.uncertainty if mine else math.nan, "1", f"{about} best estimate", SOURCE
        ),
        f"best_{name}_factor": _by_factor(
            [_of(step, name).value for step in steps], f"factor on the {text}, NaN if not included"
        ),
        f"best_{name}_factor_uncertainty": _by_factor(
            [_of(step, name).uncertainty for step in steps], f"{about} factor"
        ),
    }


def _words(one: SolvedLadder) -> dict[str, Any]:
    """Return what the rungs and factors are called, which no load changes."""
    rungs = [rung.rung for rung in one.rungs]
    best = one.best_estimate
    return {
        "label": _by_rung([rung.label for rung in rungs], "the model in words"),
        "group": _by_rung([rung.group for rung in rungs], "what it can be asked for with"),
        "follows": _by_rung([rung.follows for rung in rungs], "rung it is compared with"),
        "change": _by_rung([rung.change for rung in rungs], "what changes from that rung"),
        "factor_label": _by_factor(
            [factor.label for factor in (best.factors if best else [])],
            "factors of the best estimate",
        ),
    }


def _wavelengths(comparisons: Sequence[SolvedLadder]) -> NDArray[np.float64]:
    smallest = min(one.subject.surface.cutoff_wavelength for one in comparisons)
    samples = [s for one in comparisons for rung in one.rungs for s in rung.converged]
    return octaves((s.curve for s in samples if s.curve is not None), smallest)


def _running(rung: SolvedRung, name: str, wavelength: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean over the samples down to each wavelength; NaN where one does not tell it."""
    curves = [sample.curve for sample in rung.converged]
    told = [curve.at(name, wavelength) for curve in curves if curve is not None]
    return np.mean(told, axis=0) if told else np.full(wavelength.size, np.nan)


def _padded(rung: SolvedRung, name: str, most: int) -> NDArray[np.float64]:
    """Return each sample, NaN for those that failed and beyond the last."""
    out = np.full(most, np.nan)
    for at, sample in enumerate(rung.samples):
        out[at] = getattr(sample, name) if sample.converged else np.nan
    return out


def _of(factor: Factor, name: str) -> Any:
    return getattr(factor, name) if factor.included else UNKNOWN_VALUE


def _mean_of_known(values: NDArray[np.float64]) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if known.size else math.nan


def _by_rung(values: Sequence[object], long_name: str) -> xr.Variable:
    return labelled("rung", values, "1", long_name, SOURCE)


def _by_factor(values: Sequence[object], long_name: str) -> xr.Variable:
    return labelled("factor", values, "1", long_name, SOURCE)


# What a comparison gives: the solved ladder of one load, or one for each value of an axis.


class Comparison(SolvedLadder):
    """The rungs of one case under one load, in order, and what follows from them."""

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over `rung`, see `comparison.dataset`."""
        return to_dataset([self])


@dataclass(frozen=True, eq=False)
class ComparisonOverAxis:
    """Comparisons over a varied input of the case."""

    axis: Axis
    comparisons: Sequence[Comparison]

    @property
    def converged(self) -> bool:
        """Whether every sample of every rung may be used."""
        return all(one.converged for one in self.comparisons)

    def to_dataset(self) -> xr.Dataset:
        """Return everything as a labelled Dataset over the axis and `rung`."""
        return to_dataset(self.comparisons, self.axis)
