"""Plates and supports in a profile: stretches that are no road, and the part between them.

A stretch is suspect where its heights stand off the others,

    |z - line| > 6 s,    s = 1.4826 median |z - line|,

about a line through the medians of pieces (P. K. Sen, J. Am. Stat. Assoc. 63 (1968) 1379,
doi:10.1080/01621459.1968.10480934), which a plate does not pull, its sides are steps, not slopes,
and it is flat, not round as an exposed stone; or where it is smooth: the rms departure from its own
line is below 0.02 of that of the usual piece. Heights missing at its ends belong to it, as steel
shines. What happens often belongs to the surface, as grooves and joints do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gripscale.core import Array, Mask, checks, in_mm
from gripscale.core.arrays import runs
from gripscale.surface.profile import Profile

_OFF_THE_LINE = 6.0  # distance from the line, in robust standard deviations, that no road reaches

# Roughness of two pieces in a row, over the usual one, below which they are a plate.
_SMOOTH_SHARE = 0.02
_SIDE_STEP = 0.5  # change of height at the side of a stretch, over its height, that is a step
# Departure (rms) of a flat stretch from its mean, over its height. A cap that begins at half of its
# height has 0.15 and more, the four plates of the shipped road 0.02 to 0.05.
_FLAT = 0.1
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
        kept[first:last] = np.std(height[first:last]) < _FLAT * abs(level) and all(
            not outside.size or (np.median(inside) - np.median(outside)) / level > _SIDE_STEP
            for inside, outside in zip(inner, outer, strict=True)
        )
    return kept
