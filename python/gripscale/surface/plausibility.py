"""What is implausible about a surface: sentences for whoever measured it, never a refusal.

Each rule stands beside its limit. Limits are wide: random rough profiles of any Hurst exponent
and the shipped road between its plates pass all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.profile import FloatArray, Profile
from gripscale.surface.sine_fit import AMPLITUDE_FACTOR_RANGE, FACTOR_RANGE
from gripscale.surface.sines import SineStack

STEEPEST = 3.0
"""Height change per step of a spike (ISO 13473-1:2019, section 7.5)."""

MOST_SPIKES = 0.5
"""Share of heights beyond which spikes are the unit's doing; 4 % are usual on roads."""

TALLEST = 0.1
"""Rms height over length beyond which one of the two hardly has its unit."""

LARGEST_HEIGHT = 0.1
"""Rms height [m] that no pavement has."""

COARSEST_STEP = 0.01
"""Step [m] beyond which no texture is measured."""

SMOOTHEST = 5e-3
"""Slope below which three quarters of a surface are too gentle for friction of rubber."""

JUMP = 10.0
"""Height change over a short way, in robust standard deviations of such changes, that is a jump."""

SHORT_WAY = 1 / 400
"""That way, as a share of the profile."""

MOST_JUMPS = 8
"""Jumps beyond which they belong to the surface, as grooves do."""

STRETCHES = 40
"""Parts a profile is cut into to find flat ones."""

SHORTEST_STRETCH = 16
"""Heights a part must have for its roughness to be compared."""

LONGEST_WAVE = 4.0
"""Largest wave, in the largest lag, that a curve may need: a quarter of it rises to the plateau."""

AT_THE_EDGE = 1e-3
"""Distance of the logarithm of a factor from its limit at which it is the limit's."""

FLAT = 0.02
"""Roughness of a part, over the usual one, below which it is flat."""


def profile_doubts(
    profile: Profile, cleaned: Profile | None = None, *, steep: bool = True
) -> tuple[str, ...]:
    """Return what is implausible about a profile, a sentence each; empty where nothing is.

    Parameters
    ----------
    profile : Profile
        The profile as measured.
    cleaned : Profile, optional
        What cleaning made of it: only the heights it kept count, as they were measured.
    steep : bool, optional
        Whether steep steps that are left count; on maps, true edges are left on purpose.

    Returns
    -------
    tuple of str
        Steep slopes, many spikes, plates and jumps, flat stretches, sentinels, and heights or
        lengths that suggest another unit.

    Raises
    ------
    InputError
        If `cleaned` is no part of `profile`.
    """
    checks.instance("profile", profile, Profile)
    if cleaned is not None:
        checks.instance("cleaned", cleaned, Profile)
    checks.flag("steep", steep)
    measured, kept = _kept(profile, cleaned)
    valid = measured[np.isfinite(measured)]
    if valid.size == 0 or np.ptp(valid) == 0.0:
        return ("all heights are equal: is this the column of heights?",)
    spikes = float((np.isfinite(measured) & ~kept).sum() / valid.size)
    if spikes > MOST_SPIKES:  # what they leave says nothing
        return (
            f"{100.0 * spikes:.0f} % of the heights are spikes, steeper than {STEEPEST:g}: "
            "is the unit of heights or of distances right?",
            *_units(_levelled(measured), profile),
        )
    z = np.where(kept, measured, np.nan)
    found = [*_sentinel(z[np.isfinite(z)])]
    if found:  # a sentinel is far off, steep, flat and high, too
        return tuple(found)
    level = _levelled(z)
    found = [*_jumps(level), *_flat(level), *(_slopes(z, profile.step) if steep else ())]
    return (*found, *_units(level, profile))


