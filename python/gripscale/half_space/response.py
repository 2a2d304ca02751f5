"""A sliding viscoelastic half-space on a periodic grid: from pressure to displacement, and back.

Geometry: small strain, no friction in the contact; the rubber lies above and slides towards +x with
speed v over a rigid surface at rest. A harmonic exp(i q . r) at rest on the surface excites the
rubber at the angular frequency q_x v, so

    u(q) = K(q) p(q),    K = 2 / (|q| M(q_x v)),    M = E*/(1 - nu^2),    M(-w) = conj M(w),

with u positive where the pressure lifts the rubber: K. L. Johnson, Contact Mechanics (1985), sec.
13.2, doi:10.1017/CBO9781139171731, with the complex modulus in place of the elastic one. A line is
plane strain, a map three-dimensional: the same equation. The mean displacement is undetermined (it
is the rigid approach). A wavenumber along x that is its own opposite on the grid has a real M.

Rubber of finite thickness on a rigid base has the K of `gripscale.theory.layers`, and M is what a
half-space of this K would have, 2 / (|q| K). Its mean displacement stays undetermined too: it adds
to the approach and changes no contact.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache, partial

import numpy as np
import scipy
from numpy.typing import NDArray

from gripscale._kernel import GapExtension, Line, Map
from gripscale.conditions.conditions import RubberByScale
from gripscale.core import Array, ComplexArray, InputError, checks
from gripscale.core.arrays import AnyComplexArray
from gripscale.half_space.grid import (
    Grid,
    PeriodicHeights,
    Single,
    SingleComplex,
    from_waves,
)
from gripscale.rubber import Rubber
from gripscale.rubber.material import plane_strain_modulus_of
from gripscale.theory import layers as layer_theory
from gripscale.theory.layers import Layers

AnyArray = NDArray[np.floating]


@dataclass(frozen=True)
class HalfSpace:
    """Rubber that slides at a speed, by its response to the harmonics of a surface."""

    rubber: Rubber
    speed: float  # [m/s]; zero is the relaxed rubber
    loss: float = 1.0  # factor of the loss angle at unchanged |M|, 0 to 1; 1 is the rubber itself
    by_scale: RubberByScale | None = None  # the rubber at each scale under conditions
    thickness: float | None = None  # of the rubber on a rigid base [m]; None: a half-space
    layers: Layers | None = None  # A stack in place of one rubber; `rubber` is the layer in contact
    # E* at the wavenumbers of the finest line so far, by its length: coarser lines have the first
    # of them.
    _of_lines: dict[tuple[float, ...], ComplexArray] = field(
        default_factory=dict, repr=False, compare=False
    )

    @property
    def rubbers(self) -> list[Rubber]:
        """The rubber, or that of each layer."""
        return [self.rubber] if self.layers is None else self.layers.rubbers

    def young_modulus(self, grid: Grid) -> ComplexArray:
        """Return E* [Pa] at the wavenumbers of `grid`, broadcastable to its spectrum."""
        omega, number = self.speed * grid.along, grid.wavenumber
        if len(grid.shape) > 1:
            return self._complex_modulus(omega, number)
        value = self._of_lines.get(grid.lengths, np.empty(0, dtype=complex))
        if value.size < omega.size:
            new = self._complex_modulus(omega[value.size :], number[value.size :])
            value = self._of_lines[grid.lengths] = np.concatenate([value, new])
        return value[: omega.size]

    def _complex_modulus(self, omega: Array, wavenumber: Array) -> ComplexArray:
        if self.by_scale is not None:
            return self.by_scale.complex_modulus(omega, wavenumber)
        return self.rubber.complex_modulus(omega)

    def with_scales(self, by_scale: RubberByScale | None) -> HalfSpace:
        """Return the half-space of another rubber at each scale."""
        return replace(self, by_scale=by_scale, _of_lines={})

    def modulus(self, grid: Grid) -> ComplexArray:
        """Return M [Pa] at the wavenumbers of `grid`, broadcastable to its spectrum."""
        if self.layers is not None:
            value = np.asarray(2.0 / (_without_mean(grid) * self._stack(grid)[0]))
        else:
            value = plane_strain_modulus_of(self.young_modulus(grid), self.rubber.bulk_modulus)
        if self.thickness is not None:
            value = value / self._thickness_factor(grid)[0]
        if self.loss != 1.0:
            value = np.abs(value) * np.exp(1j * self.loss * np.angle(value))
        return np.where(grid.own_opposite, np.abs(value), value)

    def _thickness_factor(self, grid: Grid) -> tuple[ComplexArray, ComplexArray]:
        """Return K over that of the half-space [-], and the derivative of its logarithm by nu."""
        assert self.thickness is not None
        young, bulk = self.young_modulus(grid), self.rubber.bulk_modulus
        compression = layer_theory.shear_and_compression(young, bulk)[1]
        return layer_theory.thickness_factor(_without_mean(grid) * self.thickness, compression)

    def of_layer(self, layer: int) -> HalfSpace:
        """Return one layer of a stack as a half-space; of one rubber itself."""
        return self if self.layers is None else self._of_layers[layer]

    @cached_property
    def _of_layers(self) -> list[HalfSpace]:
        """Each layer as a half-space, which keeps its moduli on lines."""
        assert self.layers is not None
        return [HalfSpace(rubber, self.speed) for rubber in self.layers.rubbers]

    def _stack(
        self, grid: Grid, layer: int = 0, *, stiffer: float = 0.0, denser: float = 0.0
    ) -> tuple[ComplexArray, Array]:
        """Return K(q) [m/Pa] of a stack, and what of Im K each layer loses.

        One layer may have other logarithms of E* and of the bulk modulus.
        """
        assert self.layers is not None
        moduli = [each.young_modulus(grid) for each in self._of_layers]
        bulk = [rubber.bulk_modulus for rubber in self.layers.rubbers]
        moduli[layer] = moduli[layer] * math.exp(stiffer)
        bulk[layer] *= math.exp(denser)
        heights = self.layers.thicknesses
        return layer_theory.stack_compliance(_without_mean(grid), moduli, bulk, heights)

    def losses_by_layer(self, grid: Grid) -> Array:
        """Return what of Im K [m/Pa] each layer of a stack loses, shape (layers, *spectrum)."""
        losses = np.where(grid.own_opposite, 0.0, self._stack(grid)[1])
        return np.asarray(losses)

    def log_modulus_by(self, grid: Grid, layer: int = 0) -> tuple[ComplexArray, ComplexArray]:
        """Return d ln M / d ln E* and d ln M / d ln B [-], B being the bulk modulus, of each wave.

        E* and B are those of one layer of a stack, where the derivatives are differences.
        """
        if self.layers is not None:

            def change(name: str) -> ComplexArray:
                low, high = (
                    self._stack(grid, layer, **{name: step})[0]
                    for step in (-_LAYER_STEP, _LAYER_STEP)
                )
                return np.asarray(np.log(low / high) / (2.0 * _LAYER_STEP))

            return change("stiffer"), change("denser")
        shear, bulk = self.young_modulus(grid) / 3.0, 3.0 * self.rubber.bulk_modulus
        by_modulus = 1.0 + shear / (bulk + shear) - 4.0 * shear / (bulk + 4.0 * shear)
        by_bulk = bulk / (bulk + shear) - bulk / (bulk + 4.0 * shear)
        if self.thickness is not None:
            # d nu / d ln B = -d nu / d ln G: a layer is softer where nu is smaller
            slope = self._thickness_factor(grid)[1] * 1.5 * shear * bulk / (bulk + shear) ** 2
            by_modulus, by_bulk = by_modulus + slope, by_bulk - slope
        return np.asarray(by_modulus), np.asarray(by_bulk)

    def compliance(self, grid: Grid) -> ComplexArray:
        """Return K(q) [m/Pa] over the spectrum of `grid`, zero for the mean."""
        compliance = np.empty(grid.spectrum_shape, dtype=grid.complex)
        for rows, waves in grid.parts():
            compliance[rows] = 2.0 / (_without_mean(waves) * self.modulus(waves))
        compliance.flat[0] = 0.0
        return compliance


def _without_mean(grid: Grid) -> Array:
    """Return |q| [rad/m], and 1 for the mean, whose compliance is not defined."""
    return np.where(grid.wavenumber > 0.0, grid.wavenumber, 1.0)


class OutOfTime(Exception):
    """The time of a solution is over."""


def _require_time(deadline: float) -> None:
    if time.monotonic() > deadline:
        raise OutOfTime


@dataclass(frozen=True)
class Response:
    """Products with the response of the half-space on one grid, and with its inverse.

    Displacements have the precision of the pressure. Pressures only precondition and start
    iterations and are in single precision.
    """

    grid: Grid
    workers: int
    compliance: ComplexArray = field(repr=False)
    compliance_single: SingleComplex = field(repr=False)
    stiffness: SingleComplex = field(repr=False)
    # When, on the clock of `time.monotonic`, displacements raise `OutOfTime` [s].
    deadline: float = math.inf

    @classmethod
    def of(cls, body: HalfSpace, grid: Grid, workers: int, deadline: float = math.inf) -> Response:
        """Return the response of `body` on `grid`."""
        made = cls.with_compliance(body.compliance(grid), grid, workers)
        return replace(made, deadline=deadline)

    @classmethod
    def with_compliance(cls, compliance: ComplexArray, grid: Grid, workers: int) -> Response:
        """Return the response with K(q) [m/Pa] over the spectrum of `grid`, zero for the mean.

        The mean has no stiffness and gets that of the softest wave.
        """
        softest, stiffness = np.abs(compliance).max(), compliance.copy()
        stiffness.flat[0] = softest
        np.reciprocal(stiffness, out=stiffness)
        single = compliance.astype(np.complex64, copy=False)
        return cls(grid, workers, compliance, single, stiffness.astype(np.complex64, copy=False))

    @property
    def transposed(self) -> Response:
        """The transposed products: those of the rubber that slides the other way."""
        return replace(
            self,
            compliance=self.compliance.conj(),
            compliance_single=self.compliance_single.conj(),
            stiffness=self.stiffness.conj(),
        )

    @cached_property
    def influence(self) -> Array:
        """Displacement under unit pressure at the first point [m/Pa], shape of the grid."""
        return np.asarray(scipy.fft.irfftn(self.compliance, s=self.grid.shape))

    @cached_property
    def smallest_compliance(self) -> float:
        """|K| of the stiffest wave of the grid [m/Pa]."""
        return float(1.0 / np.abs(self.stiffness).max())

    @cached_property
    def loss_angle(self) -> float:
        """Loss angle on a line, median of the waves [rad]; positive in a slide towards +x.

        It is that of four points in a wave. Of a map it is not needed, and zero.
        """
        if len(self.grid.shape) > 1:
            return 0.0
        every = 1 + self.compliance.size // _WAVES_OF_MEDIAN
        return float(-np.median(np.angle(self.compliance[1::every])))

    def displacement(self, pressure: AnyArray) -> AnyArray:
        """Return the displacement [m] under `pressure` [Pa], of zero mean, shape of the grid."""
        _require_time(self.deadline)
        if pressure.dtype == np.float32:
            return self._single.filtered(pressure, self.compliance_single)
        return self._filtered(pressure, self.compliance)

    def full_contact(self, height: Array, mean: float) -> Array:
        """Return the pressure [Pa] of mean `mean` that follows `height` [m], tension included."""
        spectrum = scipy.fft.rfftn(height, workers=self.workers)
        spectrum.flat[0] = 0.0
        np.divide(spectrum, self.compliance, out=spectrum, where=self.compliance != 0.0)
        spectrum.flat[0] = mean * height.size
        return from_waves(spectrum, self.grid.shape, self.workers)

    def pressure(self, displacement: AnyArray) -> AnyArray:
        """Return the pressure [Pa] that gives `displacement` [m] everywhere, shape of the grid."""
        single = displacement.astype(np.float32, copy=False)
        return self._single.filtered(single, self.stiffness)

    def correction(
        self,
        right: Single,
        where: NDArray[np.intp],
        extension: GapExtension,
        numbers: tuple[float, float, int],
    ) -> tuple[Single, float, int]:
        """Return the pressure whose Q K is `right`, its residual, and the products it took.

        Q with the `extension` is that of `gripscale.half_space.active_set`; `numbers` are its
        factor, the target of the residual and the most products. `right` has unit length.
        """
        filters = [self.compliance_single, self.stiffness]
        return self._single.close_gap(right, where, filters, extension, numbers)

    @cached_property
    def _single(self) -> Line | Map:
        """Filters and contacts of the grid in single precision."""
        if len(self.grid.shape) == 1:
            return _line(self.grid.points)
        rows, columns = self.grid.shape
        return Map(rows, columns, self.workers, partial(_require_time, self.deadline))

    def _filtered(self, values: AnyArray, transfer: AnyComplexArray) -> AnyArray:
        spectrum = scipy.fft.rfftn(values, workers=self.workers)
        spectrum *= transfer
        return from_waves(spectrum, self.grid.shape, self.workers)


_WAVES_OF_MEDIAN = 4096  # waves of a line, evenly spaced, that give its median loss angle


@lru_cache(maxsize=64)
def _line(points: int) -> Line:
    """Return the filters of lines of so many points: their transforms take milliseconds to plan."""
    return Line(points)


# Change of ln E* or ln B of a layer: K is analytic, and its difference errs by 1e-8.
_LAYER_STEP = 1e-4
# Limits of pressures [Pa] and lengths [m]. The solver starts and preconditions in single precision,
# where products must stay within 1e-38 to 1e38: a number beyond has the wrong unit.
_LEAST, _MOST = 1e-12, 1e15


def half_space(rubber: Rubber | Layers, speed: float, thickness: float | None = None) -> HalfSpace:
    """Return rubber or layers at a speed [m/s], or raise `InputError`."""
    layers = rubber if isinstance(rubber, Layers) else None
    if layers is not None and thickness is not None:
        raise InputError(
            f"thickness must be None with Layers, which state their own; got {thickness!r}"
        )
    solid = layers.rubbers[0] if layers else checks.instance("rubber", rubber, Rubber)
    height = None if thickness is None else checks.positive("thickness", thickness, unit="m")
    sliding = checks.not_negative("speed", speed, unit="m/s")
    return HalfSpace(solid, sliding, thickness=height, layers=layers)


def check_magnitudes(body: HalfSpace, heights: PeriodicHeights, pressure: float) -> None:
    """Raise `InputError` for sizes that overflow or underflow single precision."""
    grid = heights.grid
    _within("the step of the surface", min(grid.spacing), "m")
    _within("the length of the surface", max(grid.lengths), "m")
    tallest = float(np.abs(heights.on(grid.shape)).max())
    if not tallest <= max(grid.lengths):
        raise InputError(
            "the heights of the surface must stay below its length, "
            f"{max(grid.lengths):.4g} m; got {tallest:.4g} m over the mean"
        )
    _within("pressure", pressure, "Pa")
    frequency = body.speed * float(grid.along.max())
    if frequency > _MOST:
        raise InputError(
            f"speed must be at most {_MOST / grid.along.max():.3g} m/s, {_MOST:g} rad/s on the "
            f"smallest wave of this surface; got {body.speed:g} m/s"
        )
    for rubber in body.rubbers:
        for extreme in (rubber.equilibrium_modulus, rubber.glassy_modulus):
            _within("the modulus of the rubber", extreme, "Pa")


def _within(name: str, value: float, unit: str) -> None:
    if not _LEAST <= value <= _MOST:
        raise InputError(f"{name} must be from {_LEAST:g} to {_MOST:g} {unit}; got {value:g}")
