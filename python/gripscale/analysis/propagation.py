"""What is not known of a case, and what it does to friction and contact area.

    from gripscale.analysis import Uncertainty, propagate, summary
    data = propagate("case.toml", Uncertainty(without=["waves"]), samples=200, folder="results")
    summary(data)

All sources are drawn at once for each sample, and each sample is a task of
`gripscale.experiment`: kept as soon as it is solved, on all cores or a cluster.
"""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.analysis.sampled_inputs import FailSafeModel, Inputs, Measurement
from gripscale.analysis.sampling import Chosen, SampledInputs, Uncertainty, draws
from gripscale.analysis.sources import Source
from gripscale.analysis.variance_shares import shares
from gripscale.case.read import CaseFile, read_case
from gripscale.case.results import CaseResults
from gripscale.case.run import prepare_case
from gripscale.case.tables import FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED
from gripscale.core import checks, provenance
from gripscale.core.errors import FileError, InputError, RubberWarning
from gripscale.core.provenance import software
from gripscale.core.units import GIVEN
from gripscale.experiment.axis import LONG_NAMES, UNITS, Axis, axes_of
from gripscale.experiment.inputs import contents, digest
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.experiment.task import Task, canonical_json
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import FRICTION_OUTSIDE_BAND, Model, NominalLoad

# Quantiles of what the samples answered, and the sentence on them that other reports quote.

LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
"""The quantiles that are told."""

QUANTITIES = {
    "friction": ("mu", "friction coefficient"),
    "contact_fraction": ("A_r/A_0", "real over nominal contact area"),
}
"""What each sample answers: its letters and its name."""


