"""What is not known of a case, and what it does to friction and contact area.

All sources are drawn at once for each sample, and each sample is a task of
`gripscale.experiment`: kept as soon as it is solved, on all cores or a cluster.
"""

from __future__ import annotations

import json
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import Array, Checked, InputError, RubberWarning, checked, checks
from gripscale.core.provenance import software
from gripscale.experiment import design as designs
from gripscale.experiment.design import CONVERGED, Design, Point
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import Doubtful, Load, Model, input_doubts
from gripscale.questions.answer.direct_contact import continued_curve, direct_contact_design
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.samples import sample_numbers, usable
from gripscale.questions.uncertainty import sampling
from gripscale.questions.uncertainty.sampled_answer import chain_answer, measured_answer
from gripscale.questions.uncertainty.sampled_inputs import Inputs
from gripscale.questions.uncertainty.sampling import SampledInputs, SampleSet, Uncertainty
from gripscale.questions.uncertainty.sources import BOTH, GRID_PLACE, SOURCES
from gripscale.questions.uncertainty.variance_shares import Shares, shares
from gripscale.questions.vary.axis import Axis, axes_of
from gripscale.questions.vary.study import coordinates
from gripscale.uncertainty_options import FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED, SAMPLES

OnAnswer = Callable[[xr.Dataset], None]
LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)  # quantiles of the samples that a result holds

