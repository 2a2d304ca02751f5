"""Temperature on the grid of a direct contact: the heat of every octave of the pressure.

The harmonics of an octave lose mu_b p_0 v per nominal area, which the pattern of
`gripscale.interface.heat_pattern` puts in its place; summed over octaves the heat is the friction
work, exactly. It is lost at a mean depth of 3/2 over the wavenumber, averaged over the octave by
the loss, and moves over the rubber while the footprint passes; the road takes up none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from gripscale.interface import temperature_rise as rise
from gripscale.interface.loss_depth import LossDepth
from gripscale.interface.passing_harmonic import passing_at_surface, passing_where_lost
from gripscale.interface.thermal import ThermalProperties
from gripscale.rough.grid import Array, Grid

ComplexArray = NDArray[np.complex128]

ROUND_OFF = 1e-12
"""Share of the friction below which an octave loses nothing."""


@dataclass(frozen=True)
class OctaveHeat:
    """Heat lost by the harmonics of one octave of wavelengths."""

    wavenumber: float
    """In its middle [rad/m]."""
    friction: float
    """mu_b [-]."""
    density: Array
    """Of the loss on the grid over its mean [-], shape of the grid."""
    depth: LossDepth


def octave_heats(grid: Grid, pressure: Array, lost: Array) -> list[OctaveHeat]:
    """Return the heat of every octave that loses energy, long waves first.

    Parameters
    ----------
    grid : Grid
        Of the contact.
    pressure : array, shape of the grid
        [Pa].
    lost : array, shape of the half spectrum
        Friction each harmonic adds [-], as `lost_by_harmonic` gives it.
    """
    number = np.broadcast_to(grid.wavenumber, grid.spectrum_shape)
    longest = 2.0 * np.pi / max(grid.lengths)
    octave = np.floor(np.log2(np.maximum(number, longest) / longest) + 1e-9).astype(int)
    phase = _phases(pressure)
    out = []
    for which in range(int(octave.max()) + 1):
        own = np.where((octave == which) & (lost > 0.0), lost, 0.0)
        total = float(own.sum())
        if total > ROUND_OFF * float(lost.sum()):
            density = np.abs(_envelope(grid, np.sqrt(own) * phase)) ** 2
            mean = float((own * 1.5 / np.maximum(number, longest)).sum() / total)
            middle = longest * 2.0 ** (which + 0.5)
            out.append(OctaveHeat(middle, total, density / density.mean(), LossDepth(mean)))
    return out


@dataclass(frozen=True)
class GridTemperature:
    """How much warmer the rubber is than before the contact [K]."""

    surface: Array
    """At the surface, shape of the grid."""
    octave: Array
    """Where each octave loses its energy, shape (octaves,)."""


def grid_temperature(
    grid: Grid,
    heats: list[OctaveHeat],
    *,
    flux: float,
    speed: float,
    time: float,
    thermal: ThermalProperties,
) -> GridTemperature:
    """Return the temperature rise of heat that is lost in a contact.

    Parameters
    ----------
    grid : Grid
        Of the contact.
    heats : list of OctaveHeat
        What is lost.
    flux : float
        Heat per nominal area and unit of friction, p_0 v [W/m^2].
    speed : float
        Of sliding [m/s].
    time : float
        For which the nominal contact lasts [s].
    thermal : ThermalProperties
        Of the rubber.
    """
    m = rise.harmonic_decay(grid.wavenumber, grid.along, speed, thermal)
    m.flat[0] = 1.0
    sources = [flux * heat.friction * _without_mean(heat.density) for heat in heats]
    uniform = [
        flux * heat.friction * rise.uniform_at_surface(time, heat.depth, thermal) for heat in heats
    ]
    surfaces = [
        source * passing_at_surface(m, time, heat.depth, thermal)
        for source, heat in zip(sources, heats, strict=True)
    ]
    surface = sum(surfaces, np.zeros(grid.spectrum_shape, dtype=complex))
    octave = []
    for which, heat in enumerate(heats):
        pattern = _without_mean(heat.density)
        seen = heat.depth.decay(m) * (surface - surfaces[which])
        seen += sources[which] * passing_where_lost(m, time, heat.depth, thermal)
        lasting = rise.uniform_where_lost(time, heat.depth, thermal)
        level = sum(uniform) - uniform[which] + flux * heat.friction * lasting
        octave.append(level + _mean_product(grid, seen, pattern))
    field = scipy.fft.irfftn(surface, s=grid.shape) + sum(uniform)
    return GridTemperature(np.asarray(field), np.array(octave))


def _phases(pressure: Array) -> ComplexArray:
    spectrum = scipy.fft.rfftn(pressure)
    size = np.abs(spectrum)
    return np.divide(spectrum, size, out=np.zeros_like(spectrum), where=size > 0.0)


def _envelope(grid: Grid, half: ComplexArray) -> ComplexArray:
    """Return the field of the waves with q_x > 0 of a half spectrum that holds their opposites."""
    whole = np.zeros(grid.shape, dtype=complex)
    if len(grid.shape) == 1:
        whole[: half.shape[0]] = half
        return np.asarray(scipy.fft.ifft(whole))
    forward = half * (grid.along > 0.0)
    backward = half * (grid.along < 0.0)
    columns = half.shape[1]
    whole[:, :columns] = forward
    opposite = np.roll(backward[::-1], 1, axis=0).conj()
    last = grid.shape[1]
    for column in range(columns):
        whole[:, (last - column) % last] += opposite[:, column]
    return np.asarray(scipy.fft.ifftn(whole))


def _without_mean(density: Array) -> ComplexArray:
    spectrum = scipy.fft.rfftn(density)
    spectrum.flat[0] = 0.0
    return np.asarray(spectrum)


def _mean_product(grid: Grid, one: ComplexArray, other: ComplexArray) -> float:
    """Return the mean of the product of two fields from their half spectra."""
    return float((grid.weight * (one * other.conj()).real).sum() / grid.points**2)
