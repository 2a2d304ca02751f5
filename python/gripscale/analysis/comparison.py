"""Solving a comparison: every sample of every rung is a task, kept as soon as it is done."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from gripscale.analysis.best_estimate import Factor, Sample, SolvedRung, sample_of
from gripscale.analysis.comparison_dataset import Comparison, ComparisonOverAxis
from gripscale.analysis.ladder import (
    DIRECT,
    LADDER,
    ComparisonSetup,
    Rung,
    SampleSpec,
    chosen,
    each_measured,
)
from gripscale.analysis.measured_comparison import (
    Predicted,
    averaged,
    friction_of_case,
    predictions_at,
    residuals,
)
from gripscale.analysis.measured_friction import MeasuredFriction
from gripscale.case.read import CaseFile
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.chain.chain import Chain
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.experiment.study import Study
from gripscale.experiment.task import Store, Task
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import TOTALS, answer, with_area_term
from gripscale.rubber.extrapolation import require_measured
from gripscale.theory.models import KlueppelHeinrich

if TYPE_CHECKING:
    import xarray as xr


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
        As for `gripscale.experiment.solve_all`.

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
    with bench_in(folder, workers, client, on_task) as bench:
        made = _compared(results.file, {"": task}, choice, bench)
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
        One input of numbers with its values, as for `gripscale.experiment.Study`.
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
    with bench_in(folder, workers, client, on_task) as bench:
        made = _compared(study.file, tasks, choice, bench)
    return ComparisonOverAxis(axis, made)


def _compared(
    file: CaseFile,
    places: Mapping[str, Task],
    choice: Choice,
    bench: Bench,
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
    solved = bench.solve(named)

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


def _subject(file: CaseFile, task: Task, choice: Choice) -> ComparisonSetup:
    theory = file.case.compare
    chain = checks.instance("model", task.model, Chain)
    return ComparisonSetup(
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


def _task(subject: ComparisonSetup, draw: SampleSpec) -> Task:
    return Task(subject.rubber_for(draw.model), draw.surface, subject.load, draw.model)


def _label(place: str, label: str, draws: Sequence[SampleSpec], at: int) -> str:
    """Return what one sample is called while it is solved."""
    number = f" {at + 1} of {len(draws)}" if len(draws) > 1 else ""
    return ": ".join(filter(None, [place, f"{label}{number}"]))


# The models of a comparison at the points of a measurement: predicted beside measured friction.

ASKED = ("chain", "chain_half_plane", "chain_upper", "direct", "persson", "klueppel_heinrich")
"""Rungs that predict; the others take a step from one of them to the next."""


def at_measured(
    made: Comparison,
    store: str | Path,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset | None:
    """Return what the rungs that predict say at each measured speed, temperature and pressure.

    Parameters
    ----------
    made : Comparison
        With the rungs that were asked for, and measured friction.
    store : path
        Folder of finished predictions: what it has is not solved again.
    workers, client, on_task
        As for `gripscale.experiment.solve_all`.

    Returns
    -------
    xarray.Dataset or None
        As `gripscale.analysis.residuals`, over `model`; None without measured friction. The total
        is the hysteresis where a model knows no contact area.

    Raises
    ------
    InputError
        If a temperature was measured and the rubber has no shift to it.
    """
    measured, subject = made.measured, made.subject
    if measured is None:
        return None
    options: dict[str, Any] = {"workers": workers, "client": client, "on_task": on_task}
    there = [rung for rung in LADDER if rung.name in ASKED and rung.name in made.by_name]
    predicted = {
        rung.name: averaged(
            [
                predictions_at(
                    measured,
                    draw.model,
                    subject.rubber_for(draw.model),
                    draw.surface,
                    subject.load,
                    Store(store),
                    **options,
                )
                for draw in rung.draws(subject)
            ]
        )
        for rung in there
    }
    if not predicted:
        return None
    return _told(measured, subject, predicted, made.file.text)


def _told(
    measured: MeasuredFriction, subject: ComparisonSetup, predicted: dict[str, Predicted], case: str
) -> xr.Dataset:
    law = None if subject.conditions is None else subject.conditions.shear_stress
    data = residuals(measured, predicted, law)
    return data.assign_attrs(case=case, measured_source=measured.source)


# What a run can afford to know of its chain: the direct contact of the measured profiles.

JUDGED_TO = 0.1
"""Estimated relative error of the contact that every run judges its chain by."""
FILE = "direct.nc"
"""What it is kept in, beside the result."""


def solve_reference(results: CaseResults) -> SolvedRung | None:
    """Return the direct contact of the measured profiles, at the speed of the case.

    Parameters
    ----------
    results : CaseResults
        The prepared case; its conditions change the rubber of the direct contact, too.

    Returns
    -------
    SolvedRung or None
        A sample for each profile, solved to an estimated relative error of `JUDGED_TO`, 10 %; None
        if no profile was measured.

    Raises
    ------
    InputError
        If the direct contact cannot use the rubber or a profile.
    """
    rung = next(one for one in LADDER if one.name == DIRECT)
    model = DirectContact(tolerance=JUDGED_TO, conditions=results.conditions)
    rubber, load = results.rubber.rubber, results.load
    samples: list[Sample] = []
    for name, surface in each_measured(results.surface):
        clock = time.perf_counter()
        answer = model.predict(rubber, surface, load)
        answer.attrs["seconds"] = time.perf_counter() - clock
        samples.append(sample_of(answer, name))
    return SolvedRung(rung, samples) if samples else None


def save_reference(results: CaseResults, folder: str | Path) -> xr.Dataset | None:
    """Solve the reference contact of a case; keep its totals in `results` and in `folder`.

    Raises `FileError` if it cannot be written.
    """
    direct = solve_reference(results)
    if direct is None:
        return None
    data = reference_totals(direct, results)
    netcdf.save(data, Path(folder) / FILE)
    results.direct = data
    return data


def reference_totals(direct: SolvedRung, results: CaseResults) -> xr.Dataset:
    """Return the means of `direct` over the profiles as a model answers with its totals."""
    import xarray as xr

    totals = {name: direct.mean(name.removeprefix("total_")) for name in TOTALS}
    found = answer(
        xr.Dataset(), totals, direct.status, direct.name, results.load, direct.extrapolation,
        direct.cut_off_exponents,
    )  # fmt: skip
    named = found.assign_attrs(case=results.file.text, tolerance=JUDGED_TO)
    return with_area_term(named, direct.mean("adhesive_friction"))
