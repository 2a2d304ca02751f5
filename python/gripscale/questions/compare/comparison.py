"""A comparison: every sample of every model is a task, and the Dataset is over `model`."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.conditions import Conditions
from gripscale.core import Described, InputError, checks, labelled
from gripscale.experiment.design import Design, Point, surface_numbers
from gripscale.experiment.measured_friction import MeasuredFriction, measured_variables
from gripscale.experiment.solve import Bench, OnTask, Progress
from gripscale.experiment.task import Store, Task
from gripscale.half_space.model import resolved_wavelength
from gripscale.model import Doubtful
from gripscale.questions.answer import estimate as estimates
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.calibrated import Contact
from gripscale.questions.answer.estimate import Factor, estimate_of_waves
from gripscale.questions.answer.intervals import half_width
from gripscale.questions.answer.variables import ANSWER_NUMBERS, LARGE_STRAIN, LARGE_STRAIN_NUMBERS
from gripscale.questions.calibration import measured_comparison as friction
from gripscale.questions.compare.ladder import ComparedModel, ComparisonSetup
from gripscale.questions.vary.axis import Axis
from gripscale.questions.vary.study import Study, coordinates
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.measured_rubber import MeasuredRubber

_SOURCE = "gripscale compare"
# The two numbers that are compared.
_WORDS = dict(zip(reduce.SMOOTH, ("contact fraction", "friction coefficient"), strict=True))


@dataclass(frozen=True, eq=False, repr=False)
class SolvedLadder(Described):
    """The models of one case with their samples, under one load or over a varied input."""

    case: Case
    setups: Sequence[ComparisonSetup]
    """What was compared: one, or one a value of `axis`."""
    models: Sequence[ComparedModel]
    """Those with samples, in order."""
    samples: xr.Dataset
    """Their answers over the axis, `model` and `sample`, see `samples`."""
    axis: Axis | None = None
    """The varied input."""
    measured: MeasuredFriction | None = None
    """Friction measured elsewhere, to be put beside the models."""
    factors: Sequence[Factor] = ()
    """Factors of the answer known from elsewhere."""
    rubbers: Sequence[MeasuredRubber] = ()
    """The rubbers of the setups with their sources and doubts."""

    @cached_property
    def data(self) -> xr.Dataset:
        """Everything as a labelled Dataset over the axis and `model`."""
        return comparison_dataset(self)


# Inputs a comparison can be made over: numbers of the load and of the surface.
COMPARED_OVER = ("speed", "pressure", "temperature", "smallest_wavelength", "cut_off")

MOST_SEEDS = 1000
FEWEST_WINDOWS = 3  # windows whose scatter is believed
# Called with the comparison as it stands, while more samples are solved.
OnStage = Callable[[SolvedLadder], None]


def comparison_setups(
    case: Case, vary: Mapping[str, Any] | None, seeds: int, tolerance: float
) -> tuple[dict[str, ComparisonSetup], Axis | None, Sequence[MeasuredRubber]]:
    """Return what is compared by labels of tasks, over which axis, and the rubbers with doubts.

    Arguments and errors are those of `compare`.
    """
    tasks, axis = {"": case.task()}, None
    rubbers: Sequence[MeasuredRubber] = [case.measured_rubber]
    if vary is not None:
        study = Study(case, vary, model=Chain.name)
        axis = study.axes[0]
        if len(study.axes) > 1 or axis.name not in COMPARED_OVER:
            names = ", ".join(other.name for other in study.axes)
            raise InputError(f"a comparison varies one of {', '.join(COMPARED_OVER)}; got {names}")
        if not axis.numeric:
            raise InputError(f"a comparison varies {axis.name} by numbers; got {axis.labels[0]}")
        if len(axis.values) < 2:
            raise InputError(f"{axis.name} must have at least two values; got {axis.labels[0]}")
        tasks = {point.label: point.task for point in study.points}
        rubbers = study.measured_rubbers
    setups: dict[str, ComparisonSetup] = {}
    for label, task in tasks.items():
        chain = checks.instance("model", task.model, Chain)
        conditions = chain.conditions
        if case.conditions is not None and case.conditions.water is not None:  # not in the chain
            conditions = replace(conditions or Conditions(), water=case.conditions.water)
        dry = conditions and conditions.dry
        setup = setups[label] = ComparisonSetup(
            task.rubber,
            task.surface,
            task.load,
            Chain(chain.solver, pressure_classes=chain.pressure_classes, conditions=dry),
            checks.whole("seeds", seeds, least=1, most=MOST_SEEDS),
            checks.positive("tolerance", tolerance),
            case.klueppel_heinrich,
            continuation=replace(case.continuation(), conditions=conditions),
            conditions=conditions,
        )
        if case.chain.extrapolate == "refuse":
            wavelength = setup.surface.sines.wavelength
            require_measured(setup.rubber_before, wavelength, setup.load.speed)
    return setups, axis, rubbers


def telling_new(bench: Bench) -> Bench:
    """Return the bench that reports progress of newly solved tasks only."""

    def tell(progress: Progress) -> None:
        if bench.on_task is not None and not progress.stored:
            bench.on_task(progress)

    return replace(bench, on_task=tell)


def ladder_design(
    setups: Mapping[str, ComparisonSetup], models: Sequence[ComparedModel], axis: Axis | None
) -> tuple[Design, list[ComparedModel]]:
    """Return the samples of models over setups as a design, and the models that have any."""
    draws = {member: [member.draws(setup) for setup in setups.values()] for member in models}
    draws = {member: specs for member, specs in draws.items() if any(specs)}
    most = max((len(specs) for by_load in draws.values() for specs in by_load), default=0)
    subjects = np.full((len(draws), most), "", dtype=object)
    points = []
    for load, (label, setup) in enumerate(setups.items()):
        for at, (member, by_load) in enumerate(draws.items()):
            for number, spec in enumerate(by_load[load]):
                subjects[at, number] = spec.subject
                count = f" {number + 1} of {len(by_load[load])}" if len(by_load[load]) > 1 else ""
                name = ": ".join(filter(None, [label, f"{member.label}{count}"]))
                task = Task(setup.rubber_for(spec.model), spec.surface, setup.load, spec.model)
                index = (at, number) if axis is None else (load, at, number)
                points.append(Point(index, name, task))
    sizes = {"model": len(draws), "sample": most}
    names = [member.name for member in draws]
    coords = {"model": names, "subject": (("model", "sample"), subjects)}
    outer = {} if axis is None else {axis.name: len(setups)}
    # the windows come last on the ladder and take the longest: they start first
    return Design(outer | sizes, points[::-1], coords), list(draws)


def windows_left(comparison: SolvedLadder, accuracy: float) -> bool:
    """Return whether more windows would narrow the estimate, and there are more.

    Enough are three that converged, with a factor known to a third of the accuracy wanted, or of
    what the rest of the estimate leaves open.
    """
    samples, pair = comparison.samples, estimates.FINITE_STRAIN
    if not set(pair) <= set(samples["model"].values.tolist()):
        return False
    over, under = (samples.sel(model=member) for member in pair)
    if int((under.subject != "").sum()) < comparison.setups[0].windows:
        return False
    best = comparison.data
    for name, measure in estimates.ESTIMATED.items():
        error = reduce.pair_scatter(over, under, measure)
        interval = f"{name}_half_width"
        left_open = best.get(f"{LARGE_STRAIN}{interval}", best[f"answer_{interval}"])
        whole = np.fmax(accuracy, left_open.fillna(0.0))
        wide = (error.freedom < FEWEST_WINDOWS - 1) | (half_width(error) > whole / 3.0)
        if bool(wide.any()):
            return True
    return False


# Models that predict; the others take a step from one of them to the next.
PREDICTING = ("chain", "chain_half_plane", "chain_upper", "direct", "persson", "klueppel_heinrich")


def at_measured(
    ladder: SolvedLadder,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what the models that predict say at each measured speed, temperature and pressure.

    The result is that of `gripscale.questions.residuals`, with the area term of the case's
    conditions; None where no friction was measured or no model predicts. Of several samples of a
    model the means; beside the direct contact the `answer` of the case. `store` is the folder of
    the predictions; other arguments and errors are those of `gripscale.experiment.Bench`.
    """
    measured, setup = ladder.measured, ladder.setups[0]
    if measured is None:
        return None
    designs: dict[str, list[Design]] = {}
    tasks: dict[str, Task] = {}
    for member in ladder.models:
        specs = member.draws(setup) if member.name in PREDICTING else []
        for number, (predicting, surface, _) in enumerate(specs, start=1):
            label = f"{member.label}{f' {number} of {len(specs)}' if len(specs) > 1 else ''}: "
            met = setup.rubber_for(predicting)
            design = friction.measured_design(measured, predicting, met, surface, setup.load, label)
            designs.setdefault(member.name, []).append(design)
            tasks |= design.tasks
    if not designs:
        return None
    bench = Bench(Store(store), workers, client, on_task)
    answers = bench.solve(tasks, surface_numbers)
    predicted = {
        name: friction.averaged([friction.predicted_of(d.dataset(answers)) for d in parts])
        for name, parts in designs.items()
    }
    if estimates.DIRECT in predicted:
        predicted["answer"] = friction.answers_at(measured, ladder.case, telling_new(bench))
    law = None if setup.conditions is None else setup.conditions.shear_stress
    data = friction.residuals(measured, predicted, law)
    return data.assign_attrs(ladder.case.attributes, measured_source=measured.source)


