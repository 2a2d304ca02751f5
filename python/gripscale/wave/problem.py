"""The problem of one wave: a rubber, the rigid profile under it, and the load on it, in SI units.

The mesh is no part of it: how a problem is solved belongs to the solver.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gripscale import checks
from gripscale.rubber import Rubber


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
    profile: Sine
    load: Load

    @property
    def angular_frequency(self) -> float:
        """Fundamental excitation 2 pi speed / wavelength [rad/s]."""
        return 2.0 * math.pi * self.load.speed / self.profile.wavelength


def _set(owner: object, **values: float) -> None:
    """Keep checked values in a frozen dataclass."""
    for name, value in values.items():
        object.__setattr__(owner, name, value)
