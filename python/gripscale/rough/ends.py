"""Makes measured heights fit for a periodic contact: missing ones filled, opposite ends joined.

Missing heights are interpolated linearly along x and along y and the two weighted by the inverse
width of the gap each way; at a border the nearest height is held.

Ends are joined by the periodic component of L. Moisan, "Periodic plus smooth image decomposition",
J. Math. Imaging Vis. 39 (2011) 161, doi:10.1007/s10851-010-0227-1: with v the jumps between
opposite borders, the smooth part s solves the discrete Laplace equation with them,

    s(q) (2 cos q_x - 2 + 2 cos q_y - 2) = v(q),    s(0) = 0,

and is subtracted. For a line it is the straight line through the two end points; for a map it takes
the tilt away and bends the rest gently near the borders, where a window would flatten it.
"""

from __future__ import annotations

import numpy as np
import scipy.fft

from gripscale.rough.grid import Array, Mask


def filled(z: Array) -> tuple[Array, Mask]:
    """Return the heights with none missing, and where they were measured."""
    measured = ~np.isnan(z)
    if measured.all():
        return z, measured
    total, weight = np.zeros(z.shape), np.zeros(z.shape)
    for axis in range(z.ndim):
        values, width = _interpolated(np.moveaxis(z, axis, -1))
        total += np.moveaxis(values / width, -1, axis)
        weight += np.moveaxis(1.0 / width, -1, axis)
    lost = weight == 0.0  # neither its row nor its column has a height
    mean = total / np.where(lost, 1.0, weight)
    mean[lost] = np.nanmean(z)
    return np.where(measured, z, mean), measured


def joined(z: Array) -> Array:
    """Return the periodic component of `z` [m], its mean zero."""
    jumps = np.zeros(z.shape)
    symbol = np.zeros((1,) * z.ndim)
    for axis, points in enumerate(z.shape):
        values, jump = np.moveaxis(z, axis, 0), np.moveaxis(jumps, axis, 0)
        jump[0] += values[-1] - values[0]
        jump[-1] += values[0] - values[-1]
        angle = 2.0 * np.pi * np.arange(points) / points
        shape = [1] * z.ndim
        shape[axis] = points
        symbol = symbol + (2.0 * np.cos(angle) - 2.0).reshape(shape)
    half = symbol[..., : z.shape[-1] // 2 + 1].copy()
    half.flat[0] = np.inf
    smooth = scipy.fft.irfftn(scipy.fft.rfftn(jumps) / half, s=z.shape)
    return np.asarray(z - z.mean() - smooth)


def _interpolated(z: Array) -> tuple[Array, Array]:
    """Return `z` filled along its last axis, and the gaps' widths in steps (inf in empty rows)."""
    values, width = np.zeros(z.shape), np.full(z.shape, np.inf)
    place = np.arange(z.shape[-1])
    for index in np.ndindex(z.shape[:-1]):
        known = np.flatnonzero(~np.isnan(z[index]))
        if known.size:
            values[index] = np.interp(place, known, z[index][known])
            after = np.searchsorted(known, place)
            left = known[np.maximum(after - 1, 0)]
            right = known[np.minimum(after, known.size - 1)]
            width[index] = np.maximum(np.abs(right - left), np.abs(place - left)) + 1.0
    return values, width
