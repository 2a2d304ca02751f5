"""The roughness that rubber meets: without steep flanks, waves too short and waves too long.

    e(r) = max_r' (z(r') - s |r - r'|)                          the envelope without slopes above s
    T(q) = exp(-ln 2 (q / q_c)^2),    q_c = 2 pi / lambda_c     half of a wave of the cut-off

The envelope is that of E. J. McShane, Bull. Amer. Math. Soc. 40 (1934) 837,
doi:10.1090/S0002-9904-1934-05978-0; the Gaussian that of ISO 16610-21 and 16610-61. All models of
measured heights take them in this order, and so do correlation, spectra and slopes; texture by
standards takes the heights as they are. A block rides over waves longer than its footprint:
docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from gripscale.core import Array, InputError, checks
from gripscale.surface.profile import FEWEST_POINTS, HeightMap, Profile, profile_list
from gripscale.surface.resampling import fill_gaps

# Slope that rubber is taken to follow: stretched to 4.1, near the elongation at break of tread.
STEEPEST = 4.0
POINTS_IN_CUT_OFF = 4  # points of a line in one wave of its cut-off length
_ROUNDING = 1e-12
_Heights = TypeVar("_Heights", Profile, HeightMap)


def transmission(wavenumber: Array, cut_off: float | Array) -> Array:
    """Return the share of the amplitude of waves [rad/m] that cut-offs [m] transmit."""
    waves = np.asarray(wavenumber) * (cut_off / (2.0 * np.pi))
    return np.asarray(np.exp(-math.log(2.0) * waves**2))


def upper_envelope(
    z: Array, steps: tuple[float, ...], steepest: float = STEEPEST, *, periodic: bool = True
) -> Array:
    """Return the smallest heights [m] above `z` without slopes above `steepest` [-].

    `z` has no gaps [m], shape (points,) or (nx, ny), and is one period if `periodic`; `steps` are
    the distances of points along each axis [m]. On maps distances run along the grid and its
    diagonals, up to 8 % longer than straight ones. Infinity returns the heights as they are.
    """
    if math.isinf(steepest):
        return z
    rises = [steepest * step for step in steps]
    if not _rises_faster(z, rises, periodic):
        return z
    # beyond this number of points a height raises no other
    margin = [0] * z.ndim
    if periodic:
        margin = [min(math.ceil(np.ptp(z) / r), n) for r, n in zip(rises, z.shape, strict=True)]
    wide = np.pad(z, [(points, points) for points in margin], mode="wrap")
    rows = wide if z.ndim > 1 else wide[None]
    ramp = rises[-1] * np.arange(rows.shape[-1])
    diagonal = math.hypot(*rises)
    for order in (slice(None), slice(None, None, -1)):
        # each row from the one before it, then along the row: exact along these eight directions
        before = None
        for row in rows[order]:
            if before is not None:
                np.maximum(row, before - rises[0], out=row)
                np.maximum(row[1:], before[:-1] - diagonal, out=row[1:])
                np.maximum(row[:-1], before[1:] - diagonal, out=row[:-1])
            np.maximum(row, np.maximum.accumulate(row + ramp) - ramp, out=row)
            back = row[::-1]
            np.maximum(back, np.maximum.accumulate(back + ramp) - ramp, out=back)
            before = row
    inside = wide[tuple(slice(m, m + n) for m, n in zip(margin, z.shape, strict=True))]
    # the ramps round: what stands out by less is the height itself
    return np.where(inside - z > _ROUNDING * np.ptp(z), inside, z)


def _rises_faster(z: Array, rises: list[float], periodic: bool) -> bool:
    """Return whether neighbours differ by more than the `rises` along the axes, or a diagonal."""
    wide = np.pad(z, [(0, 1)] * z.ndim, mode="wrap") if periodic else z
    most = [np.abs(np.diff(wide, axis=axis)).max() - rise for axis, rise in enumerate(rises)]
    if z.ndim > 1:
        diagonals = wide[1:, 1:] - wide[:-1, :-1], wide[1:, :-1] - wide[:-1, 1:]
        most += [np.abs(each).max() - math.hypot(*rises) for each in diagonals]
    return bool(max(most) > _ROUNDING * np.ptp(z))


def followed(surface: _Heights, steepest: float = STEEPEST, *, periodic: bool = False) -> _Heights:
    """Return a profile or map without flanks above a slope [-]; gaps stay, infinity keeps all."""
    steps = surface.step if isinstance(surface, HeightMap) else (surface.step,)
    slope = checks.positive("steepest", steepest, infinite=True)
    if math.isinf(slope):
        return surface
    # only measured heights raise others: filling twice changes nothing
    missing = np.isnan(surface.z)
    whole = np.where(missing, np.nanmin(surface.z), surface.z)
    envelope = upper_envelope(whole, steps, slope, periodic=periodic)
    if envelope is whole or np.array_equal(envelope[~missing], surface.z[~missing]):
        return surface
    return replace(surface, z=np.where(missing, np.nan, envelope))


def followed_lines(
    surface: Profile | Sequence[Profile] | HeightMap,
    steepest: float = STEEPEST,
    *,
    periodic: bool = False,
) -> list[Profile]:
    """Return profiles, or the lines of a map along x, without flanks above a slope [-].

    Raises `InputError` if it is neither.
    """
    if isinstance(surface, HeightMap):
        return followed(surface, steepest, periodic=periodic).lines()
    return [followed(line, steepest, periodic=periodic) for line in profile_list(surface)]


def one_period(
    line: Profile, smallest_wavelength: float | None = None, *, steepest: float = STEEPEST
) -> Profile:
    """Return a periodic line, for any model with `periodic=True`.

    Missing heights are filled, the line through the end points subtracted, and flanks above a slope
    of `steepest` [-] replaced by their `upper_envelope`; infinity keeps all. `low_pass` then cuts
    the line off at `smallest_wavelength` [m]; without one it keeps its steps and all its waves.
    Raises `InputError` if `steepest` is not above zero, or `smallest_wavelength` is not from two
    steps of the line to its length.
    """
    checks.instance("line", line, Profile)
    slope = checks.positive("steepest", steepest, infinite=True)
    z = fill_gaps(line.z)
    z = z - np.linspace(0.0, z[-1] - z[0], z.size, endpoint=False)
    z = upper_envelope(z, (line.step,), slope)
    whole = Profile(line.x, z - z.mean(), line.name, line.source)
    if smallest_wavelength is None:
        return whole
    smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
    if smallest < 2.0 * line.step * (1.0 - 1e-9):
        raise InputError(
            "smallest_wavelength must be at least two steps of the line, "
            f"{2.0 * line.step:.4g} m; got {smallest:.4g} m"
        )
    return low_pass(whole, smallest)


def low_pass(line: Profile, cut_off: float) -> Profile:
    """Return a periodic line cut off by a Gaussian, with four points in a wave of the cut-off [m].

    These points carry waves down to half of it, of which the Gaussian leaves 1/16.
    """
    cut = checks.positive("smallest_wavelength", cut_off, unit="m")
    period = len(line) * line.step
    # round-off must not drop a wave that is exactly the smallest
    waves = math.floor(min(period / cut * (1.0 + 1e-9), len(line)))
    if waves < 1:
        raise InputError(
            f"smallest_wavelength must be at most the period {period:g} m; got {cut:g} m"
        )
    points = max(FEWEST_POINTS, POINTS_IN_CUT_OFF * waves)
    spectrum = np.fft.rfft(line.z)[: (points + 1) // 2]
    number = 2.0 * np.pi / period * np.arange(spectrum.size, dtype=float)
    z = np.fft.irfft(spectrum * transmission(number, cut), points) * (points / len(line))
    x = line.x[0] + np.linspace(0.0, period, points, endpoint=False)
    return Profile(x, z, line.name, source=line.source)


PER_FOOTPRINT = 1.5  # cut-off over the length of the block
# share of the mean square height above which the long waves decide the correlation
MOST_SHARE = 0.5


def long_waves(profile: Profile, longest: float) -> Array:
    """Return the waves beyond the cut-off `longest` [m], shape (points,); none of shorter lines."""
    from scipy import fft

    cut = checks.positive("longest_wavelength", longest, unit="m")
    points, step = len(profile), profile.step
    if profile.length <= cut:
        return np.zeros(points)
    length = fft.next_fast_len(points + math.ceil(cut / step), real=True)
    q = 2.0 * np.pi / (length * step) * np.arange(length // 2 + 1, dtype=float)
    gaussian = transmission(q, cut)
    # of the weights w(u): transforms of w, u w and u^2 w
    width = 2.0 * math.log(2.0) * (cut / (2.0 * np.pi)) ** 2
    kernels = gaussian, -1j * width * q * gaussian, width * (1.0 - width * q**2) * gaussian

    def smoothed(values: Array, moment: int) -> Array:
        transform = fft.rfft(values, length) * kernels[moment]
        return np.asarray(fft.irfft(transform, length)[:points])

    measured = np.isfinite(profile.z)
    weight, heights = measured.astype(float), np.where(measured, profile.z, 0.0)
    w0, w1, w2 = (smoothed(weight, moment) for moment in range(3))
    z0, z1 = (smoothed(heights, moment) for moment in range(2))
    w0 = np.maximum(w0, np.finfo(float).eps)  # no weight within wide gaps
    centre, mean = w1 / w0, z0 / w0
    # a floor of the variance: about a single point the line is level
    slope = (z1 / w0 - centre * mean) / np.maximum(w2 / w0 - centre**2, 1e-6 * width)
    return np.asarray(mean - slope * centre)


def mean_square(profile: Profile, heights: Array) -> float:
    """Return the mean square of heights [m^2] about their mean where the profile has some."""
    return float(np.var(heights[np.isfinite(profile.z)]))


def longest_held(profiles: Sequence[Profile], footprint: float) -> float | None:
    """Return the longest wavelength that a footprint [m] holds.

    None unless longer waves hold most of the mean square height of profiles.
    """
    longest = PER_FOOTPRINT * footprint
    beyond = sum(mean_square(line, long_waves(line, longest)) for line in profiles)
    every = sum(mean_square(line, line.z) for line in profiles)
    return longest if beyond > MOST_SHARE * every else None
