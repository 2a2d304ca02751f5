"""The direct contact under conditions that depend on what is solved: passes until nothing changes.

Every pass solves the whole contact with the rubber that assumed temperatures and strains make of it
at every scale, most of them on grids that only resolve the surface
(`gripscale.conditions.fixed_point`), each from the contact of the last.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.conditions import Conditions, RubberByScale, StateByScale, state_by_scale
from gripscale.conditions.fixed_point import Iteration, Passes, mixed, separate
from gripscale.conditions.fixed_point import solve_coupled as settle_passes
from gripscale.conditions.flash_temperature import (
    LossDepth,
    ThermalProperties,
    passing_at_surface,
    passing_where_lost,
)
from gripscale.half_space.grid import Array, Grid, Mask
from gripscale.half_space.grid_sequence import GridRecord, KnownLevels
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.wave.problem import Status

# How strongly the surface strains the rubber at each scale: half the rms slope in the contact.
#
# Down to a wavenumber q: of the surface with only the waves up to q, where the whole surface is
# touched. The convention of B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840,
# doi:10.1063/1.1388626, for the strain of filled rubber on a rough surface.


def strain_by_scale(grid: Grid, height: Array, active: Mask, wavenumber: Array) -> Array:
    """Return the uniaxial strain amplitude [-] down to each wavenumber [rad/m], same shape."""
    spectrum = scipy.fft.rfftn(height) * np.where(grid.own_opposite, 0.0, 1j * grid.along)
    out = []
    for largest in wavenumber:
        slope = scipy.fft.irfftn(np.where(grid.wavenumber <= largest, spectrum, 0.0), s=grid.shape)
        out.append(0.5 * float(np.sqrt(np.mean(slope[active] ** 2))))
    return np.maximum.accumulate(np.array(out))


# Temperature on the grid of a direct contact: the heat of every octave of the pressure.
#
# The harmonics of an octave lose mu_b p_0 v per nominal area, which the pattern of
# `gripscale.conditions.flash_temperature` puts in its place; summed over octaves the heat is the
# friction work, exactly. It is lost at a mean depth of 3/2 over the wavenumber, averaged over the
# octave by the loss, and moves over the rubber while the footprint passes; the road takes up none.

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


@dataclass(frozen=True)
class GridSequenceResult:
    """A contact, and what was found on the levels on the way to it."""

    contact: RoughContact
    levels: KnownLevels


Solve = Callable[[RubberByScale | None, KnownLevels], GridSequenceResult]


def solve_coupled_contact(
    solve: Solve, quick: Solve, rubber: Rubber, conditions: Conditions, time: float
) -> RoughContact:
    """Return the contact in which rubber, strains and heat agree.

    Parameters
    ----------
    solve, quick
        Solve the contact with the rubber of every scale from known levels, the second in less time.
    rubber
        As measured.
    conditions
        What changes it.
    time
        For which the nominal contact lasts [s].

    Returns
    -------
    RoughContact
        With the state of the rubber by scale and the grids of all passes. Its status is `conditions
        not settled` if passes still changed the result.
    """
    grids: list[GridRecord] = []
    fine = _Contacts(solve, rubber, conditions, time, grids)
    return _told(settle_passes(fine, replace(fine, solve=quick)), fine)


@dataclass(frozen=True)
class _Contacts:
    """Solves the contact with the rubber that assumed temperatures and strains make."""

    solve: Solve
    rubber: Rubber
    conditions: Conditions
    time: float
    grids: list[GridRecord] = field(repr=False)
    """Of all passes."""

    def __call__(
        self, assumed: Array | None, last: GridSequenceResult | None
    ) -> Iteration[GridSequenceResult]:
        """Return the pass for what is assumed, from the last contact."""
        state = None if assumed is None or last is None else self.state(assumed, last.contact)
        known = {} if last is None or last.contact.by_scale is None else last.levels
        now = self.solve(None if state is None else state.rubber, known)
        self.grids.extend(now.contact.grids)
        found, surface = self._found(now.contact)
        warmed = replace(now, contact=replace(now.contact, surface_warming=surface))
        return Iteration(warmed, assumed, found, _results(now.contact), now.contact.converged)

    def state(self, assumed: Array, contact: RoughContact) -> StateByScale:
        """Return what is assumed at every scale of a contact."""
        warming, strain = separate(assumed)
        return state_by_scale(
            self.conditions,
            self.rubber,
            wavenumber=_scales(contact),
            warming=warming,
            strain=strain,
        )

    def _found(self, contact: RoughContact) -> tuple[Array, Array | None]:
        """Return temperatures and strains by scale, mixed, and the warming of the surface."""
        number, surface = _scales(contact), None
        warm, strain = np.zeros(number.size), np.ones(number.size)
        if self.conditions.heat is not None and contact.speed > 0.0:
            at, rise = temperature(contact, self.conditions, self.time)
            warm, surface = np.interp(np.log(number), np.log(at), rise.octave), rise.surface
        if self.conditions.softening is not None:
            strain = strain_by_scale(contact.grid, contact.height, contact.active, number)
        return mixed(warm, strain), surface


def temperature(
    contact: RoughContact, conditions: Conditions, time: float
) -> tuple[Array, GridTemperature]:
    """Return wavenumbers of the octaves that lose energy [rad/m], and the temperature rise."""
    assert conditions.heat is not None
    heats = octave_heats(contact.grid, contact.pressure, contact.lost_by_harmonic())
    rise = grid_temperature(
        contact.grid,
        heats,
        flux=contact.nominal_pressure * contact.speed,
        speed=contact.speed,
        time=time,
        thermal=conditions.heat,
    )
    return np.array([heat.wavenumber for heat in heats]), rise


def _scales(contact: RoughContact) -> Array:
    """Return the wavenumbers at which the state is known: octaves to half the smallest wave."""
    longest = 2.0 * np.pi / max(contact.grid.lengths)
    octaves = np.log2(4.0 * np.pi / contact.smallest_wavelength / longest)
    return np.asarray(longest * 2.0 ** (np.arange(int(np.ceil(octaves))) + 0.5))


def _results(now: RoughContact) -> list[float]:
    """Return what must not change any more: friction only where it slides."""
    return [now.contact_fraction, *([now.friction_from_dissipation] if now.speed > 0.0 else [])]


def _told(passes: Passes[GridSequenceResult], contacts: _Contacts) -> RoughContact:
    """Return the last pass with what became of the rubber."""
    contact, assumed = passes.last.solved.contact, passes.last.assumed
    state = None if assumed is None else contacts.state(assumed, contact)
    out = replace(
        contact,
        scales=state,
        passes=passes.fine,
        coarse_passes=passes.coarse,
        grids=contacts.grids,
    )
    if contact.converged and not passes.settled:
        return replace(out, status=Status.CONDITIONS_NOT_SETTLED)
    return out
