"""White noise of the sensor in measured heights: its rms, and what it changes in a contact.

Second differences of heights a lag of `a` steps apart, on the smoothest stretches of the lines,

    S(a) = < (z(x + a) - 2 z(x) + z(x - a))^2 > / 6 = s^2 + c a^p,    a = 1, 2, 4,

hold the variance s^2 of the noise at every lag, because each height has its own. Those of the
roughness grow with the lag: as a power p from 1, of heights with jumps, to 4, of smooth ones. The
noise is the nugget of geostatistics (N. Cressie, Statistics for Spatial Data (1993), sec. 2.3). The
whole line would not do: on a road with stones the mean square is that of their flanks, many times
the noise. The stretches are the smoothest at a lag that is not used, so that their choice hardly
changes S. Differences with a missing height do not count.

Rubber lies on the tops, whose slope is less than that of the flanks. The noise adds its mean square
slope, down to the cut-off, to that of the highest tenth of the line, by its median magnitude. The
contact area is as 1/slope (B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840,
doi:10.1063/1.1388626), and the friction nearly as the slope. Noise that the instrument has smoothed
is not white, and looks like roughness.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from gripscale.core import Array, Finding, Severity, Topic, in_mm
from gripscale.surface.low_pass import one_period, transmission
from gripscale.surface.profile import HeightMap, Profile

_LAGS = 1, 2, 4  # steps over which differences are taken ...
_CHOSEN_BY = 8  # ... and those by which the smoothest stretches are chosen
_STRETCH, _FEWEST = 64, 4  # heights of a stretch; stretches below which nothing is known
_SMOOTHEST = 0.1  # share of the stretches
_LEAST_GROWTH, _MOST_GROWTH = 2.0, 16.0  # of c a^p over twice the lag: p of 1 and 4
_TOPS = 0.9  # share of the heights below the tops that rubber lies on
# Change of area or friction that is as good as none, the error of a contact solved with care, and
# that up to which it is no doubt, the error of the contact of every answer.
_HARMLESS, _TOLERATED = 0.02, 0.05
_MOST_LINES = 32  # lines of a map whose slopes are taken
_MEDIAN = 0.6745  # median magnitude of a normal number over its standard deviation


class SensorNoise(NamedTuple):
    """White noise of measured heights."""

    rms: float  # [m]; zero where none shows
    exceeds_below: float  # wavelength below which smooth stretches have more noise than road [m]


def sensor_noise(surface: Sequence[Profile] | HeightMap) -> SensorNoise:
    """Return the white noise of heights as measured [m]; zero also of fewer than 256 points."""
    lines = [surface.z.T] if isinstance(surface, HeightMap) else [p.z[None] for p in surface]
    stretches = np.hstack([_of_stretches(z) for z in lines])
    stretches = stretches[:, np.isfinite(stretches).all(axis=0)]
    if stretches.shape[1] < _FEWEST:
        return SensorNoise(0.0, 0.0)
    count = max(_FEWEST, round(_SMOOTHEST * stretches.shape[1]))
    smooth = stretches[:, np.argsort(stretches[-1])[:count]]
    first, second, fourth = smooth[:-1].mean(axis=1)
    rise = max(second - first, 0.0)
    growth = (fourth - second) / rise if rise else math.inf
    growth = min(max(growth, _LEAST_GROWTH), _MOST_GROWTH)
    road = rise / (growth - 1.0)  # c
    variance = max(float(first - road), 0.0)
    ratio = variance / road if road else math.inf
    step = float(np.mean([p.step for p in _lines(surface)]))
    # a second difference over a lag shows a wave of twice its length best
    return SensorNoise(math.sqrt(variance), 2.0 * step * ratio ** (1.0 / math.log2(growth)))


def _of_stretches(lines: Array) -> Array:
    """Return S of each stretch of lines, shape (lags, stretches); NaN with fewer than half of it.

    `lines` are heights [m], shape (lines, points).
    """
    number, points = lines.shape[0], lines.shape[1] // _STRETCH * _STRETCH
    rows = []
    for lag in (*_LAGS, _CHOSEN_BY):
        squares = np.full_like(lines, np.nan)
        bends = lines[:, 2 * lag :] - 2.0 * lines[:, lag:-lag] + lines[:, : -2 * lag]
        squares[:, lag:-lag] = bends**2 / 6.0
        parts = squares[:, :points].reshape(number * points // _STRETCH, _STRETCH)
        there = np.isfinite(parts).sum(axis=1)
        sums = np.nansum(parts, axis=1)
        rows.append(np.where(2 * there >= _STRETCH, sums / np.maximum(there, 1), np.nan))
    return np.array(rows)


def noise_finding(surface: Sequence[Profile] | HeightMap, cut_off: float) -> Finding | None:
    """Return what noise changes in a contact down to a cut-off [m]; None where that is nothing."""
    noise = sensor_noise(surface)
    excess = excess_slope(surface, noise.rms, cut_off)
    if excess < _HARMLESS:
        return None
    longest = min(line.length for line in _lines(surface)) / 4.0
    longer = cut_off * 1.1 ** np.arange(1, max(2, math.log(longest / cut_off, 1.1)))
    harmless = (end for end in longer if excess_slope(surface, noise.rms, end) < _HARMLESS)
    end = next(harmless, math.nan)
    cure = f" With a cut-off of {in_mm(end, 2)} it changes less than {_HARMLESS:.0%}."
    lower, below = 1.0 / (1.0 + excess) - 1.0, noise.exceeds_below
    where = f"below {in_mm(below, 2)}" if math.isfinite(below) else "at every wavelength"
    effect = "the contact is that of the noise"
    if math.isfinite(excess):
        effect = f"it makes the area about {-lower:.0%} smaller, the friction {excess:.0%} larger"
    sentence = (
        f"The heights have white noise of {1e6 * noise.rms:.2g} µm rms, more than the roughness of "
        f"smooth stretches {where}. Down to the cut-off, {in_mm(cut_off, 3)}, {effect}."
        f"{cure if math.isfinite(end) else ''}"
    )
    severity = Severity.WARNING if excess < _TOLERATED else Severity.DOUBT
    return Finding(severity, sentence, lower, excess, Topic.SURFACE, "surface.cut_off")


def excess_slope(surface: Sequence[Profile] | HeightMap, rms: float, cut_off: float) -> float:
    """Return the slope of the tops down to a cut-off over that without noise, less 1.

    `rms` is that of the noise [m]. Infinite where all of the slope is noise.
    """
    if rms == 0.0:
        return 0.0
    slopes, lines = [], _lines(surface)
    step = lines[0].step
    end = max(cut_off, 2.0 * step)
    for line in lines:
        cut = one_period(line, end)
        tops = cut.z[:-1] >= np.quantile(cut.z, _TOPS)
        slopes.append(np.abs(np.diff(cut.z))[tops] / cut.step)
    square = (float(np.median(np.concatenate(slopes))) / _MEDIAN) ** 2
    noise = rms**2 * _transmitted(step, end, cut.step)
    if isinstance(surface, HeightMap):
        noise *= _transmitted(surface.step[1], end)
    return math.sqrt(square / (square - noise)) - 1.0 if square > noise else math.inf


def _transmitted(step: float, cut_off: float, over: float = 0.0) -> float:
    """Return the variance of white noise of variance 1 after the cut-off, or of its slope [1/m^2].

    The slope is that between points `over` apart [m].
    """
    q = np.linspace(0.0, math.pi / step, 1001)
    square = transmission(q, cut_off) ** 2
    if over:
        square = square * (2.0 * np.sin(0.5 * q * over) / over) ** 2
    return float(np.mean(square))


def _lines(surface: Sequence[Profile] | HeightMap) -> list[Profile]:
    """Return the profiles, or some lines of a map."""
    if isinstance(surface, HeightMap):
        chosen = np.linspace(0, surface.y.size - 1, min(surface.y.size, _MOST_LINES)).astype(int)
        return [surface.line(int(at)) for at in np.unique(chosen)]
    return list(surface)
