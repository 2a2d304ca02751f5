"""What is not known of a case, and what it does to friction and contact area.

All sources are drawn at once for each sample, and each sample is a task of
`gripscale.experiment`: kept as soon as it is solved, on all cores or a cluster.
"""

from __future__ import annotations

import json
import warnings
import zlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.chain.chain import Chain
from gripscale.core import Array, Checked, InputError, RubberWarning, checked, checks
from gripscale.core.provenance import software
from gripscale.experiment import design as designs
from gripscale.experiment.design import CONVERGED, Design, Point, variable_attributes
from gripscale.experiment.solve import Bench, OnTask, bench_in
from gripscale.half_space.model import DirectContact
from gripscale.io import netcdf
from gripscale.model import Doubtful, Load, Model, input_doubts
from gripscale.questions.answer.direct_contact import continued_curve, direct_contact_design
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.samples import sample_numbers, usable
from gripscale.questions.uncertainty.sampled_answer import chain_answer, measured_answer
from gripscale.questions.uncertainty.sampled_inputs import Inputs
from gripscale.questions.uncertainty.sources import (
    BOTH,
    GRID_PLACE,
    SOURCES,
    Source,
    SourceNotApplicable,
    SourceOptions,
)
from gripscale.questions.uncertainty.variance_shares import Shares, shares
from gripscale.questions.vary.axis import Axis, axes_of
from gripscale.questions.vary.study import coordinates
from gripscale.uncertainty_options import FEWEST_SAMPLES, MOST_SAMPLES, MOST_SEED, SAMPLES


def stated_options(case: Case) -> Mapping[str, Any]:
    """Return the arguments of `gripscale.uncertainty` that a case states."""
    stating: Mapping[str, Any] = case.options.get("uncertainty", {})
    return stating


class Chosen(NamedTuple):
    """The sources that are drawn, and a sentence on each of the others."""

    sources: list[Source]
    left_out: list[str]


# Sources that nobody can give values of, and what they are drawn from.
NO_VALUES = {
    **dict.fromkeys(("profile", "modulus"), "what was measured"),
    "grid": "its estimate",
}


@dataclass(frozen=True)
class Uncertainty:
    """What is taken to be uncertain: all sources that a case has, unless said otherwise.

    Raises `InputError` if a source is unknown, both left out and given, or has no values to be
    given.

    Parameters
    ----------
    without : sequence of str
        Sources to be left out: height_noise, cleaning, profile, grid, modulus, bulk_modulus,
        equilibrium_modulus, temperature, pressure, load_time, cut_off, waves.
    ranges : mapping
        Values of a source by its name, in place of its default: two ends as `"1 GPa:3 GPa"` or a
        pair of numbers [SI], or several equally likely values as `"1 GPa,2 GPa"` or three numbers
        and more. Of cleaning (limits of the change of height per step), bulk_modulus,
        equilibrium_modulus (moduli), cut_off (lengths), load_time (factors on that of the case)
        and waves (numbers of them). Of height_noise [m], temperature [K] and pressure (`"3 %"` or
        [Pa]) one standard error: without it they are not drawn.
    block_length : float, optional
        Length of the blocks of profiles [m]; by default four of the largest waves.
    """

    without: Sequence[str] = ()
    ranges: Mapping[str, Any] = field(default_factory=dict)
    block_length: float | None = None

    def __post_init__(self) -> None:
        checks.allowed_names("source", [*self.without, *self.ranges], SOURCES)
        for name in self.ranges:
            if name in self.without:
                raise InputError(f"{name} must be left out or given; got both")
            if name in NO_VALUES:
                raise InputError(f"{name} is drawn from {NO_VALUES[name]}; got values given for it")
        if self.block_length is not None:
            checks.positive("block_length", self.block_length, unit="m")

    @classmethod
    def of_case(
        cls,
        options: Mapping[str, Any],
        *,
        without: Sequence[str] | None = None,
        ranges: Mapping[str, Any] | None = None,
        block_length: float | None = None,
    ) -> Uncertainty:
        """Return what a case states, or what is stated here in its place.

        A source in `ranges` goes before that the case gives or leaves it out, and `without` before
        all that the case leaves out and gives of the same.
        """
        ranged = options.get("ranges", {}).items()
        merged = {name: value for name, value in ranged if name not in (without or ())}
        now = dict(ranges or {})
        if without is None:
            without = [name for name in options.get("without", ()) if name not in now]
        length = options.get("block_length") if block_length is None else block_length
        return cls(tuple(without), merged | now, length)

    def of(self, case: Case, models: Sequence[str]) -> Chosen:
        """Return the sources of a case that have an effect on one of `models`.

        Raises `InputError` if a source that is given has nothing to draw, or none is left.
        """
        chosen = Chosen([], [])
        for name, source in SOURCES.items():
            try:
                if name in self.without:
                    raise SourceNotApplicable("left out as asked")
                if not set(source.models) & set(models):
                    raise SourceNotApplicable(f"no effect on the model {' or '.join(models)}")
                values = self.ranges.get(name)
                options = SourceOptions(name, values, self.block_length, models)
                chosen.sources.append(source.of(case, options))
            except SourceNotApplicable as why:
                if name in self.ranges:
                    raise InputError(f"{name} is given and has nothing to draw: {why}") from None
                chosen.left_out.append(f"{source.label}: {why}")
        if not chosen.sources:
            raise InputError(f"no source of uncertainty is left; {'; '.join(chosen.left_out)}")
        return chosen


