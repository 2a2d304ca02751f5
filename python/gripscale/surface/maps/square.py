"""The square of equal steps an isotropic map is made on, one period of it, and its waves."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gripscale.surface.profile import FloatArray

ComplexArray = NDArray[Any]


@dataclass(frozen=True)
class Square:
    """A periodic square.

    Attributes
    ----------
    points
        Each way, even.
    length
        Period each way [m].
    """

    points: int
    length: float

    @property
    def step(self) -> float:
        """Distance between points [m]."""
        return self.length / self.points

    @cached_property
    def axes(self) -> tuple[FloatArray, FloatArray]:
        """Wavenumbers along x and y [rad/m], broadcastable to a half spectrum (`rfft2`)."""
        number = 2.0 * np.pi / self.length
        x = number * np.rint(np.fft.fftfreq(self.points, 1.0 / self.points))
        return x[:, None], number * np.arange(self.points // 2 + 1.0)[None, :]

    @cached_property
    def wavenumber(self) -> FloatArray:
        """|q| over a half spectrum [rad/m]."""
        return np.asarray(np.hypot(*self.axes))

    @property
    def carried(self) -> NDArray[np.bool_]:
        """Which waves a map has: above the mean, below the highest in every direction."""
        q = self.wavenumber
        return np.asarray((q > 0.0) & (q < np.pi / self.step * (1.0 - 1e-9)))

    def heights(self, spectrum: ComplexArray) -> FloatArray:
        """Return the heights [m] of a half spectrum."""
        from scipy.fft import irfft2

        return np.asarray(irfft2(spectrum, s=(self.points, self.points)))

    def spectrum(self, heights: FloatArray) -> ComplexArray:
        """Return the half spectrum of heights [m]."""
        from scipy.fft import rfft2

        return np.asarray(rfft2(heights))

    def noise(self, random: np.random.Generator) -> FloatArray:
        """Return white noise, of variance one."""
        return random.standard_normal((self.points, self.points))

    def onto(self, spectrum: ComplexArray, other: Square) -> ComplexArray:
        """Return the half spectrum on another square of the same length: waves of both."""
        kept = min(self.points, other.points) // 2
        out = np.zeros((other.points, other.points // 2 + 1), dtype=spectrum.dtype)
        out[:kept, :kept] = spectrum[:kept, :kept]
        out[1 - kept :, :kept] = spectrum[1 - kept :, :kept]
        scale = (other.points / self.points) ** 2
        return np.asarray(np.where(other.carried, scale * out, 0.0))
