"""Findings about implausible surfaces, for the person who measured them.

No surface is refused; limits are wide. Plates and supports are flat stretches with steps at their
sides, |z - line| > 6 s with s = 1.4826 median |z - line|, or smooth ones. White noise of the sensor
has the variance s^2 in second differences on the smoothest stretches (docs/derivations.md),

    S(a) = < (z(x + a) - 2 z(x) + z(x - a))^2 > / 6 = s^2 + c a^p,    a = 1, 2, 4 steps.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from gripscale.core import Array, Finding, InputError, Mask, Severity, Topic, checks, doubt, in_mm
from gripscale.core.arrays import runs
from gripscale.surface.height_difference import HeightDifference
from gripscale.surface.low_pass import one_period, transmission
from gripscale.surface.profile import Profile
from gripscale.surface.sines import AMPLITUDE_FACTOR_RANGE, FACTOR_RANGE, SineStack

_OFF_THE_LINE = 6.0  # distance from the line, in robust standard deviations, that no road reaches
# Roughness of two pieces in a row, over the usual one, below which they are a plate.
_SMOOTH_SHARE = 0.02
_SIDE_STEP = 0.5  # change of height at the side of a stretch, over its height, that is a step
# Departure (rms) of a flat stretch from its mean, over its height. A cap that begins at half of its
# height has 0.15 and more, the four plates of the shipped road 0.02 to 0.05.
_LEVEL = 0.1
_PIECES = 50  # pieces of a profile whose level and roughness are compared
# Heights that tell the roughness of a piece, and that a stretch off the line must have.
_FEWEST_HEIGHTS = 16
# Length of a plate, as a share of the profile: shorter are joints and cracks.
_SHORTEST_SHARE = 1 / 400
_MOST_STRETCHES = 6  # stretches beyond which they belong to the surface
# Distance kept from a plate, as a share of the profile: its edge, its shadow and what holds it.
_GUARD_SHARE = 1 / 40


@dataclass(frozen=True)
class Support:
    """A stretch of a profile that is a plate or a support."""

    first: float  # where it begins [m]
    last: float  # where it ends [m]
    height: float  # median of its heights over the road [m]

    def __str__(self) -> str:
        side = "above" if self.height > 0.0 else "below"
        span = f"{in_mm(self.first, 4)} to {in_mm(self.last, 4)}"
        return f"{span} ({in_mm(abs(self.height), 2)} {side} the road)"


def support_plates(profile: Profile) -> tuple[Support, ...]:
    """Return the plates and supports in a profile, in order; empty if there are none."""
    checks.instance("profile", profile, Profile)
    valid = np.flatnonzero(np.isfinite(profile.z))
    if valid.size < _PIECES * _FEWEST_HEIGHTS:
        return ()
    x, z = profile.x[valid], profile.z[valid]
    pieces = np.array_split(np.arange(valid.size), _PIECES)
    middles, levels = (np.array([np.median(part[at]) for at in pieces]) for part in (x, z))
    i, j = np.triu_indices(_PIECES, 1)
    slope = np.median((levels[j] - levels[i]) / (middles[j] - middles[i]))
    height = z - slope * x - np.median(levels - slope * middles)
    typical = 1.4826 * float(np.median(np.abs(height)))
    off = _stepped(_runs_of(np.abs(height) > _OFF_THE_LINE * typical, _FEWEST_HEIGHTS), height)
    roughness = []
    for at in pieces:  # the rms departure of each piece from its own line [m]
        centred = x[at] - x[at].mean()
        tilt = centred @ z[at] / (centred @ centred)
        roughness.append(float(np.std(z[at] - tilt * centred)))
    rough = np.array(roughness)
    smooth = _runs_of(rough < _SMOOTH_SHARE * np.median(rough), 2)
    suspect = off | np.repeat(smooth, [at.size for at in pieces])
    supports = []
    for first, last in runs(suspect):
        # missing heights on the sides of a stretch belong to it
        before = valid[first - 1] + 1 if first else 0
        after = valid[last] - 1 if last < valid.size else len(profile) - 1
        start, stop = float(profile.x[before]), float(profile.x[after])
        if stop - start >= _SHORTEST_SHARE * profile.length:
            supports.append(Support(start, stop, float(np.median(height[first:last]))))
    return tuple(supports) if len(supports) <= _MOST_STRETCHES else ()


def road_between(profile: Profile) -> tuple[float, float] | None:
    """Return first and last distance of the longest part without plates [m]; None: all of it.

    It ends on whole hundredths of the decade of the length of the profile: centimetres for a metre.
    """
    supports = support_plates(profile)
    if not supports:
        return None
    guard = _GUARD_SHARE * profile.length
    starts = [float(profile.x[0]), *(support.last + guard for support in supports)]
    stops = [*(support.first - guard for support in supports), float(profile.x[-1])]
    first, last = max(zip(starts, stops, strict=True), key=lambda part: part[1] - part[0])
    grain = 10.0 ** (np.floor(np.log10(profile.length)) - 2.0)
    first = first if first == starts[0] else float(np.ceil(first / grain) * grain)
    last = last if last == stops[-1] else float(np.floor(last / grain) * grain)
    return (first, last) if last - first > 0.25 * profile.length else None


def _runs_of(marked: Mask, least: int) -> Mask:
    """Return the marks without runs of fewer than `least` in a row."""
    kept = np.zeros_like(marked)
    for first, last in runs(marked):
        kept[first:last] = last - first >= least
    return kept


def _stepped(marked: Mask, height: Array) -> Mask:
    """Return the marks of flat runs whose sides within the profile are steps."""
    kept, way = np.zeros_like(marked), _FEWEST_HEIGHTS // 2
    for first, last in runs(marked):
        level = np.median(height[first:last])
        inner = (height[first : first + way], height[last - way : last])
        outer = (height[max(first - way, 0) : first], height[last : last + way])
        kept[first:last] = np.std(height[first:last]) < _LEVEL * abs(level) and all(
            not outside.size or (np.median(inside) - np.median(outside)) / level > _SIDE_STEP
            for inside, outside in zip(inner, outer, strict=True)
        )
    return kept


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
_BEYOND = 1.0 - 1e-6  # wave over the shortest one resolved below which it is extrapolated


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
    if doubts.heights is None:
        return of_doubts
    level = _levelled(doubts.heights)
    return (*of_doubts, *map(_warning, (*_jump_warnings(level), *_flat_warnings(level))))


def _warning(text: str) -> Finding:
    return Finding(Severity.WARNING, text, topic=Topic.SURFACE)


def has_likely_units(profile: Profile) -> bool:
    """Return whether the units of heights and distances are plausible for a texture."""
    return not _doubts(profile, None).units


class _Doubts(NamedTuple):
    texts: tuple[str, ...] = ()
    heights: Array | None = None  # valid heights [m]; None if meaningless, or with plates
    units: bool = False  # whether a length suggests another unit


def _doubts(profile: Profile, cleaned: Profile | None) -> _Doubts:
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
    return _Doubts((plates, *units), units=bool(units))


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
    last, end = float(sines.wavelength[-1]), sines.cut_off
    limit = correlation.resolution_limit or 0.0
    if last < limit * _BEYOND:
        yield _warning(
            f"The smallest wave, {in_mm(last, 3)}, is shorter than the measurement resolves, "
            f"{in_mm(limit, 3)}: it extrapolates the waves above it."
        )
    if end is not None and end < limit * _BEYOND:
        yield _warning(
            f"The cut-off, {in_mm(end, 3)}, lies beyond what the measurement carries, "
            f"{in_mm(limit, 3)}: the roughness between them is extrapolated."
        )


def stack_notes(
    sines: SineStack, correlation: HeightDifference, fit: Mapping[str, Any]
) -> Iterator[Finding]:
    """Yield findings on the end of the waves and on factors at the edge of their range.

    `fit` are the arguments of `fit_sines` for the waves.
    """
    last, limit = float(sines.wavelength[-1]), correlation.resolution_limit or 0.0
    stated_end = fit.get("smallest_wavelength") is not None or fit.get("cut_off") is not None
    if not stated_end and not last < limit * _BEYOND:
        at_limit = last <= limit * (1.0 + 1e-6)
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


# White noise of the sensor.
_LAGS = 1, 2, 4, 8  # steps; the last chooses the stretches, so that their choice hardly changes S
_STRETCH, _FEWEST = 64, 4  # heights of a stretch; stretches below which nothing is known
_SMOOTHEST_SHARE, _TOPS = 0.1, 0.9  # share of the stretches, and of the heights below the tops
_GROWTH = 2.0, 16.0  # least and most of c a^p over twice the lag: p of 1 and 4
# Estimated change of area or friction that is as good as none: the estimate is low, on measured
# roads by up to four times, so that the change itself is 8 % at most.
_HARMLESS = 0.02
_MEDIAN = 0.6745  # median magnitude of a normal number over its standard deviation


def sensor_noise(lines: Sequence[Profile]) -> tuple[float, float]:
    """Return the rms of white noise, and the wavelength below which it exceeds the roughness [m].

    Zeros where there are fewer than 256 heights. A missing height adds no difference.
    """
    stretches = np.hstack([_of_stretches(line.z) for line in lines])
    stretches = stretches[:, np.isfinite(stretches).all(axis=0)]
    if stretches.shape[1] < _FEWEST:
        return 0.0, 0.0
    count = max(_FEWEST, round(_SMOOTHEST_SHARE * stretches.shape[1]))
    first, second, fourth, _ = stretches[:, np.argsort(stretches[-1])[:count]].mean(axis=1)
    rise = max(float(second - first), 0.0)
    growth = float(np.clip((fourth - second) / rise, *_GROWTH)) if rise else _GROWTH[1]
    road = rise / (growth - 1.0)  # c
    variance = max(float(first - road), 0.0)
    ratio = variance / road if road else math.inf
    # a second difference over a lag shows a wave of twice its length best
    return math.sqrt(variance), 2.0 * lines[0].step * ratio ** (1.0 / math.log2(growth))


def _of_stretches(z: Array) -> Array:
    """Return S of stretches of a line [m^2], shape (lags, stretches); NaN if half is missing."""
    rows = []
    for lag in _LAGS:
        squares = np.full(z.size // _STRETCH * _STRETCH + 2 * lag, np.nan)
        bends = (z[2 * lag :] - 2.0 * z[lag:-lag] + z[: -2 * lag])[: squares.size]
        squares[: bends.size] = bends**2 / 6.0
        parts = squares[: squares.size - 2 * lag].reshape(-1, _STRETCH)
        there = np.isfinite(parts).sum(axis=1)
        sums = np.nansum(parts, axis=1)
        rows.append(np.where(2 * there >= _STRETCH, sums / np.maximum(there, 1), np.nan))
    return np.array(rows)


def noise_finding(
    lines: Sequence[Profile], cut_off: float, across: float | None = None
) -> Finding | None:
    """Return what noise changes in a contact down to a cut-off [m]; None where that is nothing.

    `across` is the distance of lines of a map [m].
    """
    rms, below = sensor_noise(lines)
    excess = _excess_slope(lines, rms, cut_off, across)
    if excess < _HARMLESS:
        return None
    longer = cut_off * 1.1 ** np.arange(1, 50)
    harmless = (w for w in longer if _excess_slope(lines, rms, w, across) < _HARMLESS)
    end = next(harmless, math.nan)
    cure = f" With a cut-off of {in_mm(end, 2)} it changes less than {_HARMLESS:.0%}."
    lower = 1.0 / (1.0 + excess) - 1.0
    where = f"below {in_mm(below, 2)}" if math.isfinite(below) else "at every wavelength"
    effect = "the contact is that of the noise"
    if math.isfinite(excess):
        more = f"the friction {excess:.0%} larger"
        effect = f"it makes the area at least {-lower:.0%} smaller and {more}"
    sentence = (
        f"The heights have white noise of {1e6 * rms:.2g} µm rms, more than the roughness of "
        f"smooth stretches {where}. Down to the cut-off, {in_mm(cut_off, 3)}, {effect}."
        f"{cure if math.isfinite(end) else ''}"
    )
    return Finding(Severity.DOUBT, sentence, lower, excess, Topic.SURFACE, "surface.cut_off")


def _excess_slope(
    lines: Sequence[Profile], rms: float, cut_off: float, across: float | None
) -> float:
    """Return the slope of the tops over that without noise of an rms [m], less 1; infinite if all.

    Zero for waves longer than a line.
    """
    step = lines[0].step
    end = max(cut_off, 2.0 * step)
    if rms == 0.0 or end > min(line.length for line in lines):
        return 0.0
    slopes = []
    for line in lines:
        cut = one_period(line, end)
        tops = cut.z[:-1] >= np.quantile(cut.z, _TOPS)
        slopes.append(np.abs(np.diff(cut.z))[tops] / cut.step)
    square = (float(np.median(np.concatenate(slopes))) / _MEDIAN) ** 2
    q = np.linspace(0.0, math.pi, 1001)  # over one step
    slope = 2.0 * np.sin(0.5 * q * cut.step / step) / cut.step * transmission(q / step, end)
    noise = rms**2 * float(np.mean(slope**2))
    if across is not None:
        noise *= float(np.mean(transmission(q / across, end) ** 2))
    return math.sqrt(square / (square - noise)) - 1.0 if square > noise else math.inf
