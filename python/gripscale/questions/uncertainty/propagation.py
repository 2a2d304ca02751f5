"""What is not known of a case, and what it does to friction and contact area.

All sources are drawn at once for each sample, and each sample is a task of
`gripscale.experiment`: kept as soon as it is solved, on all cores or a cluster.
"""

from __future__ import annotations

import hashlib
import json
import math
import tomllib
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import Array, InputError, RubberWarning, checks, provenance
from gripscale.core.provenance import software
from gripscale.experiment import design as designs
from gripscale.experiment.design import CONVERGED, Design, Point
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.experiment.task import canonical_json, load_stored
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import Load, Model, input_doubts
from gripscale.questions.answer.direct_contact import continued_curve, direct_contact_design
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.uncertainty import sampling
from gripscale.questions.uncertainty.first_order import first_order
from gripscale.questions.uncertainty.sampled_answer import chain_answer, measured_answer
from gripscale.questions.uncertainty.sampled_inputs import Inputs
from gripscale.questions.uncertainty.sampling import SampledInputs, Uncertainty
from gripscale.questions.uncertainty.sources import GRID_PLACE, SOURCES, Source
from gripscale.questions.uncertainty.variance_shares import shares
from gripscale.questions.vary.axis import Axis, axes_of
from gripscale.questions.vary.study import coordinates
from gripscale.uncertainty_options import FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED

OnAnswer = Callable[[xr.Dataset], None]
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)  # quantiles of the samples that a result holds

# What each sample answers: its letters and its name.
PROPAGATED_QUANTITIES = {
    "friction": ("mu", "friction coefficient"),
    "contact_fraction": ("A_r/A_0", "real over nominal contact area"),
}


def quantiles(values: xr.DataArray) -> xr.DataArray:
    """Return the quantiles over `sample`, last dimension `quantile`; NaN samples do not count.

    Median-unbiased (R. J. Hyndman & Y. Fan, Am. Stat. 50 (1996) 361,
    doi:10.1080/00031305.1996.10473566, their number 8): the ends of few samples are not drawn in.
    NaN for fewer than two samples.
    """
    enough = values.count("sample") > 1
    levels = values.where(enough, 0.0).quantile(LEVELS, "sample", method="median_unbiased")
    return levels.where(enough).drop_vars("quantile").transpose(..., "quantile")


# What is kept of each sample, and its meaning.
_NUMBERS = {name: text for name, (_, text) in PROPAGATED_QUANTITIES.items()} | {
    "friction_from_dissipation": model.TOTALS["total_friction_from_dissipation"],
    "adhesive_friction": "friction coefficient of the area term",
    "outside_band": model.OUTSIDE_BAND[model.FRICTION_OUTSIDE_BAND][1],
}


def uncertainty_dataset(
    solved: xr.Dataset,
    chosen: sampling.Chosen,
    drawn: Mapping[str, Any],
    logarithms: Mapping[str, Array],
) -> xr.Dataset:
    """Return all samples with their quantiles and shares; the first of `solved` is the case.

    `solved` holds the `sample_numbers`; `drawn` and `logarithms` are those of `drawn_values`. A
    sample of the direct contact has the error of its grid in it that was drawn.
    """
    usable = solved.rename({model.FRICTION_OUTSIDE_BAND: "outside_band"})[
        [*_NUMBERS, *(f"{name}_error" for name in PROPAGATED_QUANTITIES)]
    ].where(solved.prediction_status == CONVERGED)
    case, samples = usable.isel(sample=0), usable.isel(sample=slice(1, None))
    status = solved[[model.STATUS, model.STATUS_WORD, "seconds"]].isel(sample=slice(1, None))
    status_case = solved[[model.STATUS, model.STATUS_WORD]].isel(sample=0)
    data: dict[str, xr.DataArray] = {}

    def add(name: str, values: xr.DataArray, long_name: str, unit: str = "1") -> None:
        data[name] = values.drop_attrs().assign_attrs(units=unit, long_name=long_name)

    add("status", status[model.STATUS], "converged, or why the sample has no answer")
    add("status_word", status[model.STATUS_WORD], "word of the status")
    text = "converged, or why not, of the case itself"
    add("status_case", status_case[model.STATUS], text)
    text = "word of the status of the case itself"
    add("status_case_word", status_case[model.STATUS_WORD], text)
    add("seconds", status.seconds, "time to solve the sample", "s")
    failed = (status[model.STATUS] != CONVERGED).sum("sample")
    add("failed", failed, "samples without an answer; they count in no quantile")
    for name, text in _NUMBERS.items():
        add(name, samples[name], text)
        add(f"{name}_case", case[name], f"{text} of the case itself")
    is_direct = solved["model"] == DirectContact.name
    _, in_error, _ = drawn.get(GRID_PLACE, ("sample", np.zeros(samples.sizes["sample"]), {}))
    for name, (_, text) in PROPAGATED_QUANTITIES.items():
        error = (samples[f"{name}_error"] / abs(samples[name])).where(is_direct)
        about = f"estimated relative error of the grid of a direct contact, {text}"
        add(f"{name}_grid_error", error, about)
        values = samples[name] * np.exp(error.fillna(0.0) * xr.DataArray(in_error, dims="sample"))
        add(name, values.transpose(*samples[name].dims), text)
        add(f"{name}_quantile", quantiles(data[name]), text)
        parts = _shares(data[name], logarithms, name)
        for part, (_, meaning) in _SHARES.items():
            add(f"{name}_{part}", parts[f"{name}_{part}"], meaning.format(text))
    labels = [source.label for source in chosen.sources]
    return xr.Dataset(
        data,
        {
            "quantile": ("quantile", list(LEVELS), designs.variable_attributes("share below")),
            "source": ("source", list(logarithms), {"long_name": "source"}),
            "label": ("source", labels, {"long_name": "source in words"}),
            "end": ("end", ["low", "high"]),
            **drawn,
        },
        {
            "title": "Uncertainty of real contact area and friction of rubber on a rough surface",
            "left_out": json.dumps(chosen.left_out),
            **provenance.version_attributes(),
        },
    )


