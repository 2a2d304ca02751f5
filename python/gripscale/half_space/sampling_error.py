"""How well one measured surface represents its road: standard errors from pieces of one contact.

The contact of a road under a nominal pressure is a ratio: contact length (or friction force) over
load, both summed over pieces of the surface. A piece that happens to be high carries more load and
has more contact, at about the same ratio. So the error of the ratio r = sum(y) / sum(p) comes from
the residuals of the pieces,

    var(r) / r^2 = m / (m - 1) sum((y_i - r p_i)^2) / sum(y)^2,    m = sum(p)^2 / sum(p^2)

(W. G. Cochran, Sampling Techniques, 3rd ed. (1977), sec. 6.4), without another solution. m is the
number of pieces that carry (L. Kish, Survey Sampling (1965), sec. 11.7): at low pressure a few
pieces have all of the load, and the others tell nothing of the scatter. The
friction force of a piece is that of the losses: pressure times the part of the slope of the rubber
that its losses make. The traction would do for the sum but not for a piece, because elastic forces
of one piece on another cancel in the sum only.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import scipy

from gripscale.core import Array, checks
from gripscale.half_space.result import RoughContact

FEWEST_PIECES = 4  # pieces below which their scatter says nothing
FEWEST_CARRYING = 1.5  # the same of pieces that carry
PIECE = 2.0  # length of a piece in largest waves: long enough to make neighbours nearly independent


class SamplingError(NamedTuple):
    """Relative standard errors of contact fraction and friction; NaN where not known."""

    contact_fraction: float
    friction: float
    pieces: float  # pieces that carry, from which they are estimated


def sampling_error(contact: RoughContact, piece: float) -> SamplingError:
    """Return the relative standard errors of a contact as an estimate for its road.

    The pieces are equal and at least as long as `piece` along each axis [m]. NaN for fewer than
    four; of friction also at rest, and where it is not positive.
    """
    piece = checks.positive("piece", piece, unit="m")
    load = _by_piece(contact.pressure, contact, piece)
    carrying = _carrying(load)
    if load.size < FEWEST_PIECES or carrying < FEWEST_CARRYING:
        return SamplingError(math.nan, math.nan, carrying)
    touched = _by_piece(contact.active.astype(float), contact, piece)
    friction = math.nan
    if contact.speed > 0.0:
        friction = _relative_error(_by_piece(_losses(contact), contact, piece), load)
    return SamplingError(_relative_error(touched, load), friction, carrying)


def _by_piece(field: Array, contact: RoughContact, piece: float) -> Array:
    """Return the sums of a field over the pieces of a contact, at least `piece` long [m]."""
    for axis, side in enumerate(contact.grid.lengths):
        count = max(1, int(side / piece * (1.0 + 1e-9)))
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

    Two contacts of one surface have the same pieces: the differences of their residuals make the
    error of the ratio of the two frictions.
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
