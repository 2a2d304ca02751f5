"""How far friction and area change with conditions, or a thickness, that may be true as well.

Strain and temperature of every scale stay those of the solved contact, the rubber that they make is
another: one contact for each thing that is not known, started from the solved one. The answer of
strain and temperature to the change is of second order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import NamedTuple

from gripscale.conditions.alternatives import alternatives
from gripscale.conditions.conditions import RubberByScale, state_by_scale
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber


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


def condition_errors(
    contact: RoughContact, rubber: Rubber, solve: Callable[[RubberByScale], RoughContact]
) -> Iterator[tuple[str, LogChange]]:
    """Yield what is not known of the conditions of a contact, and its change by a standard error.

    `solve` returns the contact with another rubber at each scale.
    """
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
        changes = log_change(contact, solve(state.rubber))
        yield each.label, LogChange(*(each.share * change for change in changes))