def drawn_values(
    sources: Sequence[Source], drawn: Sequence[SampledInputs]
) -> tuple[dict[str, Any], dict[str, Array]]:
    """Return what was drawn over `sample`, and by source its logarithms (samples, coordinates)."""
    values: dict[str, Any] = {}
    logarithms = {}
    for source in sources:
        columns = []
        for name, number in source.coordinates.items():
            column = np.array([inputs.coordinates[name] for inputs in drawn], dtype=float)
            attributes = designs.variable_attributes(number.long_name, number.unit)
            values[name] = ("sample", column, attributes | {"source": source.name})
            columns.append(column if number.logarithm else np.log(column))
        logarithms[source.name] = np.stack(columns, axis=-1)
    return values, logarithms


# What is kept of the shares of the sources in a variance: dimensions and meaning.
_SHARES = {
    "share": (("source",), "share of each source in the variance of the logarithm of {}"),
    "share_error": (("source",), "standard error of the share"),
    "share_difference_error": (
        ("source", "other_source"),
        "standard error of the difference of two shares",
    ),
    "end": (("source", "end"), "{}, at 5 and 95 % of what a source alone does"),
    "unexplained": ((), "share of no source in the variance of the logarithm of {}"),
}


def _shares(samples: xr.DataArray, logarithms: Mapping[str, Array], name: str) -> xr.Dataset:
    """Return `_SHARES` of a quantity at every model and value of the axis, as `<name>_share`..."""
    outer, count = samples.isel(sample=0), len(logarithms)
    row, square = np.full(count, np.nan), np.full((count, count), np.nan)
    parts: dict[tuple[int, ...], xr.Dataset] = {}
    for at in np.ndindex(outer.shape):
        fit = shares(samples.values[at], logarithms)
        numbers = (row, row, square, np.full((count, 2), np.nan), math.nan)
        if fit is not None:
            ends = np.stack([fit.low, fit.high], axis=-1)
            numbers = (fit.share, fit.error, fit.apart, ends, fit.unexplained)
        columns = zip(_SHARES.items(), numbers, strict=True)
        parts[at] = xr.Dataset(
            {f"{name}_{part}": (dims, values) for (part, (dims, _)), values in columns}
        )
    return designs.stack(parts, dict(zip(map(str, outer.dims), outer.shape, strict=True)))


FOLDER, _RESULT = "uncertainty", "uncertainty.nc"  # where it is in the results folder of the case
# Tables of a case that change no prediction of it.
NO_INPUTS = ("uncertainty", "measured", "output", "compare")
_FILES = "file_sha256"  # attribute of the result: digests of the files the case names, as JSON


def stored_uncertainty(results: Path) -> xr.Dataset | None:
    """Return the uncertainty in the results folder of a case, or None without a whole one."""
    return load_stored(results / FOLDER / _RESULT)


