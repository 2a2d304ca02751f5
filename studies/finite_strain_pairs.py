"""Effect of finite strain: the same lines in the block and in the half-space, pair by pair.

The half-space solves a whole profile at small strain, the block a short window of it, cut off at
some millimetres, at finite strain. Both solve such windows, and the ratio of their answers is the
correction for finite strain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from threading import Event
from typing import TYPE_CHECKING

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.parallel import Stopped, in_threads, worker_count
from gripscale.half_space.result import RoughContact
from gripscale.half_space.solve import solve_rough_contact
from gripscale.rubber import Rubber
from gripscale.surface import Profile
from gripscale.wave.block import solve_profile
from gripscale.wave.problem import SampledProfile
from gripscale.wave.result import ScaleResult

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike


ANSWERS = ("contact_fraction", "friction_from_dissipation")
"""Quantities with a correction. Where crests are as narrow as columns the friction from dissipation
is the better one: traction depends on the flank under a single node."""


MODELS = ("block", "half_space")
CARRIED = {
    "load_share": "share of the load",
    "contact_fraction": "contact fraction",
    "friction": "contribution to the friction from traction",
}
"""What a part of the contact carries, in words."""


@dataclass(frozen=True)
class Pair:
    """One line in the block and in the half-space."""

    line: Profile
    block: ScaleResult
    half_space: RoughContact

    @property
    def status(self) -> str:
        """`converged`, or the reason not to use this pair."""
        if not self.block.converged:
            return self.block.why
        if not self.half_space.converged:
            return f"half-space: {self.half_space.status}"
        return "converged"

    @property
    def converged(self) -> bool:
        """Whether both solutions converged."""
        return self.status == "converged"

    def in_classes(self, by: str, lower: Array) -> Array:
        """Return what is carried in the classes `by` slope or pressure that begin at `lower`.

        Shape (2 of `MODELS`, 3 of `CARRIED`, classes); contact fractions and frictions add up to
        those of the results, frictions from traction.
        """
        period = len(self.line) * self.line.step
        profile = SampledProfile(period, self.line.z)
        out = np.zeros((len(MODELS), len(CARRIED), lower.size))
        models: tuple[ScaleResult | RoughContact, ...] = (self.block, self.half_space)
        for model, carried in zip(models, out, strict=True):
            inside = model.pressure > 0.0
            around = np.concatenate([model.x[-1:] - period, model.x, model.x[:1] + period])
            width = 0.5 * (around[2:] - around[:-2])
            width, pressure = width[inside], model.pressure[inside]
            slope = profile.slope(
                model.x[inside] - (0.0 if model is self.block else self.line.x[0])
            )
            number = (
                np.searchsorted(lower, np.abs(slope) if by == "slope" else pressure, "right") - 1
            )
            load = width * pressure / (width * pressure).sum()
            area = width * model.contact_fraction / width.sum()
            drag = load * slope * model.friction / (load * slope).sum()
            for values, sums in zip((load, area, drag), carried, strict=True):
                np.add.at(sums, number, values)
        return out


@dataclass(frozen=True)
class Correction:
    """A factor on the small-strain answer, with the 68 % interval of its bootstrap."""

    factor: float
    low: float
    high: float

    @property
    def log_error(self) -> float:
        """Standard error of the factor's logarithm [-]."""
        return 0.5 * math.log(self.high / self.low)


def _ratio_of_means(block: Array, half_space: Array, seed: int) -> Correction:
    """Return the ratio of the means over pairs.

    NaN limits for fewer than three pairs, or if the half-space has nothing in one of them.
    """
    if not half_space.size or not half_space.any():
        return Correction(math.nan, math.nan, math.nan)
    factor = float(block.mean() / half_space.mean())
    if half_space.size < 3 or not half_space.all():
        return Correction(factor, math.nan, math.nan)
    from scipy.stats import bootstrap  # 0.5 s and 15 MB, which a run need not pay

    interval = bootstrap(
        (block, half_space),
        lambda a, b, axis: a.mean(axis=axis) / b.mean(axis=axis),
        paired=True,
        confidence_level=0.6827,
        method="percentile",
        rng=np.random.default_rng(seed),
    ).confidence_interval
    return Correction(factor, float(interval.low), float(interval.high))


