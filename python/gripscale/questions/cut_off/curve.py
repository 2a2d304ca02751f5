"""Contact and friction against the cut-off, down below the measurement, and the usual rules."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.continuation.curve import FACTS, cut_off_at, unforetold
from gripscale.core import Finding, InputError, Severity, Topic, in_mm
from gripscale.experiment.design import surface_numbers, variable_attributes
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.model import Load
from gripscale.surface import RmsSlope, Surface, find_cut_off

# Name of the wavelength [m] that the roughness of an answer is continued to.
CONTINUED_TO = "continued_to"
FRICTION, AREA = "curve_friction_from_dissipation", "curve_contact_fraction"
SLOPE_IN_CONTACT = "curve_slope_in_contact"
# Rms slope in contact of the rule that ends the roughness where small strain ends.
CONTACT_SLOPE = 1.0
MICROTEXTURE = 0.5e-3  # longest wavelength of the microtexture of a road [m] (ISO 13473-1)
# Usual slopes at which the roughness is cut off: see docs/cut-off.md.
RMS_SLOPES = {"surface": 1.3, "profile": 1.0}


def cut_off_curve(
    case: Case,
    load: Load,
    bench: Bench,
    *,
    down_to: float | None = None,
    hurst: float | None = None,
) -> xr.Dataset:
    """Return the curves of a prepared case under a load, as `cut_off`."""
    model = case.continuation(down_to=down_to, hurst=hurst)
    task = Task(case.rubber, case.surface, load, model)
    label = f"continued down to {in_mm(model.down_to, 3)}"
    data = bench.solve({label: task}, contact_curves)[task.key]
    if "cut_off" not in data.dims:
        return data
    names, lengths = zip(*_rules(data, case.surface), strict=True)
    data = data.assign_coords(rule=list(names))
    text = variable_attributes("cut-off of the rule", "m")
    data["rule_cut_off"] = "rule", list(lengths), text
    for name, curve in (("friction", FRICTION), ("contact_fraction", AREA)):
        text = variable_attributes(f"{name.replace('_', ' ')} there")
        data[f"rule_{name}"] = "rule", [at_cut_off(data, curve, x) for x in lengths], text
    return data


def contact_curves(answer: xr.Dataset, task: Task) -> xr.Dataset:
    """Return the numbers of the last cut-off, and the curves."""
    kept = surface_numbers(answer, task)
    kept = kept.assign(answer[["nominal_pressure", "nominal_speed"]].variables)
    if "cut_off" not in answer.dims:
        return kept
    curves = [name for name in answer if answer[name].dims == ("cut_off",) or name in FACTS]
    return kept.merge(answer[curves])


def refusals(data: xr.Dataset) -> Iterator[Finding]:
    """Yield why a curve ends where the measurement ends, if more was asked for."""
    if "withheld_slope_ratio" in data and bool(data.curve_measured[-1]):
        names = ("resolved", "withheld_slope_ratio", "withheld_slope_ratio_above")
        text = unforetold(*(float(data[name]) for name in names))
        yield Finding(Severity.DOUBT, text, topic=Topic.SURFACE, key="below_measurement.hurst")


def continuation_doubts(data: xr.Dataset) -> Iterator[Finding]:
    """Yield `refusals`, and that a road that is measured too coarsely hides its microtexture."""
    yield from refusals(data)
    end = float(data.resolved)
    if end > MICROTEXTURE and not bool(data.curve_measured[-1]):
        yield Finding(
            Severity.DOUBT,
            f"The measured roughness ends at {in_mm(end, 3)}. The microtexture of a road, below "
            f"{in_mm(MICROTEXTURE, 3)}, does not follow from longer waves: of the shipped road, "
            "measured to 1.2 mm and continued, half of the friction is found, outside of the band.",
            topic=Topic.SURFACE,
        )


def at_cut_off(data: xr.Dataset, name: str, length: float) -> float:
    """Return a number of a curve at a cut-off [m]; NaN beyond the ends of the curve."""
    lengths, values = data["cut_off"].values[::-1], data[name].values[::-1]
    if not lengths[0] * (1.0 - 1e-9) <= length <= lengths[-1] * (1.0 + 1e-9):
        return math.nan
    with np.errstate(divide="ignore"):  # no friction at rest
        return float(np.exp(np.interp(math.log(length), np.log(lengths), np.log(values))))


def _rules(data: xr.Dataset, surface: Surface) -> Iterator[tuple[str, float]]:
    """Yield the rules of cut-off in words, and where they end the roughness [m]."""
    yield "shortest wavelength measured", float(data.resolved)
    yield "cut-off of the case", float(surface.cutoff_wavelength)
    assert surface.measured is not None
    for kind, slope in RMS_SLOPES.items():
        try:
            end = find_cut_off(surface.measured.slopes, RmsSlope(slope, kind, True)).wavelength
        except InputError:  # the spectrum does not reach it
            continue
        yield f"rms slope {slope:g} of the {kind}", end
    end = cut_off_at(CONTACT_SLOPE, data.cut_off.values, data[SLOPE_IN_CONTACT].values)
    if math.isfinite(end):
        yield f"rms slope {CONTACT_SLOPE:g} in contact", end
