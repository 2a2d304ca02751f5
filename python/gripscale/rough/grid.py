"""A periodic grid of points along a line or over a map, the waves it carries, and other grids."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.fft
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]


@dataclass(frozen=True)
class Grid:
    """Equal steps along x, the way of sliding, and for a map along y.

    Attributes
    ----------
    shape
        Points along x, or along x and y.
    lengths
        Period along each [m].
    """

    shape: tuple[int, ...]
    lengths: tuple[float, ...]

    @property
    def points(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def spacing(self) -> tuple[float, ...]:
        """Distance between points along each direction [m]."""
        return tuple(length / n for length, n in zip(self.lengths, self.shape, strict=True))

    @property
    def spectrum_shape(self) -> tuple[int, ...]:
        """Shape of a spectrum of `scipy.fft.rfftn`."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    @property
    def along(self) -> Array:
        """Wavenumbers along x [rad/m], broadcastable to a spectrum."""
        return self._numbers(0)

    @cached_property
    def wavenumber(self) -> Array:
        """|q| over a spectrum [rad/m]."""
        if len(self.shape) == 1:
            return np.abs(self.along)
        return np.hypot(self.along, self._numbers(1))

    @property
    def own_opposite(self) -> Mask:
        """Where a wavenumber along x is its own opposite: zero, and the highest of an even grid."""
        index = np.rint(np.abs(self.along) * self.lengths[0] / (2.0 * np.pi))
        return np.asarray((index == 0) | (2 * index == self.shape[0]))

    @property
    def weight(self) -> Array:
        """How often each wave of the half spectrum counts in a sum over all waves, 1 or 2."""
        last = self.shape[-1]
        weight = np.full(last // 2 + 1, 2.0)
        weight[0] = 1.0
        if last % 2 == 0:
            weight[-1] = 1.0
        return weight

    def slope(self, height: Array) -> Array:
        """Return dh/dx [-] of `height` [m] on the grid."""
        spectrum = scipy.fft.rfftn(height) * np.where(self.own_opposite, 0.0, 1j * self.along)
        return np.asarray(scipy.fft.irfftn(spectrum, s=self.shape))

    def _numbers(self, axis: int) -> Array:
        points, length = self.shape[axis], self.lengths[axis]
        last = axis == len(self.shape) - 1
        numbers = (scipy.fft.rfftfreq if last else scipy.fft.fftfreq)(points, length / points)
        values = 2.0 * np.pi * np.asarray(numbers)
        return values if last else values[:, None]


def resampled(spectrum: ComplexArray, shape: tuple[int, ...], onto: tuple[int, ...]) -> Array:
    """Return the values at the points of another grid, exact for the waves both carry.

    Parameters
    ----------
    spectrum : array
        `scipy.fft.rfftn` of values on a grid of `shape`.
    onto : tuple of int
        Points wanted; waves at or beyond its own highest are left out where it is coarser.
    """
    kept = [min(old, new) for old, new in zip(shape, onto, strict=True)]
    out = np.zeros((*onto[:-1], onto[-1] // 2 + 1), dtype=np.complex128)
    half = (kept[-1] + 1) // 2  # below the highest wave of an even grid, which has no phase
    if len(onto) == 1:
        out[:half] = spectrum[:half]
    else:
        side = (kept[0] + 1) // 2
        out[:side, :half] = spectrum[:side, :half]
        if side > 1:
            out[1 - side :, :half] = spectrum[1 - side :, :half]
    scale = math.prod(onto) / math.prod(shape)
    return np.asarray(scipy.fft.irfftn(out, s=onto, overwrite_x=True)) * scale


def doubled(values: Array) -> Array:
    """Return `values` on the grid with half the spacing each way, linear between points."""
    for axis in range(values.ndim):
        before = (slice(None),) * axis
        shape = [n * (1 + (along == axis)) for along, n in enumerate(values.shape)]
        new = np.empty(shape)
        new[(*before, slice(None, None, 2))] = values
        new[(*before, slice(1, None, 2))] = 0.5 * (values + np.roll(values, -1, axis))
        values = new
    return values
