"""Makes measured heights fit for a periodic contact: opposite ends joined.

The periodic component of L. Moisan, "Periodic plus smooth image decomposition", J. Math. Imaging
Vis. 39 (2011) 161, doi:10.1007/s10851-010-0227-1: with v the jumps between opposite borders, the
smooth part s solves the discrete Laplace equation with them,

    s(q) (2 cos q_x - 2 + 2 cos q_y - 2) = v(q),    s(0) = 0,

and is subtracted. For a line it is the straight line through the two end points; for a map it takes
the tilt away and bends the rest gently near the borders, where a window would flatten it.
"""

from __future__ import annotations

import numpy as np
import scipy.fft

from gripscale.rough.grid import Array


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
