"""The direct contact under conditions that depend on its solution: softening, and friction heat.

An evaluation of the fixed point (`gripscale.conditions.fixed_point`) solves the whole contact with
the rubber that a state of temperatures and strains, one of each an octave of wavelengths, makes of
it. Each contact starts from the last one.

The strain of a scale is that of `gripscale.conditions.strain_rule` in the contact.

The harmonics of an octave lose mu_b p_0 v per nominal area, and the pattern of
`gripscale.conditions.flash_temperature` distributes this heat along the surface. Summed over
octaves it is exactly the friction work. It is lost at a mean depth of 3/2 over the wavenumber,
averaged over the octave by the loss, and moves over the rubber while the footprint passes. The road
takes up none. The heat of an area term, lost in the interface, is left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.conditions import Conditions, RubberByScale, StateByScale, state_by_scale
from gripscale.conditions.fixed_point import Iteration, pack_state, solve_fixed_point, unpack_state
from gripscale.conditions.flash_temperature import LossDepth, ThermalProperties
from gripscale.conditions.strain_rule import DEPTH_FACTOR
from gripscale.core import Array, ComplexArray, Mask, Status
from gripscale.half_space.grid import Grid
from gripscale.half_space.grid_sequence import GridRecord, KnownLevels
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber

_ROUND_OFF = 1e-12  # share of the friction below which the heat of an octave is neglected


def strain_by_scale(grid: Grid, displacement: Array, active: Mask, wavenumber: Array) -> Array:
    """Return the uniaxial strain amplitude [-] on the scale of each wavenumber [rad/m], same shape.

    `displacement` of the surface [m] may have any mean; both fields have the shape of the grid.
    """
    number = np.where(grid.wavenumber > 0.0, grid.wavenumber, 1.0)
    spectrum = scipy.fft.rfftn(displacement) * grid.wavenumber
    along, across = grid.direction
    # components of the strain over that into the rubber, and how often each counts in e:e
    parts = [(np.ones(1), 1.5), (1j * along, 2.0), (1j * across, 2.0)]
    parts += [(along**2 - across**2, 0.5), (2.0 * along * across, 0.5)]
    out = []
    for scale in wavenumber:
        depth = number / scale
        wave = spectrum * depth * np.exp(-depth)
        square = np.zeros(np.count_nonzero(active))
        for component, times in parts:
            square += times * scipy.fft.irfftn(component * wave, s=grid.shape)[active] ** 2
        out.append(DEPTH_FACTOR * float(np.sqrt(2.0 / 3.0 * square).mean()))
    return np.array(out)


@dataclass(frozen=True)
class OctaveHeat:
    """Heat lost by the harmonics of one octave of wavelengths."""

    wavenumber: float  # in its middle [rad/m]
    friction: float  # mu_b [-]
    density: Array  # of the loss on the grid over its mean [-], shape of the grid
    depth: LossDepth


def octave_heats(grid: Grid, pressure: Array, lost: Array) -> list[OctaveHeat]:
    """Return the heat of every octave, long waves first, from the friction `lost` by harmonic."""
    number = np.broadcast_to(grid.wavenumber, grid.spectrum_shape)
    longest = 2.0 * np.pi / max(grid.lengths)
    octave = np.floor(np.log2(np.maximum(number, longest) / longest) + 1e-9).astype(int)
    spectrum = scipy.fft.rfftn(pressure)
    size = np.abs(spectrum)
    phase = np.divide(spectrum, size, out=np.zeros_like(spectrum), where=size > 0.0)
    out = []
    for which in range(int(octave.max()) + 1):
        loss = np.where((octave == which) & (lost > 0.0), lost, 0.0)
        total = float(loss.sum())
        if total > _ROUND_OFF * float(lost.sum()):
            density = np.abs(grid.forward_field(np.sqrt(loss) * phase)) ** 2
            mean = float((loss * 1.5 / np.maximum(number, longest)).sum() / total)
            middle = longest * 2.0 ** (which + 0.5)
            out.append(OctaveHeat(middle, total, density / density.mean(), LossDepth(mean)))
    return out


@dataclass(frozen=True)
class GridTemperature:
    """Temperature rise of the rubber over its temperature before the contact [K]."""

    surface: Array  # at the surface, shape of the grid
    octave: Array  # where each octave loses its energy, shape (octaves,)


def grid_temperature(
    grid: Grid,
    heats: list[OctaveHeat],
    *,
    flux: float,
    speed: float,
    time: float,
    thermal: ThermalProperties,
) -> GridTemperature:
    """Return the temperature rise by the heat of all octaves during a contact of `time` [s].

    `flux` is the heat per nominal area and unit of friction, p_0 v [W/m^2].
    """

    def without_mean(density: Array) -> ComplexArray:
        spectrum = scipy.fft.rfftn(density)
        spectrum.flat[0] = 0.0
        return np.asarray(spectrum)

    m = rise.harmonic_decay(grid.wavenumber, grid.along, speed, thermal)
    m.flat[0] = 1.0
    sources = [flux * heat.friction * without_mean(heat.density) for heat in heats]
    uniform = [
        flux * heat.friction * rise.uniform_at_surface(time, heat.depth, thermal) for heat in heats
    ]
    surfaces = [
        source * rise.passing_at_surface(m, time, heat.depth, thermal)
        for source, heat in zip(sources, heats, strict=True)
    ]
    surface = sum(surfaces, np.zeros(grid.spectrum_shape, dtype=complex))
    octave = []
    for which, heat in enumerate(heats):
        pattern = without_mean(heat.density)
        # the other octaves warm the depth of this one from the surface, its own heat where it is
        here = heat.depth.decay(m) * (surface - surfaces[which])
        here += sources[which] * rise.passing_where_lost(m, time, heat.depth, thermal)
        level = sum(uniform) - uniform[which]
        level += flux * heat.friction * rise.uniform_where_lost(time, heat.depth, thermal)
        mean_product = float((grid.weight * (here * pattern.conj()).real).sum() / grid.points**2)
        octave.append(level + mean_product)
    field = scipy.fft.irfftn(surface, s=grid.shape) + sum(uniform)
    return GridTemperature(np.asarray(field), np.array(octave))


def temperature(
    contact: RoughContact, conditions: Conditions, time: float
) -> tuple[Array, GridTemperature]:
    """Return the wavenumbers of the octaves that lose energy [rad/m], and the temperature rise."""
    assert conditions.heat is not None
    heats = octave_heats(contact.grid, contact.pressure, contact.lost_by_harmonic())
    rises = grid_temperature(
        contact.grid,
        heats,
        flux=contact.nominal_pressure * contact.speed,
        speed=contact.speed,
        time=time,
        thermal=conditions.heat,
    )
    return np.array([heat.wavenumber for heat in heats]), rises


@dataclass(frozen=True)
class GridSequenceResult:
    """A contact, and the contacts on all levels of its grid sequence."""

    contact: RoughContact
    levels: KnownLevels


_Solve = Callable[[RubberByScale | None, KnownLevels], GridSequenceResult]


def solve_coupled_contact(
    solve: _Solve, quick: _Solve, rubber: Rubber, conditions: Conditions, time: float
) -> RoughContact:
    """Return the contact whose strains and temperatures are those of its rubber.

    `quick` solves the contact like `solve` in less time; `time` is that of the nominal contact [s].
    """
    fine = _ContactEvaluation(solve, rubber, conditions, time)
    fixed_point = solve_fixed_point(fine, replace(fine, solve=quick))
    contact, x = fixed_point.last.solution.contact, fixed_point.last.x
    out = replace(
        contact,
        scales=None if x is None else fine.state(x, contact),
        passes=fixed_point.fine,
        coarse_passes=fixed_point.coarse,
        grids=fine.grids,
    )
    if contact.converged and not fixed_point.converged:
        return replace(out, status=Status.CONDITIONS_NOT_SETTLED)
    return out


@dataclass(frozen=True)
class _ContactEvaluation:
    """Evaluates a state: solves the contact with the rubber it makes, and keeps the grids."""

    solve: _Solve
    rubber: Rubber
    conditions: Conditions
    time: float
    grids: list[GridRecord] = field(default_factory=list, repr=False)  # of all evaluations

    def __call__(
        self, x: Array | None, last: GridSequenceResult | None
    ) -> Iteration[GridSequenceResult]:
        """Return the evaluation of `x`, started from the last contact."""
        state = None if x is None or last is None else self.state(x, last.contact)
        levels = {} if last is None or last.contact.by_scale is None else last.levels
        solved = self.solve(None if state is None else state.rubber, levels)
        contact = solved.contact
        self.grids.extend(contact.grids)
        number, surface = _octaves(contact), None
        warming, strain = np.zeros(number.size), np.ones(number.size)
        if self.conditions.heat is not None and contact.speed > 0.0:
            at, rises = temperature(contact, self.conditions, self.time)
            warming = np.interp(np.log(number), np.log(at), rises.octave)
            surface = rises.surface
        if self.conditions.softening is not None:
            moved = contact.height + contact.gap
            strain = strain_by_scale(contact.grid, moved, contact.active, number)
        friction = [contact.friction_from_dissipation] if contact.speed > 0.0 else []
        return Iteration(
            replace(solved, contact=replace(contact, surface_warming=surface)),
            x,
            pack_state(warming, strain),
            [contact.contact_fraction, *friction],
            contact.converged,
        )

    def state(self, x: Array, contact: RoughContact) -> StateByScale:
        """Return the rubber that the state `x` makes at every scale of a contact."""
        warming, strain = unpack_state(x)
        return state_by_scale(
            self.conditions,
            self.rubber,
            wavenumber=_octaves(contact),
            warming=warming,
            strain=strain,
        )


def _octaves(contact: RoughContact) -> Array:
    """Return the wavenumbers of the state [rad/m]: octaves down to half the smallest wave."""
    longest = 2.0 * np.pi / max(contact.grid.lengths)
    octaves = np.log2(4.0 * np.pi / contact.smallest_wavelength / longest)
    return np.asarray(longest * 2.0 ** (np.arange(int(np.ceil(octaves))) + 0.5))
