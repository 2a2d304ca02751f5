"""The direct contact under conditions that depend on its solution: softening, and friction heat.

An evaluation of the fixed point (`gripscale.conditions.fixed_point`) solves the whole contact with
the rubber that a state of temperatures and strains, one of each an octave of wavelengths, makes of
it. Each contact starts from the last one. docs/derivations.md has the strain of a scale and the
heat of an octave.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any

import numpy as np
import scipy

from gripscale.conditions import flash_temperature as rise
from gripscale.conditions.conditions import (
    DEPTH_FACTOR,
    Conditions,
    RubberByScale,
    StateByScale,
    state_by_scale,
)
from gripscale.conditions.fixed_point import (
    STATE_TOLERANCE,
    Iteration,
    pack_state,
    solve_fixed_point,
    unpack_state,
)
from gripscale.conditions.flash_temperature import LossDepth, ThermalProperties
from gripscale.core import Array, Mask, Status
from gripscale.core.arrays import AnyComplexArray
from gripscale.half_space.active_set import DIFFERENCE_ACCURACY, Accuracy
from gripscale.half_space.grid import Grid, PeriodicHeights, Single, SingleComplex
from gripscale.half_space.grid_sequence import GridRecord, KnownLevels, levels
from gripscale.half_space.response import AnyArray
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber

_ROUND_OFF = 1e-12  # share of the friction below which the heat of an octave is neglected


def strain_by_scale(grid: Grid, displacement: Array, active: Mask, wavenumber: Array) -> Array:
    """Return the uniaxial strain amplitude [-] on the scale of each wavenumber [rad/m], same shape.

    `displacement` of the surface [m] may have any mean; both fields have the shape of the grid.
    """
    number = np.where(grid.wavenumber > 0.0, grid.wavenumber, 1.0).astype(np.float32)
    spectrum = (scipy.fft.rfftn(displacement) * grid.wavenumber).astype(np.complex64)
    if len(grid.shape) == 1:
        return _strain_of_line(spectrum, number, active, wavenumber)
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


# Waves so many times shorter than a scale have e^-20 of their strain at its depth.
_FELT = 20.0


def _strain_of_line(
    spectrum: SingleComplex, number: Single, active: Mask, wavenumber: Array
) -> Array:
    """Return the strains of a line: of its analytic signal, 2/sqrt(3) |e| in plane strain."""
    out = []
    for scale in wavenumber:
        # a grid that just resolves the waves that reach this depth
        waves = int(np.searchsorted(number[1:], _FELT * scale)) + 1
        blocks = active.size
        while blocks % 2 == 0 and blocks // 2 > 2 * waves:
            blocks //= 2
        depth = number[:waves] / np.float32(scale)
        one_sided = np.zeros(blocks, dtype=np.complex64)
        one_sided[:waves] = spectrum[:waves] * (depth * np.exp(-depth))
        if blocks < active.size:  # from the first point of a block to its centre
            turn = np.pi * (1.0 / blocks - 1.0 / active.size)
            one_sided[:waves] *= np.exp(
                np.arange(waves, dtype=np.float32) * np.complex64(1j * turn)
            )
        signal = np.abs(scipy.fft.ifft(one_sided, overwrite_x=True))
        in_contact = active.reshape(blocks, -1).sum(axis=1, dtype=np.float32)
        mean = float(signal @ in_contact / in_contact.sum()) * (2.0 * blocks / active.size)
        out.append(2.0 / np.sqrt(3.0) * DEPTH_FACTOR * mean)
    return np.array(out)


@dataclass(frozen=True)
class OctaveHeat:
    """Heat lost by the harmonics of one octave of wavelengths."""

    wavenumber: float  # in its middle [rad/m]
    friction: float  # mu_b [-]
    # Spectrum of the density of the loss on the grid, over its mean and without it; of a line, the
    # density of an octave has no waves shorter than the octave.
    pattern: AnyComplexArray
    depth: LossDepth

    @property
    def kept(self) -> slice:
        """Where the pattern stands in a spectrum of the grid."""
        return slice(self.pattern.shape[0])


def octave_heats(grid: Grid, pressure: Array, lost: Array) -> list[OctaveHeat]:
    """Return the heat of every octave, long waves first, from the friction `lost` by harmonic."""
    number = np.broadcast_to(grid.wavenumber, grid.spectrum_shape)
    longest = 2.0 * np.pi / max(grid.lengths)
    octave = np.floor(np.log2(np.maximum(number, longest) / longest) + 1e-9).astype(int)
    spectrum = scipy.fft.rfftn(pressure).astype(np.complex64)
    size = np.abs(spectrum)
    phase = np.divide(spectrum, size, out=np.zeros_like(spectrum), where=size > 0.0)
    out = []
    line = len(grid.shape) == 1
    for which in range(int(octave.max()) + 1):
        # on a line the waves of an octave follow each other
        these = slice(2**which, 2 ** (which + 1)) if line else slice(None)
        loss = np.where((octave[these] == which) & (lost[these] > 0.0), lost[these], 0.0)
        total = float(loss.sum())
        if total > _ROUND_OFF * float(lost.sum()):
            half = np.zeros_like(spectrum[: these.stop])
            half[these] = np.sqrt(loss).astype(np.float32) * phase[these]
            pattern = _loss_pattern(grid, half, 2 ** (which + 1))
            mean = float((loss * (1.5 / np.maximum(number[these], longest))).sum() / total)
            middle = longest * 2.0 ** (which + 0.5)
            out.append(OctaveHeat(middle, total, pattern, LossDepth(mean)))
    return out


def _loss_pattern(grid: Grid, half: SingleComplex, end: int) -> AnyComplexArray:
    """Return the spectrum of the loss of `half` a spectrum over its mean; of a line up to `end`."""
    if len(grid.shape) > 1:
        density = np.abs(grid.forward_field(half)) ** 2
        return _without_mean(density / density.mean())
    points, waves = grid.points, min(end, half.shape[0])
    while points % 2 == 0 and points // 2 >= 2 * end:  # a coarser grid has all the waves
        points //= 2
    one_sided = np.zeros(points, dtype=half.dtype)
    one_sided[:waves] = half[:waves]
    signal = scipy.fft.ifft(one_sided, overwrite_x=True)
    density = signal.real**2 + signal.imag**2
    scale = grid.points / points / float(density.mean(dtype=np.float64))
    return _without_mean(density * np.float32(scale))[:waves]


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
    m = _decay(grid, speed, thermal)
    passing = rise.PassingHarmonics(m, time, thermal)
    uniform = [flux * rise.uniform_at_surface(time, heat.depth, thermal) for heat in heats]
    strengths = [heat.friction for heat in heats]
    surfaces = [
        flux * heat.friction * heat.pattern * passing.at_surface(heat.depth, heat.kept)
        for heat in heats
    ]
    surface = np.zeros(grid.spectrum_shape, dtype=np.complex64)
    for heat, part in zip(heats, surfaces, strict=True):
        surface[heat.kept] += part
    octave = []
    for which, heat in enumerate(heats):
        # the other octaves warm the depth of this one from the surface, its own heat where it is
        here = heat.depth.decay(m[heat.kept]) * (surface[heat.kept] - surfaces[which])
        source = flux * heat.friction * heat.pattern
        here += source * passing.where_lost(heat.depth, heat.kept)
        level = flux * heat.friction * rise.uniform_where_lost(time, heat.depth, thermal)
        level += rise.uniform_from_others(strengths, uniform, which)
        octave.append(level + _mean_over(grid, here, heat.pattern))
    field = _with_mean(grid, surface, float(np.dot(strengths, uniform)))
    return GridTemperature(field, np.array(octave))


def contact_source_temperature(
    grid: Grid,
    heats: list[OctaveHeat],
    contact: Mask,
    *,
    flux: float,
    speed: float,
    time: float,
    thermal: ThermalProperties,
    counterface: ThermalProperties | None,
) -> tuple[GridTemperature, float]:
    """Return the rises of the rubber, and of the counterface's contact [K], by a unit of friction.

    The heat is even over `contact`, at the surface; an insulating counterface is infinitely hot.
    """
    pattern, at_surface = _without_mean(contact / contact.mean()), LossDepth(0.0)

    def field(solid: ThermalProperties, m: SingleComplex) -> tuple[float, AnyComplexArray]:
        """Return mean and harmonics of the surface of a solid in which harmonics decay by `m`."""
        harmonics = rise.PassingHarmonics(m, time, solid).at_surface(at_surface)
        return flux * rise.uniform_at_surface(time, at_surface, solid), flux * pattern * harmonics

    m = _decay(grid, speed, thermal)
    mean, surface = field(thermal, m)
    octave = [
        # a source at the surface warms a depth as one at this depth warms the surface
        flux * rise.uniform_at_surface(time, heat.depth, thermal)
        + _mean_over(grid, heat.depth.decay(m[heat.kept]) * surface[heat.kept], heat.pattern)
        for heat in heats
    ]
    rises = GridTemperature(_with_mean(grid, surface, mean), np.array(octave))
    if counterface is None:
        return rises, np.inf
    mean, surface = field(counterface, _decay(grid, 0.0, counterface))
    return rises, mean + _mean_over(grid, surface, pattern)


def _decay(grid: Grid, speed: float, thermal: ThermalProperties) -> SingleComplex:
    """Return the decay of the harmonics of a grid [1/m]; of the mean, which has none, one.

    In single precision, as all harmonics of heat: a thousandth of a kelvin would be enough.
    """
    m = rise.harmonic_decay(grid.wavenumber, grid.along, speed, thermal).astype(np.complex64)
    m.flat[0] = 1.0
    return m


def _without_mean(density: AnyArray) -> AnyComplexArray:
    spectrum = scipy.fft.rfftn(density)
    spectrum.flat[0] = 0.0
    return np.asarray(spectrum)


def _with_mean(grid: Grid, harmonics: AnyComplexArray, mean: float) -> Array:
    return np.asarray(scipy.fft.irfftn(harmonics, s=grid.shape), dtype=float) + mean


def _mean_over(grid: Grid, harmonics: AnyComplexArray, pattern: AnyComplexArray) -> float:
    """Return the mean of a field without mean, weighted by a density of mean one."""
    weight = grid.weight[: harmonics.shape[-1]]
    return float((weight * (harmonics * pattern.conj()).real).sum() / grid.points**2)


def temperature(
    contact: RoughContact, conditions: Conditions, time: float
) -> tuple[list[OctaveHeat], GridTemperature]:
    """Return the octaves that lose energy, and the temperature rise in a contact of `time` [s]."""
    assert conditions.heat is not None
    grid, active = contact.grid, contact.active
    heats = octave_heats(grid, contact.pressure, contact.lost_by_harmonic())
    motion: dict[str, Any] = {
        "flux": contact.nominal_pressure * contact.speed,
        "speed": contact.speed,
        "time": time,
        "thermal": conditions.heat,
    }
    rises = grid_temperature(grid, heats, **motion)
    if conditions.shear_stress is None and conditions.counterface is None:
        return heats, rises
    by_unit, counterface = contact_source_temperature(
        grid, heats, active, counterface=conditions.counterface, **motion
    )
    part = rise.Partition(
        float(rises.surface[active].mean()), float(by_unit.surface[active].mean()), counterface
    )
    cold, unit = (
        float(np.average(each.surface, weights=contact.pressure)) for each in (rises, by_unit)
    )
    friction, warming = 0.0, conditions.warming
    if warming.shear_stress is not None:
        friction = rise.settled_interface(
            partial(contact.adhesive_friction_at, warming),
            lambda friction: cold + part.net(friction) * unit,
        )
    net = part.net(friction)
    return heats, GridTemperature(
        rises.surface + net * by_unit.surface, rises.octave + net * by_unit.octave
    )


@dataclass(frozen=True)
class MeanWarming:
    """Mean temperature rises of a contact [K]."""

    contact: float  # at the surface, weighted by the pressure
    where_lost: float  # in the depth, weighted by the loss


def warming_of(contact: RoughContact, conditions: Conditions, footprint: float) -> MeanWarming:
    """Return the rise by the heat of `conditions` in a contact solved without; `footprint` [m]."""
    if contact.speed == 0.0:
        return MeanWarming(0.0, 0.0)
    heats, rises = temperature(contact, conditions, footprint / contact.speed)
    return MeanWarming(
        float(np.average(rises.surface, weights=contact.pressure)),
        float(np.average(rises.octave, weights=[heat.friction for heat in heats])),
    )


@dataclass(frozen=True)
class GridSequenceResult:
    """A contact, and the contacts on all levels of its grid sequence."""

    contact: RoughContact
    levels: KnownLevels


_Solve = Callable[[RubberByScale | None, KnownLevels], GridSequenceResult]
# Tolerance of the fixed point over that of the contact, and the largest: the interval of an answer
# is ten times wider.
_OF_GOAL, _LOOSEST = 0.4, 2e-2
_CLOSED = 0.5  # strain of rubber in contact over that of rubber pressed into every valley, about


def state_tolerance(goal: float) -> float:
    """Return the tolerance of the fixed point for a contact with a tolerance."""
    return max(STATE_TOLERANCE, min(_OF_GOAL * goal, _LOOSEST))


def accuracy_of_state(goal: float) -> Accuracy:
    """Return the accuracy of a contact that gives strains and temperatures only.

    At the loosest, areas err by half a per cent, and half of the products are saved.
    """
    tolerance = state_tolerance(goal)
    return Accuracy(max(DIFFERENCE_ACCURACY.missing, 0.05 * tolerance), 0.5 * tolerance)


def solve_coupled_contact(
    solve: _Solve,
    quick: _Solve,
    heights: PeriodicHeights,
    rubber: Rubber,
    conditions: Conditions,
    time: float,
    goal: float = 0.0,
) -> RoughContact:
    """Return the contact on heights whose strains and temperatures are those of its rubber.

    `quick` solves it like `solve` in less time; `time` is that of the nominal contact [s].
    """
    wavenumber, guess = _octaves(heights), None
    if conditions.softening is not None:
        grid = levels(heights)[-1].grid
        strain = strain_by_scale(
            grid, heights.on(grid.shape), np.ones(grid.shape, bool), wavenumber
        )
        guess = pack_state(np.zeros(strain.size), _CLOSED * strain)
    fine = _ContactEvaluation(solve, rubber, conditions, time, wavenumber, guess)
    fixed_point = solve_fixed_point(fine, replace(fine, solve=quick), state_tolerance(goal))
    contact, x = fixed_point.last.solution.contact, fixed_point.last.x
    earlier = [grid for grid in fine.grids if grid not in contact.grids]
    out = replace(
        contact,
        scales=None if x is None else fine.state(x),
        passes=fixed_point.fine,
        coarse_passes=fixed_point.coarse,
        grids=[*earlier, *contact.grids],
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
    wavenumber: Array  # of the scales [rad/m]
    guess: Array | None  # state of the first evaluation; None: the rubber before the contact
    grids: list[GridRecord] = field(default_factory=list, repr=False)  # of all evaluations

    def __call__(
        self, x: Array | None, last: GridSequenceResult | None
    ) -> Iteration[GridSequenceResult]:
        """Return the evaluation of `x`, started from the last contact."""
        x = self.guess if x is None else x
        earlier = {} if last is None or last.contact.by_scale is None else last.levels
        solved = self.solve(None if x is None else self.state(x).rubber, earlier)
        contact = solved.contact
        self.grids.extend(contact.grids)
        number, surface = self.wavenumber, None
        warming, strain = np.zeros(number.size), np.ones(number.size)
        if self.conditions.heat is not None and contact.speed > 0.0:
            heats, rises = temperature(contact, self.conditions, self.time)
            at = [heat.wavenumber for heat in heats]
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

    def state(self, x: Array) -> StateByScale:
        """Return the rubber that the state `x` makes at every scale."""
        warming, strain = unpack_state(x)
        at = {"wavenumber": self.wavenumber, "warming": warming, "strain": strain}
        return state_by_scale(self.conditions, self.rubber, **at)


def _octaves(heights: PeriodicHeights) -> Array:
    """Return the wavenumbers of the state [rad/m]: octaves down to half the smallest wave."""
    longest = 2.0 * np.pi / max(heights.grid.lengths)
    octaves = np.log2(4.0 * np.pi / heights.smallest_wavelength / longest)
    return np.asarray(longest * 2.0 ** (np.arange(int(np.ceil(octaves))) + 0.5))
