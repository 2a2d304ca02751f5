"""The heat of one wave: where along it and how deep below it the friction work is lost."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.interface.heat_pattern import loss_pattern
from gripscale.interface.loss_depth import DepthsOfLoss, LossDepth
from gripscale.interface.loss_layers import LossLayers
from gripscale.rubber import Rubber
from gripscale.wave.result import WaveResult

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

POINTS = 256


@dataclass(frozen=True)
class WaveHeat:
    """Patterns of a wave as amplitudes of its harmonics 1, 2, ... over the mean [-]."""

    wavelength: float
    pressure: float
    """Mean pressure on the wave [Pa]."""
    friction: float
    contact: ComplexArray
    """Of the pressure: where the smaller waves lose energy."""
    lost: ComplexArray
    """Of its own loss."""
    depth: DepthsOfLoss
    """Of its own loss."""

    @property
    def wavenumbers(self) -> Array:
        """Of the harmonics [rad/m]."""
        return np.asarray(2.0 * math.pi / self.wavelength * np.arange(1.0, POINTS // 2))

    @classmethod
    def of(cls, wave: WaveResult, rubber: Rubber) -> WaveHeat:
        """Return the heat of a solved wave of `rubber`.

        The pressure along the wave decides where along it: harmonic n of it loses
        |p_n|^2 Im M / |M|^2 at n times the frequency of the wave. How deep it tells its solver, or
        each harmonic has a mean depth of 3/2 over its wavenumber.
        """
        spectrum = np.fft.rfft(_pressure(wave)) / POINTS
        number = np.arange(1, POINTS // 2)
        modulus = rubber.plane_strain_modulus(number * wave.angular_frequency)
        lost = np.zeros(spectrum.size)
        lost[1:-1] = np.abs(spectrum[1:-1]) ** 2 * modulus.imag / np.abs(modulus) ** 2
        total = lost.sum()
        wavenumber = 2.0 * math.pi / wave.wavelength
        depth: DepthsOfLoss = LossDepth.under(wavenumber)
        if total <= 0.0:
            pattern = np.zeros(number.size, dtype=complex)
        else:
            along = np.fft.rfft(loss_pattern(spectrum, lost))
            pattern = along[1:-1] / along[0]
            depth = LossDepth(float(lost[1:-1] @ (1.5 / number) / total / wavenumber))
        if wave.loss_by_depth is not None and wave.friction_from_dissipation > 0.0:
            depth = LossLayers.of(*wave.loss_by_depth)
        return cls(
            wave.wavelength,
            wave.pressure_received,
            max(wave.friction, 0.0),
            spectrum[1:-1] / spectrum[0],
            pattern,
            depth,
        )


def _pressure(wave: WaveResult) -> Array:
    """Return the pressure at equal steps along the wave [Pa]."""
    steps = np.arange(POINTS) * wave.wavelength / POINTS
    return np.asarray(np.interp(steps, wave.x, wave.pressure, period=wave.wavelength))
