"""Flash temperature of a sliding rubber: closed forms for a half-space, and what the road takes.

Harmonics of the heat in the steady state, uniform heat, harmonics that begin with the contact, the
means over the depths at which energy is lost, and the division with the road: docs/derivations.md
(H. S. Carslaw & J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), sec. 10.2 and 10.7).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.core import Array, Checked, Mask, checked, checks
from gripscale.core.arrays import AnyComplexArray


class ThermalProperties(Checked):
    """Thermal properties of a rubber, or of its counterface; by default of a typical filled rubber.

    Conductivity: D. Hands & F. Horsfall, Rubber Chem. Technol. 50 (1977) 253. Specific heat: C. Nah
    et al., J. Appl. Polym. Sci. 72 (1999) 1513. Rounded, and not of one compound.

    Raises `InputError` if a value is no finite number above zero.
    """

    conductivity: float = checked(checks.positive, unit="W/(m K)", default=0.25)
    """Thermal conductivity [W/(m K)]."""
    density: float = checked(checks.positive, unit="kg/m^3", default=1150.0)
    """Its density [kg/m^3]."""
    specific_heat: float = checked(checks.positive, unit="J/(kg K)", default=1500.0)
    """Its specific heat [J/(kg K)]."""

    @property
    def diffusivity(self) -> float:
        """D = conductivity / (density x specific heat) [m^2/s]."""
        return self.conductivity / (self.density * self.specific_heat)

    @property
    def effusivity(self) -> float:
        """sqrt(conductivity x density x specific heat) [J/(m^2 K s^0.5)]."""
        return math.sqrt(self.conductivity * self.density * self.specific_heat)


# One standard deviation of ln effusivity between rubbers, estimated: conductivity 20 %, specific
# heat 15 %, density 4 %; of one kind of counterface, from the spread between rocks.
THERMAL_SCATTER = 0.13
COUNTERFACE_SCATTER = 0.15
# Stone of a road: between basalt (1.7), granite (2.9) and limestone (3.2 W/(m K)), A. L. Marshall,
# Build. Sci. 7 (1972) 167. Others: F. P. Incropera et al., Fundamentals of Heat and Mass Transfer,
# appendix A.
STONE = ThermalProperties(2.0, 2650.0, 800.0)
CONCRETE = ThermalProperties(1.4, 2300.0, 880.0)
GLASS = ThermalProperties(1.4, 2500.0, 750.0)
STEEL = ThermalProperties(60.5, 7850.0, 434.0)
COUNTERFACES = {"stone": STONE, "concrete": CONCRETE, "glass": GLASS, "steel": STEEL}
"""Counterfaces by the word for their material."""
COUNTERFACE_BY_KIND = {"surface": STONE, "road": STONE, "floor": CONCRETE, "counterface": STEEL}
"""Counterface of each kind of surface where none is stated."""


# Z, |Z - Z'| and Z + Z'.
Distances = Literal["depth", "difference", "sum"]
DEEPEST = 60.0  # depth in units of 1/b beyond which the loss is neglected: exp(-60)
WIDEST = 6.5  # argument beyond which ierfc is below 1e-20
# Re(m) l/2 from which a harmonic is steady. Across the sliding direction erfc of it is left, 4e-4
# in the depth. Along it what is left falls as 1/|m l| only, and waves may begin at any phase.
STEADY, STEADY_AT_SURFACE = 2.5, 4.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(48)
_TIMES, _TIME_WEIGHTS = np.polynomial.legendre.leggauss(64)


class LossDepth(Checked):
    """The depth at which a harmonic of the pressure loses energy: a gamma distribution of shape 3.

    Raises `InputError` if the mean is no finite number from zero.
    """

    mean: float = checked(checks.not_negative, unit="m")
    """Mean depth [m]; zero is the surface itself."""

    @classmethod
    def under(cls, wavenumber: float) -> LossDepth:
        """Return the depths at which a harmonic of this wavenumber [rad/m] loses energy."""
        return cls(1.5 / checks.positive("wavenumber", wavenumber, unit="rad/m"))

    @property
    def rate(self) -> float:
        """The rate b = 3/mean [1/m], infinite at the surface."""
        return 3.0 / self.mean if self.mean > 0.0 else math.inf

    def decay(self, m: AnyComplexArray) -> AnyComplexArray:
        """Return E exp(-m Z) for `m` [1/m], same shape."""
        near = 1.0 / (1.0 + np.asarray(m) / self.rate)
        return np.asarray(near * near * near)

    def decay_between(self, m: AnyComplexArray) -> AnyComplexArray:
        """Return E exp(-m |Z - Z'|) for `m` [1/m], same shape."""
        near = 1.0 / (1.0 + np.asarray(m) / self.rate)
        return np.asarray(near * (3.0 + near * (3.0 + 2.0 * near)) / 8.0)

    def spread(self, length: float, of: Distances = "depth") -> float:
        """Return E ierfc(distance / length)."""
        return float(self.average(of, lambda z: ierfc(z / length), length))

    def average(self, of: Distances, function: Callable[[Array], Any], length: float) -> Any:
        """Return the mean of a function of a distance Z, |Z - Z'| or Z + Z' [m].

        The first axis of the function's values is that of the distances, shape (n,). It changes
        over `length` [m] and vanishes at `WIDEST` lengths.
        """
        if self.mean == 0.0:
            return function(np.zeros(1))[0]
        end = min(DEEPEST, WIDEST * self.rate * length)
        s = 0.5 * end * (_NODES + 1.0)
        if of == "difference":
            density = (3.0 + 3.0 * s + s**2) / 8.0 * np.exp(-s)
        else:
            power = 2 if of == "depth" else 5  # of one depth, and of the sum of two
            density = s**power * np.exp(-s) / math.factorial(power)
        weights = 0.5 * end * _WEIGHTS * density
        return np.tensordot(weights, function(s / self.rate), axes=(0, 0))


def ierfc(x: Array) -> Array:
    """Return exp(-x^2)/sqrt(pi) - x erfc(x) for `x` from zero."""
    from scipy.special import erfc

    return np.asarray(np.exp(-(x**2)) / math.sqrt(math.pi) - x * erfc(x))


def harmonic_decay(
    wavenumber: ArrayLike, along: ArrayLike, speed: float, thermal: ThermalProperties
) -> AnyComplexArray:
    """Return the decay m [1/m] of harmonics of |k| and k_x [rad/m], at a speed [m/s]."""
    number = np.asarray(wavenumber, dtype=float)
    carried = np.asarray(along, dtype=float) * speed / thermal.diffusivity
    return np.asarray(np.sqrt(number**2 + 1j * carried))


def harmonic_at_surface(
    m: AnyComplexArray, depth: DepthsOfLoss, thermal: ThermalProperties
) -> AnyComplexArray:
    """Return the surface temperature of harmonics per heat per area [K m^2/W], shape of `m`."""
    return np.asarray(depth.decay(m) / (thermal.conductivity * m))


def harmonic_where_lost(
    m: AnyComplexArray, depth: DepthsOfLoss, thermal: ThermalProperties
) -> AnyComplexArray:
    """Return the temperature where harmonics lose their heat per area [K m^2/W], shape of `m`."""
    mean = depth.decay_between(m) + depth.decay(m) ** 2
    return np.asarray(mean / (2.0 * thermal.conductivity * m))


def uniform_at_surface(time: float, depth: DepthsOfLoss, thermal: ThermalProperties) -> float:
    """Return the surface temperature of uniform heat per heat per area [K m^2/W].

    `time` is the duration of the heat [s]. Raises `InputError` if it is no finite number from zero.
    """
    length = _diffusion_length(time, thermal)
    return length * depth.spread(length) / thermal.conductivity if length > 0.0 else 0.0


def uniform_where_lost(time: float, depth: DepthsOfLoss, thermal: ThermalProperties) -> float:
    """Return the temperature where uniform heat is lost; otherwise as `uniform_at_surface`."""
    length = _diffusion_length(time, thermal)
    if length == 0.0:
        return 0.0
    mean = depth.spread(length, "difference") + depth.spread(length, "sum")
    return length * mean / (2.0 * thermal.conductivity)


def uniform_from_others(
    strength: Sequence[float], at_surface: Sequence[float], which: int
) -> float:
    """Return the temperature of uniform heat where `which` loses energy, by all others.

    `strength` is the heat of each, `at_surface` the temperature that a unit of it has there: of two
    depths the deeper one decides.
    """
    pairs = enumerate(zip(strength, at_surface, strict=True))
    return sum(heat * min(top, at_surface[which]) for j, (heat, top) in pairs if j != which)


def _diffusion_length(time: float, thermal: ThermalProperties) -> float:
    """Return 2 sqrt(D t) [m]."""
    return 2.0 * math.sqrt(thermal.diffusivity * checks.not_negative("time", time, unit="s"))


EVERY = slice(None)


@dataclass(frozen=True)
class PassingHarmonics:
    """Harmonics of heat that begin with a contact, after some time of it."""

    m: AnyComplexArray  # decay of the harmonics [1/m], no zero
    time: float  # of the contact [s]
    thermal: ThermalProperties

    def at_surface(self, depth: LossDepth, kept: slice = EVERY) -> AnyComplexArray:
        """Return the surface temperature per heat per area [K m^2/W], of the first harmonics."""
        from scipy.special import erf

        m = self.m[kept]
        steady = harmonic_at_surface(m, depth, self.thermal)
        if depth.mean > 0.0:
            return self._with_changing(steady, kept, depth, "depth")
        half = 0.5 * _diffusion_length(self.time, self.thermal)
        which = m.real * half < STEADY_AT_SURFACE
        steady[which] *= erf(m[which] * half)
        return steady

    def where_lost(self, depth: LossDepth, kept: slice = EVERY) -> AnyComplexArray:
        """Return the temperature, averaged over the loss, per heat per area; as `at_surface`."""
        steady = harmonic_where_lost(self.m[kept], depth, self.thermal)
        return self._with_changing(steady, kept, depth, "difference", "sum")

    def _with_changing(
        self, steady: AnyComplexArray, kept: slice, depth: LossDepth, *distances: Distances
    ) -> AnyComplexArray:
        """Return the steady values, and E r over the `distances` of harmonics that still change."""
        roots, weights, waves, inverse = self._sources
        changing = self._changing[kept]
        inverse = inverse[: np.count_nonzero(changing)]
        if not inverse.size or self.time == 0.0:
            steady[changing] = 0.0
            return steady
        spreads = 2.0 * np.sqrt(self.thermal.diffusivity) * roots
        length = _diffusion_length(self.time, self.thermal)

        def met(z: Array) -> Array:
            """Return exp(-z^2/(4 D s)) at depths and times."""
            return np.asarray(np.exp(-((z[:, None] / spreads) ** 2)))

        mean = sum(depth.average(of, met, length) for of in distances) / len(distances)
        steady[changing] = ((weights * mean) @ waves)[inverse]
        return steady

    @cached_property
    def _changing(self) -> Mask:
        length = _diffusion_length(self.time, self.thermal)
        return np.asarray(self.m.real * (0.5 * length) < STEADY)

    @cached_property
    def _sources(self) -> tuple[Array, Array, AnyComplexArray, NDArray[np.intp]]:
        """Return roots and weights of times s, exp(-D m^2 s) of each different m, and its index."""
        different, inverse = np.unique(self.m[self._changing], return_inverse=True)
        nodes, width = 0.5 * (_TIMES + 1.0), 0.5 * _TIME_WEIGHTS
        # the cubes of the nodes resolve depths of a thousandth of 2 sqrt(D t)
        root = math.sqrt(self.time)
        roots, d = root * nodes**3, self.thermal.diffusivity
        weights = 6.0 * root * nodes**2 * width * math.sqrt(d / math.pi) / self.thermal.conductivity
        waves = np.asarray(np.exp(-d * np.multiply.outer(roots**2, different**2)))
        return roots, weights, waves, inverse


@dataclass(frozen=True)
class LossLayers:
    """A distribution of the depth at which energy is lost, by layers."""

    edges: Array  # depths between the layers, rising from the surface [m], shape (layers + 1,)
    share: Array  # of the loss in each layer [-], adding up to one, shape (layers,)

    @classmethod
    def of(cls, edges: Array, lost: Array) -> LossLayers:
        """Return the layers with the loss of each; a negative loss counts as zero."""
        positive = np.maximum(lost, 0.0)
        return cls(edges, positive / positive.sum())

    @property
    def mean(self) -> float:
        """Mean depth [m]."""
        return float(self.share @ (0.5 * (self.edges[1:] + self.edges[:-1])))

    def decay(self, m: AnyComplexArray) -> AnyComplexArray:
        """Return E exp(-m Z) for `m` [1/m], same shape."""
        falls = np.exp(-np.multiply.outer(m, self.edges[:-1]))
        return np.asarray((falls * self._within(m)) @ self.share)

    def decay_between(self, m: AnyComplexArray) -> AnyComplexArray:
        """Return E exp(-m |Z - Z'|) for `m` [1/m], same shape."""
        within = self._within(m)
        height = np.multiply.outer(m, np.diff(self.edges))
        same_layer = (2.0 * (1.0 - within) / height) @ self.share**2
        lossy = within * self.share
        falls = np.exp(-height)
        above, pairs = np.zeros_like(same_layer), np.zeros_like(same_layer)
        for layer in range(self.share.size):
            pairs = pairs + above * lossy[..., layer]
            above = above * falls[..., layer] + lossy[..., layer]
        return np.asarray(same_layer + 2.0 * pairs)

    def spread(self, length: float, of: Distances = "depth") -> float:
        """Return E ierfc(distance / length)."""
        edges, density = self.edges, self.share / np.diff(self.edges)
        if of == "depth":
            return float(density @ -np.diff(length * _i2erfc(edges / length)))
        # the mean over pairs of layers, from the second integral at their edges
        if of == "sum":
            second = length**2 * _i3erfc((edges[:, None] + edges[None, :]) / length)
        else:
            apart = np.abs(edges[:, None] - edges[None, :])
            second = -(length**2 * _i3erfc(apart / length) + 0.25 * length * apart)
        return float(density @ np.diff(np.diff(second, axis=0), axis=1) @ density)

    def _within(self, m: AnyComplexArray) -> AnyComplexArray:
        """Return e_i, shape (..., layers)."""
        height = np.multiply.outer(m, np.diff(self.edges))
        return np.asarray(-np.expm1(-height) / height)


DepthsOfLoss: TypeAlias = LossDepth | LossLayers
"""A distribution of the depth Z at which energy is lost, with the means temperatures need."""


def _i2erfc(x: Array) -> Array:
    """Return the integral of ierfc from `x` to infinity."""
    from scipy.special import erfc

    return np.asarray(0.25 * erfc(x) - 0.5 * x * ierfc(x))


def _i3erfc(x: Array) -> Array:
    """Return the integral of i2erfc from `x` to infinity."""
    return np.asarray(ierfc(x) / 6.0 - x * _i2erfc(x) / 3.0)


@dataclass(frozen=True)
class Partition:
    """Rises of the contact [K], means over it, that divide heat between rubber and counterface."""

    hysteresis: float  # of the rubber, by the heat of the hysteresis
    rubber: float  # of the rubber, by a unit of friction at its surface
    counterface: float  # of the counterface, by a unit of friction; infinite if insulating

    def net(self, interface: float) -> float:
        """Return the part of the friction `interface` whose heat enters the rubber [-]."""
        into_road = (self.hysteresis + self.rubber * interface) / (self.rubber + self.counterface)
        return interface - into_road


def settled_interface(
    friction_at: Callable[[float], float], rise: Callable[[float], float]
) -> float:
    """Return the friction mu [-] of an interface at its rise [K]: mu = friction_at(rise(mu))."""
    from scipy.optimize import brentq

    def excess(friction: float) -> float:
        return friction_at(rise(friction)) - friction

    end = friction_at(rise(0.0))
    while excess(end) > 0.0:
        end *= 2.0
    return float(brentq(excess, 0.0, end, rtol=1e-9)) if end > 0.0 else 0.0


def loss_pattern(pressure: AnyComplexArray, lost: Array) -> Array:
    """Return the loss |g|^2 along one period, shape (points,); its mean is the sum of `lost`.

    `pressure` is the `rfft` of the pressure; a negative loss of a harmonic is round-off.
    """
    import scipy.fft

    points = 2 * (pressure.size - 1)
    size = np.abs(pressure)
    phase = np.divide(pressure, size, out=np.zeros_like(pressure), where=size > 0.0)
    envelope = np.zeros(points, dtype=complex)
    envelope[: pressure.size] = np.sqrt(np.maximum(lost, 0.0)) * phase
    return np.asarray(np.abs(scipy.fft.ifft(envelope) * points) ** 2)
