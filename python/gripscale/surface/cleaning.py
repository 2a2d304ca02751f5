"""Cleaning of measured profiles and maps: crop, dropouts, borders, spikes, trend or form.

Each step is reported. Missing heights stay missing: statistics skip them, nothing is interpolated.
Spikes go out and back within three samples; ISO 13473-1:2019, section 7.5, takes edges of stones,
too: docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from gripscale.core import Array, Described, InputError, Mask, checks, in_mm
from gripscale.surface.low_pass import long_waves, mean_square
from gripscale.surface.profile import FEWEST_POINTS, HeightMap, Profile

_TRENDS = ("linear", "mean", "none")
SPIKE_RULES = ("isolated", "iso13473")  # rules for spikes, the first by default; None keeps all
# Samples of the longest run that is a spike: laser spots are one to three samples wide.
_LONGEST_SPIKE = 3
_HEIGHTS_AT_ONCE = 2**20  # of lines of a map that are looked through together
_HIGHEST_ORDER = 8  # highest order of a form: beyond it a polynomial follows the roughness
Limits = tuple[float, float]
_Heights = TypeVar("_Heights", Profile, HeightMap)


@dataclass(frozen=True, repr=False)
class StepReport(Described):
    """The effect of one cleaning step, in numbers of points."""

    step: str
    """Its name, such as "crop" or "spikes"."""
    points: int
    """Points after it."""
    removed: int
    """Points it cut off."""
    made_missing: int
    """Heights it removed from points that remain."""
    missing: int
    """Points without height after it."""
    note: str = ""
    """Details in words."""
    share: float = 0.0
    """Share of the mean square height that long waves held [-], of their step."""


@dataclass(frozen=True, repr=False)
class CleaningReport(Described):
    """The effect of each cleaning step, in order; `print` shows a table."""

    steps: tuple[StepReport, ...]

    def __iter__(self) -> Iterator[StepReport]:
        return iter(self.steps)

    def __getitem__(self, step: str) -> StepReport:
        for report in self.steps:
            if report.step == step:
                return report
        names = ", ".join(report.step for report in self.steps)
        raise InputError(f"step must be one of {names}; got {checks.short_repr(step)}")

    def table(self) -> str:
        """Return the steps as a plain table: points, cut off, made missing, missing in all."""
        lines = [f"{'step':<10} {'points':>8} {'removed':>8} {'made missing':>13} {'missing':>8}"]
        for s in self.steps:
            line = f"{s.step:<10} {s.points:>8} {s.removed:>8} {s.made_missing:>13} {s.missing:>8}"
            lines.append(f"{line}  {s.note}".rstrip())
        return "\n".join(lines)

    __str__ = table


def clean(
    profile: Profile,
    *,
    crop: tuple[float, float] | None = None,
    valid_range: tuple[float, float] | None = None,
    spikes: str | None = "isolated",
    spike_slope: float = 3.0,
    detrend: str = "linear",
    longest_wavelength: float | None = None,
) -> tuple[Profile, CleaningReport]:
    """Crop a profile, mark dropouts and spikes as missing, and take out its trend.

    Returns the cleaned profile and the effect of each step. Raises `InputError` if an argument is
    wrong, or a step leaves too few points or heights.

        >>> round(gs.clean(road, crop=(0.05, 0.15))[0].length, 4)
        0.1

    Parameters
    ----------
    crop : (float, float), optional
        First and last distance to keep [m], both included.
    valid_range : (float, float), optional
        Lowest and highest valid height [m]; others become missing (sentinels, plates).
    spikes : {"isolated", "iso13473"} or None, optional
        Rule by which spikes become missing: runs of at most three samples that go out and back, or
        `mark_steep_steps`; None keeps all.
    spike_slope : float, optional
        Height change per step at which a run stands off, or a step is steep.
    detrend : {"linear", "mean", "none"}, optional
        Trend to subtract, fitted to the valid heights.
    longest_wavelength : float, optional
        Cut-off [m] beyond which waves are taken out, see `gripscale.surface.low_pass`; None keeps
        them.
    """
    checks.instance("profile", profile, Profile)
    steps: list[Callable[[Profile], tuple[Profile, StepReport]]] = []
    if crop is not None:
        steps.append(partial(crop_profile, limits=crop))
    steps.append(partial(mark_dropouts, valid_range=valid_range))
    if spikes is not None:
        checks.one_of("spikes", spikes, SPIKE_RULES)
        rule = mark_steep_steps if spikes == "iso13473" else mark_spikes
        steps.append(partial(rule, slope=spike_slope))
    steps.append(partial(subtract_trend, kind=detrend))
    if longest_wavelength is not None:
        steps.append(partial(subtract_long_waves, longest=longest_wavelength))
    return _in_turn(steps, profile)


def crop_profile(profile: Profile, limits: Limits) -> tuple[Profile, StepReport]:
    """Keep the points whose distance lies within `limits` [m], both included."""
    first, last = limit_pair("crop", limits)
    keep = _kept(profile.x, first, last, "profile")
    cropped = replace(profile, x=profile.x[keep], z=profile.z[keep])
    return _report("crop", profile, cropped, f"kept {in_mm(first)} to {in_mm(last)}")


def _kept(axis: Array, first: float, last: float, kind: str, along: str = "") -> slice:
    """Return the part of an axis within limits [m]; raise `InputError` if it has few points."""
    inside = np.flatnonzero((axis >= first) & (axis <= last))
    if inside.size < FEWEST_POINTS:
        raise InputError(
            f"crop must leave at least {FEWEST_POINTS} points{along}; {in_mm(first)} to "
            f"{in_mm(last)} leaves {inside.size} of a {kind} from {in_mm(axis[0])} to "
            f"{in_mm(axis[-1])}"
        )
    return slice(int(inside[0]), int(inside[-1]) + 1)


def mark_spikes(surface: _Heights, *, slope: float = 3.0) -> tuple[_Heights, StepReport]:
    """Mark spikes as missing: runs of at most three samples that go out and back.

    A run is a spike if all its heights stand off the nearest height before and after it, to the
    same side, by `slope` or more over the distance. On a map a run must do so along x and along y:
    a spike stands off all round, a crest one step wide does not.
    """
    limit = checks.positive("spike_slope", slope)
    steps = (surface.step,) if isinstance(surface, Profile) else surface.step
    along = (
        np.moveaxis(_isolated(np.moveaxis(surface.z, axis, -1), limit * step), -1, axis)
        for axis, step in enumerate(steps)
    )
    z = np.where(np.logical_and.reduce(tuple(along)), np.nan, surface.z)
    return _without_spikes(surface, z, slope, f"out and back, {slope:g} a step")


def _isolated(z: Array, rise: float) -> Mask:
    """Return where `z` belongs to a run along its last axis that stands off by `rise` a step."""
    points = z.shape[-1]
    lines = z.reshape(-1, points)
    spikes = np.zeros(lines.shape, dtype=bool)
    together = max(1, _HEIGHTS_AT_ONCE // points)
    for first in range(0, len(lines), together):
        part = slice(first, first + together)
        spikes[part].reshape(-1)[_runs(lines[part].ravel(), points, rise)] = True
    return spikes.reshape(z.shape)


def _runs(z: Array, points: int, rise: float) -> NDArray[np.intp]:
    """Return the places of heights in such runs, of lines of so many points one after another."""
    at = np.flatnonzero(np.isfinite(z))
    heights = z[at]
    steep = np.abs(np.diff(heights)) >= rise * np.diff(at)
    # a run begins after a steep step, or a line
    starts = np.searchsorted(at, np.arange(0, z.size, points))
    begin = np.union1d(np.flatnonzero(steep) + 1, starts[starts < at.size])
    spikes = []
    for width in range(1, _LONGEST_SPIKE + 1):
        first = begin[begin + width <= at.size]
        last = first + width - 1
        line = at[first] // points
        whole = (at[last] - at[first] == width - 1) & (at[last] // points == line)
        first, last, line = first[whole], last[whole], line[whole]
        runs = heights[first[:, None] + np.arange(width)]
        lowest, highest = runs.min(axis=1), runs.max(axis=1)
        above = below = np.ones(first.size, dtype=bool)
        bounded = ~above
        for side, end in ((first - 1, first), (last + 1, last)):
            near = np.clip(side, 0, at.size - 1)
            inside = (side == near) & (at[near] // points == line)  # at an end one side decides
            off = rise * np.abs(at[near] - at[end])
            above = above & (~inside | (lowest - heights[near] >= off))
            below = below & (~inside | (heights[near] - highest >= off))
            bounded |= inside
        chosen = first[(above | below) & bounded]
        spikes.append(at[chosen[:, None] + np.arange(width)].ravel())
    return np.concatenate(spikes)


def mark_steep_steps(profile: Profile, *, slope: float = 3.0) -> tuple[Profile, StepReport]:
    """Mark both sides of steep steps as missing, by the rule of ISO 13473-1:2019, section 7.5.

    Neighbours whose heights differ by |z[i+1] - z[i]| >= slope * step are a spike: the two heights
    alone cannot say which one is false. The standard then interpolates; here the gaps stay.
    """
    limit = checks.positive("spike_slope", slope) * profile.step
    z = profile.z.copy()
    steep = np.flatnonzero(np.abs(np.diff(z)) >= limit)
    z[steep] = z[steep + 1] = np.nan
    return _without_spikes(profile, z, slope, f"height change per step >= {slope:g}")


def subtract_trend(profile: Profile, kind: str = "linear") -> tuple[Profile, StepReport]:
    """Subtract the least-squares line, or the mean, of the valid heights."""
    checks.one_of("detrend", kind, _TRENDS)
    valid = np.isfinite(profile.z)
    mean = float(profile.z[valid].mean())
    note = f"mean {1e3 * mean:.4g} mm"
    if kind == "none":
        z, note = profile.z, "kept"
    elif kind == "mean" or valid.sum() < 2:
        z = profile.z - mean
    else:
        centred = profile.x - profile.x[valid].mean()
        squares = centred[valid] @ centred[valid]
        slope = float((centred[valid] @ (profile.z[valid] - mean)) / squares)
        z, note = profile.z - mean - slope * centred, f"{note}, slope {slope:.4g}"
    return _report("trend", profile, replace(profile, z=z), note)


def subtract_long_waves(profile: Profile, longest: float) -> tuple[Profile, StepReport]:
    """Subtract the waves beyond the cut-off `longest` [m], by a Gaussian that halves these."""
    waves, whole = long_waves(profile, longest), mean_square(profile, profile.z)
    share = mean_square(profile, waves) / whole if whole else 0.0
    note = f"beyond {in_mm(longest, 4)}: {100.0 * share:.2g} % of the mean square height"
    after, report = _report("long waves", profile, replace(profile, z=profile.z - waves), note)
    return after, replace(report, share=share)


def clean_map(
    surface: HeightMap,
    *,
    crop: tuple[Limits | None, Limits | None] | None = None,
    valid_range: Limits | None = None,
    trim: float | None = 0.5,
    spikes: str | None = "isolated",
    spike_slope: float = 3.0,
    form: int | None = 1,
) -> tuple[HeightMap, CleaningReport]:
    """Crop a map, mark dropouts and spikes as missing, cut off bare borders, take out the form.

    Returns the cleaned map and the effect of each step. Raises `InputError` if an argument is
    wrong, or a step leaves too few points or heights.

        >>> gs.clean_map(height_map)[0].missing
        0

    Parameters
    ----------
    crop : ((float, float) or None, (float, float) or None), optional
        First and last distance to keep along x and along y [m], both included; None keeps all.
    valid_range : (float, float), optional
        Lowest and highest valid height [m]; others become missing (sentinels, fixtures).
    trim : float, optional
        Share of missing heights above which a line at a border is cut off; None keeps all.
    spikes : {"isolated"} or None, optional
        Rule by which spikes become missing, see `mark_spikes`; None keeps all.
    spike_slope : float, optional
        Height change per step at which a run stands off.
    form : int, optional
        Order of the polynomial to subtract: 0 the mean, 1 a plane, 2 a paraboloid (as a shallow
        sphere or cylinder is) and so on to 8; None keeps the form.
    """
    checks.instance("surface", surface, HeightMap)
    steps: list[Callable[[HeightMap], tuple[HeightMap, StepReport]]] = []
    if crop is not None:
        steps.append(partial(crop_map, limits=crop))
    steps.append(partial(mark_dropouts, valid_range=valid_range))
    if trim is not None:
        steps.append(partial(trim_map, share=trim))
    if spikes is not None:
        if checks.one_of("spikes", spikes, SPIKE_RULES) == "iso13473":
            raise InputError('spikes = "iso13473" is a rule for profiles; expected "isolated"')
        steps.append(partial(mark_spikes, slope=spike_slope))
    if form is not None:
        steps.append(partial(subtract_form, order=form))
    return _in_turn(steps, surface)


def crop_map(
    surface: HeightMap, limits: tuple[Limits | None, Limits | None]
) -> tuple[HeightMap, StepReport]:
    """Keep the points within `limits` [m] along x and y, both included."""
    if not isinstance(limits, tuple | list) or len(limits) != 2:
        raise InputError(
            f"crop must be limits along x and along y, or None; got {checks.short_repr(limits)}"
        )
    parts, everything = [], (-math.inf, math.inf)
    for name, axis, pair in zip("xy", (surface.x, surface.y), limits, strict=True):
        ends = limit_pair(f"crop along {name}", everything if pair is None else pair)
        parts.append(_kept(axis, *ends, "map", f" along {name}"))
    return _part(surface, "crop", parts[0], parts[1])


def trim_map(surface: HeightMap, share: float = 0.5) -> tuple[HeightMap, StepReport]:
    """Cut off border lines with more than a share of missing heights, the barest line first."""
    most = checks.share("trim", share)
    missing = np.isnan(surface.z)
    (start, stop), (low, high) = (0, surface.x.size), (0, surface.y.size)
    while True:
        inside = missing[start:stop, low:high]
        borders = [line.mean() for line in (inside[0], inside[-1], inside[:, 0], inside[:, -1])]
        barest = int(np.argmax(borders))
        if borders[barest] <= most:
            break
        start, stop = start + (barest == 0), stop - (barest == 1)
        low, high = low + (barest == 2), high - (barest == 3)
        if min(stop - start, high - low) < FEWEST_POINTS:
            raise InputError(
                f"trim must leave at least {FEWEST_POINTS} points a way; lines with a share of "
                f"{most:g} missing leave {stop - start} x {high - low}"
            )
    return _part(surface, "trim", slice(start, stop), slice(low, high))


def subtract_form(surface: HeightMap, order: int = 1) -> tuple[HeightMap, StepReport]:
    """Subtract the least-squares polynomial of the valid heights, of total order `order`.

    The F-operation of ISO 25178-2 with a polynomial sum of a_mn P_m(x) P_n(y), m + n <= order,
    in Legendre polynomials over the map, which keep the equations well conditioned.
    """
    highest = checks.whole("form", order, least=0, most=_HIGHEST_ORDER)
    terms = [(m, n) for m in range(highest + 1) for n in range(highest + 1 - m)]
    if surface.z.size - surface.missing < len(terms):
        raise InputError(
            f"form {highest} must have at least {len(terms)} heights; "
            f"got {surface.z.size - surface.missing}"
        )
    along, across = (
        np.asarray(np.polynomial.legendre.legvander(np.linspace(-1.0, 1.0, n), highest), float)
        for n in surface.z.shape
    )
    level = float(np.nanmean(surface.z))  # instruments put their origin metres away
    # The normal equations are sums over x and y of products of functions of x and of y: matrix
    # products, without a table of all terms at all points.
    m, n = np.array(terms).T
    valid = np.isfinite(surface.z)
    squares = np.einsum("ia,ib->iab", along, along)
    weighted = np.tensordot(squares, valid.astype(float), axes=(0, 0))
    normal = np.einsum("abj,jc,jd->acbd", weighted, across, across, optimize=True)
    pull = along.T @ np.where(valid, surface.z - level, 0.0) @ across
    matrix = normal[m[:, None], n[:, None], m, n]
    coefficient = np.zeros((highest + 1, highest + 1))
    coefficient[m, n] = np.linalg.lstsq(matrix, pull[m, n], rcond=None)[0]
    mean, slopes = level + coefficient[0, 0], ""
    if highest:
        sizes = (0.5 * length for length in surface.length)
        along_x, along_y = (c / s for c, s in zip(coefficient[[1, 0], [0, 1]], sizes, strict=True))
        slopes = f", slopes {along_x:.4g} along x and {along_y:.4g} along y"
    z = surface.z - level - along @ coefficient @ across.T
    note = f"order {highest}: mean {1e3 * mean:.4g} mm{slopes}"
    return _report("form", surface, replace(surface, z=z), note)


def _part(
    surface: HeightMap, step: str, along: slice, across: slice
) -> tuple[HeightMap, StepReport]:
    """Return a rectangle of the map; raise `InputError` if it has no height."""
    x, y, z = surface.x[along], surface.y[across], surface.z[along, across]
    size = f"{in_mm(x[0])} to {in_mm(x[-1])} by {in_mm(y[0])} to {in_mm(y[-1])}"
    if np.isnan(z).all():
        raise InputError(f"{step} must leave some heights; {size} has none")
    part = surface if z.shape == surface.z.shape else replace(surface, x=x, y=y, z=z)
    return _report(step, surface, part, f"kept {size}")


def mark_dropouts(
    measured: _Heights, valid_range: Limits | None = None
) -> tuple[_Heights, StepReport]:
    """Count the heights already missing; mark those outside `valid_range` [m] as missing."""
    note = f"{measured.missing} missing as measured"
    if valid_range is None:
        return _report("dropouts", measured, measured, note)
    low, high = limit_pair("valid_range", valid_range)
    valid = (measured.z >= low) & (measured.z <= high)  # false where a height is missing
    marked = replace(measured, z=np.where(valid, measured.z, np.nan))
    return _report("dropouts", measured, marked, f"{note}; kept {in_mm(low)} to {in_mm(high)}")


def _without_spikes(
    measured: _Heights, z: Array, slope: float, note: str
) -> tuple[_Heights, StepReport]:
    if np.isnan(z).all():
        step = in_mm(np.max(measured.step), 3)
        raise InputError(
            "the unit of heights or of distances looks wrong: heights differ by up to "
            f"{in_mm(np.nanmax(measured.z) - np.nanmin(measured.z), 3)} in steps of {step}, and "
            f"spike_slope = {slope:g} makes all of them spikes"
        )
    return _report("spikes", measured, replace(measured, z=z), note)


def _in_turn(
    steps: Sequence[Callable[[_Heights], tuple[_Heights, StepReport]]], measured: _Heights
) -> tuple[_Heights, CleaningReport]:
    reports = []
    for step in steps:
        measured, report = step(measured)
        reports.append(report)
    return measured, CleaningReport(tuple(reports))


def _report(step: str, before: _Heights, after: _Heights, note: str) -> tuple[_Heights, StepReport]:
    removed = before.z.size - after.z.size
    made_missing = 0 if removed else after.missing - before.missing
    return after, StepReport(step, after.z.size, removed, made_missing, after.missing, note)


def limit_pair(name: str, limits: Limits) -> Limits:
    """Return two limits [m], the first below the second; raise `InputError` for anything else."""
    try:
        first, last = limits
    except (TypeError, ValueError) as error:
        raise InputError(
            f"{name} must be two numbers [m]; got {checks.short_repr(limits)}"
        ) from error
    first = checks.number(f"{name}[0]", first, unit="m", infinite=True)
    last = checks.number(f"{name}[1]", last, unit="m", infinite=True)
    if first >= last:
        raise InputError(
            f"{name} must have its first number below its second; got {checks.short_repr(limits)}"
        )
    return first, last
