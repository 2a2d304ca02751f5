"""White noise of the sensor in measured heights: its rms, and what it changes in a contact.

Second differences of heights a lag of `a` steps apart, on the smoothest stretches of the lines,

    S(a) = < (z(x + a) - 2 z(x) + z(x - a))^2 > / 6 = s^2 + c a^p,    a = 1, 2, 4,

hold the variance s^2 of the noise at every lag: the nugget of geostatistics (N. Cressie, Statistics
for Spatial Data (1993), sec. 2.3). Its mean square slope, down to the cut-off, adds to that of the
tops of the line (docs/derivations.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gripscale.core import Array, Finding, Severity, Topic, in_mm
from gripscale.surface.low_pass import one_period, transmission
from gripscale.surface.profile import Profile

_LAGS = 1, 2, 4, 8  # steps; the last chooses the stretches, so that their choice hardly changes S
_STRETCH, _FEWEST = 64, 4  # heights of a stretch; stretches below which nothing is known
_SMOOTHEST, _TOPS = 0.1, 0.9  # share of the stretches, and of the heights below the tops
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
    count = max(_FEWEST, round(_SMOOTHEST * stretches.shape[1]))
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
