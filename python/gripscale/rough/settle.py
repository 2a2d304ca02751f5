"""The direct contact under conditions that depend on what is solved: passes until nothing changes.

Every pass solves the whole contact with the rubber that heat and strains of the passes before make
of it at every scale, first on grids that only resolve the surface, then to the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from gripscale.conditions.by_scale import RubberByScale
from gripscale.conditions.conditions import Conditions
from gripscale.conditions.fixed_point import MOST_PASSES, FixedPoint
from gripscale.conditions.mixing import mixed, separate
from gripscale.conditions.state_by_scale import StateByScale, state_by_scale
from gripscale.rough.grid import Array
from gripscale.rough.heat import GridTemperature, grid_temperature, octave_heats
from gripscale.rough.result import RoughContact
from gripscale.rough.strain import strain_by_scale
from gripscale.rubber import Rubber
from gripscale.wave.status import Status

Solve = Callable[[RubberByScale | None], RoughContact]


def settle(
    solve: Solve, quick: Solve, rubber: Rubber, conditions: Conditions, time: float
) -> RoughContact:
    """Return the contact in which rubber, strains and heat agree.

    Parameters
    ----------
    solve, quick
        Solve the contact with the rubber of every scale, the second in less time.
    rubber
        As measured.
    conditions
        What changes it.
    time
        For which the nominal contact lasts [s].

    Returns
    -------
    RoughContact
        With the state of the rubber by scale. Its status is `conditions not settled` if passes
        still changed the result.
    """
    first = quick(None)
    number = _scales(first)
    point = FixedPoint(_found(conditions, first, number, time))
    for how in (quick, solve):
        point = point.anew()
        found = _passes(how, rubber, conditions, time, number, point)
    return found


def _passes(
    solve: Solve,
    rubber: Rubber,
    conditions: Conditions,
    time: float,
    number: Array,
    point: FixedPoint,
) -> RoughContact:
    """Return the contact after passes from `point`, which is moved."""
    last: RoughContact | None = None
    for passes in range(1, MOST_PASSES + 1):
        warming, strain = separate(point.assumed)
        state = state_by_scale(
            conditions, rubber, wavenumber=number, warming=warming, strain=strain
        )
        now = solve(state.rubber)
        point.found(_found(conditions, now, number, time))
        settled = point.settled(_results(now), None if last is None else _results(last))
        if settled or not now.converged or passes == MOST_PASSES:
            return _told(now, conditions, state, passes, time, settled=settled)
        last = now
    raise AssertionError("unreachable")


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


def _found(conditions: Conditions, contact: RoughContact, number: Array, time: float) -> Array:
    """Return temperatures and strains at the wavenumbers `number`, mixed."""
    warm, strain = np.zeros(number.size), np.ones(number.size)
    if conditions.heat is not None and contact.speed > 0.0:
        at, rise = temperature(contact, conditions, time)
        warm = np.interp(np.log(number), np.log(at), rise.octave)
    if conditions.softening is not None:
        strain = strain_by_scale(contact.grid, contact.height, contact.active, number)
    return mixed(warm, strain)


def _results(now: RoughContact) -> list[float]:
    """Return what must not change any more: friction only where it slides."""
    return [now.contact_fraction, *([now.friction_from_dissipation] if now.speed > 0.0 else [])]


def _told(
    contact: RoughContact,
    conditions: Conditions,
    state: StateByScale,
    passes: int,
    time: float,
    *,
    settled: bool,
) -> RoughContact:
    """Return `contact` with what became of the rubber."""
    warm = None
    if conditions.heat is not None and contact.speed > 0.0:
        warm = temperature(contact, conditions, time)[1].surface
    out = replace(contact, scales=state, passes=passes, surface_warming=warm)
    if contact.converged and not settled:
        return replace(out, status=Status.CONDITIONS_NOT_SETTLED)
    return out
