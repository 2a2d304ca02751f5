"""Whether a road has a direction: profiles along and across sliding, or the texture of a map.

The step from lines to their surface takes an isotropic one (`gripscale.half_space.line_to_map`). On
ridges it errs by `AREA_OVER_TRUTH`, a function of the ratio of slopes along and across,

    rho = (C_along(l) / C_across(l))^(1/2),   l half the cut-off.

A map tells it by its autocorrelation, f(t) = < z(r) z(r + t) > / < z^2 >: the lengths Sal and Str
and the direction Std of ISO 25178-2:2021. docs/derivations.md has both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from gripscale.core import Array, CaseKey, Finding, Severity, Topic, Words, checks, in_mm
from gripscale.surface.cleaning import subtract_form
from gripscale.surface.height_difference import height_difference
from gripscale.surface.profile import HeightMap, Profile
from gripscale.surface.resampling import fill_gaps

_FALLEN = 0.2  # autocorrelation to which lengths are measured
_WAYS = 180  # directions that are followed, one a degree
# Weights of neighbouring degrees, without which the strongest wave of a random texture decides.
_SMOOTHING = np.hanning(33)[1:-1]
# Share of the largest wavenumber within which the direction is sought: a square grid has more waves
# along its diagonals beyond it.
_LONGEST_PART = 0.5


def texture_lengths(surface: HeightMap) -> tuple[float, float]:
    """Return autocorrelation length Sal [m] and texture aspect ratio Str [-]; NaN of a flat map.

    Sal is the shortest way from the middle of the autocorrelation to where it falls to 0.2, Str
    that over the longest one, or half the map where it does not fall that far: 1 without direction.
    """
    from scipy.ndimage import map_coordinates  # slow to import

    z, (dx, dy) = _level(surface), surface.step
    nx, ny = z.shape
    # without wrapping round: with as many zeros beyond either end
    correlation = np.fft.irfft2(np.abs(np.fft.rfft2(z, [2 * nx, 2 * ny])) ** 2, [2 * nx, 2 * ny])
    if not correlation[0, 0] > 0.0:
        return math.nan, math.nan
    away = np.linspace(0.0, min((nx // 2 - 1) * dx, (ny // 2 - 1) * dy), 2 * max(nx, ny))
    pairs = np.outer(*(n - np.abs(np.fft.fftfreq(2 * n, 0.5 / n)) for n in (nx, ny)))
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = correlation / pairs * (z.size / correlation[0, 0])
    lengths = []
    for angle in np.linspace(0.0, np.pi, _WAYS, endpoint=False):
        at = np.array([away * np.cos(angle) / dx, away * np.sin(angle) / dy])
        values = map_coordinates(relative, at, order=1, mode="grid-wrap")
        first = int(np.argmax(values < _FALLEN)) or away.size - 1
        pair = slice(first, first - 2, -1)  # where it stays above, the last point
        lengths.append(np.interp(_FALLEN, values[pair], away[pair]))
    return float(min(lengths)), float(min(lengths)) / float(max(lengths))


def texture_direction(surface: HeightMap) -> float:
    """Return the angle of the ridges of a map to x, Std [rad] from 0 to pi; NaN where it is flat.

    Each wave of the spectrum counts in the degree of its direction.
    """
    z, (dx, dy) = _level(surface), surface.step
    window = np.outer(*(np.hanning(n + 2)[1:-1] for n in z.shape))
    power = np.abs(np.fft.fft2(z * window)) ** 2
    qx, qy = np.meshgrid(*map(np.fft.fftfreq, z.shape, (dx, dy)), indexing="ij")
    inside = np.hypot(qx, qy) < _LONGEST_PART * min(0.5 / dx, 0.5 / dy)
    inside[0, 0] = False
    if not power[inside].sum() > 0.0:
        return math.nan
    degree = np.rint(np.degrees(np.arctan2(qy[inside], qx[inside]))).astype(int) % _WAYS
    by_degree = np.fft.rfft(np.bincount(degree, power[inside], _WAYS))
    smooth = np.fft.irfft(by_degree * np.fft.rfft(_SMOOTHING, _WAYS), _WAYS)
    waves = math.radians(int(np.argmax(smooth)) - _SMOOTHING.size // 2)
    return (waves + 0.5 * math.pi) % math.pi


def _level(surface: HeightMap) -> Array:
    """Return the heights of a map over their plane [m], gaps filled."""
    return fill_gaps(subtract_form(surface, order=1)[0].z, surface.step)


_SLOPE_RATIO = np.array([0.201, 0.393, 0.567, 0.725, 1.0, 1.38, 1.76, 2.54, 4.91])
# Contact area from lines over that of the map, at these ratios of slopes.
AREA_OVER_TRUTH = np.array([2.55, 1.52, 1.29, 1.11, 1.0, 0.87, 0.86, 0.73, 0.68])
# Factor by which the area may be wrong on ridges three times as long as wide, either way.
ERROR_OF_RIDGES = float(max(AREA_OVER_TRUTH[1], 1.0 / AREA_OVER_TRUTH[-2]))
_HARMLESS = 1.1  # error of the area near the scatter of the step on isotropic surfaces, 8 %
_WIDEST = math.log(10.0)  # half width of the band of a profile that is too short for one
_POINTS = 2000  # points a way of a map of which its direction is found: more are passed over
_NO_DIRECTION = 0.5  # texture aspect ratio above which a map counts as without direction


def area_over_truth(slope_ratio: float) -> float:
    """Return the contact area from lines over the true one; the ends of the table beyond it."""
    logs = np.log(_SLOPE_RATIO), np.log(AREA_OVER_TRUTH)
    return math.exp(float(np.interp(math.log(slope_ratio), *logs)))


def direction_of_profiles(
    along: Sequence[Profile], across: Sequence[Profile], lags: tuple[float, float]
) -> Finding:
    """Return what profiles along and across sliding tell of ridges.

    Their slopes are compared over two lags [m], of the cut-off and of the large waves. A ratio
    counts where it differs from 1 by more than its 95 % band, from the blocks of the profiles. One
    that changes the area less than the step from lines to a surface errs does not.
    """
    if not across:
        sentence = Words(
            f"Profiles in one direction do not show ridges: ridges 3:1 make the area up to "
            f"{ERROR_OF_RIDGES:.1f} times too large or too small. A second profile, with ",
            CaseKey("lay", "across"),
            ", decides.",
        )
        error = 1.0 / ERROR_OF_RIDGES - 1.0
        return Finding(
            Severity.WARNING, sentence, area=error, topic=Topic.SURFACE, key="surface.lay"
        )
    ratios = [_SlopeRatio.over(lag, along, across) for lag in lags]
    counting = [ratio for ratio in ratios if abs(math.log(ratio.value)) > ratio.half_width]
    slopes = ratios[0]
    errors = map(area_over_truth, (*slopes.ends, *(ratio.value for ratio in counting)))
    if all(abs(math.log(error)) < math.log(_HARMLESS) for error in errors):
        return Finding(Severity.GOOD, f"The surface is isotropic: {slopes}.", topic=Topic.SURFACE)
    if counting:
        worst = max(counting, key=lambda ratio: abs(math.log(area_over_truth(ratio.value))))
        return _warning(f"The surface has ridges: {worst}", area_over_truth(worst.value))
    error = max(map(area_over_truth, slopes.ends), key=lambda error: abs(math.log(error)))
    return _warning(f"The profiles are too short to show ridges: {slopes}", error)


def direction_of_map(surface: HeightMap) -> Finding | None:
    """Return that lines of a map do not stand for it, where its texture has a direction."""
    every = 1 + max(surface.z.shape) // _POINTS
    x, y, z = surface.x[::every], surface.y[::every], surface.z[::every, ::every]
    _, aspect = texture_lengths(replace(surface, x=x, y=y, z=z) if every > 1 else surface)
    if not aspect < _NO_DIRECTION:
        return None
    text = (
        f"The map has a direction (texture aspect ratio {aspect:.2f}, 1 without): its direct "
        "contact holds, chain and theories take its lines for those of an isotropic surface."
    )
    return Finding(Severity.WARNING, text, topic=Topic.SURFACE)


class _SlopeRatio(NamedTuple):
    lag: float  # [m]
    value: float
    half_width: float  # of its 95 % band, in its logarithm

    @classmethod
    def over(cls, lag: float, along: Sequence[Profile], across: Sequence[Profile]) -> _SlopeRatio:
        """Return the ratio at a lag [m], or at the shortest one that all profiles have."""
        curves = [height_difference(list(lines)) for lines in (along, across)]
        lag = max(lag, *(float(curve.lag[0]) for curve in curves))
        logs, widths = [], []
        for curve in curves:
            value = np.maximum(curve.value, checks.LEAST)
            at, lags = math.log(lag), np.log(curve.lag)
            logs.append(0.5 * float(np.interp(at, lags, np.log(value))))
            half = 0.5 * float(np.interp(at, lags, np.log(curve.upper / value)))
            widths.append(half if math.isfinite(half) else _WIDEST)
        return cls(lag, math.exp(logs[0] - logs[1]), math.hypot(*widths))

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of the band."""
        factor = math.exp(self.half_width)
        return self.value / factor, self.value * factor

    def __str__(self) -> str:
        low, high = self.ends
        return (
            f"the rms slope over {in_mm(self.lag, 2)} along sliding is {self.value:.3g} "
            f"({low:.3g} to {high:.3g}) times that across"
        )


def _warning(sentence: str, error: float) -> Finding:
    """Return a warning that the area from lines is `error` times the true one."""
    way = "large" if error > 1.0 else "small"
    text = f"{sentence}. The area from lines may be {max(error, 1.0 / error):.2f} times too {way}."
    return Finding(Severity.WARNING, text, area=1.0 / error - 1.0, topic=Topic.SURFACE)
