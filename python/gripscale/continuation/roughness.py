"""Octaves of a periodic line, and where those below its measurement come from.

The slope of a line is the sum of its octaves s_k, the waves between two wavelengths of which one is
half the other. The local amplitude of an octave is the smoothed length of its analytic signal,

    a_k(x)^2 = G * |s_k + i H s_k|^2,

H being the Hilbert transform and G a Gaussian as wide as a wave of the octave. Real roughness is
intermittent: where an octave is strong, the next is strong too. From the measured octaves,

    ln a_k(x) = c + b ln a_(k-1)(x) + e(x),

by least squares over the faces that touch; a Gaussian line has b = 0 and a scatter of ln a that
belongs to random waves alone. A new octave is Gaussian noise times exp(b ln a_(k-1) + e), with the
scatter of e beyond that of random waves. It is limited: the largest amplitudes are those of edges,
whose waves are in phase and do not stand for rough places.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import scipy

from gripscale.core import checks
from gripscale.core.arrays import Array, ComplexArray, Mask
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.half_space.grid import periodic_heights, resampled
from gripscale.half_space.grid_sequence import POINTS_IN_WAVE
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import STEEPEST

QUANTILE = 0.68
"""Share of the points in contact whose slope is below that of an octave."""

LONGEST_SHARE = 0.25
"""Longest wavelength of a line that counts, over the length of the line."""

_MOST_ABOVE = 1.25
"""Largest deviation of the logarithm of a local amplitude, over its standard deviation. With 0.6
intermittent surfaces lose a tenth of their friction, with 2.5 surfaces with edges gain a third."""

_ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class PeriodicLine:
    """A periodic line by its waves."""

    length: float
    """Period [m]."""
    points: int
    """Points of the line as it is sampled, an even number."""
    waves: ComplexArray
    """`scipy.fft.rfft` of the heights [m], shape (points // 2 + 1,)."""

    @classmethod
    def of(
        cls,
        line: Profile,
        shortest: float,
        finest: float = math.inf,
        steepest: float = STEEPEST,
    ) -> PeriodicLine:
        """Return the waves of a line down to `shortest` in full, with points for `finest` [m]."""
        heights = periodic_heights(
            line, smallest_wavelength=shortest, periodic=False, steepest=steepest
        )
        length = heights.grid.lengths[0]
        waves = length / min(shortest, finest)
        points = 2 * scipy.fft.next_fast_len(math.ceil(0.5 * POINTS_IN_WAVE * waves))
        kept = heights.grid.wavenumber <= 2.0 * np.pi / shortest * (1.0 + _ROUNDING)
        z = resampled(np.where(kept, heights.spectrum, 0.0), heights.grid.shape, (points,))
        return cls(length, points, np.asarray(scipy.fft.rfft(z)))

    @property
    def wavenumber(self) -> Array:
        """Wavenumber of each wave [rad/m]."""
        return 2.0 * np.pi * np.asarray(scipy.fft.rfftfreq(self.points, self.length / self.points))

    def between(self, longest: float, shortest: float) -> ComplexArray:
        """Return the waves shorter than `longest` and not shorter than `shortest` [m]."""
        q = self.wavenumber
        above = q > 2.0 * np.pi / longest * (1.0 + _ROUNDING)
        return np.where(above & (q <= 2.0 * np.pi / shortest * (1.0 + _ROUNDING)), self.waves, 0.0)

    def down_to(self, shortest: float) -> PeriodicLine:
        """Return the line without waves shorter than `shortest` [m]."""
        return replace(self, waves=self.between(np.inf, shortest))

    def slope(self, longest: float, shortest: float) -> Array:
        """Return the slope [-] of the waves between two wavelengths [m], shape (points,)."""
        derivative = self.between(longest, shortest) * (1j * self.wavenumber)
        return np.asarray(scipy.fft.irfft(derivative, self.points))

    def amplitude(self, longest: float, shortest: float) -> Array:
        """Return the natural logarithm of the local amplitude of the slope, shape (points,)."""
        both = np.zeros(self.points, dtype=complex)
        both[: self.waves.size] = self.between(longest, shortest) * (2j * self.wavenumber)
        square = np.abs(scipy.fft.ifft(both)) ** 2
        bell = np.exp(-0.5 * (0.5 * shortest * self.wavenumber) ** 2)
        smooth = scipy.fft.irfft(scipy.fft.rfft(square) * bell, self.points)
        return np.asarray(0.5 * np.log(np.maximum(smooth, np.finfo(float).tiny)))

    def noise(self, random: np.random.Generator) -> PeriodicLine:
        """Return a line of white noise with the same points."""
        return replace(self, waves=scipy.fft.rfft(random.standard_normal(self.points)))

    def profile(self) -> Profile:
        """Return the heights as a profile, one period."""
        x = np.asarray(self.length / self.points * np.arange(self.points), dtype=np.float64)
        return Profile(x, np.asarray(scipy.fft.irfft(self.waves, self.points)))


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

    coupling: float
    """b, zero for random phases [-]."""
    scatter: float
    """Standard deviation of the logarithm of the amplitude beyond both [-]."""

    @classmethod
    def of(
        cls,
        lines: Sequence[PeriodicLine],
        faces: Sequence[Mask],
        wavelength: float,
        random: np.random.Generator,
    ) -> Intermittency:
        """Return that of the octave that ends at `wavelength` [m], on faces, shape (points,)."""
        parent, child, alone = [], [], []
        for line, face in zip(lines, faces, strict=True):
            parent.append(line.amplitude(4.0 * wavelength, 2.0 * wavelength)[face])
            child.append(line.amplitude(2.0 * wavelength, wavelength)[face])
            alone.append(line.noise(random).amplitude(2.0 * wavelength, wavelength))
        above, below = np.concatenate(parent), np.concatenate(child)
        coupling = float(np.cov(above, below)[0, 1] / above.var(ddof=1))
        rest = float(np.var(below - coupling * above) - np.var(np.concatenate(alone)))
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
        return replace(line, waves=replace(line, waves=strong).between(longest, shortest))


class OwnFaces(Checked):
    """Continue with the slopes of the faces that touch."""


class HurstExponent(Checked):
    """Continue the slopes of the faces that touch as a power law with this exponent."""

    hurst: float = checked(checks.positive)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.at_most_one("hurst", self.hurst)


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


Roughness = OwnFaces | HurstExponent | FinerMeasurement
"""Where the roughness below the measurement comes from."""


def as_roughness(name: str, value: Any) -> Roughness:
    """Return `value` if it is a `Roughness`; else raise `InputError`."""
    if not isinstance(value, Roughness):
        expected = "OwnFaces, HurstExponent or FinerMeasurement"
        raise InputError(f"{name} must be {expected}; got {checks.short_repr(value)}")
    return value