def quantiles(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the quantiles over the last axis, shape (levels, ...), NaN not counting.

    Median-unbiased (R. J. Hyndman & Y. Fan, Am. Stat. 50 (1996) 361,
    doi:10.1080/00031305.1996.10473566, their number 8): the ends of few samples are not drawn in.
    """
    found = np.full((len(LEVELS), *values.shape[:-1]), np.nan)
    for place in np.ndindex(values.shape[:-1]):
        known = values[place][np.isfinite(values[place])]
        if known.size > 1:
            found[(slice(None), *place)] = np.quantile(known, LEVELS, method="median_unbiased")
    return found


def summary(data: xr.Dataset) -> str:
    """Return friction and contact fraction of each model in a sentence, failures counted.

    Parameters
    ----------
    data : xarray.Dataset
        Of `propagate`, at one load.
    """
    return "; ".join(_of_model(data.sel(model=name)) for name in data.model.values)


def _of_model(one: xr.Dataset) -> str:
    failed, number = int(one.failed), one.sizes["sample"]
    count = f"{number} samples" if not failed else f"{number - failed} of {number} samples"
    told = [
        _interval(letters, one[f"{name}_quantile"].values)
        for name, (letters, _) in QUANTITIES.items()
        if np.isfinite(one[f"{name}_quantile"].values).all()
    ]
    if not told:
        return f"{one.model.item()}: none of {number} samples has an answer"
    text = f"{one.model.item()}: {', '.join(told)} in 90 % of {count}"
    return f"{text}, {failed} failed" if failed else text


def _interval(letters: str, values: NDArray[np.float64]) -> str:
    low, middle, high = (f"{value:#.2g}" for value in values[[0, 2, 4]])
    return f"{letters} = {middle} ({low} to {high})"


# From the answers of all samples to one Dataset: what was drawn beside what came of it.

Array = NDArray[np.float64]

CONVERGED = "converged"
NUMBERS = {
    "friction": ("total_friction", "1", "friction coefficient"),
    "contact_fraction": ("total_contact_fraction", "1", "real over nominal contact area"),
    "outside_band": (
        FRICTION_OUTSIDE_BAND,
        "1",
        "share of the friction that rests on the rubber outside the measured frequencies",
    ),
}
"""What is kept of each answer: its name there, unit and meaning."""


class TaskKey(NamedTuple):
    """One prediction: of which model, at which value of the axis, of which sample.

    The case itself is sample -1.
    """

    model: str
    value: int
    sample: int


def dataset(
    models: Sequence[str],
    axis: Axis | None,
    drawn: Sequence[SampledInputs],
    chosen: Chosen,
    solved: Mapping[TaskKey, xr.Dataset],
    refused: Mapping[TaskKey, str],
) -> xr.Dataset:
    """Return all samples over model, axis and sample, with quantiles and shares.

    Parameters
    ----------
    models, axis
        The dimensions beside `sample`; no axis for one load.
    drawn, chosen
        What was drawn in each sample, and of which sources.
    solved, refused
        The answers, and why there is none.
    """
    values = 1 if axis is None else len(axis.values)
    shape = (len(models), values, len(drawn) + 1)
    errors = [f"{name}_grid_error" for name in QUANTITIES]
    kept = {name: np.full(shape, np.nan) for name in (*NUMBERS, *errors, "seconds")}
    status = np.full(shape, "", dtype=object)
    for at in np.ndindex(shape):
        place = TaskKey(models[at[0]], at[1], at[2] - 1)
        status[at] = refused.get(place, "")
        if place in solved:
            answer = solved[place]
            status[at] = str(answer["prediction_status"].item())
            kept["seconds"][at] = float(answer.attrs.get("seconds", math.nan))
            if status[at] == CONVERGED:
                for name, (theirs, *_) in NUMBERS.items():
                    kept[name][at] = float(answer[theirs])
                for name in QUANTITIES:
                    kept[f"{name}_grid_error"][at] = _grid_error(answer, name)
    named = _Named(axis)
    samples = {name: values[..., 1:] for name, values in kept.items()}
    data: dict[str, Any] = {
        name: named(samples[name], ("sample",), unit, text)
        for name, (_, unit, text) in NUMBERS.items()
    }
    data |= {
        f"{name}_case": named(kept[name][..., 0], (), "1", f"{text} of the case itself")
        for name, (_, text) in QUANTITIES.items()
    }
    for name, (_, text) in QUANTITIES.items():
        about = f"estimated relative error of the grid of a direct contact, {text}"
        error = samples[f"{name}_grid_error"]
        data[f"{name}_grid_error"] = named(error, ("sample",), "1", about)
    data["seconds"] = named(samples["seconds"], ("sample",), "s", "time it took to solve")
    data["status"] = named(status[..., 1:], ("sample",), "1", "converged, or why not")
    data["status_case"] = named(status[..., 0], (), "1", "converged, or why not, the case itself")
    failed = (status[..., 1:] != CONVERGED).sum(axis=-1)
    data["failed"] = named(failed, (), "1", "samples without an answer; they count in no quantile")
    for name, (_, text) in QUANTITIES.items():
        found = np.moveaxis(quantiles(samples[name]), 0, -1)
        data[f"{name}_quantile"] = named(found, ("quantile",), "1", text)
        data |= _shares(named, name, samples[name], _coordinates(drawn, chosen.sources))
    coordinates: dict[str, Any] = {
        "model": list(models),
        "quantile": ("quantile", list(LEVELS), {"units": "1", "long_name": "share below"}),
        "source": ("source", [s.name for s in chosen.sources], {"long_name": "source"}),
        "label": ("source", [s.label for s in chosen.sources], {"long_name": "source in words"}),
        "end": ("end", ["low", "high"]),
        **_drawn(drawn, chosen.sources),
    }
    if axis is not None:
        attrs = {"units": UNITS[axis.name], "long_name": LONG_NAMES[axis.name], GIVEN: axis.unit}
        coordinates[axis.name] = (axis.name, list(axis.values), attrs)
    return xr.Dataset(data, coordinates).assign_attrs(
        title="Uncertainty of real contact area and friction of rubber on a rough surface",
        left_out=json.dumps(chosen.left_out),
        **provenance.attributes(),
    )


def _grid_error(answer: xr.Dataset, name: str) -> float:
    """Return the relative error a direct contact estimates of its grid, NaN of other models."""
    if not {"weight", f"{name}_error"} <= set(answer.data_vars):
        return math.nan
    total = abs(float(answer[f"total_{name}"]))
    error = float((answer["weight"] * answer[f"{name}_error"]).sum())
    return error / total if total > 0.0 else math.nan


class _Named:
    """Makes variables over model and axis; without an axis its dimension of one is dropped."""

    def __init__(self, axis: Axis | None) -> None:
        self.axis = axis

    def __call__(
        self, values: NDArray[Any], dims: tuple[str, ...], unit: str, long_name: str
    ) -> xr.Variable:
        attrs = {"units": unit, "long_name": long_name}
        if self.axis is None:
            return xr.Variable(("model", *dims), values[:, 0], attrs)
        return xr.Variable(("model", self.axis.name, *dims), values, attrs)


def _drawn(drawn: Sequence[SampledInputs], sources: Sequence[Source]) -> dict[str, Any]:
    """Return the coordinates of the draws over `sample`, each with its source."""
    return {
        name: (
            "sample",
            [one.coordinates[name] for one in drawn],
            {"units": told.unit, "long_name": told.long_name, "source": source.name},
        )
        for source in sources
        for name, told in source.coordinates.items()
    }


def _coordinates(drawn: Sequence[SampledInputs], sources: Sequence[Source]) -> dict[str, Array]:
    """Return the logarithms that describe the draws of each source, shape (samples, numbers)."""
    found = {}
    for source in sources:
        columns = [
            np.array([one.coordinates[name] for one in drawn], dtype=float)
            for name in source.coordinates
        ]
        logs = [told.logarithm for told in source.coordinates.values()]
        found[source.name] = np.stack(
            [c if is_log else np.log(c) for c, is_log in zip(columns, logs, strict=True)], axis=-1
        )
    return found


def _shares(
    named: _Named, name: str, samples: Array, coordinates: dict[str, Array]
) -> dict[str, xr.Variable]:
    """Return share, its error, the error of differences and the ends of each source."""
    outer, count = samples.shape[:-1], len(coordinates)
    share, error = np.full((*outer, count), np.nan), np.full((*outer, count), np.nan)
    apart, ends = np.full((*outer, count, count), np.nan), np.full((*outer, count, 2), np.nan)
    unexplained = np.full(outer, np.nan)
    for place in np.ndindex(outer):
        found = shares(samples[place], coordinates)
        if found is not None:
            share[place], error[place], apart[place] = found.share, found.error, found.apart
            ends[place] = np.stack([found.low, found.high], axis=-1)
            unexplained[place] = found.unexplained
    of = f"in the variance of the logarithm of {QUANTITIES[name][1]}"
    return {
        f"{name}_share": named(share, ("source",), "1", f"share of each source {of}"),
        f"{name}_share_error": named(error, ("source",), "1", "standard error of the share"),
        f"{name}_share_difference_error": named(
            apart, ("source", "other_source"), "1", "standard error of the difference of two shares"
        ),
        f"{name}_end": named(
            ends,
            ("source", "end"),
            "1",
            f"{QUANTITIES[name][1]}, at 5 and 95 % of what a source alone does",
        ),
        f"{name}_unexplained": named(unexplained, (), "1", f"share of no source {of}"),
    }


# The uncertainty that was sampled of a case, found again beside its other results.

FOLDER, RESULT = "uncertainty", "uncertainty.nc"
"""Where it is in the results folder of the case."""

NO_INPUTS = ("uncertainty", "measured", "output", "compare")
"""Tables of a case that change no prediction of it."""

FILES = "file_sha256"
"""Attribute of the result: digests of the files the case names, as JSON."""


def stored_uncertainty(results: Path) -> xr.Dataset | None:
    """Return the uncertainty in the results folder of a case, or None if there is none whole."""
    try:
        return netcdf.load(results / FOLDER / RESULT)
    except FileError:
        return None


def input_digests(file: CaseFile) -> list[str]:
    """Return the digests of the files that predictions of a case depend on.

    Raises `FileError` if one cannot be read.
    """
    named = [name for role, name in file.case.named_files() if role != "measured"]
    return [digest(file.resolve(name)) for name in named]


def of_same_inputs(data: xr.Dataset, text: str, digests: Iterable[str] | None = None) -> bool:
    """Return whether uncertainty `data` is of a case with these inputs.

    Parameters
    ----------
    data
        Of `gripscale.analysis.propagation`.
    text
        The case file.
    digests
        Of the files it names; None where they are not known.
    """
    if _inputs(str(data.attrs.get("case", ""))) != _inputs(text):
        return False
    return digests is None or sorted(json.loads(data.attrs.get(FILES, "[]"))) == sorted(digests)


def _inputs(text: str) -> dict[str, Any] | None:
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None
    return {name: table for name, table in tables.items() if name not in NO_INPUTS}


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
            "uncertainty": canonical_json(self.uncertainty),
            "samples": [self.samples, self.seed],
            "models": list(self.models),
            "tolerance": canonical_json(self.tolerance),
            "axis": None
            if self.axis is None
            else [self.axis.name, canonical_json(self.axis.values)],
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
        Speeds or pressures, as for `gripscale.experiment.Study`; the same samples at each.
    tolerance : float, optional
        Estimated relative error of a direct contact, below 1. Without one it is that of the first
        full grid, about a tenth; asking for less than it has doubles the grid.
    folder : path, optional
        Gets `uncertainty.nc`, and the predictions in `predictions`: what it has is not solved
        again.
    workers, client, on_task
        As for `gripscale.experiment.solve_all`.

    Returns
    -------
    xarray.Dataset
        Over `model`, what is varied, and `sample`: `friction`, `contact_fraction` and `status`,
        with what was drawn as coordinates of `sample`; `_case` of the case itself; `_quantile`
        over `quantile`; `_grid_error` of each sample of the direct contact, which is in no
        quantile; `failed` samples, which count in no quantile; `_share` of each `source` in
        the variance (see `gripscale.analysis.variance_shares`).

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
    with bench_in(folder, workers, client, on_task) as bench, warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        data = _solved(plan, results, chosen, bench)
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
        raise InputError(
            f"models must be one or both of chain, direct; got {checks.short_repr(given)}"
        )
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
    bench: Bench,
) -> xr.Dataset:
    case = Inputs.of(Measurement.of(results))
    drawn = list(draws(case, chosen.sources, plan.samples, plan.seed))
    loads = _loads(results.load, plan.axis)
    tasks: dict[TaskKey, Task] = {}
    status: dict[TaskKey, str] = {}
    for name in plan.models:
        model = results.chain if name == "chain" else _direct(results, plan.tolerance)
        for sample, one in enumerate([SampledInputs(case, {}), *drawn], start=-1):
            places = [TaskKey(name, value, sample) for value in range(len(loads))]
            try:
                tasks |= dict(zip(places, _tasks(one, model, loads), strict=True))
            except InputError as refusal:
                status |= dict.fromkeys(places, str(refusal))
    labels = {_label(place, plan.axis): task for place, task in tasks.items()}
    answers = bench.solve(labels)
    solved = {place: answers[task.key] for place, task in tasks.items()}
    data = dataset(plan.models, plan.axis, drawn, chosen, solved, status)
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


def _tasks(one: SampledInputs, model: Model, loads: Sequence[NominalLoad]) -> list[Task]:
    """Return the tasks of a sample; raise `InputError` if it cannot be made."""
    if one.inputs is None:
        raise InputError(one.why_not)
    surface, own = one.inputs.for_model(model)
    relevant = surface.only(own.needs)
    return [Task(one.inputs.rubber, relevant, load, FailSafeModel(own)) for load in loads]


def _label(place: TaskKey, axis: Axis | None) -> str:
    where = "" if axis is None else f", {axis.name} {axis.labels[place.value]}"
    what = "the case itself" if place.sample < 0 else f"sample {place.sample + 1}"
    return f"{place.model}{where}, {what}"
