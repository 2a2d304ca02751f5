"""How strongly the surface strains the rubber at each scale: half the rms slope in the contact.

Down to a wavenumber q: of the surface with only the waves up to q, where the whole surface is
touched. The convention of B. N. J. Persson, J. Chem. Phys. 115 (2001) 3840, doi:10.1063/1.1388626,
for the strain of filled rubber on a rough surface.
"""

from __future__ import annotations

import numpy as np
import scipy.fft

from gripscale.rough.grid import Array, Grid, Mask


def strain_by_scale(grid: Grid, height: Array, active: Mask, wavenumber: Array) -> Array:
    """Return the uniaxial strain amplitude [-] down to each wavenumber [rad/m], same shape."""
    spectrum = scipy.fft.rfftn(height) * np.where(grid.own_opposite, 0.0, 1j * grid.along)
    out = []
    for largest in wavenumber:
        slope = scipy.fft.irfftn(np.where(grid.wavenumber <= largest, spectrum, 0.0), s=grid.shape)
        out.append(0.5 * float(np.sqrt(np.mean(slope[active] ** 2))))
    return np.maximum.accumulate(np.array(out))