def of_same_inputs(data: xr.Dataset, text: str, digests: Iterable[str] | None = None) -> bool:
    """Return whether uncertainty `data` of `propagate` is of a case file with this text.

    `digests` are those of the files it names; None where they are not known.
    """

    def inputs(case: str) -> dict[str, Any] | None:
        try:
            tables = tomllib.loads(case)
        except tomllib.TOMLDecodeError:
            return None
        return {name: table for name, table in tables.items() if name not in NO_INPUTS}

    if inputs(str(data.attrs.get("case", ""))) != inputs(text):
        return False
    return digests is None or sorted(json.loads(data.attrs.get(_FILES, "[]"))) == sorted(digests)


# Name of the error of a quantity that each source carries by derivatives alone.
FIRST_ORDER = "{}_first_order"
_MODELS = ("chain", "direct")
# Inputs that may be varied beside the samples: those of the load, the same samples at each.
SAMPLED_OVER = ("speed", "pressure")
# Models by the word of a case for one or both of them.
BOTH = {"chain": ("chain",), "direct": ("direct",), "both": _MODELS}


@dataclass(frozen=True)
class Plan:
    """What is to be sampled: the case, its uncertainty, how often, by which models, over what."""

    case: Case
    uncertainty: Uncertainty
    samples: int
    seed: int
    models: tuple[str, ...]
    axis: Axis | None
    # Estimated relative error of a direct contact; None: that of its first full grid.
    tolerance: float | None

    @classmethod
    def of(
        cls,
        case: Case,
        choice: Uncertainty,
        *,
        samples: int | None = None,
        seed: int | None = None,
        models: Sequence[str] | None = None,
        vary: Mapping[str, Any] | None = None,
        tolerance: float | None = None,
    ) -> Plan:
        """Return what a case states where an argument is None; arguments as `uncertainty`."""
        defaults = sampling.stated_options(case)
        named = stated_models(case, choice) if models is None else models
        named = [named] if isinstance(named, str) else list(named)
        for name in named:
            checks.one_of("model", name, _MODELS)
        if not named or len(set(named)) < len(named):
            short = checks.short_repr(models)
            raise InputError(f"models must be one or both of chain, direct; got {short}")
        axis: Axis | None = None
        if vary:
            axis, *further = axes_of(vary)
            if further or axis.name not in SAMPLED_OVER:
                names = ", ".join(each.name for each in (axis, *further))
                raise InputError(
                    f"uncertainty varies one of {', '.join(SAMPLED_OVER)}; got {names}"
                )
        number = defaults.samples if samples is None else samples
        start = defaults.seed if seed is None else seed
        return cls(
            case,
            choice,
            checks.whole("samples", number, least=FEWEST_SAMPLES, most=MOST_SAMPLES),
            checks.whole("seed", start, least=0, most=MOST_SEED),
            tuple(name for name in _MODELS if name in named),
            axis,
            defaults.tolerance if tolerance is None else checks.positive("tolerance", tolerance),
        )

    @property
    def key(self) -> str:
        """A hash of all the result depends on."""
        axis = self.axis
        content = {
            "software": software(),
            "case": [self.case.key, self.case.origin.text],
            "uncertainty": canonical_json(self.uncertainty),
            "samples": [self.samples, self.seed],
            "models": list(self.models),
            "tolerance": canonical_json(self.tolerance),
            "axis": None if axis is None else [axis.name, canonical_json(axis.values)],
        }
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def propagate(
    plan: Plan,
    folder: str | Path | None = None,
    *,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_answer: OnAnswer | None = None,
) -> xr.Dataset:
    """Predict each sample of a plan; return the Dataset of `gripscale.uncertainty`, and keep it."""
    path = None if folder is None else Path(folder) / _RESULT
    data = None if path is None else load_stored(path)
    if data is not None and data.attrs.get("plan_key") == plan.key:
        return data
    chosen = plan.uncertainty.of(plan.case, plan.models)
    with bench_in(folder, workers, client, on_task) as bench, warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        data = _answered(plan, chosen, bench, on_answer)
    return data if path is None else netcdf.load_dataset(netcdf.save(data, path))


def stated_models(case: Case, uncertainty: Uncertainty) -> tuple[str, ...]:
    """Return the models a case states; by default that of its answer, if it is quick.

    The direct contact of a map takes minutes and has no blocks to draw. A range of a source that
    only the chain has asks for both.
    """
    word, measured = sampling.stated_options(case).model, case.surface.measured
    if word is None and (measured is None or measured.map is not None):
        word = "chain"
    elif word is None:
        of_chain = [name for name in uncertainty.ranges if SOURCES[name].models == (Chain.name,)]
        word = "both" if of_chain else "direct"
    return BOTH[word]


