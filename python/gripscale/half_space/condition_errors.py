"""How far friction and area change with conditions, thickness or moduli that may be true as well.

Strain and temperature of every scale stay those of the solved contact, the rubber that they make is
another: one contact for each thing that is not known, started from the solved one. The answer of
strain and temperature to the change is of second order.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
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


def condition_errors(
    contact: RoughContact, rubber: Rubber, solve: Callable[[RubberByScale], RoughContact]
) -> Iterator[tuple[str, LogChange]]:
    """Yield what is not known of the iterated conditions of a contact, with its standard errors.

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
        yield each.label, LogChange(*(each.share * abs(change) for change in changes))


SERIES = "series of the rubber"


def series_change(
    contact: RoughContact,
    rubber: Rubber,
    solve: Callable[[Rubber, RubberByScale | None], RoughContact],
) -> LogChange | None:
    """Return the change by the moduli that a series was fitted to, in its place; None without any.

    A linear solid has no such moduli where E' and E'' do not belong to one, but the contact of a
    steady slide needs only E* at the frequency of each wave.
    """
    if contact.speed == 0.0 or rubber.admissible is None or not rubber.admissible.omega.size:
        return None

    def measured(series: Rubber) -> Rubber:
        return MeasuredModuli(**{item.name: getattr(series, item.name) for item in fields(series)})

    scales = contact.by_scale
    by_scale = None if scales is None else replace(scales, rubber=measured(scales.rubber))
    return log_change(contact, solve(measured(rubber), by_scale))
