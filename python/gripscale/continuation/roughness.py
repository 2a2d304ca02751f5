"""Octaves of a periodic line, and where those below its measurement come from.

The local amplitude of an octave s_k is a_k(x)^2 = G * |s_k + i H s_k|^2, with the Hilbert transform
H and a Gaussian G as wide as a wave. It follows that of the octave above, but is limited: the
largest amplitudes are those of edges, not of rough places (docs/below-measurement.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from gripscale.core import Array, Checked, ComplexArray, InputError, Mask, checked, checks
from gripscale.half_space.grid import Grid, periodic_heights, resampled
from gripscale.half_space.grid_sequence import POINTS_IN_WAVE
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import STEEPEST
from gripscale.surface.profile import RESOLVED_STEPS

QUANTILE = 0.68  # share of the points in contact whose slope is below that of an octave
LONGEST_SHARE = 0.25  # longest wavelength of a line that counts, over the length of the line
# Largest deviation of the logarithm of a local amplitude, over its standard deviation. With 0.6 or
# 2.5 stones with sharp edges and cascades change their friction by 3 % at most.
_MOST_ABOVE = 1.25
_LEAST = 1e-100
_MOST_PASSED = math.sqrt(2.0)  # longest wave of which nothing is passed: the cut-off over this
_MARGIN = 3  # points of a period on either side that a cubic between two points depends on


@dataclass(frozen=True, eq=False)
class PeriodicLine:
    """A periodic line by its waves."""

    length: float  # period [m]
    points: int  # points of the line as it is sampled, an even number
    waves: ComplexArray  # `scipy.fft.rfft` of the heights [m], shape (points // 2 + 1,)

    @classmethod
    def of(
        cls,
        line: Profile,
        shortest: float,
        finest: float = math.inf,
        steepest: float = STEEPEST,
    ) -> PeriodicLine:
        """Return all waves of a line that resolves `shortest`, with points for `finest` [m]."""
        heights = periodic_heights(
            line, smallest_wavelength=shortest, periodic=False, steepest=steepest
        )
        length, count = heights.grid.lengths[0], heights.grid.points
        steps = POINTS_IN_WAVE * length / (min(shortest, finest) * count)
        points = 2 * math.ceil(0.5 * steps) * count  # with those of the measurement
        z = resampled(heights.spectrum, heights.grid.shape, Grid((points,), (length,)))
        return cls(length, points, np.asarray(scipy.fft.rfft(z)))

    @property
    def wavenumber(self) -> Array:
        """Wavenumber of each wave [rad/m]."""
        return 2.0 * np.pi * np.asarray(scipy.fft.rfftfreq(self.points, self.length / self.points))

    def between(self, longest: float, shortest: float) -> ComplexArray:
        """Return the waves between two wavelengths [m], whose ends are `_passed` by halves.

        Shorter waves, of which none is passed, have no place in the array.
        """
        count = math.ceil(self.length * _MOST_PASSED / shortest) + 1 if shortest > 0.0 else None
        q = self.wavenumber[:count]
        octave = _passed(q, shortest) - _passed(q, longest)
        return np.asarray(self.waves[:count] * np.sqrt(octave))

    def resolved_to(self, shortest: float) -> PeriodicLine:
        """Return the line as points measure it, four in a wave of `shortest` [m].

        Between them lies a monotone cubic (F. N. Fritsch & J. Butland, SIAM J. Sci. Stat. Comput. 5
        (1984) 300, doi:10.1137/0905021): waves that end at `shortest` overshoot beside a step.
        """
        stride = round(shortest / RESOLVED_STEPS * self.points / self.length)
        at = np.arange(0, self.points, stride)
        z = scipy.fft.irfft(self.waves, self.points)[at]
        period, node = np.divmod(np.arange(-_MARGIN, at.size + _MARGIN), at.size)
        curve = scipy.interpolate.PchipInterpolator(at[node] + period * self.points, z[node])
        return replace(self, waves=np.asarray(scipy.fft.rfft(curve(np.arange(self.points)))))

    def slope(self, longest: float, shortest: float) -> Array:
        """Return the slope [-] of the waves between two wavelengths [m], shape (points,)."""
        waves = self.between(longest, shortest)
        derivative = waves * (1j * self.wavenumber[: waves.size])
        return np.asarray(scipy.fft.irfft(derivative, self.points))

    def amplitude(self, longest: float, shortest: float) -> Array:
        """Return the natural logarithm of the local amplitude of the slope, shape (points,)."""
        waves = self.between(longest, shortest)
        q = self.wavenumber[: waves.size]
        # no wave of the square is shorter than the shortest of the signal
        coarse = min(2 * scipy.fft.next_fast_len(waves.size, real=True), self.points)
        signal = scipy.fft.ifft(waves * (2j * q), coarse)
        square = scipy.fft.rfft(np.abs(signal) ** 2)[: waves.size]
        bell = np.exp(-0.5 * (0.5 * shortest * q) ** 2)
        smooth = scipy.fft.irfft(square * bell, self.points) * (coarse / self.points)
        return np.asarray(0.5 * np.log(np.maximum(smooth, np.finfo(float).tiny)))

    def noise(self, random: np.random.Generator) -> PeriodicLine:
        """Return a line of white noise with the same points."""
        return replace(self, waves=scipy.fft.rfft(random.standard_normal(self.points)))

    def profile(self) -> Profile:
        """Return the heights as a profile, one period."""
        x = np.asarray(self.length / self.points * np.arange(self.points), dtype=np.float64)
        return Profile(x, np.asarray(scipy.fft.irfft(self.waves, self.points)))


def _passed(wavenumber: Array, shortest: float) -> Array:
    """Return the share of the power of waves longer than `shortest` [m].

    It falls over an octave about it: a sharp end would spread an edge over all of a face.
    """
    waves = np.maximum(wavenumber, _LEAST) * (shortest / (2.0 * np.pi))
    beyond = np.log2(np.maximum(waves, _LEAST)) + 0.5
    return np.asarray(np.cos(0.5 * np.pi * np.clip(beyond, 0.0, 1.0)) ** 2)


def typical_slope(slopes: Array) -> float:
    """Return the slope [-] that stands for an octave."""
    return float(np.quantile(np.abs(slopes), QUANTILE))


def slope_on_faces(
    lines: Sequence[PeriodicLine], faces: Sequence[Mask], longest: float, shortest: float
) -> float:
    """Return the slope [-] of the waves between two wavelengths [m] on the faces of all lines."""
    slopes = [line.slope(longest, shortest)[on] for line, on in zip(lines, faces, strict=True)]
    return typical_slope(np.concatenate(slopes))


@dataclass(frozen=True)
class Intermittency:
    """How the local amplitude of an octave follows that of the octave above."""

    coupling: float  # b, zero for random phases [-]
    scatter: float  # standard deviation of the logarithm of the amplitude beyond both [-]

    @classmethod
    def of(
        cls,
        lines: Sequence[PeriodicLine],
        faces: Sequence[Mask],
        wavelength: float,
        random: np.random.Generator,
    ) -> Intermittency:
        """Return that of the octave that ends at `wavelength` [m], on faces, shape (points,)."""
        ends = 4.0 * wavelength, 2.0 * wavelength, wavelength
        faces_only, alone = [], []
        for line, face in zip(lines, faces, strict=True):
            noise = line.noise(random)
            both = [line.amplitude(*ends[:2])[face], line.amplitude(*ends[1:])[face]]
            faces_only.append(np.stack(both))
            alone.append(np.stack([noise.amplitude(*ends[:2]), noise.amplitude(*ends[1:])]))
        (above, below), chance = np.hstack(faces_only), np.cov(np.hstack(alone))
        # octaves share the waves of their common end, those of noise as well
        common = chance[0, 1] / chance[0, 0]
        coupling = float(np.cov(above, below)[0, 1] / above.var(ddof=1) - common)
        rest = float(np.var(below - coupling * above) - chance[1, 1])
        return cls(coupling, math.sqrt(max(rest, 0.0)))

    def octave(
        self, line: PeriodicLine, longest: float, shortest: float, random: np.random.Generator
    ) -> PeriodicLine:
        """Return the waves of a new octave of `line`, of any scale and with H = 1 within it.

        `longest` and `shortest` [m] are its ends; the octave above is part of the line.
        """
        q = line.wavenumber
        bell = np.exp(-0.5 * (0.5 * longest * q) ** 2)
        smooth = scipy.fft.irfft(line.noise(random).waves * bell, line.points)
        log = self.coupling * line.amplitude(2.0 * longest, longest)
        log += self.scatter * (smooth / smooth.std())
        log -= log.mean()
        limit = _MOST_ABOVE * log.std()
        noise = line.noise(random)
        noise = replace(noise, waves=noise.waves * np.maximum(q, q[1]) ** -1.5)
        heights = scipy.fft.irfft(noise.between(longest, shortest), line.points)
        strong = scipy.fft.rfft(heights * np.exp(np.clip(log, -limit, limit)))
        return replace(line, waves=np.asarray(strong))


class OwnFaces(Checked):
    """Continue with the slopes of the faces that touch."""


class HurstExponent(Checked):
    """Continue the slopes of the faces that touch as a power law with this exponent."""

    hurst: float = checked(checks.fraction)


class FinerMeasurement(Checked):
    """Continue with the slopes of a finer measurement of a face of a stone: a line or a map."""

    surface: Profile | HeightMap

    @cached_property
    def lines(self) -> list[Profile]:
        """The measured lines."""
        return [self.surface] if isinstance(self.surface, Profile) else self.surface.lines()

    @property
    def wavelengths(self) -> tuple[float, float]:
        """Longest and shortest wavelength [m] whose slope is measured."""
        longest = LONGEST_SHARE * self.lines[0].length
        return longest, max(line.resolution_limit for line in self.lines)

    def slope(self, longest: float, shortest: float) -> float:
        """Return the slope [-] of the waves between two wavelengths [m]."""
        # as measured: heights in a wrong unit must show
        periodic = [PeriodicLine.of(line, shortest, steepest=math.inf) for line in self.lines]
        return typical_slope(np.concatenate([line.slope(longest, shortest) for line in periodic]))


# Where the roughness below the measurement comes from.
Roughness = OwnFaces | HurstExponent | FinerMeasurement


def as_roughness(name: str, value: Any) -> Roughness:
    """Return `value` if it is a `Roughness`; else raise `InputError`."""
    if not isinstance(value, Roughness):
        expected = "OwnFaces, HurstExponent or FinerMeasurement"
        raise InputError(f"{name} must be {expected}; got {checks.short_repr(value)}")
    return value
