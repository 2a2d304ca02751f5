"""How well one measured surface represents its road: standard errors from pieces of one contact.

The contact is a ratio of sums over pieces: their residuals say how well it is known, of a map their
low frequencies (docs/derivations.md). How far friction and area change with conditions, thickness
or moduli that may be true as well follows from one contact for each, started from the solved one,
with its strain and temperature of every scale.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import scipy

from gripscale.conditions.conditions import RubberByScale, alternatives, state_by_scale
from gripscale.core import Array, checks
from gripscale.half_space.result import RoughContact
from gripscale.rubber import Rubber
from gripscale.rubber.material import MeasuredModuli

FEWEST_PIECES = 4  # pieces below which their scatter says nothing
FEWEST_CARRYING = 1.5  # the same of pieces that carry
PIECE = 2.0  # length of a piece in largest waves: long enough to make neighbours nearly independent
_PART = 1.0 / 16.0  # width of the parts of a map in pieces: an eighth of the shortest half wave


class SamplingError(NamedTuple):
    """Relative standard errors of contact fraction and friction; NaN where not known."""

    contact_fraction: float
    friction: float
    pieces: float  # that carry, from which they are estimated: one more than degrees of freedom


def sampling_error(contact: RoughContact, piece: float) -> SamplingError:
    """Return the relative standard errors of a contact as an estimate for its road.

    The pieces of a line, the waves of a map, are at least as long as `piece` [m]. NaN for fewer
    than four, or load on one alone; of friction also at rest, and where it is not positive.
    """
    piece = checks.positive("piece", piece, unit="m")
    of_map = len(contact.grid.shape) > 1
    part = _PART * piece if of_map else piece
    load = _by_piece(contact.pressure, contact, part)
    carrying = _carrying(load)
    if load.size < FEWEST_PIECES or carrying < FEWEST_CARRYING:
        return SamplingError(math.nan, math.nan, carrying)
    fields = [contact.active.astype(float)] + [_losses(contact)] * (contact.speed > 0.0)
    values = [_by_piece(field, contact, part) for field in fields]
    if of_map:
        pairs = [_error_of_map(each, load, contact, piece) for each in values]
        errors, freedom = [error for error, _ in pairs], min(each for _, each in pairs)
    else:
        errors, freedom = [_relative_error(each, load) for each in values], carrying - 1.0
    return SamplingError(errors[0], errors[1] if len(errors) > 1 else math.nan, freedom + 1.0)


def _error_of_map(
    values: Array, load: Array, contact: RoughContact, wave: float
) -> tuple[float, float]:
    """Return the relative error of a ratio and its freedom, from waves of a length at least."""
    if float(values.sum()) <= 0.0:
        return math.nan, math.inf
    residuals = _residuals(values, load)
    if not residuals.any():
        return 0.0, math.inf
    axes, orders = [], []
    for side, count in zip(contact.grid.lengths, _counts(contact, _PART * wave), strict=True):
        most = max(1, int(2.0 * side / wave * (1.0 + 1e-9)))
        order = np.arange(min(most, count - 1) + 1)
        angle = np.pi * order[:, None] * (np.arange(count) + 0.5) / count
        axes.append(np.where(order > 0, math.sqrt(2.0), 1.0)[:, None] * np.cos(angle))
        orders.append(order / most)
    radius = np.hypot(orders[0][:, None], orders[1])
    cosines = np.einsum("ja,kb->jkab", *axes)[(radius > 0.0) & (radius < 1.0 + 1e-9)]
    cosines = cosines.reshape(len(cosines), -1)
    seen = cosines @ residuals
    away = cosines - (cosines @ load / load.sum())[:, None]
    covariance = (away * residuals**2) @ away.T / float(residuals @ residuals)
    trace = float(np.trace(covariance))
    freedom = trace**2 / float(np.sum(covariance**2))
    return math.sqrt(float(seen @ seen) / trace), max(freedom, 1.0)


def _counts(contact: RoughContact, piece: float) -> list[int]:
    """Return the number of pieces along each axis, at least `piece` long [m]."""
    grid = contact.grid
    counts = (max(1, int(side / piece * (1.0 + 1e-9))) for side in grid.lengths)
    return [min(pair) for pair in zip(counts, grid.shape, strict=True)]


def _by_piece(field: Array, contact: RoughContact, piece: float) -> Array:
    """Return the sums of a field over the pieces of a contact, at least `piece` long [m]."""
    for axis, count in enumerate(_counts(contact, piece)):
        ends = np.linspace(0, field.shape[axis], count, endpoint=False).astype(int)
        field = np.add.reduceat(field, ends, axis=axis)
    return field.reshape(-1)


def _losses(contact: RoughContact) -> Array:
    """Return pressure times the slope [Pa] that the losses of the rubber make."""
    slope = -contact.grid.along * contact.body.compliance(contact.grid).imag
    waves = slope * scipy.fft.rfftn(contact.pressure)
    return np.asarray(contact.pressure * scipy.fft.irfftn(waves, s=contact.grid.shape))


def friction_residuals(contact: RoughContact, piece: float) -> Array:
    """Return y/sum(y) - p/sum(p) of the friction force y and the load p of each piece [-].

    Their differences between two contacts of one surface make the error of the ratio of frictions.
    """
    piece = checks.positive("piece", piece, unit="m")
    load = _by_piece(contact.pressure, contact, piece)
    return _residuals(_by_piece(_losses(contact), contact, piece), load)


def error_of_residuals(residuals: Array, carrying: float) -> float:
    """Return the relative standard error that the residuals of pieces make, of which some carry."""
    if carrying <= 1.0:
        return math.nan
    return math.sqrt(carrying / (carrying - 1.0) * float(residuals @ residuals))


def pieces_that_carry(contact: RoughContact, piece: float) -> float:
    """Return the number m of pieces of a length [m] that carry the load."""
    return _carrying(_by_piece(contact.pressure, contact, piece))


def _carrying(load: Array) -> float:
    return float(load.sum() ** 2 / (load @ load))


def _residuals(values: Array, load: Array) -> Array:
    return np.asarray(values / values.sum() - load / load.sum())


def _relative_error(values: Array, load: Array) -> float:
    """Return the relative standard error of sum(values) / sum(load)."""
    if float(values.sum()) <= 0.0:
        return math.nan
    return error_of_residuals(_residuals(values, load), _carrying(load))


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

    Each has the size of a standard error; measured moduli are likelier than their series. `solve`
    returns the contact with another rubber, or one at each scale.
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