@dataclass(frozen=True)
class FiniteStrainPairs:
    """Lines solved both ways."""

    pairs: list[Pair]

    @property
    def converged(self) -> list[Pair]:
        """The pairs of which both solutions converged."""
        return [pair for pair in self.pairs if pair.converged]

    def mean(self, name: str, which: str = "block") -> float:
        """Return the mean of one of `ANSWERS` of the `block` or `half_space`."""
        values = [getattr(getattr(pair, which), name) for pair in self.converged]
        return float(np.mean(values)) if values else math.nan

    def correction(self, name: str, *, seed: int = 0) -> Correction:
        """Return the mean in the block over the mean in the half-space.

        Percentiles of 9999 resamples of the pairs (B. Efron & R. Tibshirani, An Introduction to
        the Bootstrap, 1993, ch. 13); NaN limits for fewer than three pairs.
        """
        both = [[getattr(p.block, name), getattr(p.half_space, name)] for p in self.converged]
        block, half_space = np.array(both, dtype=float).reshape(-1, 2).T
        return _ratio_of_means(block, half_space, seed)

    def by_class(self, by: str, edges: ArrayLike, *, seed: int = 0) -> xr.Dataset:
        """Return what the classes of contact carry in the block and in the half-space.

        Parameters
        ----------
        by : str
            `slope`, the size of the profile's slope under the contact [-], or `pressure`, the
            contact pressure [Pa].
        edges : array_like
            Between the classes, increasing from above 0; the last class has no upper end.
        seed : int
            Of the bootstrap.

        Returns
        -------
        Dataset
            Over `model` (`block`, `half_space`) and `class`, in the means of the converged pairs:
            `load_share` [-]; `contact_fraction` [-]; and `friction`, contribution to
            the friction from traction [-]. `load_share_factor`, `contact_fraction_factor` and
            `friction_factor`, block over half-space as by `correction`, with `_low` and `_high`;
            NaN where the half-space has nothing in a class, limits also where a pair has nothing.

        Raises
        ------
        InputError
            If `by` is another word, or `edges` do not increase from above 0.
        """
        import xarray as xr

        checks.one_of("by", by, ("slope", "pressure"))
        lower = np.append(0.0, checks.increasing_vector("edges", edges))
        # (pairs, 2 models, 3 quantities, classes)
        parts = np.array([pair.in_classes(by, lower) for pair in self.converged])
        parts = parts.reshape(-1, len(MODELS), len(CARRIED), lower.size)
        unit = {"slope": "1", "pressure": "Pa"}[by]
        data: dict[str, xr.Variable] = {}
        for at, (name, words) in enumerate(CARRIED.items()):
            mean = parts[:, :, at].mean(axis=0) if len(parts) else np.full((2, lower.size), np.nan)
            attrs = {"units": "1", "long_name": words}
            data[name] = xr.Variable(("model", "class"), mean, attrs)
            ratios = [
                _ratio_of_means(parts[:, 0, at, k], parts[:, 1, at, k], seed)
                for k in range(lower.size)
            ]
            for end, field in (("", "factor"), ("_low", "low"), ("_high", "high")):
                values = [getattr(ratio, field) for ratio in ratios]
                long_name = f"{words}, block over half-space{end.replace('_', ', ')}"
                attrs = {"units": "1", "long_name": long_name}
                data[f"{name}_factor{end}"] = xr.Variable("class", values, attrs)
        lower_end = ("class", lower, {"units": unit, "long_name": f"lower end of the {by}"})
        return xr.Dataset(data, {"model": list(MODELS), "class": lower_end})

    def to_dataset(self) -> xr.Dataset:
        """Return both answers of each line, over `line`, and the corrections."""
        import xarray as xr

        def along(values: Sequence[object], unit: str, long_name: str) -> xr.Variable:
            return xr.Variable("line", np.array(values), {"units": unit, "long_name": long_name})

        data: dict[str, xr.Variable] = {}
        for name in (*ANSWERS, "friction"):
            words = name.replace("_", " ")
            for which in ("block", "half_space"):
                values = [getattr(getattr(pair, which), name) for pair in self.pairs]
                data[f"{which}_{name}"] = along(values, "1", f"{words}, {which.replace('_', '-')}")
        data["status"] = along([p.status for p in self.pairs], "1", "converged, or why not")
        data["start"] = along([p.line.x[0] for p in self.pairs], "m", "first point of the line")
        data["length"] = along([p.line.length for p in self.pairs], "m", "length of the line")
        out = xr.Dataset(data, {"line": np.arange(len(self.pairs))})
        for name in ANSWERS:
            correction = self.correction(name)
            out.attrs |= {
                f"{name}_correction": correction.factor,
                f"{name}_correction_interval": [correction.low, correction.high],
            }
        return out


def solve_both_ways(
    rubber: Rubber,
    lines: Sequence[Profile],
    *,
    pressure: float,
    speed: float,
    load_time: float = math.inf,
    workers: int | None = None,
    on_pair: Callable[[Pair], None] | None = None,
) -> FiniteStrainPairs:
    """Return contact and friction of each line at finite strain and at small strain.

    A line that did not converge, or whose mesh is too coarse for it, does not count in means and
    corrections and says why. Raises `InputError` as `gripscale.solve_profile` and
    `gripscale.solve_rough_contact` do.

    Parameters
    ----------
    rubber : Rubber
        The viscoelastic solid of both.
    lines : sequence of Profile
        Periods as they stand, such as `one_period` makes of the `windows` of a profile; of at most
        a hundred waves or so.
    pressure, speed, load_time
        As for `gripscale.solve_profile` [Pa], [m/s], [s]; the half-space knows no load time.
    workers : int, optional
        Lines solved at a time, in threads; one per core by default.
    on_pair : callable, optional
        Called with each `Pair` as it is solved, in whatever order they come.
    """
    lines = checks.instances("lines", lines, Profile)

    in_block = partial(solve_profile, rubber, pressure=pressure, speed=speed, load_time=load_time)
    in_half_space = partial(solve_rough_contact, rubber, pressure=pressure, speed=speed)

    def solve(line: Profile, stop: Event) -> Pair:
        if stop.is_set():
            raise Stopped
        return Pair(line, in_block(line, periodic=True), in_half_space(line, periodic=True))

    pairs: dict[int, Pair] = {}
    jobs = [partial(solve, line) for line in lines]
    with closing(in_threads(jobs, worker_count(workers))) as stream:
        for index, pair in stream:
            pairs[index] = pair
            if on_pair is not None:
                on_pair(pair)
    return FiniteStrainPairs([pairs[index] for index in range(len(lines))])
