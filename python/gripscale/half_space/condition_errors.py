"""How far friction and area change with conditions, thickness or moduli that may be true as well.

Strain and temperature of every scale stay those of the solved contact, the rubber that they make is
another: one contact for each thing that is not known, started from the solved one. The answer of
strain and temperature to the change is of second order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

from gripscale.conditions.alternatives import alternatives
from gripscale.conditions.conditions import RubberByScale, state_by_scale
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.rubber.material import MeasuredModuli


class LogChange(NamedTuple):
    """Changes of the logarithms of contact area and friction [-]."""

    contact_fraction: float
    friction: float


def log_change(contact: RoughContact, other: RoughContact) -> LogChange:
    """Return the change from a contact to another one on the same surface, on the same grid."""
    last = other.grids[-1]
    before = [grid for grid in contact.grids if grid.points == last.points][-1]
    pairs = (
        (last.contact_fraction, before.contact_fraction),
        (last.friction_from_dissipation, before.friction_from_dissipation),
    )
    return LogChange(*(math.log(a / b) if a > 0.0 and b > 0.0 else 0.0 for a, b in pairs))


SERIES = "series of the rubber"  # label of what it misses of the moduli it was fitted to


def condition_changes(
    contact: RoughContact,
    rubber: Rubber,
    solve: Callable[[Rubber, RubberByScale | None], RoughContact],
) -> Iterator[tuple[str, LogChange]]:
    """Yield what is not known of rubber and iterated conditions of a contact, with its changes.

    Each has the size of a standard error: measured moduli are likelier than their series, to which
    the answer keeps. They may be those of no linear solid, but a steady slide needs only E* at the
    frequency of each wave. `solve` returns the contact with another rubber, or one at each scale.
    """
    by_scale = contact.by_scale
    if contact.speed > 0.0 and rubber.admissible is not None and rubber.admissible.omega.size:
        if by_scale is not None:
            by_scale = replace(by_scale, rubber=MeasuredModuli.of(by_scale.rubber))
        yield SERIES, log_change(contact, solve(MeasuredModuli.of(rubber), by_scale))
    scales, conditions = contact.scales, contact.conditions
    if scales is None or conditions is None:
        return
    for each in alternatives(conditions):
        state = state_by_scale(
            each.conditions,
            rubber,
            wavenumber=scales.wavenumber,
            warming=each.warming * scales.warming,
            strain=scales.strain,
        )
        changes = log_change(contact, solve(rubber, state.rubber))
        yield each.label, LogChange(*(each.share * change for change in changes))
