"""Make a measured profile fit for statistics: crop, dropouts, spikes, trend, each one reported.

Missing heights stay missing: statistics skip them, nothing is interpolated.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from gripscale import checks
from gripscale.errors import InputError
from gripscale.surface.profile import FEWEST_POINTS, FloatArray, Profile
from gripscale.units import in_mm

TRENDS = ("linear", "mean", "none")


@dataclass(frozen=True)
class StepReport:
    """What one cleaning step did, in numbers of points."""

    step: str
    """Its name, such as "crop" or "spikes"."""
    points: int
    """Points after it."""
    removed: int
    """Points it cut off."""
    made_missing: int
    """Heights it took out, of points that stay."""
    missing: int
    """Points without height after it."""
    note: str = ""
    """What else is to be said, in words."""


@dataclass(frozen=True)
class CleaningReport:
    """What each cleaning step did, in order; `print` shows a table."""

    steps: tuple[StepReport, ...]

    def __iter__(self) -> Iterator[StepReport]:
        return iter(self.steps)

    def __getitem__(self, step: str) -> StepReport:
        for report in self.steps:
            if report.step == step:
                return report
        known = ", ".join(report.step for report in self.steps)
        raise InputError(f"step must be one of {known}; got {checks.shown(step)}")

    def table(self) -> str:
        """Return the steps as a plain table: points left, cut off, made missing, missing now."""
        lines = [f"{'step':<10} {'points':>8} {'removed':>8} {'made missing':>13} {'missing':>8}"]
        for s in self.steps:
            line = f"{s.step:<10} {s.points:>8} {s.removed:>8} {s.made_missing:>13} {s.missing:>8}"
            lines.append(f"{line}  {s.note}".rstrip())
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.table()


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

    Parameters
    ----------
    profile : Profile
        The measured profile.
    crop : (float, float), optional
        First and last distance to keep [m], both included.
    valid_range : (float, float), optional
        Lowest and highest height to believe [m]; others become missing (sentinels, plates).
    remove_spikes : bool, optional
        Mark spikes as missing, see `mark_spikes`.
    spike_slope : float, optional
        Height change per step at which neighbours are a spike; 3 in ISO 13473-1.
    across_gaps : bool, optional
        Hold the points on both sides of a gap to the same slope as well, see `mark_spikes`.
    detrend : {"linear", "mean", "none"}, optional
        Trend to subtract, fitted to the valid heights.

    Returns
    -------
    Profile
        The cleaned profile.
    CleaningReport
        What each step did.

    Raises
    ------
    InputError
        If an argument is wrong, or a step leaves too few points or heights.
    """
    checks.instance("profile", profile, Profile)
    reports = []
    if crop is not None:
        profile, report = crop_profile(profile, crop)
        reports.append(report)
    profile, report = mark_dropouts(profile, valid_range)
    reports.append(report)
    if checks.flag("remove_spikes", remove_spikes):
        profile, report = mark_spikes(profile, slope=spike_slope, across_gaps=across_gaps)
        reports.append(report)
    profile, report = subtract_trend(profile, detrend)
    reports.append(report)
    return profile, CleaningReport(tuple(reports))


def crop_profile(profile: Profile, limits: tuple[float, float]) -> tuple[Profile, StepReport]:
    """Keep the points whose distance lies within `limits` [m], both included."""
    first, last = interval("crop", limits)
    keep = (profile.x >= first) & (profile.x <= last)
    if keep.sum() < FEWEST_POINTS:
        raise InputError(
            f"crop must leave at least {FEWEST_POINTS} points; {in_mm(first)} to {in_mm(last)} "
            f"leaves {keep.sum()} of a profile from {in_mm(profile.x[0])} to {in_mm(profile.x[-1])}"
        )
    note = f"kept {in_mm(first)} to {in_mm(last)}"
    return _changed(profile, "crop", x=profile.x[keep], z=profile.z[keep], note=note)


def mark_dropouts(
    profile: Profile, valid_range: tuple[float, float] | None = None
) -> tuple[Profile, StepReport]:
    """Count the heights already missing; mark those outside `valid_range` [m] as missing."""
    z, note = believed(profile.z, valid_range)
    return _changed(profile, "dropouts", z=z, note=note)


