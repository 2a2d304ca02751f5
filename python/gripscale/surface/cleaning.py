"""Cleaning of measured profiles and maps: crop, dropouts, borders, spikes, trend or form.

Each step is reported. Missing heights stay missing: statistics skip them, nothing is interpolated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TypeVar

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.core.units import in_mm
from gripscale.surface.profile import FEWEST_POINTS, HeightMap, Profile

_TRENDS = ("linear", "mean", "none")

_HIGHEST_ORDER = 8
"""Highest order of a form: beyond it a polynomial follows the roughness."""

Limits = tuple[float, float]
_Heights = TypeVar("_Heights", Profile, HeightMap)


@dataclass(frozen=True)
class StepReport:
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


@dataclass(frozen=True)
class CleaningReport:
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
    remove_spikes: bool = True,
    spike_slope: float = 3.0,
    across_gaps: bool = False,
    detrend: str = "linear",
) -> tuple[Profile, CleaningReport]:
    """Crop a profile, mark dropouts and spikes as missing, and take out its trend.

    Returns the cleaned profile and the effect of each step. Raises `InputError` if an argument is
    wrong, or a step leaves too few points or heights.

    Parameters
    ----------
    profile : Profile
        The measured profile.
    crop : (float, float), optional
        First and last distance to keep [m], both included.
    valid_range : (float, float), optional
        Lowest and highest valid height [m]; others become missing (sentinels, plates).
    remove_spikes : bool, optional
        Mark spikes as missing, see `mark_spikes`.
    spike_slope : float, optional
        Height change per step at which neighbours are a spike; 3 in ISO 13473-1.
    across_gaps : bool, optional
        Hold the points on both sides of a gap to the same slope as well, see `mark_spikes`.
    detrend : {"linear", "mean", "none"}, optional
        Trend to subtract, fitted to the valid heights.
    """
    checks.instance("profile", profile, Profile)
    steps: list[Callable[[Profile], tuple[Profile, StepReport]]] = []
    if crop is not None:
        steps.append(partial(crop_profile, limits=crop))
    steps.append(partial(mark_dropouts, valid_range=valid_range))
    if checks.flag("remove_spikes", remove_spikes):
        steps.append(partial(mark_spikes, slope=spike_slope, across_gaps=across_gaps))
    steps.append(partial(subtract_trend, kind=detrend))
    return _in_turn(steps, profile)


def crop_profile(profile: Profile, limits: Limits) -> tuple[Profile, StepReport]:
    """Keep the points whose distance lies within `limits` [m], both included."""
    first, last = limit_pair("crop", limits)
    keep = (profile.x >= first) & (profile.x <= last)
    if keep.sum() < FEWEST_POINTS:
        raise InputError(
            f"crop must leave at least {FEWEST_POINTS} points; {in_mm(first)} to {in_mm(last)} "
            f"leaves {keep.sum()} of a profile from {in_mm(profile.x[0])} to {in_mm(profile.x[-1])}"
        )
    cropped = replace(profile, x=profile.x[keep], z=profile.z[keep])
    return _report("crop", profile, cropped, f"kept {in_mm(first)} to {in_mm(last)}")


def mark_spikes(
    profile: Profile, *, slope: float = 3.0, across_gaps: bool = False
) -> tuple[Profile, StepReport]:
    """Mark spikes as missing, by the rule of ISO 13473-1:2019, section 7.5.

    Neighbours whose heights differ by |z[i+1] - z[i]| >= slope * step are a spike, and both become
    missing: the rule runs forwards and backwards along the profile, because the two heights alone
    cannot say which one is false. One pass is complete, since it makes no new neighbours.

    The standard then interpolates. Here the gaps stay, and heights on both sides of a gap still
    count in statistics at larger lags. With `across_gaps` the same rule holds for the valid points
    next to a gap, |z[j] - z[i]| >= slope * (j - i) * step, repeated until none remain. That makes
    the curve of height differences consistent at the smallest lags (a stationary profile has
    C_z(m l) <= m^2 C_z(l), which the standard's rule alone can break), but also wears away true
    steep flanks, so it is a choice.
    """
    limit = checks.positive("spike_slope", slope) * profile.step
    repeated = checks.flag("across_gaps", across_gaps)
    z, passes, marked = profile.z.copy(), 0, True
    while marked:
        valid = np.flatnonzero(np.isfinite(z))
        distance = np.diff(valid)
        steep = np.abs(np.diff(z[valid])) >= limit * distance
        if not repeated:
            steep &= distance == 1
        z[valid[:-1][steep]] = z[valid[1:][steep]] = np.nan
        passes, marked = passes + 1, repeated and bool(steep.any())
    note = f"height change per step >= {slope:g}"
    if repeated:
        note += f", across gaps, {passes} passes"
    return _without_spikes(profile, z, slope, note)


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


def clean_map(
    surface: HeightMap,
    *,
    crop: tuple[Limits | None, Limits | None] | None = None,
    valid_range: Limits | None = None,
    trim: float | None = 0.5,
    remove_spikes: bool = True,
    spike_slope: float = 3.0,
    form: int | None = 1,
) -> tuple[HeightMap, CleaningReport]:
    """Crop a map, mark dropouts and spikes as missing, cut off bare borders, take out the form.

    Returns the cleaned map and the effect of each step. Raises `InputError` if an argument is
    wrong, or a step leaves too few points or heights.

    Parameters
    ----------
    surface : HeightMap
        The measured map.
    crop : ((float, float) or None, (float, float) or None), optional
        First and last distance to keep along x and along y [m], both included; None keeps all.
    valid_range : (float, float), optional
        Lowest and highest valid height [m]; others become missing (sentinels, fixtures).
    trim : float, optional
        Share of missing heights above which a line at a border is cut off; None keeps all.
    remove_spikes : bool, optional
        Mark spikes as missing, see `mark_map_spikes`.
    spike_slope : float, optional
        Height over the neighbours, per step, at which a point is a spike.
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
    if checks.flag("remove_spikes", remove_spikes):
        steps.append(partial(mark_map_spikes, slope=spike_slope))
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
        first, last = limit_pair(f"crop along {name}", everything if pair is None else pair)
        inside = np.flatnonzero((axis >= first) & (axis <= last))
        if inside.size < FEWEST_POINTS:
            raise InputError(
                f"crop must leave at least {FEWEST_POINTS} points along {name}; {in_mm(first)} to "
                f"{in_mm(last)} leaves {inside.size} of a map from {in_mm(axis[0])} to "
                f"{in_mm(axis[-1])}"
            )
        parts.append(slice(int(inside[0]), int(inside[-1]) + 1))
    return _part(surface, "crop", parts[0], parts[1])


def trim_map(surface: HeightMap, share: float = 0.5) -> tuple[HeightMap, StepReport]:
    """Cut off border lines with more than a share of missing heights, the barest line first."""
    most = checks.not_negative("trim", share)
    if most > 1.0:
        raise InputError(f"trim must be a share of the heights, from 0 to 1; got {most:g}")
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


def mark_map_spikes(surface: HeightMap, *, slope: float = 3.0) -> tuple[HeightMap, StepReport]:
    """Mark spikes as missing: heights far from the median of the valid heights around them.

    A point is a spike if |z - median of its up to eight neighbours| >= slope * step, the larger
    step of both ways. It is the median test of J. Westerweel, Exp. Fluids 16 (1994) 236,
    doi:10.1007/BF00206543, with the limit of ISO 13473-1 for profiles. The rule for profiles marks
    both sides of a steep step; on a map most neighbours of a point at a straight edge are on its
    own side, so that stones keep their edges, and a spike of up to two by two points is marked.
    """
    limit = checks.positive("spike_slope", slope) * max(surface.step)
    nx, ny = surface.z.shape
    padded = np.pad(surface.z, 1, constant_values=np.nan)
    around = np.stack(
        [padded[i : i + nx, j : j + ny] for i in range(3) for j in range(3) if (i, j) != (1, 1)]
    )
    # sorted with NaN last: the median is the mean of the two in the middle of the valid ones
    around.sort(axis=0)
    count = np.isfinite(around).sum(axis=0)[None]
    low, high = (
        np.take_along_axis(around, at, axis=0)[0]
        for at in (np.maximum(count - 1, 0) // 2, np.minimum(count // 2, 7))
    )
    spikes = np.abs(surface.z - 0.5 * (low + high)) >= limit  # false where a height is missing
    z = np.where(spikes, np.nan, surface.z)
    return _without_spikes(surface, z, slope, f"{slope:g} steps off the median around")


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
    return _report(step, surface, replace(surface, x=x, y=y, z=z), f"kept {size}")


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
    steps: Sequence[Callable[[_Heights], tuple[_Heights, StepReport]]],
    measured: _Heights,
) -> tuple[_Heights, CleaningReport]:
    """Return a profile or map after all steps, and their reports."""
    reports = []
    for step in steps:
        measured, report = step(measured)
        reports.append(report)
    return measured, CleaningReport(tuple(reports))


def _report(step: str, before: _Heights, after: _Heights, note: str) -> tuple[_Heights, StepReport]:
    """Return the changed profile or map and the count of its changes."""
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
