"""Waves longer than a footprint, which do not press into the rubber: the block rides over them.

The line through the heights below a block of length L leaves a quarter of the mean square of waves
of 1.5 L. So does the Gaussian of ISO 16610-21 at its cut-off, which is therefore 1.5 L. Near ends
and gaps it is the local line with these weights (ISO 16610-28). A contact sees little of long
waves, but the correlation and its waves are theirs once they hold most of the mean square: by
default they are left out there only. docs/derivations.md has the share and what was measured.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from gripscale.core import Array, checks
from gripscale.surface.low_pass import transmission
from gripscale.surface.profile import Profile

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
