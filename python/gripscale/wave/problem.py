"""The problem of one wave: a rubber, the rigid profile under it, and the load on it, in SI."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from gripscale.core import Array, Checked, InputError, checked, checks
from gripscale.rubber import Rubber

FEWEST_HEIGHTS = 8
# Waves beyond the last with this share of the largest amplitude are round-off.
SMALLEST_SHARE = 1e-9


class Sine(Checked):
    """A rigid sine wave z = amplitude cos(2 pi x / wavelength), both above zero [m].

    The amplitude is half the peak-to-valley height. Raises `InputError` for others.
    """

    wavelength: float = checked(checks.positive, unit="m")
    amplitude: float = checked(checks.positive, unit="m")


def _heights(name: str, value: ArrayLike) -> Array:
    """Return heights without their mean."""
    heights = checks.vector(name, value, unit="m")
    if heights.size < FEWEST_HEIGHTS:
        raise InputError(f"{name} must be at least {FEWEST_HEIGHTS}; got {heights.size}")
    if np.ptp(heights) == 0.0:
        raise InputError(f"{name} must differ; got {heights.size} times {heights[0]:g} m")
    return np.asarray(heights - heights.mean())


class SampledProfile(Checked, eq=False):
    """Heights at equal steps over one period; between them the trigonometric interpolant.

    Raises `InputError` if the period is no number above zero, or the heights are too few, not
    finite, or all equal.
    """

    wavelength: float = checked(checks.positive, unit="m")
    """The period [m], above zero."""
    heights: Array = checked(_heights)
    """Heights at x = 0, wavelength/points, ... [m], at least 8; their mean is subtracted."""

    @property
    def amplitude(self) -> float:
        """Half the range of the interpolant [m], on sixteen times finer steps."""
        count = self.heights.size
        fine = np.fft.irfft(np.fft.rfft(self.heights), 16 * count) * 16.0
        return float(np.ptp(fine)) / 2.0

    def slope(self, x: Array) -> Array:
        """Return the slope dz/dx [-] of the interpolant at `x` [m], shape (points,)."""
        count = self.heights.size
        number = np.arange(1, count // 2 + 1)
        ik = 2j * np.pi / self.wavelength * number
        weight = np.where(2 * number == count, 1.0, 2.0) / count
        amplitudes = weight * np.fft.rfft(self.heights)[number]
        return np.asarray((np.exp(np.outer(x, ik)) @ (ik * amplitudes)).real)

    @property
    def waves(self) -> int:
        """Number of the smallest wave: its repeats in the period."""
        size = np.abs(np.fft.rfft(self.heights))
        return int(np.flatnonzero(size > SMALLEST_SHARE * size.max())[-1])


class WaveLoad(Checked):
    """Mean pressure and sliding on one wave.

    Raises `InputError` if a value is not a number or out of its range.
    """

    pressure: float = checked(checks.positive, unit="Pa")
    """Mean pressure [Pa], above zero."""
    speed: float = checked(checks.not_negative, unit="m/s", default=0.0)
    """Sliding speed [m/s]; zero is static contact of the relaxed rubber."""
    load_time: float = checked(checks.not_negative, unit="s", infinite=True, default=math.inf)
    """Time the mean deformation has had to relax [s]; may be infinite."""


class WaveProblem(Checked):
    """Input of a solver of one wave."""

    rubber: Rubber = checked(checks.instance, kind=Rubber)
    profile: Sine | SampledProfile
    load: WaveLoad
    thickness: float | None = checked(checks.positive, unit="m", default=None)
    """Of the rubber on a rigid base [m]; None: as deep as the solver has it."""


class Mesh(Checked):
    """Elements of the periodic block, one wavelength wide, graded towards the contact.

    Raises `InputError` if a value is out of its range.
    """

    columns: int = checked(checks.whole, least=4, most=4096, default=128)
    """Elements along the block."""
    rows: int = checked(checks.whole, least=2, most=256, default=20)
    """Elements across the block."""
    depth: float = checked(checks.positive, default=1.5)
    """Height of the block in wavelengths."""
    element_order: int = checked(checks.whole, least=1, most=2, default=1)
    """1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure."""
