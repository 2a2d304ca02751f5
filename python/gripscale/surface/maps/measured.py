"""Measured profiles as one period each, without waves longer than a map holds.

Missing heights are filled linearly and the straight line through the ends is taken out, as the
direct contact does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.errors import InputError
from gripscale.surface.gaps import filled
from gripscale.surface.maps.square import ComplexArray
from gripscale.surface.profile import FloatArray, Profile

LONGEST = 2.0
"""Longest wave kept, over the period of the map: those up to twice as long appear in its first."""

FEWEST_PERIODS = 4
"""Periods of the map all profiles together must be long."""


@dataclass(frozen=True, eq=False)
class MeasuredLine:
    """The waves of one profile (`rfft`), their wavenumbers [rad/m] and its number of points."""

    waves: ComplexArray
    wavenumber: FloatArray
    points: int

    @property
    def heights(self) -> FloatArray:
        """Heights [m]."""
        return np.asarray(np.fft.irfft(self.waves, self.points))


def measured_lines(profiles: Sequence[Profile], length: float) -> list[MeasuredLine]:
    """Return the profiles for a map of period `length` [m].

    Raises
    ------
    InputError
        If they are too short for it.
    """
    total = sum(profile.length for profile in profiles)
    if total < FEWEST_PERIODS * length:
        raise InputError(
            f"profiles must be {FEWEST_PERIODS} times as long as a map together, "
            f"{FEWEST_PERIODS * length:.4g} m; got {total:.4g} m"
        )
    return [_line(profile, length) for profile in profiles]


def _line(profile: Profile, length: float) -> MeasuredLine:
    z = filled(profile.z)
    z = z - np.linspace(z[0], z[-1], z.size)
    waves = np.fft.rfft(z)
    q = np.asarray(2.0 * np.pi * np.fft.rfftfreq(z.size, profile.step), dtype=np.float64)
    waves[q < 2.0 * np.pi / (LONGEST * length)] = 0.0
    return MeasuredLine(waves, q, z.size)
