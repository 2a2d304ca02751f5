"""Densities of the heat of an octave, and the patterns that they are kept as."""

import numpy as np

from gripscale.core import Array, ComplexArray
from gripscale.half_space.conditions import OctaveHeat
from gripscale.half_space.grid import Grid


def density_of(grid: Grid, heat: OctaveHeat) -> Array:
    """Return the density over its mean at the points of a grid."""
    spectrum = np.zeros(grid.spectrum_shape, dtype=complex)
    spectrum[heat.kept] = heat.pattern
    return 1.0 + np.asarray(np.fft.irfftn(spectrum, grid.shape, range(len(grid.shape))))


def pattern_of(density: Array) -> ComplexArray:
    """Return the pattern of a density of mean one."""
    return np.asarray(np.fft.rfftn(density - 1.0))
