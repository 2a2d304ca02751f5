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

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from gripscale.conditions.wave_heat import WaveHeat
from gripscale.interface import temperature_rise as rise
from gripscale.interface.thermal import ThermalProperties


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
