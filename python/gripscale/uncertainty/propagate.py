"""What is not known of a case, and what it does to friction and contact area.

    from gripscale.uncertainty import Uncertainty, propagate, summary
    data = propagate("case.toml", Uncertainty(without=["waves"]), samples=200, folder="results")
    summary(data)

All sources are drawn at once for each sample, and each sample is a task of `gripscale.study`: kept
as soon as it is solved, on all cores or a cluster.
"""

from __future__ import annotations

import hashlib
import json
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import checks, netcdf
from gripscale.case.read import CaseFile, read_case
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.case.uncertainty_table import FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED
from gripscale.errors import FileError, InputError, RubberWarning
from gripscale.model import Model, NominalLoad
from gripscale.rough.model import DirectContact
from gripscale.software import software
from gripscale.study.axes import axes_of
from gripscale.study.axis import Axis
from gripscale.study.inputs import contents
from gripscale.study.store import Store, store_in
from gripscale.study.task import Task, exact
from gripscale.study.threads import OnTask, solve_all
from gripscale.uncertainty import assemble
from gripscale.uncertainty.assemble import Place
from gripscale.uncertainty.attempt import Attempt
from gripscale.uncertainty.choice import Chosen, Uncertainty
from gripscale.uncertainty.design import Drawn, draws
from gripscale.uncertainty.inputs import Inputs, Measurement
from gripscale.uncertainty.stored import FILES, RESULT, input_digests

MODELS = ("chain", "direct")
VARIED = ("speed", "pressure")
"""Inputs that may be varied beside the samples: those of the load, the same samples at each."""

BOTH = {"chain": ("chain",), "direct": ("direct",), "both": MODELS}
"""Models by the word of a case for one or both of them."""


@dataclass(frozen=True)
class Plan:
    """What is to be sampled: the case, its uncertainty, how often, by which models, over what."""

    file: CaseFile
    uncertainty: Uncertainty
    samples: int
    seed: int
    models: tuple[str, ...]
    axis: Axis | None
    tolerance: float | None
    """Estimated relative error of a direct contact; None: that of its first full grid."""

    @property
    def key(self) -> str:
        """A hash of all the result depends on."""
        stated = {
            "software": software(),
            "case": contents(self.file),
            "uncertainty": exact(self.uncertainty),
            "samples": [self.samples, self.seed],
            "models": list(self.models),
            "tolerance": exact(self.tolerance),
            "axis": None if self.axis is None else [self.axis.name, exact(self.axis.values)],
        }
        return hashlib.sha256(json.dumps(stated, sort_keys=True).encode()).hexdigest()


def propagate(
    case: CaseFile | str | Path,
    uncertainty: Uncertainty | None = None,
    *,
    samples: int | None = None,
    seed: int | None = None,
    models: Sequence[str] | None = None,
    vary: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
) -> xr.Dataset:
    """Sample what is not known of a case and predict each sample.

    Parameters
    ----------
    case : path or CaseFile
        The case; its speed is the one of the prediction.
    uncertainty : Uncertainty, optional
        What is taken to be uncertain; by default what the case states, or every source it has.
    samples : int, optional
        Samples, 10 to 100 000. This, and all that follows, by default as the case states it.
    seed : int, optional
        Seed of the random numbers.
    models : sequence of str, optional
        "chain" (as the case asks for it), "direct", or both.
    vary : mapping, optional
        Speeds or pressures, as for `gripscale.study.Study`; the same samples at each.
    tolerance : float, optional
        Estimated relative error of a direct contact, below 1. Without one it is that of the first
        full grid, about a tenth; asking for less than it has doubles the grid.
    folder : path, optional
        Gets `uncertainty.nc`, and the predictions in `predictions`: what it has is not solved
        again.
    workers, client, on_task
        As for `gripscale.study.solve_all`.

    Returns
    -------
    xarray.Dataset
        Over `model`, what is varied, and `sample`: `friction`, `contact_fraction` and `status`,
        with what was drawn as coordinates of `sample`; `_case` of the case itself; `_quantile`
        over `quantile`; `_grid_error` of each sample of the direct contact, which is in no
        quantile; `failed` samples, which count in no quantile; `_share` of each `source` in
        the variance (see `gripscale.uncertainty.shares`).

    Raises
    ------
    InputError, FileError
        If an argument or a file cannot be used, or a result cannot be written.
    """
    file = case if isinstance(case, CaseFile) else read_case(case)
    stated = file.case.uncertainty
    accuracy = stated.tolerance if tolerance is None else checks.positive("tolerance", tolerance)
    number = stated.samples if samples is None else samples
    plan = Plan(
        file,
        Uncertainty.of_case(stated) if uncertainty is None else uncertainty,
        checks.whole("samples", number, least=FEWEST_SAMPLES, most=MOST_SAMPLES),
        checks.whole("seed", stated.seed if seed is None else seed, least=0, most=MOST_SEED),
        _models(BOTH[stated.model] if models is None else models),
        _axis(vary),
        accuracy,
    )
    known = None if folder is None else stored(plan, folder)
    if known is not None:
        return known
    results = prepare_case(plan.file)
    chosen = plan.uncertainty.of(Measurement.of(results), plan.models)
    with store_in(folder) as store, warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        data = _solved(plan, results, chosen, store, workers, client, on_task)
    if folder is None:
        return data
    return netcdf.load(netcdf.save(data, Path(folder) / RESULT))


