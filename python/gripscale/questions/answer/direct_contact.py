"""The number behind every answer: direct contact of the measured surface, times known factors.

The direct contact of each profile is a sample of the road, solved to an estimated relative error of
`JUDGED_TO`; `gripscale.questions.answer.estimate` multiplies their mean by its factors.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.continuation.curve import QUANTILE_90
from gripscale.core import CaseKey, Finding, InputError, Severity, Topic, Words, in_mm
from gripscale.experiment.design import Design, Point, solve_design
from gripscale.experiment.solve import Bench, bench_in
from gripscale.experiment.task import Task
from gripscale.half_space.location import trace_variables
from gripscale.half_space.model import JUDGED_TO, WARMING, DirectContact, resolved_wavelength
from gripscale.half_space.result import TRAPPED_WATER
from gripscale.model import Load
from gripscale.questions.answer import estimate
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.calibrated import Contact
from gripscale.questions.answer.reliance import WORTH_NAMING, estimated_names
from gripscale.questions.answer.variables import has_answer
from gripscale.questions.cut_off.curve import (
    AREA,
    CONTINUED_TO,
    FRICTION,
    at_cut_off,
    continuation_doubts,
    cut_off_curve,
    refusals,
)
from gripscale.questions.inputs.record import in_words
from gripscale.surface.random_phases import REAL_PHASES
from gripscale.surface.surface import each_measured


def direct_contact_design(
    case: Case,
    load: Load,
    label: str = "",
    *,
    tolerance: float | None = JUDGED_TO,
    traces: bool = False,
) -> Design | None:
    """Return the direct contacts of the profiles of a case under a load as tasks, over `sample`.

    None if no profile was measured. `label` begins the names of the tasks; with `traces` the
    answers hold the contacts as charts draw them, and what changes by what the case does not state.
    Without a `tolerance` the first full grid counts.
    """
    profiles = each_measured(case.surface)
    if not profiles:
        return None
    direct = DirectContact(
        tolerance=tolerance,
        conditions=case.conditions,
        traces=traces,
        alternatives=True,
        unstated=traces,
    )
    points = [
        Point((at,), f"{label}{name}", Task(case.rubber, surface, load, direct))
        for at, (name, surface) in enumerate(profiles)
    ]
    subjects = {"subject": ("sample", [name for name, _ in profiles])}
    return Design({"sample": len(points)}, points, subjects)


def solve_direct_contact(case: Case, bench: Bench | None = None) -> xr.Dataset | None:
    """Return the direct contact of each profile of a case over `sample`, with its trace.

    None if no profile was measured; `InputError` for a rubber or profile that cannot be used. A
    `bench` with a store keeps each contact.
    """
    design = direct_contact_design(case, case.load, traces=True)
    if design is None:
        return None

    def numbers(predicted: xr.Dataset, task: Task) -> xr.Dataset:
        traces = trace_variables(predicted).isel(profile=0)
        return reduce.sample_numbers(predicted, task).assign(traces)

    return solve_design(design, bench or Bench(None), numbers)


# Attribute of an answer: that profiles across each other showed no ridges.
ISOTROPIC = "isotropic_road"


def other_findings(samples: xr.Dataset, totals: xr.Dataset, case: Case) -> Iterator[Finding]:
    """Yield what the moduli as measured, and what is not stated, change in an answer.

    The first wherever the interval names the series. The others are a tread of 8 mm, and warming
    without a temperature shift: nothing for a stated thickness, for waves that do not feel the
    base, of rubber with a shift, or if the changes are within the sampling error of the answer or
    that of its grids.
    """
    master = " The series was fitted before: a case that has the master curve fits it for its load."
    rise = float(samples.get(WARMING, xr.DataArray(math.nan)).mean())
    texts = {
        "tread": ("With a tread of 8 mm on a rigid base, not rubber without end, {}.", "thickness"),
        "heat": (
            "Without a temperature shift the rubber does not warm. Its friction would warm it by "
            f"{rise:.2g} K where energy is lost: with the shift of other treads {{}}.",
            "shift",
        ),
        "series": (
            "With the moduli as measured, not the series fitted to them, {}."
            f"{'' if case.measured_rubber.fit else master}",
            "",
        ),
    }
    for which, (text, key) in texts.items():
        names = {name: f"{name}_of_{which}" for name in estimated_names(totals)}
        if not {*names.values()} <= {*samples.data_vars} or not has_answer(totals):
            continue
        changes = {name: math.expm1(float(samples[of].mean())) for name, of in names.items()}
        errors = {name: float(totals[f"answer_{name}_sampling_error"]) for name in names}
        least = {n: np.fmax(JUDGED_TO, errors[n]) if key else WORTH_NAMING for n in names}
        if not any(abs(changes[name]) > least[name] for name in names):
            continue
        state = (" State ", CaseKey(key), " in [rubber].") if key else ()
        words = Words(text.format(in_words(changes)), *state)
        friction, area = changes.get("friction", math.nan), changes["contact_fraction"]
        cure = f"rubber.{key}" if key else ""
        yield Finding(Severity.WARNING, words, friction, area, Topic.RUBBER, cure)


def continued_curve(case: Case, load: Load, folder: str | Path | None = None) -> xr.Dataset | None:
    """Return the contact against the cut-off, if the case continues its roughness; else None.

    It ends where the measurement ends if that foretells no octave (`refusals`). A `folder` keeps
    the solution. Raises `InputError` if it has no result.
    """
    if case.below_measurement.down_to is None:
        return None
    with bench_in(folder) as bench:
        curve = cut_off_curve(case, load, bench)
    status = curve[model.STATUS].item()
    if "cut_off" not in curve.dims:
        raise InputError(f"roughness below the measurement has no result: {status}")
    return curve


def continuation_factors(case: Case, curve: xr.Dataset | None) -> list[estimate.Factor]:
    """Return the factor of the roughness of a `continued_curve` below the cut-off of its case.

    Its error is that of the continuation; none without a curve, or one that was refused. A surface
    known by its spectrum has that of its phases.
    """
    spectrum, phases = case.surface.spectrum, list[estimate.Factor]()
    if spectrum is not None and spectrum.phases in REAL_PHASES:
        area, friction, freedom = REAL_PHASES[spectrum.phases]
        ratios = estimate.LogNormalValue(*area), estimate.LogNormalValue(*friction)
        phases = [estimate.Factor("real_phases", "random to real phases", *ratios, freedom, True)]
    if curve is None or any(refusals(curve)):
        return phases
    cut_off = resolved_wavelength(case.surface)

    def grown(name: str) -> estimate.LogNormalValue:
        end, upper = float(curve[name][-1]), float(curve[f"{name}_upper"][-1])
        ratio = end / at_cut_off(curve, name, cut_off)
        if not math.isfinite(ratio):  # no friction at rest
            return estimate.LogNormalValue(1.0, 0.0)
        return estimate.LogNormalValue(ratio, math.log(upper / end) / QUANTILE_90)

    end = in_mm(float(curve.cut_off[-1]), 3)
    label = f"roughness continued from {in_mm(cut_off, 3)} to {end}"
    return [*phases, estimate.Factor("below_measurement", label, grown(AREA), grown(FRICTION))]


def direct_contact_totals(
    samples: xr.Dataset,
    case: Case,
    load: Load,
    curve: xr.Dataset | None = None,
    sampled: estimate.SampledErrors | None = None,
) -> xr.Dataset:
    """Return the mean contact of the profiles as a model answers, with the answer.

    `samples` are answers of `direct_contact_design` under the load; `curve` is the contact against
    the cut-off below the measurement (`continued_curve`); `sampled` widens the interval by the
    errors of the inputs.
    """
    means = {name: float(reduce.mean(samples, name)) for name in reduce.SAMPLED_QUANTITIES}
    beyond, exponents = reduce.outside_band(samples), reduce.cut_off_exponents(samples)
    best = estimate.answer_of_samples(
        samples.expand_dims(model=[estimate.DIRECT]),
        continuation_factors(case, curve),
        sampled=sampled,
        conditions=case.conditions,
        contacts=[
            Contact(case.rubber, case.surface, load, case.conditions, case.below_measurement)
        ],
    )
    if curve is not None and not any(refusals(curve)):
        best[CONTINUED_TO] = case.below_measurement.down_to
    end = resolved_wavelength(case.surface)
    best["cutoff_wavelength"] = xr.Variable((), end, {"units": "m"})
    of_curve = [] if curve is None else list(continuation_doubts(curve))
    of_curve += case.softening_doubts
    doubts = model.input_doubts([case.surface, case.measured_rubber], [load], case.units, of_curve)
    totals = model.predicted_answer(
        best,
        {f"total_{name}": value for name, value in means.items()},
        str(reduce.status(samples).item()),
        estimate.DIRECT,
        load,
        model.extrapolation_of(beyond),
        model.cut_off_exponents_of(exponents),
        status_word=str(reduce.status_word(samples).item()),
    ).assign_attrs(case.attributes | doubts, tolerance=JUDGED_TO)
    for finding in case.surface.direction:
        if finding.severity == Severity.GOOD:
            totals.attrs[ISOTROPIC] = finding.sentence
    for name, text in TRAPPED_WATER.items():
        if name in samples:  # of a map, the only sample
            attrs = {"units": "1", "long_name": text}
            totals[name] = xr.Variable((), float(samples[name][0]), attrs)
    if traces := trace_variables(samples):
        totals = totals.assign(traces.variables)
    area_term = reduce.mean(samples, "adhesive_friction")
    return model.with_area_term(totals, float(area_term))
