"""Solving a comparison: every sample of every rung is a task, kept as soon as it is done."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from gripscale import checks
from gripscale.case.read import CaseFile
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.chain.model import Chain
from gripscale.comparison.estimate import Factor
from gripscale.comparison.ladder import chosen
from gripscale.comparison.result import Comparison, ComparisonOverAxis
from gripscale.comparison.rung import Draw, Rung, Subject
from gripscale.comparison.sample import sample_of
from gripscale.comparison.solved import SolvedRung
from gripscale.errors import InputError
from gripscale.measured.friction import MeasuredFriction
from gripscale.measured.of_case import friction_of_case
from gripscale.rubber.extrapolation import require_measured
from gripscale.study import Study
from gripscale.study.store import Store, store_in
from gripscale.study.task import Task
from gripscale.study.threads import OnTask, solve_all
from gripscale.theory.models import KlueppelHeinrich

VARIED = (
    "speed",
    "pressure",
    "temperature",
    "smallest_wavelength",
    "waves",
    "cut_off",
    "upper_share",
)
"""Inputs a comparison can be made over: numbers of the load and of the surface."""

MOST_SEEDS = 1000


class Choice(NamedTuple):
    """What is compared, how finely, and beside what."""

    seeds: int = 3
    tolerance: float = 0.05
    rungs: Sequence[str] = ()
    measured: MeasuredFriction | None = None
    factors: Sequence[Factor] = ()


def compare_case(
    case: CaseResults | CaseFile | str | Path,
    *,
    seeds: int = 3,
    tolerance: float = 0.05,
    rungs: Sequence[str] = (),
    measured: MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> Comparison:
    """Put the models side by side over the inputs of a case.

    Parameters
    ----------
    case : path, CaseFile or CaseResults
        The case; `prepare_case` gives one with its inputs prepared.
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
    folder : path, optional
        Keeps each answer as soon as it is there, in `predictions`; what it has is not solved again.
    workers, client, on_task
        As for `gripscale.study.solve_all`.

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
    results = case if isinstance(case, CaseResults) else prepare_case(case)
    choice = Choice(seeds, tolerance, rungs, measured, factors)
    task = Task(results.rubber.rubber, results.surface, results.load, results.chain)
    with store_in(folder) as store:
        made = _compared(results.file, {"": task}, choice, store, workers, client, on_task)
    return made[0]


def compare_over(
    case: CaseFile | str | Path,
    vary: Mapping[str, Any],
    *,
    seeds: int = 3,
    tolerance: float = 0.05,
    rungs: Sequence[str] = (),
    measured: MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> ComparisonOverAxis:
    """Put the models side by side over one varied input of a case, such as the speed.

    Parameters
    ----------
    vary : mapping
        One input of numbers with its values, as for `gripscale.study.Study`.
    case, seeds, tolerance, rungs, measured, factors, folder, workers, client, on_task
        As for `compare_case`.

    Raises
    ------
    InputError, FileError
        As for `compare_case`, and if other than one input of numbers is varied.
    """
    study = Study(case, vary, static=False)
    axis = study.axes[0]
    if len(study.axes) > 1 or axis.name not in VARIED:
        names = ", ".join(one.name for one in study.axes)
        raise InputError(f"a comparison varies one of {', '.join(VARIED)}; got {names}")
    if not axis.numeric:
        raise InputError(f"a comparison varies {axis.name} by numbers; got {axis.labels[0]}")
    if len(axis.values) < 2:
        raise InputError(f"{axis.name} must have at least two values; got {axis.labels[0]}")
    choice = Choice(seeds, tolerance, rungs, measured, factors)
    tasks = {point.label: point.task for point in study.points}
    with store_in(folder) as store:
        made = _compared(study.file, tasks, choice, store, workers, client, on_task)
    return ComparisonOverAxis(axis, made)


def _compared(
    file: CaseFile,
    places: Mapping[str, Task],
    choice: Choice,
    store: Store,
    workers: int | None,
    client: Any,
    on_task: OnTask | None,
) -> list[Comparison]:
    """Return the comparison of each rubber, surface and load in `places`."""
    ladder = chosen(choice.rungs)
    subjects = {place: _subject(file, task, choice) for place, task in places.items()}
    if file.case.rubber.extrapolate == "refuse":
        for place, task in places.items():
            require_measured(
                subjects[place].rubber_before, task.surface.sines.wavelength, task.load.speed
            )
    drawn = {
        (place, rung.name): rung.draws(subject)
        for place, subject in subjects.items()
        for rung in ladder
    }
    tasks = {key: [_task(subjects[key[0]], draw) for draw in draws] for key, draws in drawn.items()}
    labels = {rung.name: rung.label for rung in ladder}
    named = {
        _label(place, labels[name], draws, at): tasks[place, name][at]
        for (place, name), draws in drawn.items()
        for at in range(len(draws))
    }
    solved = solve_all(named, store, workers=workers, client=client, on_task=on_task)

    def rung_at(place: str, rung: Rung) -> SolvedRung:
        pairs = zip(drawn[place, rung.name], tasks[place, rung.name], strict=True)
        subject = subjects[place]
        known = (subject.conditions, subject.rubber_before.reference_temperature)
        samples = [sample_of(solved[task.key], draw.of, *known) for draw, task in pairs]
        return SolvedRung(rung, samples)

    measured = choice.measured or friction_of_case(file)
    out = []
    for place, subject in subjects.items():
        met = [rung_at(place, rung) for rung in ladder if drawn[place, rung.name]]
        out.append(Comparison(file, subject, met, measured, choice.factors))
    if not out[0].rungs:
        raise InputError(f"no rung of {', '.join(choice.rungs)} has anything to say of this case")
    return out


def _subject(file: CaseFile, task: Task, choice: Choice) -> Subject:
    theory = file.case.compare
    chain = checks.instance("model", task.model, Chain)
    return Subject(
        task.rubber,
        task.surface,
        task.load,
        chain.solver,
        checks.whole("seeds", choice.seeds, least=1, most=MOST_SEEDS),
        checks.positive("tolerance", choice.tolerance),
        None
        if theory.layer_ratio is None or theory.penetration_depth is None
        else KlueppelHeinrich(theory.layer_ratio, theory.penetration_depth),
        chain.pressure_classes,
        chain.conditions,
    )


def _task(subject: Subject, draw: Draw) -> Task:
    return Task(subject.rubber_for(draw.model), draw.surface, subject.load, draw.model)


def _label(place: str, label: str, draws: Sequence[Draw], at: int) -> str:
    """Return what one sample is called while it is solved."""
    number = f" {at + 1} of {len(draws)}" if len(draws) > 1 else ""
    return ": ".join(filter(None, [place, f"{label}{number}"]))
