"""Temperature of the rubber on every wave of a chain, by the friction heat of all waves.

With friction mu_j and pressure p_j of the waves, the temperature rise on wave i is

    uniform, for the time footprint/v           v p_1 sum_j mu_j
    + the harmonics of each wave l <= i         v p_l (mu_l own pattern + sum_(j > l) mu_j contact)

each from `gripscale.conditions.flash_temperature`: for l < i averaged over the contact, weighted by
its pressure; for l = i averaged over the loss of wave i. An area term, less what a counterface
takes up of all heat, counts as a further wave below the last, at the surface.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.conditions import SLOPE_FACTOR, Conditions, StrainNorm
from gripscale.core import Array, ComplexArray, InputError
from gripscale.rubber import Rubber
from gripscale.wave.result import ScaleResult

_POINTS = 256


@dataclass(frozen=True)
class WaveHeat:
    """Patterns of a wave as amplitudes of its harmonics 1, 2, ... over the mean [-]."""

    wavelength: float
    pressure: float  # mean pressure on the wave [Pa]
    friction: float
    contact: ComplexArray  # of the pressure: where the smaller waves lose energy
    lost: ComplexArray  # of its own loss
    depth: rise.DepthsOfLoss  # of its own loss

    @property
    def wavenumbers(self) -> Array:
        """Of the harmonics [rad/m]."""
        return np.asarray(2.0 * math.pi / self.wavelength * np.arange(1.0, _POINTS // 2))

    @classmethod
    def of(cls, wave: ScaleResult, rubber: Rubber) -> WaveHeat:
        """Return the heat of a solved wave of `rubber`.

        Along the wave, harmonic n of the pressure loses |p_n|^2 Im M / |M|^2 at n times the
        frequency of the wave. The depth of the loss comes from the solver, if it reports one; else
        each harmonic has a mean depth of 3/2 over its wavenumber.
        """
        steps = np.arange(_POINTS) * wave.wavelength / _POINTS
        pressure = np.interp(steps, wave.x, wave.pressure, period=wave.wavelength)
        spectrum = np.fft.rfft(np.asarray(pressure)) / _POINTS
        number = np.arange(1, _POINTS // 2)
        modulus = rubber.plane_strain_modulus(number * wave.angular_frequency)
        lost = np.zeros(spectrum.size)
        lost[1:-1] = np.abs(spectrum[1:-1]) ** 2 * modulus.imag / np.abs(modulus) ** 2
        total = lost.sum()
        wavenumber = 2.0 * math.pi / wave.wavelength
        depth: rise.DepthsOfLoss = rise.LossDepth.under(wavenumber)
        pattern = np.zeros(number.size, dtype=complex)
        if total > 0.0:
            along = np.fft.rfft(rise.loss_pattern(spectrum, lost))
            pattern = along[1:-1] / along[0]
            depth = rise.LossDepth(float(lost[1:-1] @ (1.5 / number) / total / wavenumber))
        if wave.loss_by_depth is not None and wave.friction_from_dissipation > 0.0:
            depth = rise.LossLayers.of(*wave.loss_by_depth)
        return cls(
            wavelength=wave.wavelength,
            pressure=wave.pressure_received,
            friction=max(wave.friction, 0.0),
            contact=spectrum[1:-1] / spectrum[0],
            lost=pattern,
            depth=depth,
        )


@dataclass(frozen=True)
class Warming:
    """Temperature rises over the temperature of the rubber before the contact [K]."""

    # By the heat of all waves, spread over the nominal area, where this wave loses its energy.
    uniform: float
    larger_waves: float  # by the patterns of the larger waves, in their contact
    own_pattern: float  # by the pattern of this wave, where it loses its energy
    contact: float  # by everything, at the surface in the real contact of this wave

    @property
    def total(self) -> float:
        """Where this wave loses its energy [K]."""
        return self.uniform + self.larger_waves + self.own_pattern


_SURFACE = rise.LossDepth(0.0)


def warming(
    waves: Sequence[WaveHeat],
    conditions: Conditions,
    friction_at: Callable[[float], float],
    *,
    speed: float,
    time: float,
) -> list[Warming]:
    """Return the temperature rise of the rubber on each wave of a chain, largest first.

    `friction_at` is the friction of the area term [-] at a rise in the contact [K], `time` the
    duration of the nominal contact [s]. What the counterface takes up does not warm the rubber.
    """
    thermal, road = conditions.heat, conditions.counterface
    assert thermal is not None
    if speed == 0.0 or not waves:
        return [Warming(0.0, 0.0, 0.0, 0.0) for _ in waves]
    cold, unit = _rises(waves, speed, time, thermal, np.array([0.0, 1.0]))
    of_cold, by_unit = float(cold[-1, -1]), float(unit[-1, -1] - cold[-1, -1])
    in_road = math.inf
    if road is not None:
        in_road = speed * waves[0].pressure * rise.uniform_at_surface(time, _SURFACE, road)
        for wave in waves:
            m = rise.harmonic_decay(wave.wavenumbers, 0.0, 0.0, road)
            harmonics = wave.contact * rise.PassingHarmonics(m, time, road).at_surface(_SURFACE)
            in_road += speed * wave.pressure * float(_mean(harmonics, wave.contact))
    divided = rise.Partition(of_cold, by_unit, in_road)
    friction = 0.0
    if conditions.shear_stress is not None:
        friction = rise.settled_interface(
            friction_at, lambda mu: of_cold + divided.net(mu) * by_unit
        )
    rises = cold + divided.net(friction) * (unit - cold)  # linear in it
    return [Warming(*of_wave) for of_wave in rises.tolist()]


def _rises(
    waves: Sequence[WaveHeat],
    speed: float,
    time: float,
    thermal: rise.ThermalProperties,
    interface: Array,
) -> Array:
    """Return the rises of `Warming` for each friction `interface` [-], (interfaces, waves, 4) [K].

    The heat of that friction enters the rubber at the surface of the real contact.
    """
    nominal = speed * waves[0].pressure
    deep = [rise.uniform_where_lost(time, wave.depth, thermal) for wave in waves]
    top = [rise.uniform_at_surface(time, wave.depth, thermal) for wave in waves]
    heats = [nominal * wave.friction for wave in waves]
    from_interface, interface = nominal * interface, interface[:, None]
    on_surface = from_interface * rise.uniform_at_surface(time, _SURFACE, thermal)
    out, larger_waves = [], np.zeros(interface.size)
    for i, wave in enumerate(waves):
        # by the harmonics of this wave: where it loses energy, and in its contact
        k, heat = wave.wavenumbers, speed * wave.pressure
        m = rise.harmonic_decay(k, k, speed, thermal)
        loss = heat * wave.friction * wave.lost
        at_surface = rise.harmonic_at_surface(m, _SURFACE, thermal)
        by_smaller = heat * interface * wave.contact * at_surface
        for other in waves[i + 1 :]:
            at_surface = rise.harmonic_at_surface(m, other.depth, thermal)
            by_smaller += heat * other.friction * wave.contact * at_surface
        where_lost = loss * rise.harmonic_where_lost(m, wave.depth, thermal)
        where_lost = where_lost + wave.depth.decay(m) * by_smaller
        own_pattern = _mean(where_lost, wave.lost)
        in_contact = loss * rise.harmonic_at_surface(m, wave.depth, thermal) + by_smaller
        contact = _mean(in_contact, wave.contact)
        surface = float(np.dot(heats, top)) + on_surface + larger_waves + contact
        uniform = rise.uniform_from_others(heats, top, i) + heats[i] * deep[i]
        out.append((uniform + from_interface * top[i], larger_waves, own_pattern, surface))
        larger_waves = larger_waves + contact
    return np.array(out).transpose(2, 0, 1)


def _mean(temperature: ComplexArray, weight: ComplexArray) -> Array:
    """Return the mean of temperatures over a pattern of unit mean, harmonics on the last axis."""
    return np.asarray(2.0 * (temperature * weight.conj()).real.sum(axis=-1))


def strains(waves: Sequence[ScaleResult], norm: StrainNorm) -> Array:
    """Return the strain amplitude [-] on each wave, largest wave first.

    Raises `InputError` for the norm "stretch" if the solver has no stretches.
    """
    if norm == "slope":
        squares = np.cumsum([(SLOPE_FACTOR * contact_slope(wave)) ** 2 for wave in waves])
        return np.asarray(np.sqrt(squares))
    out = np.array([max(wave.max_stretch - 1.0, 1.0 - wave.min_stretch) for wave in waves])
    if not np.isfinite(out).all():
        raise InputError(
            f'strain_norm must be "slope" for a solver without stretches; got "stretch" '
            f"with {waves[0].model}"
        )
    return out


def contact_slope(wave: ScaleResult) -> float:
    """Return the rms slope of a solved wave in its contact [-]."""
    k = 2.0 * math.pi / wave.wavelength
    edges = np.asarray(wave.details["contact_edges"], dtype=float)
    start, end = k * edges[:, 0], k * edges[:, 1]
    square = 0.5 - (np.sin(2.0 * end) - np.sin(2.0 * start)).sum() / (4.0 * (end - start).sum())
    return float(k * wave.amplitude * math.sqrt(max(square, 0.0)))
