"""What of a case is taken to be uncertain, and what the user knows of it."""

from __future__ import annotations

import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.core import Array, InputError, checks
from gripscale.experiment.design import variable_attributes
from gripscale.questions.uncertainty.sampled_inputs import Inputs
from gripscale.questions.uncertainty.sources import (
    SOURCES,
    Source,
    SourceNotApplicable,
    SourceOptions,
)


class SampledInputs(NamedTuple):
    """One sample: its inputs, or why there are none, and the coordinates of what was drawn."""

    inputs: Inputs | None
    coordinates: dict[str, float]
    why_not: str = ""


@dataclass(frozen=True)
class SampleSet:
    """The sources that are drawn, a sentence on each of the others, and samples of a case."""

    sources: list[Source]
    left_out: list[str]
    samples: Sequence[SampledInputs] = ()

    @cached_property
    def coordinates(self) -> dict[str, xr.Variable]:
        """What was drawn, over `sample`."""
        return {
            name: xr.Variable(
                "sample",
                [each.coordinates[name] for each in self.samples],
                variable_attributes(number.long_name, number.unit) | {"source": source.name},
            )
            for source in self.sources
            for name, number in source.coordinates.items()
        }

    @cached_property
    def logarithms(self) -> dict[str, Array]:
        """Logarithms of what each source drew, shape (samples, coordinates)."""
        logarithms = {}
        for source in self.sources:
            columns = []
            for name, number in source.coordinates.items():
                values = self.coordinates[name].values
                columns.append(values if number.logarithm else np.log(values))
            logarithms[source.name] = np.stack(columns, axis=-1)
        return logarithms


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

    def of(self, case: Case, models: Sequence[str]) -> SampleSet:
        """Return the sources of a case that have an effect on one of `models`.

        Raises `InputError` if a source that is given has nothing to draw, or none is left.
        """
        chosen = SampleSet([], [])
        for name, source in SOURCES.items():
            try:
                if name in self.without:
                    raise SourceNotApplicable("left out as asked")
                if not set(source.models) & set(models):
                    raise SourceNotApplicable(f"no effect on the model {' or '.join(models)}")
                values = self.ranges.get(name)
                options = SourceOptions(name, values, self.block_length, models)
                chosen.sources.append(replace(source, draw=source.prepare(case, options)))
            except SourceNotApplicable as why:
                if name in self.ranges:
                    raise InputError(f"{name} is given and has nothing to draw: {why}") from None
                chosen.left_out.append(f"{source.label}: {why}")
        if not chosen.sources:
            raise InputError(f"no source of uncertainty is left; {'; '.join(chosen.left_out)}")
        return chosen


def draws(
    case: Inputs, sources: Sequence[Source], samples: int, seed: int
) -> Iterator[SampledInputs]:
    """Yield the samples of a case: all sources at once, each spread evenly over its own values.

    A Latin hypercube (M. D. McKay, R. J. Beckman & W. J. Conover, Technometrics 21 (1979) 239,
    doi:10.1080/00401706.1979.10489755). Columns and random numbers are a source's own, by its name:
    leaving out one source changes no draw of the others.
    """
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
