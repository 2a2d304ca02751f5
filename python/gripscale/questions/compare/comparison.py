"""Solving a comparison: every sample of every rung is a task, kept as soon as it is done."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.experiment.design import Design, Point, solve_design, surface_numbers
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.experiment.task import Store, Task
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.best_estimate import (
    ESTIMATED,
    FINITE_STRAIN,
    Factor,
)
from gripscale.questions.answer.direct_contact import continuation_factors, continued_curve
from gripscale.questions.answer.intervals import half_width
from gripscale.questions.calibration import measured_comparison
from gripscale.questions.compare.comparison_dataset import Comparison
from gripscale.questions.compare.ladder import (
    WINDOWS,
    ComparisonSetup,
    Rung,
    chosen,
)
from gripscale.questions.vary.axis import Axis
from gripscale.questions.vary.study import Study
from gripscale.rubber.extrapolation import require_measured
from gripscale.rubber.measured_rubber import MeasuredRubber

COMPARED_OVER = (
    "speed",
    "pressure",
    "temperature",
    "smallest_wavelength",
    "waves",
    "cut_off",
    "top_height_fraction",
)
"""Inputs a comparison can be made over: numbers of the load and of the surface."""

MOST_SEEDS = 1000
FEWEST_WINDOWS = 3
"""Windows whose scatter is believed."""


OnStage = Callable[[Comparison], None]
"""Called with the comparison as it stands, while more samples are solved."""


class ComparisonOptions(NamedTuple):
    """What is compared, how finely, and beside what."""

    seeds: int = 3
    tolerance: float = 0.05
    rungs: Sequence[str] = ()
    measured: MeasuredFriction | None = None
    factors: Sequence[Factor] = ()
    accuracy: float = 0.1
    on_stage: OnStage | None = None


def compare_case(
    case: Case,
    *,
    seeds: int = 3,
    tolerance: float = 0.05,
    rungs: Sequence[str] = (),
    measured: MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    accuracy: float = 0.1,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_stage: OnStage | None = None,
) -> Comparison:
    """Put the models side by side over the inputs of a case.

    Parameters
    ----------
    case : Case
        The case.
    seeds : int
        Random phases drawn of each surface.
    tolerance : float
        Estimated relative error of each direct contact.
    rungs : sequence of str
        Names and groups of the rungs wanted, see `LADDER`; by default all.
    measured : MeasuredFriction, optional
        Friction measured elsewhere; what `[measured] friction` of the case names by default.
    factors : sequence of Factor
        Factors of the best estimate known from elsewhere.
    accuracy : float
        Half width of the 90 % interval wanted, relative: windows are solved at finite strain until
        their factor is known to a third of it, or of what the rest of the estimate leaves open.
    folder : path, optional
        Keeps each answer as soon as it is there, in `predictions`; what it has is not solved again.
    workers, client, on_task
        As for `gripscale.experiment.solve_all`.
    on_stage : callable, optional
        Called with the `Comparison` as it stands, while more samples are solved.

    Returns
    -------
    Comparison
        Without a measured profile only the chain and its own waves at once. A sample that did not
        converge counts in no mean, and its rung says so.

    Raises
    ------
    InputError, FileError
        If an input cannot be used by a model, a result cannot be written, or the case refuses
        extrapolation and a wave excites the rubber beyond the measured band.
    """
    factors = [*continuation_factors(case, continued_curve(case, case.load, folder)), *factors]
    choice = ComparisonOptions(seeds, tolerance, rungs, measured, factors, accuracy, on_stage)
    task = Task(case.rubber, case.surface, case.load, case.chain)
    with bench_in(folder, workers, client, on_task) as bench:
        return _compared(case, {"": task}, [case.measured_rubber], choice, None, bench)


def compare_over(
    case: Case,
    vary: Mapping[str, Any],
    *,
    seeds: int = 3,
    tolerance: float = 0.05,
    rungs: Sequence[str] = (),
    measured: MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    accuracy: float = 0.1,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_stage: OnStage | None = None,
) -> Comparison:
    """Put the models side by side over one varied input of a case, such as the speed.

    Parameters
    ----------
    vary : mapping
        One input of numbers with its values, as for `gripscale.questions.Study`.
    case, seeds, tolerance, rungs, measured, factors, accuracy, folder
        As for `compare_case`.
    workers, client, on_task, on_stage
        As for `compare_case`.

    Raises
    ------
    InputError, FileError
        As for `compare_case`, and if other than one input of numbers is varied.
    """
    study = Study(case, vary, static=False, model=Chain.name)
    axis = study.axes[0]
    if len(study.axes) > 1 or axis.name not in COMPARED_OVER:
        names = ", ".join(other.name for other in study.axes)
        raise InputError(f"a comparison varies one of {', '.join(COMPARED_OVER)}; got {names}")
    if not axis.numeric:
        raise InputError(f"a comparison varies {axis.name} by numbers; got {axis.labels[0]}")
    if len(axis.values) < 2:
        raise InputError(f"{axis.name} must have at least two values; got {axis.labels[0]}")
    choice = ComparisonOptions(seeds, tolerance, rungs, measured, factors, accuracy, on_stage)
    tasks = {point.label: point.task for point in study.points}
    with bench_in(folder, workers, client, on_task) as bench:
        return _compared(case, tasks, study.measured_rubbers, choice, axis, bench)


def _compared(
    case: Case,
    tasks: Mapping[str, Task],
    rubbers: Sequence[MeasuredRubber],
    choice: ComparisonOptions,
    axis: Axis | None,
    bench: Bench,
) -> Comparison:
    """Return the comparison of the rubber, surface and load of each of `tasks`, by its label."""
    measured = choice.measured or case.friction
    setups = []
    for task in tasks.values():
        chain = checks.instance("model", task.model, Chain)
        setup = ComparisonSetup(
            task.rubber,
            task.surface,
            task.load,
            chain.solver,
            checks.whole("seeds", choice.seeds, least=1, most=MOST_SEEDS),
            checks.positive("tolerance", choice.tolerance),
            case.klueppel_heinrich,
            chain.pressure_classes,
            continuation=case.continuation(),
            conditions=chain.conditions,
        )
        setups.append(setup)
    if case.chain.extrapolate == "refuse":
        for setup in setups:
            wavelength, speed = setup.surface.sines.wavelength, setup.load.speed
            require_measured(setup.rubber_before, wavelength, speed)
    wanted = chosen(choice.rungs)
    quick = [rung for rung in wanted if rung.group != WINDOWS]
    make = partial(
        Comparison, case, axis=axis, measured=measured, factors=choice.factors, rubbers=rubbers
    )
    rungs: Sequence[Rung] = quick or wanted
    while True:
        design, rungs = _design(setups, list(tasks), rungs, axis)
        if not rungs:
            raise InputError(
                f"no rung of {', '.join(choice.rungs)} applies to this case; windows and maps "
                "need measured profiles, klueppel_heinrich the parameters of [compare]"
            )
        numbers = partial(reduce.sample_numbers, conditions=setups[0].conditions)
        comparison = make(setups=setups, rungs=rungs, samples=solve_design(design, bench, numbers))
        if choice.on_stage is not None:
            choice.on_stage(comparison)
        if quick and len(quick) < len(wanted):
            quick, rungs = [], wanted
        elif _windows_left(comparison, choice.accuracy):
            setups = [replace(setup, windows=setup.windows + 1) for setup in setups]
        else:
            return comparison
        bench = replace(bench, on_task=_of_new_tasks(bench.on_task))


def _design(
    setups: Sequence[ComparisonSetup],
    labels: Sequence[str],
    rungs: Sequence[Rung],
    axis: Axis | None,
) -> tuple[Design, list[Rung]]:
    """Return the samples of rungs over setups as a design, and the rungs that have any."""
    draws = {rung: [rung.draws(setup) for setup in setups] for rung in rungs}
    draws = {rung: specs for rung, specs in draws.items() if any(specs)}
    most = max((len(specs) for by_load in draws.values() for specs in by_load), default=0)
    subjects = np.full((len(draws), most), "", dtype=object)
    points = []
    for load, (label, setup) in enumerate(zip(labels, setups, strict=True)):
        for at, (rung, by_load) in enumerate(draws.items()):
            for number, spec in enumerate(by_load[load]):
                subjects[at, number] = spec.subject
                count = f" {number + 1} of {len(by_load[load])}" if len(by_load[load]) > 1 else ""
                name = ": ".join(filter(None, [label, f"{rung.label}{count}"]))
                task = Task(setup.rubber_for(spec.model), spec.surface, setup.load, spec.model)
                index = (at, number) if axis is None else (load, at, number)
                points.append(Point(index, name, task))
    sizes = {"rung": len(draws), "sample": most}
    coords = {"rung": [rung.name for rung in draws], "subject": (("rung", "sample"), subjects)}
    outer = {} if axis is None else {axis.name: len(setups)}
    return Design(outer | sizes, points, coords), list(draws)


def _windows_left(comparison: Comparison, accuracy: float) -> bool:
    """Return whether more windows would narrow the estimate, and there are more.

    Enough are three that converged, with a factor known to a third of the accuracy wanted, or to a
    third of what the rest of the estimate leaves open.
    """
    samples, names = comparison.samples, comparison.samples["rung"].values.tolist()
    if not {FINITE_STRAIN.over, FINITE_STRAIN.under} <= set(names):
        return False
    over, under = (samples.sel(rung=rung) for rung in (FINITE_STRAIN.over, FINITE_STRAIN.under))
    if int((under.subject != "").sum()) < comparison.setups[0].windows:
        return False
    best = comparison.data
    for name, measure in ESTIMATED.items():
        error = reduce.pair_scatter(over, under, measure)
        whole = np.fmax(accuracy, best[f"best_{name}_half_width"].fillna(0.0))
        if bool((error.freedom < FEWEST_WINDOWS - 1).any()) or bool(
            (half_width(error) > whole / 3.0).any()
        ):
            return True
    return False


def _of_new_tasks(on_task: OnTask | None) -> OnTask | None:
    """Return `on_task` without the tasks that were solved before."""
    if on_task is None:
        return None
    return lambda progress: None if progress.stored else on_task(progress)


PREDICTING = ("chain", "chain_half_plane", "chain_upper", "direct", "persson", "klueppel_heinrich")
"""Rungs that predict; the others take a step from one of them to the next."""


def at_measured(
    comparison: Comparison,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what the rungs that predict say at each measured speed, temperature and pressure.

    Parameters
    ----------
    comparison : Comparison
        Under one load, with what was measured.
    store : path
        Folder of the finished predictions.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    xarray.Dataset or None
        As `gripscale.questions.residuals`, with the area term of the case's conditions; None where
        no friction was measured or no rung predicts. Of several samples of a rung the means.

    Raises
    ------
    InputError, FileError
        As `predictions_at`.
    """
    measured, setup = comparison.measured, comparison.setups[0]
    if measured is None:
        return None
    designs: dict[str, list[Design]] = {}
    tasks: dict[str, Task] = {}
    for rung in comparison.rungs:
        if rung.name not in PREDICTING:
            continue
        specs = rung.draws(setup)
        designs[rung.name] = []
        for number, (model, surface, _) in enumerate(specs, start=1):
            label = f"{rung.label}{f' {number} of {len(specs)}' if len(specs) > 1 else ''}: "
            met = setup.rubber_for(model)
            design = measured_comparison.measured_design(
                measured, model, met, surface, setup.load, label
            )
            designs[rung.name].append(design)
            tasks |= design.tasks
    if not designs:
        return None
    answers = Bench(Store(store), workers, client, on_task).solve(tasks, surface_numbers)
    predicted = {}
    for name, parts in designs.items():
        samples = [measured_comparison.predicted_of(part.dataset(answers)) for part in parts]
        predicted[name] = measured_comparison.averaged(samples)
    law = None if setup.conditions is None else setup.conditions.shear_stress
    data = measured_comparison.residuals(measured, predicted, law)
    return data.assign_attrs(comparison.case.attributes, measured_source=measured.source)