# What each sample answers, and its meaning.
PROPAGATED_QUANTITIES = {
    "friction": "friction coefficient",
    "contact_fraction": "real over nominal contact area",
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
_NUMBERS = PROPAGATED_QUANTITIES | {
    "friction_from_dissipation": model.TOTALS["total_friction_from_dissipation"],
    "adhesive_friction": "friction coefficient of the area term",
    "outside_band": model.OUTSIDE_BAND[model.FRICTION_OUTSIDE_BAND][1],
}


def uncertainty_dataset(solved: xr.Dataset, drawn: SampleSet) -> xr.Dataset:
    """Return all samples with their quantiles and shares; the first of `solved` is the case.

    `solved` holds the `sample_numbers`. A sample of the direct contact has the error of its grid in
    it that was drawn.
    """
    sources, logarithms = drawn.sources, drawn.logarithms
    data: dict[str, xr.DataArray] = {}

    def add(name: str, values: xr.DataArray, long_name: str, unit: str = "1") -> None:
        # the coordinates keep theirs, by which places are called
        data[name] = values.drop_attrs(deep=False).assign_attrs(units=unit, long_name=long_name)

    def known_shares(values: Array) -> Shares:
        nothing = np.full(len(sources), np.nan)
        return shares(values, logarithms) or Shares(nothing, nothing)

    solved = solved.rename({model.FRICTION_OUTSIDE_BAND: "outside_band"})
    case, samples = solved.isel(sample=0), solved.isel(sample=slice(1, None))
    add("status", samples[model.STATUS], "converged, or why the sample has no answer")
    add("status_word", samples[model.STATUS_WORD], "word of the status")
    add("status_case", case[model.STATUS], "converged, or why not, of the case itself")
    add("status_case_word", case[model.STATUS_WORD], "word of the status of the case itself")
    add("seconds", samples.seconds, "time to solve the sample", "s")
    failed = (samples[model.STATUS] != CONVERGED).sum("sample")
    add("failed", failed, "samples without an answer; they count in no quantile")
    for name, text in _NUMBERS.items():
        add(name, usable(samples, name), text)
        add(f"{name}_case", usable(case, name), f"{text} of the case itself")
    is_direct = solved["model"] == DirectContact.name
    in_error = drawn.coordinates.get(GRID_PLACE, xr.Variable((), 0.0))
    for name, text in PROPAGATED_QUANTITIES.items():
        error = (usable(samples, f"{name}_error") / abs(data[name])).where(is_direct)
        about = f"estimated relative error of the grid of a direct contact, {text}"
        add(f"{name}_grid_error", error, about)
        values = data[name] * np.exp(error.fillna(0.0) * xr.DataArray(in_error))
        add(name, values.transpose(*data[name].dims), text)
        add(f"{name}_quantile", quantiles(data[name]), text)
        share, share_error = xr.apply_ufunc(
            known_shares,
            data[name],
            input_core_dims=[["sample"]],
            output_core_dims=[["source"], ["source"]],
            vectorize=True,
        )
        about = f"share of each source in the variance of the logarithm of {text}"
        add(f"{name}_share", share, about)
        add(f"{name}_share_error", share_error, "standard error of the share")
    labels = [source.label for source in sources]
    coordinates = {
        "quantile": ("quantile", list(LEVELS), designs.variable_attributes("share below")),
        "source": ("source", list(logarithms), {"long_name": "source"}),
        "label": ("source", labels, {"long_name": "source in words"}),
    }
    attributes = {
        "title": "Uncertainty of real contact area and friction of rubber on a rough surface",
        "left_out": json.dumps(drawn.left_out),
    }
    return xr.Dataset(data, coordinates | drawn.coordinates, attributes)


# Inputs that may be varied beside the samples: those of the load, the same samples at each.
SAMPLED_OVER = ("speed", "pressure")


class Plan(Checked):
    """What is to be sampled: the case, its uncertainty, how often, by which models, over what."""

    case: Case
    uncertainty: Uncertainty
    samples: int = checked(checks.whole, least=FEWEST_SAMPLES, most=MOST_SAMPLES)
    seed: int = checked(checks.whole, least=0, most=MOST_SEED)
    models: tuple[str, ...]
    axes: tuple[Axis, ...]  # none, or one
    # Estimated relative error of a direct contact; None: that of its first full grid.
    tolerance: float | None = checked(checks.positive, default=None)

    @classmethod
    def of(cls, case: Case, **asked: Any) -> Plan:
        """Return what a case states where an argument is None; arguments as `uncertainty`."""
        asked = {name: value for name, value in asked.items() if value is not None}
        chosen = {name: asked.pop(name, None) for name in ("without", "ranges", "block_length")}
        stating: Mapping[str, Any] = case.options.get("uncertainty", {})
        choice = Uncertainty.of_case(stating, **chosen)
        usual = {"samples": SAMPLES, "seed": 0, "tolerance": None}
        options: dict[str, Any] = {**usual, **stating, **asked}
        models = asked.get("models")
        named = stated_models(case, choice) if models is None else models
        named = [named] if isinstance(named, str) else list(named)
        for name in named:
            checks.one_of("model", name, BOTH["both"])
        if not named or len(set(named)) < len(named):
            short = checks.short_repr(models)
            raise InputError(f"models must be one or both of chain, direct; got {short}")
        axes = axes_of(asked["vary"]) if asked.get("vary") else ()
        if len(axes) > 1 or any(axis.name not in SAMPLED_OVER for axis in axes):
            names = ", ".join(axis.name for axis in axes)
            raise InputError(f"uncertainty varies one of {', '.join(SAMPLED_OVER)}; got {names}")
        numbers = {name: options[name] for name in ("samples", "seed", "tolerance")}
        in_order = tuple(name for name in BOTH["both"] if name in named)
        return cls(case=case, uncertainty=choice, models=in_order, axes=axes, **numbers)

    @property
    def loads(self) -> dict[str, Load]:
        """The loads by how the names of their tasks begin, such as "speed 0.3, "."""
        return {
            f"{axis.name} {label}, ": replace(self.case.load, **{axis.name: value})
            for axis in self.axes
            for label, value in zip(axis.labels, axis.values, strict=True)
        } or {"": self.case.load}

    def design(self, samples: Sequence[SampledInputs]) -> Design:
        """Return the tasks of samples, of which the first is the case, by each model and load."""
        case, shape = self.case, [len(axis.values) for axis in self.axes]
        points: list[Point] = []
        refused: dict[designs.Index, str] = {}
        for at, name in enumerate(self.models):
            predicting: Model = case.chain
            if name == DirectContact.name:
                if case.surface.measured is None:
                    raise InputError(
                        "the direct contact needs a measured profile; got waves stated by hand"
                    )
                predicting = DirectContact(tolerance=self.tolerance, conditions=case.conditions)
            for number, sample in enumerate(samples):
                by_load = [(at, *of_load, number) for of_load in np.ndindex(*shape)]
                subject = f"sample {number}" if number else "the case itself"
                try:
                    if sample.inputs is None:
                        raise InputError(sample.why_not)
                    tasks = sample.inputs.tasks(predicting, list(self.loads.values()))
                except InputError as refusal:
                    refused |= dict.fromkeys(by_load, str(refusal))
                    continue
                for index, label, task in zip(by_load, self.loads, tasks, strict=True):
                    points.append(Point(index, f"{name}, {label}{subject}", task))
        coords: dict[str, Any] = {"model": list(self.models)}
        coords |= coordinates(self.axes, case.units)
        sizes = {name: len(values) for name, values in coords.items()} | {"sample": len(samples)}
        return Design(sizes, points, coords, refused)


def stated_models(case: Case, uncertainty: Uncertainty) -> tuple[str, ...]:
    """Return the models a case states; by default that of its answer, if it is quick.

    The direct contact of a map takes minutes and has no blocks to draw. A range of a source that
    only the chain has asks for both.
    """
    word, measured = case.options.get("uncertainty", {}).get("model"), case.surface.measured
    if word is None and (measured is None or measured.map is not None):
        word = "chain"
    elif word is None:
        of_chain = [name for name in uncertainty.ranges if SOURCES[name].models == (Chain.name,)]
        word = "both" if of_chain else "direct"
    return BOTH[word]


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
    case, chosen = plan.case, plan.uncertainty.of(plan.case, plan.models)
    with bench_in(folder, workers, client, on_task) as bench, warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        samples = sampling.draws(Inputs.of(case), chosen.sources, plan.samples, plan.seed)
        data = solve_samples(plan, replace(chosen, samples=list(samples)), bench, on_answer)
    if folder is None:
        return data
    return netcdf.load_dataset(netcdf.save(data, Path(folder) / "uncertainty.nc"))


def solve_samples(
    plan: Plan, drawn: SampleSet, bench: Bench, on_answer: OnAnswer | None
) -> xr.Dataset:
    """Return all samples of a plan, and the answer of its case at each load."""
    case, loads = plan.case, list(plan.loads.values())
    design = plan.design([SampledInputs(Inputs.of(case), {}), *drawn.samples])
    references = [direct_contact_design(case, load, label) for label, load in plan.loads.items()]
    measured = case.surface.measured is not None
    curves = [continued_curve(case, load) if measured else None for load in loads]
    tasks, answers = design.tasks, dict[str, xr.Dataset]()
    for reference in references:
        tasks |= {} if reference is None else reference.tasks
    first, *further = references
    if on_answer is not None and first is not None and not further:
        answers = bench.solve(first.tasks, sample_numbers)
        on_answer(measured_answer(first.dataset(answers), case, case.load, curves[0]))
    tasks = {label: task for label, task in tasks.items() if task.key not in answers}
    answers |= bench.solve(tasks, sample_numbers)
    data = uncertainty_dataset(design.dataset(answers), drawn)
    of_case = []
    for at, (load, reference, curve) in enumerate(zip(loads, references, curves, strict=True)):
        part = data.isel({axis.name: at for axis in plan.axes}, drop=True)
        if reference is None:
            of_case.append(chain_answer(part.sel(model=Chain.name), case, load, drawn))
            continue
        direct = part.sel(model=DIRECT) if DIRECT in plan.models else None
        samples = reference.dataset(answers)
        of_case.append(measured_answer(samples, case, load, curve, drawn, direct))
    answer = xr.concat(of_case, plan.axes[0].name) if plan.axes else of_case[0]
    inputs: list[Doubtful] = [case.surface, case.measured_rubber]
    return data.assign(answer.drop_attrs(deep=False).data_vars).assign_attrs(
        case.attributes | input_doubts(inputs, loads, case.units, case.softening_doubts),
        seed=plan.seed,
        software=software(),
    )
