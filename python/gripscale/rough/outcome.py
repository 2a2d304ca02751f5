"""What a contact tells: friction in two ways, friction by wavelength, where the surface is touched.

    mu = mean(p dh/dx) / p_0                                       from the contact traction
    mu = sum_q q_x |p(q)|^2 2 Im M(q_x v) / (|q| |M|^2) / p_0       from the energy lost

with p(q) the Fourier coefficients of the pressure. The second is the work that every harmonic of
the pressure loses per sliding distance, so that its sum may be split by wavelength exactly.
"""

from __future__ import annotations

import numpy as np
import scipy.fft

from gripscale.rough.grid import Array, Grid
from gripscale.rough.half_space import ComplexArray


def friction_from_traction(grid: Grid, pressure: Array, height: Array) -> float:
    """Return the friction coefficient [-] of a pressure [Pa] on heights [m]."""
    return float(np.mean(pressure * grid.slope(height)) / pressure.mean())


def lost_by_harmonic(compliance: ComplexArray, grid: Grid, pressure: Array) -> Array:
    """Return the friction coefficient each harmonic adds [-], over the spectrum of `grid`."""
    share = np.abs(scipy.fft.rfftn(pressure) / grid.points) ** 2
    lost = -grid.along * compliance.imag * share * grid.weight
    return np.asarray(lost / pressure.mean())