def _answer(ladder: SolvedLadder) -> xr.Dataset:
    """Return the answer with its factors: of the direct contact, or of waves stated by hand."""
    case, samples, factors = ladder.case, ladder.samples, ladder.factors
    if case.surface.measured is None:
        chain = samples.isel(model=0, sample=0, drop=True)
        names = ["friction", "contact_fraction", "adhesive_friction"]
        return estimate_of_waves(chain[names].where(reduce.converged(chain)))
    contacts = [
        Contact(s.rubber, s.surface, s.load, s.conditions, case.below_measurement)
        for s in ladder.setups
    ]
    about: dict[str, Any] = {"conditions": case.conditions}
    best = estimates.answer_of_samples(samples, factors, contacts=contacts, **about)
    return estimates.with_large_strain(best, samples, factors, **about)


def _steps(ladder: SolvedLadder, name: str) -> list[xr.DataArray]:
    """Return the relative uncertainty of a mean, its factor on the model before, and that of it.

    Over `model`; the last two are NaN for a model that follows none.
    """
    rows = []
    for at, member in enumerate(ladder.models):
        samples = ladder.samples.isel(model=at, drop=True)
        factor = sigma = reduce.usable(samples, name).mean("sample") * np.nan
        if member.follows in ladder.samples["model"].values:
            before = ladder.samples.sel(model=member.follows, drop=True)
            factor, (sigma, _) = reduce.ratio(samples, before, name)
        rows.append((reduce.relative_uncertainty(samples, name), factor, sigma))
    return [xr.concat(parts, "model") for parts in zip(*rows, strict=True)]


