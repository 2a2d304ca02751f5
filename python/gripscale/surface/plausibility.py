"""Findings about implausible surfaces, for the person who measured them.

No surface is refused. Limits are wide: random rough profiles of any Hurst exponent and the shipped
road between its plates pass all of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from gripscale.core import Array, Finding, InputError, Severity, Topic, checks, doubt, in_mm
from gripscale.core.arrays import runs
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.profile import Profile
from gripscale.surface.sines import AMPLITUDE_FACTOR_RANGE, FACTOR_RANGE, SineStack
from gripscale.surface.supports import road_between, support_plates

_SPIKE_SLOPE = 3.0  # height change per step that is steep (ISO 13473-1:2019, section 7.5)

# Share of heights at such steps beyond which the unit is probably wrong; roads have 4 %.
_MOST_STEEP = 0.5
_TALLEST = 0.1  # rms height over length beyond which one of the two probably has a wrong unit
_LARGEST_HEIGHT = 0.1  # rms height [m] that no pavement has
_COARSEST_STEP = 0.01  # step [m] beyond which no texture is measured

# Slope that a quarter of a rough surface exceeds: a gentler one causes hardly any friction.
_SMOOTHEST = 5e-3
# Height change over a short way that is a jump, in robust standard deviations of such changes.
_JUMP = 10.0
_SHORT_WAY = 1 / 400  # the short way, as a share of the profile
_MOST_JUMPS = 8  # jumps beyond which they belong to the surface, as grooves do
_STRETCHES = 40  # parts into which a profile is cut to find flat ones
_SHORTEST_STRETCH = 16  # heights a part must have for its roughness to be compared

# Largest wave of a plausible fit, in largest lags: a quarter of a wave rises to the plateau.
_LONGEST_WAVE = 4.0
# Distance of the logarithm of a factor from its limit below which the factor is at the limit.
_AT_THE_EDGE = 1e-3
_FLAT = 0.02  # roughness of a part, over the usual one, below which it is flat


def profile_warnings(profile: Profile, cleaned: Profile | None = None) -> tuple[Finding, ...]:
    """Return findings about an implausible profile; empty if there are none.

    They concern many steep steps, plates and jumps, flat stretches, sentinels, and
    heights or lengths that suggest another unit. Sentinels, plates and units are doubts: the answer
    may be that of another road. With the `cleaned` profile only the heights it kept count, as they
    were measured, and none beside a step of slope 3 or more. Raises `InputError` if it is no part
    of `profile`.
    """
    doubts = _doubts(profile, cleaned)
    of_doubts = tuple(doubt(text, topic=Topic.SURFACE) for text in doubts.texts)
    if doubts.heights is None or doubts.plates:
        return of_doubts
    level = _levelled(doubts.heights)
    return (*of_doubts, *map(_warning, (*_jump_warnings(level), *_flat_warnings(level))))


def _warning(text: str) -> Finding:
    return Finding(Severity.WARNING, text, topic=Topic.SURFACE)


def has_likely_units(profile: Profile) -> bool:
    """Return whether the units of heights and distances are plausible for a texture."""
    return not _doubts(profile, None).units


class _Doubts(NamedTuple):
    """Reasons to doubt that a profile is a road."""

    texts: tuple[str, ...] = ()
    heights: Array | None = None  # valid heights [m]; None if they are meaningless
    plates: bool = False
    units: bool = False  # whether a length suggests another unit


def _doubts(profile: Profile, cleaned: Profile | None) -> _Doubts:
    """Return reasons to doubt a profile; raise `InputError` as `profile_warnings` does."""
    part = _kept_part(profile, cleaned)
    measured = part.z
    valid = measured[np.isfinite(measured)]
    if valid.size == 0 or np.ptp(valid) == 0.0:
        return _Doubts(("all heights are equal: is this the column of heights?",))
    steps = np.abs(np.diff(measured)) >= _SPIKE_SLOPE * profile.step
    steep = np.append(steps, False) | np.append(False, steps)
    share = float(steep.sum() / valid.size)
    if share > _MOST_STEEP:  # the heights mean nothing
        text = (
            f"{100.0 * share:.0f} % of the heights stand at steps steeper than {_SPIKE_SLOPE:g}: "
            "is the unit of heights or of distances right?"
        )
        return _Doubts((text, *_unit_warnings(_levelled(measured), profile)), units=True)
    if cleaned is not None:
        kept = np.isfinite(cleaned.z) & ~steep
        part = replace(part, z=np.where(kept, measured, np.nan))
    sentinels = tuple(_sentinel_warnings(part.z[np.isfinite(part.z)]))
    if sentinels:  # a sentinel is far off, steep, flat and high, too
        return _Doubts(sentinels)
    units = tuple(_unit_warnings(_levelled(part.z), profile))
    supports = support_plates(part)
    if not supports:
        return _Doubts(units, part.z, units=bool(units))
    road = road_between(part)
    ends = "" if road is None else ' = ["{}", "{}"]'.format(*map(in_mm, road))
    plates = (
        "plates, supports or filled gaps lie in the profile, at "
        f"{' and '.join(map(str, supports))}: they carry the rubber in place of the surface; "
        f"crop{ends} leaves them out."
    )
    return _Doubts((plates, *units), part.z, plates=True, units=bool(units))


def _kept_part(profile: Profile, cleaned: Profile | None) -> Profile:
    checks.instance("profile", profile, Profile)
    if cleaned is None:
        return profile
    checks.instance("cleaned", cleaned, Profile)
    first = int(np.searchsorted(profile.x, cleaned.x[0] - 0.5 * profile.step))
    measured = profile.z[first : first + len(cleaned)]
    if measured.size != len(cleaned):
        raise InputError(
            f"cleaned must be a part of profile; got {len(cleaned)} points from "
            f"{cleaned.x[0]:g} m on of a profile from {profile.x[0]:g} m to {profile.x[-1]:g} m"
        )
    return replace(cleaned, z=measured)


def _levelled(z: Array) -> Array:
    """Return heights without their least-squares line: a tilt is no roughness."""
    x = np.linspace(-1.0, 1.0, z.size)
    valid = np.isfinite(z)
    return np.asarray(z - np.polynomial.Polynomial.fit(x[valid], z[valid], 1)(x))


def _sentinel_warnings(valid: Array) -> Iterator[str]:
    """Warn of a repeated value that lies farther from all others than their range."""
    for extreme, words in ((float(valid.min()), "lowest"), (float(valid.max()), "highest")):
        rest = valid[valid != extreme]
        count = valid.size - rest.size
        if rest.size and count > 1 and np.abs(rest - extreme).min() > np.ptp(rest):
            yield (
                f"the {words} height, {extreme * 1e3:g} mm, comes {count} times, far from all "
                "others: does it mark missing heights? valid_range leaves it out."
            )


def _jump_warnings(z: Array) -> Iterator[str]:
    """Warn of a few changes of level, each as wide as the way over which heights are compared."""
    valid = z[np.isfinite(z)]
    way = max(_SHORTEST_STRETCH // 2, round(_SHORT_WAY * valid.size))
    changes = valid[way:] - valid[:-way]
    if not changes.size:
        return
    departures = np.abs(changes - np.median(changes))
    # 1.4826 median absolute departures are a standard deviation that jumps themselves hardly move
    far = departures > _JUMP * float(1.4826 * np.median(departures))
    jumps = sum(last - first >= way // 2 for first, last in runs(far))
    if 0 < jumps <= _MOST_JUMPS:
        yield (
            f"heights jump in {jumps} place{'s' if jumps > 1 else ''}, by up to "
            f"{in_mm(np.abs(changes).max(), 3)}, far more than the roughness: are plates, "
            "supports or a step in the profile? crop leaves them out."
        )


def _flat_warnings(z: Array) -> Iterator[str]:
    """Warn of parts that bend much less than the others: filled or held, not measured."""
    count = min(_STRETCHES, z.size // (2 * _SHORTEST_STRETCH))
    parts = [part[np.isfinite(part)] for part in np.array_split(z, max(count, 1))]
    bends = np.array(
        [np.sqrt(np.mean(np.diff(p, 2) ** 2)) for p in parts if p.size >= _SHORTEST_STRETCH]
    )
    flat = bends < _FLAT * np.median(bends) if bends.size else np.zeros(0, dtype=bool)
    if flat.any():
        yield (
            f"{flat.sum()} of {flat.size} parts of the profile are flat or straight, with less "
            f"than {_FLAT:g} of the usual roughness: are plates or filled gaps in it?"
        )


def _unit_warnings(z: Array, profile: Profile) -> Iterator[str]:
    rms = float(np.nanstd(z))
    changes = np.abs(np.diff(z))  # between neighbours that are both valid
    slopes = changes[np.isfinite(changes)] / profile.step
    lengths = (in_mm(length, 3) for length in (rms, profile.length, profile.step))
    sizes = "rms height {} over {} in steps of {}".format(*lengths)
    if rms > min(_TALLEST * profile.length, _LARGEST_HEIGHT):
        yield f"{sizes}: too high for a texture; is the unit of heights right?"
    elif slopes.size and np.quantile(slopes, 0.75) < _SMOOTHEST:
        yield f"{sizes}: hardly any slope; is the unit of heights right?"
    if profile.step > _COARSEST_STEP:
        yield f"{sizes}: too coarse for a texture; is the unit of distances right?"


def extrapolation_notes(sines: SineStack, correlation: HeightDifference) -> Iterator[Finding]:
    """Yield findings on waves and roughness beyond the resolution of the measurement."""
    last, end, limit = float(sines.wavelength[-1]), sines.cut_off, correlation.resolution_limit
    if limit is not None and _beyond(last, limit):
        yield _warning(
            f"The smallest wave, {in_mm(last, 3)}, is shorter than the measurement resolves, "
            f"{in_mm(limit, 3)}: it extrapolates the waves above it."
        )
    if end is not None and limit is not None and _beyond(end, limit):
        yield _warning(
            f"The cut-off, {in_mm(end, 3)}, lies beyond what the measurement carries, "
            f"{in_mm(limit, 3)}: the roughness between them is extrapolated."
        )


def _beyond(length: float, limit: float | None) -> bool:
    """Return whether a wave is shorter than what the measurement resolves [m]."""
    return limit is not None and length < limit * (1.0 - 1e-6)


def stack_notes(
    sines: SineStack, correlation: HeightDifference, fit: Mapping[str, Any]
) -> Iterator[Finding]:
    """Yield findings on the end of the waves and on factors at the edge of their range.

    `fit` are the arguments of `fit_sines` for the waves.
    """
    last, limit = float(sines.wavelength[-1]), correlation.resolution_limit
    stated_end = fit.get("smallest_wavelength") is not None or fit.get("cut_off") is not None
    if not stated_end and not _beyond(last, limit):
        at_limit = limit is not None and last <= limit * (1.0 + 1e-6)
        reason = "the shortest the measurement carries" if at_limit else "where the fit puts it"
        yield _warning(
            f"no smallest wavelength is stated: the smallest wave is {in_mm(last, 3)}, {reason}."
        )
    first, longest = float(sines.wavelength[0]), _LONGEST_WAVE * float(correlation.lag[-1])
    if first > longest and fit.get("first_wavelength") is None:
        yield _warning(
            f"the largest wave, {in_mm(first, 3)}, is longer than {_LONGEST_WAVE:g} times the "
            f"largest lag, {in_mm(longest, 3)}: fewer scales, or a smaller smallest_wavelength, "
            "suit the curve."
        )
    for name, limits in (("s_wavelength", FACTOR_RANGE), ("s_amplitude", AMPLITUDE_FACTOR_RANGE)):
        factor = getattr(sines, name)
        if factor is None or fit.get(name) is not None:
            continue
        if min(abs(np.log(factor / edge)) for edge in limits) < _AT_THE_EDGE:
            yield _warning(
                f"{name} is {factor:.3g}, at the edge of the range searched, {limits[0]:g} to "
                f"{limits[1]:g}: the correlation does not determine it; state it, or change scales."
            )
