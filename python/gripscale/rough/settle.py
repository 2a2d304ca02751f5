"""The direct contact under conditions that depend on what is solved: passes until nothing changes.

Every pass solves the whole contact with the rubber that assumed temperatures and strains make of it
at every scale, most of them on grids that only resolve the surface (`gripscale.conditions.passes`),
each from the contact of the last.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from gripscale.conditions.by_scale import RubberByScale
from gripscale.conditions.conditions import Conditions
from gripscale.conditions.mixing import mixed, separate
from gripscale.conditions.passes import Pass, Passes
from gripscale.conditions.passes import settle as settle_passes
from gripscale.conditions.state_by_scale import StateByScale, state_by_scale
from gripscale.rough.grid import Array
from gripscale.rough.grids import GridRecord, KnownLevels
from gripscale.rough.heat import GridTemperature, grid_temperature, octave_heats
from gripscale.rough.result import RoughContact
from gripscale.rough.strain import strain_by_scale
from gripscale.rubber import Rubber
from gripscale.wave.status import Status


@dataclass(frozen=True)
class Climbed:
    """A contact, and what was found on the levels on the way to it."""

    contact: RoughContact
    levels: KnownLevels


Solve = Callable[[RubberByScale | None, KnownLevels], Climbed]


def settle(
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

    def __call__(self, assumed: Array | None, last: Climbed | None) -> Pass[Climbed]:
        """Return the pass for what is assumed, from the last contact."""
        state = None if assumed is None or last is None else self.state(assumed, last.contact)
        known = {} if last is None or last.contact.by_scale is None else last.levels
        now = self.solve(None if state is None else state.rubber, known)
        self.grids.extend(now.contact.grids)
        found, surface = self._found(now.contact)
        warmed = replace(now, contact=replace(now.contact, surface_warming=surface))
        return Pass(warmed, assumed, found, _results(now.contact), now.contact.converged)

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


def _told(passes: Passes[Climbed], contacts: _Contacts) -> RoughContact:
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