# Where each sample lies: all sources at once, each spread evenly over its own values.
#
# A Latin hypercube (M. D. McKay, R. J. Beckman & W. J. Conover, Technometrics 21 (1979) 239,
# doi:10.1080/00401706.1979.10489755): of N samples one lies in each N-th of every source. Columns
# and random numbers are a source's own, by its name, so that leaving out one source changes no draw
# of the others.


class SampledInputs(NamedTuple):
    """One sample: its inputs, or why there are none, and the coordinates of what was drawn."""

    inputs: Inputs | None
    coordinates: dict[str, float]
    why_not: str = ""


def draws(
    case: Inputs, sources: Sequence[Source], samples: int, seed: int
) -> Iterator[SampledInputs]:
    """Yield the samples of a case."""
    from scipy.stats.qmc import LatinHypercube  # 0.5 s and 15 MB, which a run need not pay

    numbers = {source.name: zlib.crc32(source.name.encode()) for source in sources}
    columns = {
        name: LatinHypercube(1, rng=np.random.default_rng([seed, number])).random(samples)[:, 0]
        for name, number in numbers.items()
    }
    for sample in range(samples):
        inputs, why_not = case, ""
        coordinates: dict[str, float] = {}
        for source in sources:
            assert source.draw is not None
            random = np.random.default_rng([seed, numbers[source.name], sample])
            drawn: Sequence[float] = [np.nan] * len(source.coordinates)
            try:
                inputs, drawn = source.draw(columns[source.name][sample], random, inputs)
            except InputError as error:
                why_not = str(error)
            coordinates |= dict(zip(source.coordinates, drawn, strict=True))
        yield SampledInputs(None if why_not else inputs, coordinates, why_not)


@dataclass(frozen=True)
class SampleSet:
    """Samples of a case with the sources they were drawn from."""

    chosen: Chosen
    samples: Sequence[SampledInputs]

    @cached_property
    def coordinates(self) -> dict[str, xr.Variable]:
        """What was drawn, over `sample`."""
        return {
            name: xr.Variable(
                "sample",
                [each.coordinates[name] for each in self.samples],
                variable_attributes(number.long_name, number.unit) | {"source": source.name},
            )
            for source in self.chosen.sources
            for name, number in source.coordinates.items()
        }

    @cached_property
    def logarithms(self) -> dict[str, Array]:
        """Logarithms of what each source drew, shape (samples, coordinates)."""
        logarithms = {}
        for source in self.chosen.sources:
            columns = []
            for name, number in source.coordinates.items():
                values = self.coordinates[name].values
                columns.append(values if number.logarithm else np.log(values))
            logarithms[source.name] = np.stack(columns, axis=-1)
        return logarithms


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


def uncertainty_dataset(solved: xr.Dataset, drawn: SampleSet) -> xr.Dataset:
    """Return all samples with their quantiles and shares; the first of `solved` is the case.

    `solved` holds the `sample_numbers`. A sample of the direct contact has the error of its grid in
    it that was drawn.
    """
    sources, logarithms = drawn.chosen.sources, drawn.logarithms
    data: dict[str, xr.DataArray] = {}

    def add(name: str, values: xr.DataArray, long_name: str, unit: str = "1") -> None:
        # the coordinates keep theirs, by which places are called
        data[name] = values.drop_attrs(deep=False).assign_attrs(units=unit, long_name=long_name)

    def known_shares(values: Array) -> Shares:
        """Return shares and their errors, NaN where the samples cannot tell."""
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
    for name, (_, text) in PROPAGATED_QUANTITIES.items():
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
    return xr.Dataset(
        data,
        {
            "quantile": ("quantile", list(LEVELS), designs.variable_attributes("share below")),
            "source": ("source", list(logarithms), {"long_name": "source"}),
            "label": ("source", labels, {"long_name": "source in words"}),
            **drawn.coordinates,
        },
        {
            "title": "Uncertainty of real contact area and friction of rubber on a rough surface",
            "left_out": json.dumps(drawn.chosen.left_out),
        },
    )


_RESULT = "uncertainty.nc"  # in the folder of the samples
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
    def of(cls, case: Case, choice: Uncertainty, **asked: Any) -> Plan:
        """Return what a case states where an argument is None; arguments as `uncertainty`."""
        asked = {name: value for name, value in asked.items() if value is not None}
        options = {"samples": SAMPLES, "seed": 0, **stated_options(case), **asked}
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
        return cls(
            case,
            choice,
            options["samples"],
            options["seed"],
            tuple(name for name in BOTH["both"] if name in named),
            axes,
            options.get("tolerance"),
        )

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
    word, measured = stated_options(case).get("model"), case.surface.measured
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
    path = None if folder is None else Path(folder) / _RESULT
    chosen = plan.uncertainty.of(plan.case, plan.models)
    with bench_in(folder, workers, client, on_task) as bench, warnings.catch_warnings():
        warnings.simplefilter("ignore", RubberWarning)  # drawn rubbers are not made by hand
        samples = draws(Inputs.of(plan.case), chosen.sources, plan.samples, plan.seed)
        data = solve_samples(plan, SampleSet(chosen, list(samples)), bench, on_answer)
    return data if path is None else netcdf.load_dataset(netcdf.save(data, path))


def solve_samples(
    plan: Plan, drawn: SampleSet, bench: Bench, on_answer: OnAnswer | None = None
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