def believed(z: FloatArray, valid_range: tuple[float, float] | None) -> tuple[FloatArray, str]:
    """Return heights with those outside `valid_range` [m] missing, and a note of both."""
    note = f"{int(np.isnan(z).sum())} missing as measured"
    if valid_range is None:
        return z, note
    low, high = interval("valid_range", valid_range)
    inside = (z >= low) & (z <= high)  # comparisons with NaN are false: missing stays missing
    return np.where(inside, z, np.nan), f"{note}; kept {in_mm(low)} to {in_mm(high)}"


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

    Parameters
    ----------
    profile : Profile
        The profile.
    slope : float, optional
        Largest height change per distance that is still a surface.
    across_gaps : bool, optional
        Hold points on both sides of a gap to the rule as well.

    Raises
    ------
    InputError
        If `slope` is not above zero, or all heights would become missing.
    """
    limit = checks.positive("spike_slope", slope) * profile.step
    z = profile.z.copy()
    passes = 1
    checks.flag("across_gaps", across_gaps)
    spikes = _spikes(z, limit, across_gaps)
    while spikes.size:
        z[spikes] = np.nan
        if not across_gaps:
            break
        spikes = _spikes(z, limit, across_gaps)
        passes += 1
    if np.isnan(z).all():
        raise InputError(
            f"spike_slope must leave some heights; {slope:g} makes all of them spikes (or are the "
            "units of distance and height others?)"
        )
    note = f"height change per step >= {slope:g}"
    return _changed(
        profile,
        "spikes",
        z=z,
        note=f"{note}, across gaps, {passes} passes" if across_gaps else note,
    )


def _spikes(
    z: FloatArray, limit: float, across_gaps: bool
) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return the indices of both points of every pair that is too steep."""
    valid = np.flatnonzero(np.isfinite(z))
    distance = np.diff(valid)
    steep = np.abs(np.diff(z[valid])) >= limit * distance
    if not across_gaps:
        steep &= distance == 1
    return np.unique(np.concatenate((valid[:-1][steep], valid[1:][steep])))


def subtract_trend(profile: Profile, kind: str = "linear") -> tuple[Profile, StepReport]:
    """Subtract the least-squares line, or the mean, of the valid heights."""
    checks.one_of("detrend", kind, TRENDS)
    valid = np.isfinite(profile.z)
    if kind == "none":
        return _changed(profile, "trend", z=profile.z, note="kept")
    mean = float(profile.z[valid].mean())
    if kind == "mean" or valid.sum() < 2:
        return _changed(profile, "trend", z=profile.z - mean, note=f"mean {1e3 * mean:.4g} mm")
    centred = profile.x - profile.x[valid].mean()
    slope = float((centred[valid] @ (profile.z[valid] - mean)) / (centred[valid] @ centred[valid]))
    z = profile.z - mean - slope * centred
    return _changed(profile, "trend", z=z, note=f"mean {1e3 * mean:.4g} mm, slope {slope:.4g}")


def _changed(
    profile: Profile, step: str, *, z: FloatArray, x: FloatArray | None = None, note: str = ""
) -> tuple[Profile, StepReport]:
    """Return the changed profile and the count of what changed."""
    new = replace(profile, x=profile.x if x is None else x, z=z)
    removed = len(profile) - len(new)
    made_missing = 0 if removed else new.missing - profile.missing
    return new, StepReport(step, len(new), removed, made_missing, new.missing, note)


def interval(name: str, limits: tuple[float, float]) -> tuple[float, float]:
    """Return two limits [m], the first below the second; raise `InputError` for anything else."""
    try:
        first, last = limits
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must be two numbers [m]; got {checks.shown(limits)}") from error
    first = checks.number(f"{name}[0]", first, unit="m", infinite=True)
    last = checks.number(f"{name}[1]", last, unit="m", infinite=True)
    if first >= last:
        raise InputError(
            f"{name} must have its first number below its second; got {checks.shown(limits)}"
        )
    return first, last