def _kept(profile: Profile, cleaned: Profile | None) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Return heights as measured where cleaning cropped to, and which of them it kept."""
    if cleaned is None:
        return profile.z, np.isfinite(profile.z)
    first = int(np.searchsorted(profile.x, cleaned.x[0] - 0.5 * profile.step))
    measured = profile.z[first : first + len(cleaned)]
    if measured.size != len(cleaned):
        raise InputError(
            f"cleaned must be a part of profile; got {len(cleaned)} points from "
            f"{cleaned.x[0]:g} m on of a profile from {profile.x[0]:g} m to {profile.x[-1]:g} m"
        )
    return measured, np.isfinite(cleaned.z)


def _levelled(z: FloatArray) -> FloatArray:
    """Return heights without their least-squares line: a tilt is no roughness."""
    place = np.linspace(-1.0, 1.0, z.size)
    valid = np.isfinite(z)
    return np.asarray(z - np.polynomial.Polynomial.fit(place[valid], z[valid], 1)(place))


def _sentinel(valid: FloatArray) -> Iterator[str]:
    """Doubt a value that comes twice, farther from all others than they are from each other."""
    for extreme, words in ((float(valid.min()), "lowest"), (float(valid.max()), "highest")):
        rest = valid[valid != extreme]
        count = valid.size - rest.size
        if rest.size and count > 1 and np.abs(rest - extreme).min() > np.ptp(rest):
            yield (
                f"the {words} height, {extreme * 1e3:g} mm, comes {count} times, far from all "
                "others: does it mark missing heights? valid_range leaves it out"
            )


def _jumps(z: FloatArray) -> Iterator[str]:
    """Doubt a few changes of level, each as wide as the way over which heights are compared."""
    valid = z[np.isfinite(z)]
    way = max(SHORTEST_STRETCH // 2, round(SHORT_WAY * valid.size))
    changes = valid[way:] - valid[:-way]
    if not changes.size:
        return
    far = np.abs(changes - np.median(changes)) > JUMP * _spread(changes)
    jumps = int((_runs(far) >= way // 2).sum())
    if 0 < jumps <= MOST_JUMPS:
        yield (
            f"heights jump in {jumps} place{'s' if jumps > 1 else ''}, by up to "
            f"{_mm(np.abs(changes).max())}, far more than the roughness: are plates, supports or "
            "a step in the profile? crop leaves them out"
        )


def _flat(z: FloatArray) -> Iterator[str]:
    """Doubt parts that bend much less than the others: filled or held, not measured."""
    bends = np.array([_rms(np.diff(part, 2)) for part in _parts(z)])
    flat = bends < FLAT * np.median(bends) if bends.size else np.zeros(0, dtype=bool)
    if flat.any():
        yield (
            f"{flat.sum()} of {flat.size} parts of the profile are flat or straight, with less "
            f"than {FLAT:g} of the usual roughness: are plates or filled gaps in it?"
        )


def _slopes(z: FloatArray, step: float) -> Iterator[str]:
    """Doubt slopes that no surface keeps."""
    slopes = _between_neighbours(z) / step
    rms, steep = _rms(slopes), int((slopes >= STEEPEST * (1 + 1e-6)).sum())
    if rms > STEEPEST:
        yield f"the rms slope is {rms:.3g}, above {STEEPEST:g}: spikes, or another unit?"
    elif steep:
        yield (
            f"{steep} of {slopes.size} slopes left are {STEEPEST:g} or steeper, up to "
            f"{slopes.max():.3g}: remove_spikes with spike_slope = {STEEPEST:g} takes them out"
        )


def _units(z: FloatArray, profile: Profile) -> Iterator[str]:
    """Doubt lengths that no texture has."""
    rms = float(np.nanstd(z))
    slopes = _between_neighbours(z) / profile.step
    sizes = f"rms height {_mm(rms)} over {_mm(profile.length)} in steps of {_mm(profile.step)}"
    if rms > min(TALLEST * profile.length, LARGEST_HEIGHT):
        yield f"{sizes}: too high for a texture; is the unit of heights right?"
    elif slopes.size and np.quantile(slopes, 0.75) < SMOOTHEST:
        yield f"{sizes}: hardly a slope; is the unit of heights right?"
    if profile.step > COARSEST_STEP:
        yield f"{sizes}: too coarse for a texture; is the unit of distances right?"


def _parts(z: FloatArray) -> list[FloatArray]:
    """Return the parts of a profile that have enough heights, each without the missing ones."""
    count = min(STRETCHES, z.size // (2 * SHORTEST_STRETCH))
    parts = [part[np.isfinite(part)] for part in np.array_split(z, max(count, 1))]
    return [part for part in parts if part.size >= SHORTEST_STRETCH]


def _between_neighbours(z: FloatArray) -> FloatArray:
    """Return the sizes of height changes between neighbours that are both there."""
    changes = np.abs(np.diff(z))
    return changes[np.isfinite(changes)]


def _mm(length: float) -> str:
    return f"{length * 1e3:.3g} mm"


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2))) if values.size else 0.0


def _spread(values: FloatArray) -> float:
    """Return the robust standard deviation: 1.4826 times the median distance from the median."""
    return float(1.4826 * np.median(np.abs(values - np.median(values))))


def _runs(flags: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return how many flags stand side by side, stretch by stretch."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], flags.astype(np.int8), [0]))))
    return edges[1::2] - edges[::2]


def stack_notes(
    sines: SineStack, correlation: HeightDifference, fit: Mapping[str, Any]
) -> Iterator[str]:
    """Yield where the waves end and why, and factors at the edge of the range searched.

    `fit` are the arguments the waves were fitted with.
    """
    last, carried = float(sines.wavelength[-1]), correlation.carried
    stated = fit.get("smallest_wavelength") is not None or fit.get("cut_off") is not None
    if carried is not None and last < carried * (1.0 - 1e-6):
        yield (
            f"the smallest wave, {_mm(last)}, is shorter than the measurement carries, "
            f"{_mm(carried)}: it extrapolates the waves above it"
        )
    elif not stated:
        held = carried is not None and last <= carried * (1.0 + 1e-6)
        why = "the shortest the measurement carries" if held else "where the fit puts it"
        yield f"no smallest wavelength is stated: the smallest wave is {_mm(last)}, {why}"
    first, longest = float(sines.wavelength[0]), LONGEST_WAVE * float(correlation.lag[-1])
    if first > longest and fit.get("first_wavelength") is None:
        yield (
            f"the largest wave, {_mm(first)}, is longer than {LONGEST_WAVE:g} times the largest "
            f"lag, {_mm(longest)}: fewer scales, or a smaller smallest_wavelength, suit the curve"
        )
    for name, limits in (
        ("s_wavelength", FACTOR_RANGE),
        ("s_amplitude", AMPLITUDE_FACTOR_RANGE),
    ):
        factor = getattr(sines, name)
        if factor is None or fit.get(name) is not None:
            continue
        if min(abs(np.log(factor / limit)) for limit in limits) < AT_THE_EDGE:
            yield (
                f"{name} is {factor:.3g}, at the edge of the range searched, {limits[0]:g} to "
                f"{limits[1]:g}: the correlation does not fix it; give it, or take other scales"
            )
