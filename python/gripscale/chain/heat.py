"""How warm the rubber is on every wave of a chain: the heat of all waves, at all their scales.

Wave j loses mu_j p_j v per area of its own, which is mu_j p_1 v of the nominal area: all waves
together lose mu p_1 v. Seen from the nominal area this heat is uniform while the footprint passes;
in the contact of wave l it is denser by the pattern of the pressure there, for wave l's own loss by
the pattern of that loss. So the temperature on wave i, over that of the rubber, is

    uniform, for the time footprint/v           v p_1 sum_j mu_j
    + the harmonics of each wave l <= i         v p_l (mu_l own pattern + sum_(j > l) mu_j contact)

each by `interface.temperature_rise`: for l < i averaged over the contact, by its pressure; for
l = i over where wave i loses its energy. The road takes up no heat: an upper bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.conditions import StrainNorm
from gripscale.conditions.flash_temperature import (
    DepthsOfLoss,
    LossDepth,
    LossLayers,
    ThermalProperties,
    loss_pattern,
)
from gripscale.core.errors import InputError
from gripscale.rubber import Rubber
from gripscale.wave.result import WaveResult

# The heat of one wave: where along it and how deep below it the friction work is lost.

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


@dataclass(frozen=True)
class Warming:
    """Temperatures over that of the rubber before the contact [K]."""

    uniform: float
    """Of the heat of all waves, spread over the nominal area, where this wave loses its own."""
    larger_waves: float
    """Of the patterns of the larger waves, in their contact."""
    own: float
    """Of this wave's own pattern, where it loses energy."""
    contact: float
    """In the real contact of this wave, at the surface, from everything."""

    @property
    def total(self) -> float:
        """Where this wave loses its energy [K]."""
        return self.uniform + self.larger_waves + self.own


def warming(
    waves: Sequence[WaveHeat], *, speed: float, time: float, thermal: ThermalProperties
) -> list[Warming]:
    """Return how much warmer the rubber is on each wave.

    Parameters
    ----------
    waves : sequence of WaveHeat
        Of the chain, largest first.
    speed : float
        Of sliding [m/s].
    time : float
        For which the nominal contact lasts [s].
    thermal : ThermalProperties
        Of the rubber.
    """
    if speed == 0.0 or not waves:
        return [Warming(0.0, 0.0, 0.0, 0.0) for _ in waves]
    nominal = speed * waves[0].pressure
    deep = [rise.uniform_where_lost(time, wave.depth, thermal) for wave in waves]
    top = [rise.uniform_at_surface(time, wave.depth, thermal) for wave in waves]
    out, above = [], 0.0
    for i, wave in enumerate(waves):
        heats = [nominal * other.friction for other in waves]
        others = sum(h * t for j, (h, t) in enumerate(zip(heats, top, strict=True)) if j != i)
        uniform = others + heats[i] * deep[i]
        own, contact = _patterns(wave, waves[i + 1 :], speed, thermal)
        surface = others + heats[i] * top[i]
        out.append(Warming(uniform, above, own, surface + above + contact))
        above += contact
    return out


def _patterns(
    wave: WaveHeat, smaller: Sequence[WaveHeat], speed: float, thermal: ThermalProperties
) -> tuple[float, float]:
    """Return the rise by the wave's harmonics where it loses energy, and in its contact [K]."""
    k, heat = wave.wavenumbers, speed * wave.pressure
    m = rise.harmonic_decay(k, k, speed, thermal)
    own = heat * wave.friction * wave.lost
    passed_on = np.zeros_like(m)
    for other in smaller:
        reached = rise.harmonic_at_surface(m, other.depth, thermal)
        passed_on += heat * other.friction * wave.contact * reached
    at_surface = own * rise.harmonic_at_surface(m, wave.depth, thermal) + passed_on
    where_lost = own * rise.harmonic_where_lost(m, wave.depth, thermal)
    where_lost += wave.depth.decay(m) * passed_on
    return _mean(where_lost, wave.lost), _mean(at_surface, wave.contact)


def _mean(temperature: np.ndarray, weight: np.ndarray) -> float:
    """Return the mean of a temperature over a pattern of unit mean, both as harmonics."""
    return float(2.0 * (temperature * weight.conj()).real.sum())


# How strongly a wave strains the rubber it touches.


def strains(waves: Sequence[WaveResult], norm: StrainNorm) -> list[float]:
    """Return the strain amplitude [-] on each wave, largest wave first.

    Raises `InputError` for the stretches of a solver that gives none.
    """
    if norm == "stretch":
        return [_largest_strain(wave) for wave in waves]
    squares = np.cumsum([(0.5 * contact_slope(wave)) ** 2 for wave in waves])
    return [float(e) for e in np.sqrt(squares)]


def contact_slope(wave: WaveResult) -> float:
    """Return the rms slope of a solved wave in its contact [-]."""
    k = 2.0 * math.pi / wave.wavelength
    edges = np.asarray(wave.details["contact_edges"], dtype=float)
    start, end = k * edges[:, 0], k * edges[:, 1]
    square = 0.5 - (np.sin(2.0 * end) - np.sin(2.0 * start)).sum() / (4.0 * (end - start).sum())
    return float(k * wave.amplitude * math.sqrt(max(square, 0.0)))


def _largest_strain(wave: WaveResult) -> float:
    strain = max(wave.max_stretch - 1.0, 1.0 - wave.min_stretch)
    if not math.isfinite(strain):
        raise InputError(
            f'strain_norm must be "slope" for a solver without stretches; got "stretch" '
            f"with {wave.model}"
        )
    return strain
