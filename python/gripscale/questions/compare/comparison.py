"""Solving a comparison: every sample of every rung is a task, kept as soon as it is done."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.experiment.design import Design, Point, solve_design, surface_numbers
from gripscale.experiment.measured_friction import MeasuredFriction
from gripscale.experiment.solve import Bench, OnTask, Progress
from gripscale.experiment.task import Store, Task
from gripscale.questions.answer import samples as reduce
from gripscale.questions.answer.best_estimate import ESTIMATED, FINITE_STRAIN, Factor
from gripscale.questions.answer.intervals import half_width
from gripscale.questions.calibration import measured_comparison as friction
from gripscale.questions.compare.comparison_dataset import SolvedLadder
from gripscale.questions.compare.ladder import WINDOWS, ComparisonSetup, Rung, chosen
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


OnStage = Callable[[SolvedLadder], None]
"""Called with the comparison as it stands, while more samples are solved."""


def solved_ladder(
    case: Case,
    vary: Mapping[str, Any] | None,
    bench: Bench,
    *,
    seeds: int,
    tolerance: float,
    rungs: Sequence[str],
    measured: MeasuredFriction | None,
    factors: Sequence[Factor],
    accuracy: float,
    on_stage: OnStage | None,
) -> SolvedLadder:
    """Return the rungs of a case with their samples; arguments and errors as of `compare`."""
    tasks = {"": Task(case.rubber, case.surface, case.load, case.chain)}
    rubbers: Sequence[MeasuredRubber] = [case.measured_rubber]
    axis: Axis | None = None
    if vary is not None:
        study = Study(case, vary, static=False, model=Chain.name)
        axis = _axis(study)
        tasks = {point.label: point.task for point in study.points}
        rubbers = study.measured_rubbers
    setups = []
    for task in tasks.values():
        chain = checks.instance("model", task.model, Chain)
        setup = ComparisonSetup(
            task.rubber,
            task.surface,
            task.load,
            chain.solver,
            checks.whole("seeds", seeds, least=1, most=MOST_SEEDS),
            checks.positive("tolerance", tolerance),
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

    shown = bench.on_task

    def of_new_tasks(progress: Progress) -> None:
        if shown is not None and not progress.stored:
            shown(progress)

    wanted = chosen(rungs)
    quick = [rung for rung in wanted if rung.group != WINDOWS]
    asked: Sequence[Rung] = quick or wanted
    while True:
        design, solved = _design(setups, list(tasks), asked, axis)
        if not solved:
            raise InputError(
                f"no rung of {', '.join(rungs)} applies to this case; windows and maps "
                "need measured profiles, klueppel_heinrich the parameters of [compare]"
            )
        numbers = partial(reduce.sample_numbers, conditions=setups[0].conditions)
        samples = solve_design(design, bench, numbers)
        ladder = SolvedLadder(
            case, setups, solved, samples, axis, measured or case.friction, factors, rubbers
        )
        if on_stage is not None:
            on_stage(ladder)
        if len(asked) < len(wanted):
            asked = wanted
        elif _windows_left(ladder, accuracy):
            setups = [replace(setup, windows=setup.windows + 1) for setup in setups]
        else:
            return ladder
        bench = replace(bench, on_task=of_new_tasks)


def _axis(study: Study) -> Axis:
    """Return the varied input of a comparison; raise `InputError` unless it is one of numbers."""
    axis = study.axes[0]
    if len(study.axes) > 1 or axis.name not in COMPARED_OVER:
        names = ", ".join(other.name for other in study.axes)
        raise InputError(f"a comparison varies one of {', '.join(COMPARED_OVER)}; got {names}")
    if not axis.numeric:
        raise InputError(f"a comparison varies {axis.name} by numbers; got {axis.labels[0]}")
    if len(axis.values) < 2:
        raise InputError(f"{axis.name} must have at least two values; got {axis.labels[0]}")
    return axis


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


def _windows_left(comparison: SolvedLadder, accuracy: float) -> bool:
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


PREDICTING = ("chain", "chain_half_plane", "chain_upper", "direct", "persson", "klueppel_heinrich")
"""Rungs that predict; the others take a step from one of them to the next."""


def at_measured(
    ladder: SolvedLadder,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what the rungs that predict say at each measured speed, temperature and pressure.

    Parameters
    ----------
    ladder : SolvedLadder
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
    measured, setup = ladder.measured, ladder.setups[0]
    if measured is None:
        return None
    designs: dict[str, list[Design]] = {}
    for rung in ladder.rungs:
        if rung.name not in PREDICTING:
            continue
        specs = rung.draws(setup)
        designs[rung.name] = []
        for number, (model, surface, _) in enumerate(specs, start=1):
            label = f"{rung.label}{f' {number} of {len(specs)}' if len(specs) > 1 else ''}: "
            met = setup.rubber_for(model)
            design = friction.measured_design(measured, model, met, surface, setup.load, label)
            designs[rung.name].append(design)
    if not designs:
        return None
    tasks = {
        key: task for parts in designs.values() for d in parts for key, task in d.tasks.items()
    }
    answers = Bench(Store(store), workers, client, on_task).solve(tasks, surface_numbers)
    predicted = {
        name: friction.averaged([friction.predicted_of(d.dataset(answers)) for d in parts])
        for name, parts in designs.items()
    }
    law = None if setup.conditions is None else setup.conditions.shear_stress
    data = friction.residuals(measured, predicted, law)
    return data.assign_attrs(ladder.case.attributes, measured_source=measured.source)
