"""Periodic grids along a line or over a map: their waves, heights on them, and other grids.

Measured heights are made periodic with the periodic component of L. Moisan, "Periodic plus smooth
image decomposition", J. Math. Imaging Vis. 39 (2011) 161, doi:10.1007/s10851-010-0227-1: with v the
jumps between opposite borders, the smooth part s solves the discrete Laplace equation with them,

    s(q) (2 cos q_x - 2 + 2 cos q_y - 2) = v(q),    s(0) = 0,

and is subtracted. For a line it is the straight line through the two end points; for a map it
removes the tilt and bends the rest gently near the borders, where a window would flatten it.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
import scipy
from numpy.typing import NDArray

from gripscale.core import Array, ComplexArray, InputError, Mask, checks
from gripscale.core.arrays import AnyComplexArray
from gripscale.surface import HeightMap, Profile
from gripscale.surface.low_pass import STEEPEST, transmission, upper_envelope
from gripscale.surface.resampling import fill_gaps

Single = NDArray[np.float32]
SingleComplex = NDArray[np.complex64]
_Field = TypeVar("_Field", bound=NDArray[Any])

DEFAULT_STEPS = 4  # steps of the surface in the smallest wave that is kept by default
FEWEST_STEPS = 2
MOST_POINTS = 2**22  # points of a line beyond which no contact is solved unless it is asked for
# Points of a map from which its fields are in single precision: `python -m benchmarks precision`.
SINGLE_FROM = 2**22
_PART = 2**20  # waves of a part of a spectrum, about
# Bytes that a point of a large map takes while it is solved; measured, with room for its surface.
_BYTES_A_POINT = 75


@dataclass(frozen=True)
class Grid:
    """Equal steps along x, the sliding direction, and for a map along y."""

    shape: tuple[int, ...]
    lengths: tuple[float, ...]  # period along each axis [m]

    @property
    def points(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def spacing(self) -> tuple[float, ...]:
        """Distance between points along each direction [m]."""
        return tuple(length / n for length, n in zip(self.lengths, self.shape, strict=True))

    @property
    def real(self) -> np.dtype[Any]:
        """Precision of fields."""
        single = len(self.shape) > 1 and self.points >= SINGLE_FROM
        return np.dtype(np.float32 if single else np.float64)

    @property
    def complex(self) -> np.dtype[Any]:
        """Precision of spectra."""
        return np.result_type(self.real, np.complex64)

    def parts(self) -> Iterator[tuple[slice, Grid]]:
        """Yield rows of a spectrum of a map, and the grid with the waves of these rows only.

        Formulas of waves need several arrays of their number: of a part these are small.
        """
        if len(self.shape) == 1:
            yield slice(None), self
            return
        rows = max(1, _PART // self.spectrum_shape[1])
        for first in range(0, self.shape[0], rows):
            part = slice(first, min(first + rows, self.shape[0]))
            yield part, _Part(self.shape, self.lengths, part)

    @property
    def spectrum_shape(self) -> tuple[int, ...]:
        """Shape of a spectrum of `scipy.fft.rfftn`."""
        return (*self.shape[:-1], self.shape[-1] // 2 + 1)

    @cached_property
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
    def direction(self) -> tuple[Array, Array]:
        """Components of q/|q| along x and y [-], broadcastable to a spectrum."""
        number = np.where(self.wavenumber > 0.0, self.wavenumber, 1.0)
        across = self._numbers(1) if len(self.shape) > 1 else np.zeros(1)
        return self.along / number, across / number

    @cached_property
    def own_opposite(self) -> Mask:
        """Where a wavenumber along x is its own opposite: zero, and the highest of an even grid."""
        index = np.rint(np.abs(self.along) * self.lengths[0] / (2.0 * np.pi))
        return np.asarray((index == 0) | (2 * index == self.shape[0]))

    @cached_property
    def weight(self) -> Array:
        """Weight of each wave of the half spectrum in a sum over all waves, 1 or 2."""
        last = self.shape[-1]
        weight = np.full(last // 2 + 1, 2.0)
        weight[0] = 1.0
        if last % 2 == 0:
            weight[-1] = 1.0
        return weight

    def slope(self, height: Array) -> Array:
        """Return dh/dx [-] of `height` [m] on the grid."""
        spectrum = scipy.fft.rfftn(height)
        spectrum *= np.where(self.own_opposite, 0.0, 1j * self.along).astype(spectrum.dtype)
        return from_waves(spectrum, self.shape)

    def forward_field(self, half: AnyComplexArray) -> ComplexArray:
        """Return the complex field of the waves with q_x > 0 from the half spectrum of a real one.

        Waves of the half spectrum that run the other way are those of their opposites.
        """
        whole = np.zeros(self.shape, dtype=complex)
        if len(self.shape) == 1:
            whole[: half.shape[0]] = half
            return np.asarray(scipy.fft.ifft(whole))
        columns, last = half.shape[1], self.shape[1]
        whole[:, :columns] = half * (self.along > 0.0)
        opposite = np.roll((half * (self.along < 0.0))[::-1], 1, axis=0).conj()
        for column in range(columns):
            whole[:, (last - column) % last] += opposite[:, column]
        return np.asarray(scipy.fft.ifftn(whole))

    def _numbers(self, axis: int) -> Array:
        points, length = self.shape[axis], self.lengths[axis]
        last = axis == len(self.shape) - 1
        numbers = (scipy.fft.rfftfreq if last else scipy.fft.fftfreq)(points, length / points)
        values = 2.0 * np.pi * np.asarray(numbers)
        return values if last else values[:, None]


def points_in_memory(grid: Grid) -> int:
    """Return the points that a grid like `grid` may have unless more are asked for."""
    if len(grid.shape) == 1 or not hasattr(os, "sysconf"):
        return MOST_POINTS
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return max(MOST_POINTS, memory // (2 * _BYTES_A_POINT))


@dataclass(frozen=True)
class _Part(Grid):
    """A grid with the waves of some rows of its spectrum."""

    rows: slice

    @property
    def spectrum_shape(self) -> tuple[int, ...]:
        return self.rows.stop - self.rows.start, self.shape[1] // 2 + 1

    def _numbers(self, axis: int) -> Array:
        values = super()._numbers(axis)
        return values[self.rows] if axis == 0 else values


def from_waves(spectrum: ComplexArray, shape: tuple[int, ...], workers: int | None = None) -> Array:
    """Return the values of a spectrum, which is overwritten (`irfftn` would copy it)."""
    for axis in range(spectrum.ndim - 1):
        spectrum = scipy.fft.ifft(spectrum, axis=axis, overwrite_x=True, workers=workers)
    return np.asarray(scipy.fft.irfft(spectrum, shape[-1], overwrite_x=True, workers=workers))


def resampled(
    spectrum: ComplexArray,
    shape: tuple[int, ...],
    onto: Grid,
    cut_off: float | None = None,
    workers: int | None = None,
) -> Array:
    """Return the values at the points `onto` another grid, exact for the waves both carry.

    `spectrum` is the `scipy.fft.rfftn` of values on a grid of `shape`; a `cut_off` [m] damps it.
    """
    kept = [min(old, new) for old, new in zip(shape, onto.shape, strict=True)]
    out = np.zeros(onto.spectrum_shape, dtype=onto.complex)
    half = (kept[-1] + 1) // 2  # below the highest wave of an even grid, which has no phase
    if len(shape) == 1:
        out[:half] = spectrum[:half]
    else:
        side = (kept[0] + 1) // 2
        out[:side, :half] = spectrum[:side, :half]
        if side > 1:
            out[1 - side :, :half] = spectrum[1 - side :, :half]
    if cut_off is not None:
        for rows, waves in onto.parts():
            out[rows] *= transmission(waves.wavenumber, cut_off).astype(onto.real, copy=False)
    values = from_waves(out, onto.shape, workers)
    values *= math.prod(onto.shape) / math.prod(shape)
    return values


def nearest(values: _Field, shape: tuple[int, ...]) -> _Field:
    """Return periodic values at the points of another grid, each that of the nearest point."""
    for axis, (old, new) in enumerate(zip(values.shape, shape, strict=True)):
        if old != new:
            index = np.rint(np.arange(new) * (old / new)).astype(int) % old
            values = np.take(values, index, axis=axis)
    return values


def doubled(values: Array) -> Array:
    """Return `values` on the grid with half the spacing each way, linear between points."""
    for axis in range(values.ndim):
        before = (slice(None),) * axis
        shape = [n * (1 + (along == axis)) for along, n in enumerate(values.shape)]
        new = np.empty(shape, values.dtype)
        new[(*before, slice(None, None, 2))] = values
        new[(*before, slice(1, None, 2))] = 0.5 * (values + np.roll(values, -1, axis))
        values = new
    return values


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


@dataclass(frozen=True)
class PeriodicHeights:
    """Periodic heights of a line or a map on the grid of the measurement."""

    grid: Grid
    origin: tuple[float, ...]  # position of the first point [m]
    # `scipy.fft.rfftn` of the heights [m] that rubber follows.
    spectrum: ComplexArray = field(repr=False)
    measured: Mask = field(repr=False)
    smallest_wavelength: float  # cut-off: waves of this length are transmitted by half [m]
    # Whether nothing is cut off: the cut-off is four steps of a period taken as it stands.
    whole: bool = False

    def on(
        self, shape: tuple[int, ...], cut_off: float | None = None, workers: int | None = None
    ) -> Array:
        """Return the heights [m] at the points of another grid, with a cut-off [m]."""
        shortest = max(cut_off or 0.0, self.smallest_wavelength)
        damped = not self.whole or shortest > self.smallest_wavelength
        onto = Grid(shape, self.grid.lengths)
        return resampled(
            self.spectrum, self.grid.shape, onto, shortest if damped else None, workers
        )


def surface_axes(surface: Profile | HeightMap) -> list[Array]:
    """Return the distances [m] along each axis; raise `InputError` for anything else."""
    if isinstance(surface, Profile):
        return [surface.x]
    if isinstance(surface, HeightMap):
        return [surface.x, surface.y]
    raise InputError(f"surface must be a Profile or a HeightMap; got {type(surface).__name__}")


def periodic_heights(
    surface: Profile | HeightMap,
    *,
    smallest_wavelength: float | None,
    periodic: bool,
    steepest: float = STEEPEST,
) -> PeriodicHeights:
    """Return the periodic heights of a surface; arguments and errors as `solve_rough_contact`."""
    slope = checks.positive("steepest", steepest, infinite=True)
    axes = surface_axes(surface)
    steps = [float((a[-1] - a[0]) / (a.size - 1)) for a in axes]
    grid = Grid(surface.z.shape, tuple(d * a.size for d, a in zip(steps, axes, strict=True)))
    z = fill_gaps(surface.z, tuple(steps), periodic=periodic)
    if not periodic:
        z = joined(z)
    z = upper_envelope(z, tuple(steps), slope)
    step, length = max(steps), min(grid.lengths)
    if FEWEST_STEPS * step > length:
        raise InputError(
            f"surface must be longer each way than {FEWEST_STEPS} of its steps, of which the "
            f"largest is {step:.4g} m; got {length:.4g} m"
        )
    if smallest_wavelength is None:
        smallest = min(DEFAULT_STEPS * step, length)
    else:
        smallest = checks.positive("smallest_wavelength", smallest_wavelength, unit="m")
        if not FEWEST_STEPS * step * (1.0 - 1e-9) <= smallest <= length * (1.0 + 1e-9):
            raise InputError(
                f"smallest_wavelength must be from {FEWEST_STEPS * step:.4g} m, two steps of the "
                f"surface, to {length:.4g} m, its length; got {smallest:.4g} m"
            )
    return PeriodicHeights(
        grid=grid,
        origin=tuple(float(a[0]) for a in axes),
        spectrum=scipy.fft.rfftn(z - z.mean()).astype(grid.complex, copy=False),
        measured=~np.isnan(surface.z),
        smallest_wavelength=smallest,
        whole=periodic and smallest_wavelength is None,
    )