def _answered(
    plan: Plan, chosen: sampling.Chosen, bench: Bench, on_answer: OnAnswer | None
) -> xr.Dataset:
    """Return all samples, and the answer of the case at each load."""
    case, axis = plan.case, plan.axis
    usual = Inputs.of(case)
    drawn = list(sampling.draws(usual, chosen.sources, plan.samples, plan.seed))
    loads, labels = [case.load], [""]
    if axis is not None:
        loads = [replace(case.load, **{axis.name: value}) for value in axis.values]
        labels = [f"{axis.name} {label}, " for label in axis.labels]
    design = _design(plan, [SampledInputs(usual, {}), *drawn], loads)
    references = [
        direct_contact_design(case, load, label) for load, label in zip(loads, labels, strict=True)
    ]
    by_load = list(zip(loads, references, strict=True))
    tasks = design.tasks
    for reference in references:
        tasks |= {} if reference is None else reference.tasks
    curves = [None if each is None else continued_curve(case, load) for load, each in by_load]
    first, *further = references
    answers: dict[str, xr.Dataset] = {}
    if on_answer is not None and first is not None and not further:
        answers = bench.solve(first.tasks, sample_numbers)
        samples = first.dataset(answers)
        on_answer(measured_answer(samples, case, case.load, curves[0], None, [], {}))
    tasks = {label: task for label, task in tasks.items() if task.key not in answers}
    answers |= bench.solve(tasks, sample_numbers)
    values, logarithms = drawn_values(chosen.sources, drawn)
    data = uncertainty_dataset(design.dataset(answers), chosen, values, logarithms)
    answered = []
    for at, (load, reference) in enumerate(by_load):
        part = data if axis is None else data.isel({axis.name: at}, drop=True)
        if reference is None:
            chain = part.sel(model=Chain.name)
            answered.append(chain_answer(chain, case, load, chosen.sources, logarithms))
            continue
        direct = None
        if DirectContact.name in plan.models:
            direct = part.sel(model=DirectContact.name)
        samples = reference.dataset(answers)
        answered.append(
            measured_answer(samples, case, load, curves[at], direct, chosen.sources, logarithms)
        )
    answer = answered[0] if axis is None else xr.concat(answered, axis.name)
    if axis is None and DirectContact.name in plan.models and case.load.speed > 0.0:
        carried = first_order(case, plan.uncertainty, seed=plan.seed)
        carried = carried.reindex(source=data.source.values)
        for name in PROPAGATED_QUANTITIES:
            data[FIRST_ORDER.format(name)] = carried[f"{name}_error"]
    return data.assign(answer.drop_attrs(deep=False).data_vars).assign_attrs(
        case.attributes | input_doubts([case.surface, case.measured_rubber], loads, case.units),
        case_file=case.origin.name,
        **{_FILES: json.dumps(case.origin.digests)},
        seed=plan.seed,
        plan_key=plan.key,
        software=software(),
    )


def _design(plan: Plan, samples: Sequence[SampledInputs], loads: Sequence[Load]) -> Design:
    """Return the tasks of the samples, of which the first is the case, by each model and load."""
    case, axis = plan.case, plan.axis
    points: list[Point] = []
    refused: dict[designs.Index, str] = {}
    for at, name in enumerate(plan.models):
        predicting: Model = case.chain
        if name == DirectContact.name:
            if case.surface.measured is None:
                raise InputError(
                    "the direct contact needs a measured profile; got waves stated by hand"
                )
            predicting = DirectContact(tolerance=plan.tolerance, conditions=case.conditions)
        for sample, inputs in enumerate(samples):
            by_load = [(at, sample) if axis is None else (at, i, sample) for i in range(len(loads))]
            try:
                if inputs.inputs is None:
                    raise InputError(inputs.why_not)
                tasks = inputs.inputs.tasks(predicting, loads)
            except InputError as refusal:
                refused |= dict.fromkeys(by_load, str(refusal))
                continue
            for i, (index, task) in enumerate(zip(by_load, tasks, strict=True)):
                at_value = "" if axis is None else f", {axis.name} {axis.labels[i]}"
                subject = f"sample {sample}" if sample else "the case itself"
                points.append(Point(index, f"{name}{at_value}, {subject}", task))
    sizes = {"model": len(plan.models)}
    coords: dict[str, Any] = {"model": list(plan.models)}
    if axis is not None:
        sizes[axis.name] = len(loads)
        coords |= coordinates([axis], case.units)
    return Design(sizes | {"sample": len(samples)}, points, coords, refused)
