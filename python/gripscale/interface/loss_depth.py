"""How deep below the surface energy is lost: distributions of depth, and averages over them.

A pressure p cos(k x) on a half-plane, moving along, shears it with an amplitude p k z exp(-k z)
that is the same everywhere along x (K. L. Johnson, Contact Mechanics (1985), sec. 13.2,
doi:10.1017/CBO9781139171731), so that its loss lies at depths distributed as (k z)^2 exp(-2 k z): a
gamma distribution of shape 3 and mean 3/(2 k). Shape 1 is the exponential exp(-a z), mean 1/a.

With b = shape/mean, Z and Z' two depths, and m of positive real part:

    E exp(-m Z)        = (b/(b + m))^shape
    E exp(-m |Z - Z'|) = b/(b + m)                                     shape 1
                       = b/8 (3/(b + m) + 3 b/(b + m)^2 + 2 b^2/(b + m)^3)    shape 3
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.special import erfc, gamma

from gripscale import checks
from gripscale.errors import InputError

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]


class DepthsOfLoss(Protocol):
    """A distribution of the depth Z at which energy is lost, as temperatures ask for it."""

    @property
    def mean(self) -> float:
        """Mean depth [m]."""

    def decay(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m Z) for `m` [1/m], same shape."""

    def decay_between(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m |Z - Z'|) for `m` [1/m], same shape."""

    def spread(self, length: float) -> float:
        """Return E ierfc(Z / length), ierfc the integral of the complementary error function."""

    def spread_between(self, length: float) -> float:
        """Return E ierfc(|Z - Z'| / length)."""

    def spread_sum(self, length: float) -> float:
        """Return E ierfc((Z + Z') / length)."""


Distances = Literal["one", "between", "sum"]

SHAPES = (1, 3)
DEEPEST = 60.0
"""Depth in units of 1/b beyond which nothing is lost: exp(-60)."""
WIDEST = 6.5
"""Argument beyond which ierfc is below 1e-20."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(96)


@dataclass(frozen=True)
class LossDepth:
    """A distribution of the depth at which energy is lost.

    Parameters
    ----------
    mean : float
        Mean depth [m]; zero is the surface itself.
    shape : int
        1: exponential; 3: under a harmonic of the pressure.

    Raises
    ------
    InputError
        If the mean is no finite number from zero, or the shape another.
    """

    mean: float
    shape: int = 3

    def __post_init__(self) -> None:
        object.__setattr__(self, "mean", checks.not_negative("mean", self.mean, unit="m"))
        if self.shape not in SHAPES:
            raise InputError(f"shape must be 1 or 3; got {checks.shown(self.shape)}")

    @classmethod
    def under(cls, wavenumber: float) -> LossDepth:
        """Return where a harmonic of the pressure of this wavenumber [rad/m] loses energy."""
        return cls(1.5 / checks.positive("wavenumber", wavenumber, unit="rad/m"))

    @property
    def rate(self) -> float:
        """The rate b = shape/mean [1/m], infinite at the surface."""
        return self.shape / self.mean if self.mean > 0.0 else math.inf

    def decay(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m Z) for `m` [1/m], same shape."""
        return np.asarray((1.0 / (1.0 + np.asarray(m) / self.rate)) ** self.shape)

    def decay_between(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m |Z - Z'|) for `m` [1/m], same shape."""
        near = 1.0 / (1.0 + np.asarray(m) / self.rate)
        if self.shape == 1:
            return np.asarray(near)
        return np.asarray((3.0 * near + 3.0 * near**2 + 2.0 * near**3) / 8.0)

    def spread(self, length: float) -> float:
        """Return E ierfc(Z / length), ierfc the integral of the complementary error function."""
        return self._spread("one", length)

    def spread_between(self, length: float) -> float:
        """Return E ierfc(|Z - Z'| / length)."""
        return self._spread("between", length)

    def spread_sum(self, length: float) -> float:
        """Return E ierfc((Z + Z') / length)."""
        return self._spread("sum", length)

    def average(self, of: Distances, function: Callable[[Array], Any], length: float) -> Any:
        """Return the mean of a function of a distance [m] that vanishes beyond some lengths.

        Parameters
        ----------
        of : "one", "between" or "sum"
            The distance: Z, |Z - Z'| or Z + Z'.
        function : callable
            Of distances of shape (n,); n is the first axis of what it returns.
        length : float
            Over which it changes [m]: at `WIDEST` of it nothing is left.
        """
        if self.mean == 0.0:
            return function(np.zeros(1))[0]
        end = min(DEEPEST, WIDEST * self.rate * length)
        s = 0.5 * end * (_NODES + 1.0)
        weights = 0.5 * end * _WEIGHTS * self._density(of, s)
        return np.tensordot(weights, function(s / self.rate), axes=(0, 0))

    def _spread(self, of: Distances, length: float) -> float:
        return float(self.average(of, lambda z: ierfc(z / length), length))

    def _density(self, of: Distances, s: Array) -> Array:
        """Return the density of a distance times the rate."""
        if of == "between":
            return np.exp(-s) if self.shape == 1 else (3.0 + 3.0 * s + s**2) / 8.0 * np.exp(-s)
        return _gamma_density(s, self.shape if of == "one" else 2 * self.shape)


def ierfc(x: Array) -> Array:
    """Return exp(-x^2)/sqrt(pi) - x erfc(x) for `x` from zero."""
    return np.asarray(np.exp(-(x**2)) / math.sqrt(math.pi) - x * erfc(x))


def _gamma_density(s: Array, shape: int) -> Array:
    return np.asarray(s ** (shape - 1) * np.exp(-s) / gamma(shape))