def stored(plan: Plan, folder: str | Path) -> xr.Dataset | None:
    """Return the Dataset an earlier run of just this plan left in `folder`, or None."""
    try:
        found = netcdf.load(Path(folder) / RESULT)
    except FileError:
        return None
    return found if found.attrs.get("plan_key") == plan.key else None


def _models(given: Sequence[str]) -> tuple[str, ...]:
    names = [given] if isinstance(given, str) else list(given)
    for name in names:
        checks.one_of("model", name, MODELS)
    if not names or len(set(names)) < len(names):
        raise InputError(f"models must be one or both of chain, direct; got {checks.shown(given)}")
    return tuple(name for name in MODELS if name in names)


def _axis(vary: Mapping[str, Any] | None) -> Axis | None:
    if not vary:
        return None
    axes = axes_of(vary)
    if len(axes) > 1 or axes[0].name not in VARIED:
        names = ", ".join(axis.name for axis in axes)
        raise InputError(f"uncertainty varies one of {', '.join(VARIED)}; got {names}")
    return axes[0]


def _solved(
    plan: Plan,
    results: CaseResults,
    chosen: Chosen,
    store: Store,
    workers: int | None,
    client: Any,
    on_task: OnTask | None,
) -> xr.Dataset:
    case = Inputs.of(Measurement.of(results))
    drawn = list(draws(case, chosen.sources, plan.samples, plan.seed))
    loads = _loads(results.load, plan.axis)
    tasks: dict[Place, Task] = {}
    status: dict[Place, str] = {}
    for name in plan.models:
        model = results.chain if name == "chain" else _direct(results, plan.tolerance)
        for sample, one in enumerate([Drawn(case, {}), *drawn], start=-1):
            places = [Place(name, value, sample) for value in range(len(loads))]
            try:
                tasks |= dict(zip(places, _tasks(one, model, loads), strict=True))
            except InputError as refusal:
                status |= dict.fromkeys(places, str(refusal))
    labels = {_label(place, plan.axis): task for place, task in tasks.items()}
    answers = solve_all(labels, store, workers=workers, client=client, on_task=on_task)
    solved = {place: answers[task.key] for place, task in tasks.items()}
    data = assemble.dataset(plan.models, plan.axis, drawn, chosen, solved, status)
    return data.assign_attrs(
        {FILES: json.dumps(input_digests(plan.file))},
        case=plan.file.text,
        seed=plan.seed,
        plan_key=plan.key,
        software=software(),
    )


def _loads(load: NominalLoad, axis: Axis | None) -> list[NominalLoad]:
    return [load] if axis is None else [replace(load, **{axis.name: v}) for v in axis.values]


def _direct(results: CaseResults, tolerance: float | None) -> DirectContact:
    if results.surface.measured is None:
        raise InputError("the direct contact needs a measured profile; got waves stated by hand")
    return DirectContact(tolerance=tolerance, conditions=results.conditions)


def _tasks(one: Drawn, model: Model, loads: Sequence[NominalLoad]) -> list[Task]:
    """Return the tasks of a sample; raise `InputError` if it cannot be made."""
    if one.inputs is None:
        raise InputError(one.why_not)
    surface, own = one.inputs.for_model(model)
    relevant = own.relevant(surface)
    return [Task(one.inputs.rubber, relevant, load, Attempt(own)) for load in loads]


def _label(place: Place, axis: Axis | None) -> str:
    where = "" if axis is None else f", {axis.name} {axis.labels[place.value]}"
    what = "the case itself" if place.sample < 0 else f"sample {place.sample + 1}"
    return f"{place.model}{where}, {what}"
