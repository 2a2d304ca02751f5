"""The problem of one wave: a rubber, the rigid profile under it, and the load on it, in SI units.

The mesh belongs to the finite-strain block, not to the problem. A `Status` says how a solution
ended.
"""

from __future__ import annotations

import math
from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from gripscale import _kernel
from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.checks import Checked, checked
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber

FEWEST_HEIGHTS = 8
SMALLEST_SHARE = 1e-9
"""Waves beyond the last with this share of the largest amplitude are round-off."""


class Sine(Checked):
    """A rigid sine wave z = amplitude cos(2 pi x / wavelength), crest at x = 0.

    Wavelength and amplitude (half peak-to-valley height) [m] are above zero. Raises `InputError`
    for others.
    """

    wavelength: float = checked(checks.positive, unit="m")
    amplitude: float = checked(checks.positive, unit="m")


def _heights(name: str, value: ArrayLike) -> Array:
    """Return heights without their mean, read-only."""
    heights = checks.vector(name, value, unit="m")
    if heights.size < FEWEST_HEIGHTS:
        raise InputError(f"{name} must be at least {FEWEST_HEIGHTS}; got {heights.size}")
    if np.ptp(heights) == 0.0:
        raise InputError(f"{name} must differ; got {heights.size} times {heights[0]:g} m")
    heights -= heights.mean()
    heights.flags.writeable = False
    return heights


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

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s]."""
        return 2.0 * math.pi * self.load.speed / self.profile.wavelength


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


class Status(StrEnum):
    """How a solution ended: `converged`, or the reason not to use its numbers.

    Every member is, and compares equal to, its word; it carries what happened, what to do about it
    and where the documentation says more.
    """

    CONVERGED = "converged"
    ITERATION_LIMIT = "iteration limit"
    ELEMENT_INVERTED = "element inverted"
    NO_ACTIVE_SET = "no active set"
    NOT_FINITE = "not finite"
    FOLD = "fold in the load path"
    MEAN_SHEAR = "mean shear too large"
    TIME_LIMIT = "time limit"
    TOLERANCE_NOT_MET = "tolerance not met"
    FRICTIONS_DISAGREE = "frictions disagree"
    ACTIVE_SET_NOT_SETTLED = "active set not settled"
    CONTACT_TOO_NARROW = "contact too narrow"
    PROFILE_TOO_ROUGH = "profile too rough"
    CONDITIONS_NOT_SETTLED = "conditions not settled"

    @property
    def sentence(self) -> str:
        """What happened."""
        return _TEXTS[self][0]

    @property
    def advice(self) -> str:
        """What to do about it; empty for `converged`."""
        return _TEXTS[self][1]

    @property
    def chapter(self) -> str:
        """Page and heading of the documentation that say more."""
        return _CHAPTERS.get(self, "reading-results.md#statuses-and-what-to-do-about-them")


_TEXTS = {word: (sentence, advice) for word, sentence, advice in _kernel.statuses()} | {
    Status.FRICTIONS_DISAGREE: (
        "The contact has a solution, but on the last mesh friction from traction and friction from "
        "dissipation differ too much.",
        "Take more columns. For a direct contact, set a tolerance: it refines the grid.",
    ),
    Status.ACTIVE_SET_NOT_SETTLED: (
        "The half-plane model did not converge to a set of points in contact.",
        "Take another number of points.",
    ),
    Status.CONDITIONS_NOT_SETTLED: (
        "Contact, strains and temperatures did not agree after the allowed passes.",
        "Leave out an effect, or take a lower speed or pressure.",
    ),
}
"""Sentence and advice by the word of a status, of the kernel and of the solvers in Python."""

_WAVES, _MESHES = "limits.md#where-waves-converge", "limits.md#discretisation"
_CHAPTERS = {
    Status.CONVERGED: "reading-results.md#how-far-to-trust-a-number",
    Status.FOLD: _WAVES,
    Status.MEAN_SHEAR: _WAVES,
    Status.TOLERANCE_NOT_MET: _MESHES,
    Status.FRICTIONS_DISAGREE: _WAVES,
    Status.CONTACT_TOO_NARROW: _WAVES,
    Status.PROFILE_TOO_ROUGH: _MESHES,
    Status.CONDITIONS_NOT_SETTLED: "conditions.md#the-fixed-point",
}
"""Chapters of statuses that have one of their own."""