def comparison_dataset(comparison: SolvedLadder) -> xr.Dataset:
    """Return means, scatter, factors and the answer of the models of a comparison."""
    samples, setups, axis = comparison.samples, comparison.setups, comparison.axis
    outer = () if axis is None else (axis.name,)
    order = (*outer, "model", "factor", "sample", "wavelength")
    data: dict[str, xr.Variable] = {}

    def add(name: str, values: xr.DataArray, long_name: str, unit: str = "1") -> None:
        ordered = values.transpose(*(dim for dim in order if dim in values.dims))
        data[name] = labelled(ordered.dims, ordered.values, unit, long_name, _SOURCE)

    def by_load(values: Sequence[Any], *dims: str) -> xr.DataArray:
        """Return values of each setup over the axis, or of the only one."""
        return xr.DataArray(np.asarray(values if outer else values[0]), dims=(*outer, *dims))

    for name in reduce.SAMPLED_QUANTITIES:
        text = f"{model.TOTALS[f'total_{name}']}, mean of the samples"
        add(f"total_{name}", reduce.mean(samples, name), text)
    cut_offs = by_load([resolved_wavelength(setup.surface) for setup in setups])
    add("cutoff_wavelength", cut_offs, "shortest wavelength of the roughness", "m")
    wavelength = np.empty(0)  # octaves that hold the curves of all samples
    if "curve_wavelength" in samples:
        smallest = min(setup.surface.cutoff_wavelength for setup in setups)
        ends = reduce.usable(samples, "curve_wavelength")
        wavelength = reduce.octaves(float(ends.max()), float(ends.min()), smallest)
    about = "relative standard uncertainty of the"
    for name, text in _WORDS.items():
        values = reduce.usable(samples, name)
        add(f"{name}_spread", reduce.spread(values), f"standard deviation of the {text}")
        error = reduce.mean(samples, f"{name}_error")
        add(f"{name}_error", error, f"error of the {text} as the model estimates it")
        of_mean, factor, of_factor = _steps(comparison, name)
        add(f"{name}_uncertainty", of_mean, f"{about} mean {text}")
        add(f"{name}_factor", factor, f"{text} over that of the model it follows")
        add(f"{name}_factor_uncertainty", of_factor, f"{about} factor on the {text}")
        add(f"sample_{name}", values, f"{text} by sample")
        running = reduce.running(samples, name, wavelength)
        add(f"running_{name}", running, f"{text} down to the wavelength")
    best = _answer(comparison)
    for name in ANSWER_NUMBERS | LARGE_STRAIN_NUMBERS:
        if name in best and "slope" not in best[name].dims:
            add(name, best[name], best[name].attrs["long_name"])
    adhesive = reduce.mean(samples, "adhesive_friction")
    if adhesive.notnull().any():
        add(model.ADHESIVE_FRICTION, adhesive, "friction coefficient of the area term")
    basis = reduce.outside_band(samples).assign(reduce.cut_off_exponents(samples))
    for name, (_, text) in (model.OUTSIDE_BAND | model.CUT_OFF_EXPONENTS).items():
        add(name, basis[name], text)
    text = "why an exponent of the cut-off is not known"
    add(model.WHY_NO_EXPONENT, basis[model.WHY_NO_EXPONENT], text)
    excited = [
        setup.rubber.outside_band(2.0 * np.pi * setup.load.speed / wavelength).astype(np.int8)
        for setup in setups
    ]
    text = "1 where the wavelength excites the rubber outside the measured frequencies"
    add("outside_band", by_load(excited, "wavelength"), text)
    add("samples", (samples.prediction_status != "").sum("sample"), "number of samples")
    count = reduce.converged(samples).sum("sample")
    add("converged_samples", count, "number of samples that converged")
    add("status", reduce.status(samples), "converged, or what failed")
    add("status_word", reduce.status_word(samples), "word of the status")
    add("seconds", samples.seconds.sum("sample"), "time its samples took", "s")
    loads = [setup.load for setup in setups]
    add("nominal_pressure", by_load([x.pressure for x in loads]), "nominal pressure", "Pa")
    add("nominal_speed", by_load([x.speed for x in loads]), "sliding speed", "m/s")
    words = {
        "label": "the model in words",
        "group": "what it can be asked for with",
        "follows": "model it is compared with",
        "change": "what changes from that model",
    }
    for name, text in words.items():
        column = np.array([getattr(member, name) for member in comparison.models], dtype=object)
        add(name, xr.DataArray(column, dims="model"), text)
    add("factor_label", best.factor_label, "factors of the answer")
    measured, case = comparison.measured, comparison.case
    data |= {} if measured is None else measured_variables(measured)
    coords = {} if axis is None else coordinates([axis], case.units)
    text = "lower end of the octave"
    coords["wavelength"] = labelled("wavelength", wavelength, "m", text, _SOURCE)
    subjects: list[Doubtful] = [setups[0].surface, *comparison.rubbers]
    conditions = setups[0].conditions
    return xr.Dataset(
        data,
        {"model": [member.name for member in comparison.models], **coords},
        {
            "title": "Contact and friction by model",
            **case.attributes,
            **model.input_doubts(subjects, loads, case.units, case.softening_doubts),
            "conditions": json.dumps(conditions and conditions.to_dict()),
            "seeds": setups[0].seeds,
            "tolerance": setups[0].tolerance,
            "measured_source": "" if measured is None else measured.source,
        },
    )
