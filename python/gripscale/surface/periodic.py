"""One period of a measured line: made from a profile, split into octaves, continued by random ones.

**One period.** Gaps are filled, ends joined, and flanks made no steeper than rubber follows. The
profile of a contact is the smallest one above the heights z without slopes above s (E. J. McShane,
Bull. Amer. Math. Soc. 40 (1934) 837, doi:10.1090/S0002-9904-1934-05978-0),

    e(x) = max_y (z(y) - s |x - y|),

the upper envelope of cones on all points. A surface of rubber that follows a flank of slope s is
stretched by up to sqrt(1 + s^2). The envelope keeps every summit, and every face below that slope;
waves that are then cut off do not ring beside a step, by 9 % of its height (J. W. Gibbs, Nature 59
(1899) 606).

**Octaves.** The slope of a line is the sum of its octaves s_k, the waves between two wavelengths of
which one is half the other. The local amplitude of an octave is the smoothed length of its analytic
signal,

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
from dataclasses import dataclass

import numpy as np
import scipy

from gripscale.core import checks
from gripscale.core.arrays import Array, ComplexArray, Mask
from gripscale.core.errors import InputError
from gripscale.surface.profile import FEWEST_POINTS, RESOLVED_STEPS, Profile
from gripscale.surface.resampling import fill_gaps

_STEEPEST = 4.0
"""Slope that rubber is taken to follow: stretched to 4.1, near the elongation at break of tread."""


def one_period(
    line: Profile, smallest_wavelength: float | None = None, *, steepest: float = _STEEPEST
) -> Profile:
    """Return a periodic line, for any model with `periodic=True`.

    Missing heights are filled, the line through the end points subtracted, and flanks above a slope
    of `steepest` [-] replaced by the smallest heights above the line without them; infinity keeps
    all. Then waves shorter than `smallest_wavelength` [m], by default four steps, are left out.
    The smallest wave has four points.

    Raises `InputError` if `steepest` is not above zero, or `smallest_wavelength` is not from two
    steps of the line to its length.
    """
    checks.instance("line", line, Profile)
    slope = checks.positive("steepest", steepest, infinite=True)
    step, period = line.step, len(line) * line.step
    z = fill_gaps(line.z)
    z = z - np.linspace(0.0, z[-1] - z[0], z.size, endpoint=False)
    z -= z.mean()
    if smallest_wavelength is None:
        smallest = min(RESOLVED_STEPS * step, period)
    else:
        smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    if smallest < 2.0 * step * (1.0 - 1e-9):
        raise InputError(
            f"smallest_wavelength must be at least two steps of the line, {2.0 * step:.4g} m; "
            f"got {smallest:.4g} m"
        )
    if not math.isinf(slope):
        # the envelope over three periods, of which the middle one has both neighbours
        periods = np.tile(z, 3)
        ramp = slope * step * np.arange(periods.size)
        behind = np.maximum.accumulate(periods + ramp) - ramp
        before = (np.maximum.accumulate(periods[::-1] + ramp) - ramp)[::-1]
        z = np.maximum(behind, before)[z.size : 2 * z.size]
    whole = Profile(line.x, z, line.name, line.source)
    return without_short_waves(whole, smallest)


def without_short_waves(line: Profile, smallest_wavelength: float) -> Profile:
    """Return a periodic line without shorter waves [m], with four points in the smallest left.

    Raises `InputError` if that is longer than the period.
    """
    cut = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    period = len(line) * line.step
    # round-off must not drop a wave that is exactly the smallest
    waves = math.floor(min(period / cut * (1.0 + 1e-9), len(line)))
    if waves < 1:
        raise InputError(
            f"smallest_wavelength must be at most the period {period:g} m; got {cut:g} m"
        )
    spectrum = np.fft.rfft(line.z)[: waves + 1]
    points = max(FEWEST_POINTS, 4 * (spectrum.size - 1))
    z = np.fft.irfft(spectrum, points) * (points / len(line))
    x = line.x[0] + np.linspace(0.0, period, points, endpoint=False)
    return Profile(x, z, line.name, source=line.source)


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
        return self.with_waves(self.between(np.inf, shortest))

    def with_waves(self, waves: ComplexArray) -> PeriodicLine:
        """Return a line of the same period with other waves."""
        return PeriodicLine(self.length, self.points, waves)

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

    def profile(self, name: str = "") -> Profile:
        """Return the heights as a profile, one period."""
        x = np.asarray(self.length / self.points * np.arange(self.points), dtype=np.float64)
        return Profile(x, np.asarray(scipy.fft.irfft(self.waves, self.points)), name)


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
            noise = line.with_waves(scipy.fft.rfft(random.standard_normal(line.points)))
            alone.append(noise.amplitude(2.0 * wavelength, wavelength))
        above, below = np.concatenate(parent), np.concatenate(child)
        coupling = float(np.cov(above, below)[0, 1] / above.var(ddof=1))
        rest = float(np.var(below - coupling * above) - np.var(np.concatenate(alone)))
        return cls(coupling, math.sqrt(max(rest, 0.0)))

    def octave(
        self, line: PeriodicLine, longest: float, shortest: float, random: np.random.Generator
    ) -> ComplexArray:
        """Return waves of a new octave of `line`, of any scale and with H = 1 within it.

        `longest` and `shortest` [m] are its ends; the octave above is part of the line.
        """

        def smooth_noise() -> Array:
            bell = np.exp(-0.5 * (0.5 * longest * line.wavenumber) ** 2)
            noise = scipy.fft.rfft(random.standard_normal(line.points)) * bell
            values = np.asarray(scipy.fft.irfft(noise, line.points))
            return np.asarray(values / values.std())

        log = self.coupling * line.amplitude(2.0 * longest, longest)
        log += self.scatter * smooth_noise()
        log -= log.mean()
        limit = _MOST_ABOVE * log.std()
        q = np.maximum(line.wavenumber, line.wavenumber[1])
        noise = line.with_waves(scipy.fft.rfft(random.standard_normal(line.points)) * q**-1.5)
        heights = scipy.fft.irfft(noise.between(longest, shortest), line.points)
        strong = scipy.fft.rfft(heights * np.exp(np.clip(log, -limit, limit)))
        return line.with_waves(strong).between(longest, shortest)
