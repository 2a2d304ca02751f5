"""The problem of one wave: a rubber, the rigid profile under it, and the load on it, in SI units.

The mesh is no part of it: how a problem is solved belongs to the solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from numpy.typing import NDArray

from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber

FEWEST_HEIGHTS = 8
SMALLEST_SHARE = 1e-9
"""Waves beyond the last with this share of the largest amplitude are round-off."""


@dataclass(frozen=True)
class Sine:
    """A rigid sine wave z = amplitude cos(2 pi x / wavelength), crest at x = 0.

    Parameters
    ----------
    wavelength : float
        [m], above zero.
    amplitude : float
        Half peak-to-valley height [m], above zero.

    Raises
    ------
    InputError
        If a value is not a number above zero.
    """

    wavelength: float
    amplitude: float

    def __post_init__(self) -> None:
        _set(self, wavelength=checks.positive("wavelength", self.wavelength, unit="m"))
        _set(self, amplitude=checks.positive("amplitude", self.amplitude, unit="m"))


@dataclass(frozen=True, eq=False)
class SampledProfile:
    """Heights at equal steps over one period; between them the trigonometric interpolant.

    Parameters
    ----------
    wavelength : float
        The period [m], above zero.
    heights : array_like, shape (points,)
        Heights at x = 0, wavelength/points, ... [m], at least 8; their mean is taken off.

    Raises
    ------
    InputError
        If the period is no number above zero, or the heights are too few, not finite, or all equal.
    """

    wavelength: float
    heights: NDArray[np.float64]

    def __post_init__(self) -> None:
        heights = checks.vector("heights", self.heights, unit="m")
        if heights.size < FEWEST_HEIGHTS:
            raise InputError(f"heights must be at least {FEWEST_HEIGHTS}; got {heights.size}")
        if np.ptp(heights) == 0.0:
            raise InputError(f"heights must differ; got {heights.size} times {heights[0]:g} m")
        heights -= heights.mean()
        heights.flags.writeable = False
        _set(self, wavelength=checks.positive("wavelength", self.wavelength, unit="m"))
        object.__setattr__(self, "heights", heights)

    @property
    def amplitude(self) -> float:
        """Half the difference of largest and smallest height [m], on sixteen times finer steps."""
        count = self.heights.size
        fine = np.fft.irfft(np.fft.rfft(self.heights), 16 * count) * 16.0
        return float(np.ptp(fine)) / 2.0

    def slope(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the slope dz/dx [-] of the interpolant at `x` [m], shape (points,)."""
        count = self.heights.size
        number = np.arange(1, count // 2 + 1)
        turn = 2j * np.pi / self.wavelength * number
        share = np.where(2 * number == count, 1.0, 2.0) / count
        amplitudes = share * np.fft.rfft(self.heights)[number]
        return np.asarray((np.exp(np.outer(x, turn)) @ (turn * amplitudes)).real)

    @property
    def waves(self) -> int:
        """Number of its smallest wave: whole waves in the period."""
        size = np.abs(np.fft.rfft(self.heights))
        return int(np.flatnonzero(size > SMALLEST_SHARE * size.max())[-1])


@dataclass(frozen=True)
class Load:
    """Mean pressure and sliding on one wave.

    Parameters
    ----------
    pressure : float
        Mean pressure [Pa], above zero.
    speed : float
        Sliding speed [m/s]; zero is static contact of the relaxed rubber.
    load_time : float
        Time the mean deformation has had to relax [s]; may be infinite.

    Raises
    ------
    InputError
        If a value is not a number or out of its range.
    """

    pressure: float
    speed: float = 0.0
    load_time: float = math.inf

    def __post_init__(self) -> None:
        load_time = checks.not_negative("load_time", self.load_time, unit="s", infinite=True)
        _set(self, pressure=checks.positive("pressure", self.pressure, unit="Pa"))
        _set(self, speed=checks.not_negative("speed", self.speed, unit="m/s"), load_time=load_time)


@dataclass(frozen=True)
class WaveProblem:
    """What a solver of one wave is asked."""

    rubber: Rubber
    profile: Sine | SampledProfile
    load: Load

    def __post_init__(self) -> None:
        checks.instance("rubber", self.rubber, Rubber)

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s]."""
        return 2.0 * math.pi * self.load.speed / self.profile.wavelength


def _set(owner: object, **values: float) -> None:
    """Keep checked values in a frozen dataclass."""
    for name, value in values.items():
        object.__setattr__(owner, name, value)


# The mesh of the finite-strain block.


@dataclass(frozen=True)
class Mesh:
    """Elements of the periodic block, one wavelength wide, graded towards the contact.

    Parameters
    ----------
    columns, rows : int
        Elements along the block and across it.
    depth : float
        Height of the block in wavelengths.
    element_order : int
        1: bilinear with one pressure; 2: biquadratic with linear discontinuous pressure.

    Raises
    ------
    InputError
        If a value is out of its range.
    """

    columns: int = 128
    rows: int = 20
    depth: float = 1.5
    element_order: int = 1

    def __post_init__(self) -> None:
        checked = {
            "columns": checks.whole("columns", self.columns, least=4, most=4096),
            "rows": checks.whole("rows", self.rows, least=2, most=256),
            "depth": checks.positive("depth", self.depth),
            "element_order": checks.whole("element_order", self.element_order, least=1, most=2),
        }
        for name, value in checked.items():
            object.__setattr__(self, name, value)


# How a solution ended: `converged`, or why its numbers are not to be trusted.


class Status(StrEnum):
    """Every member is, and compares equal to, its word."""

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
