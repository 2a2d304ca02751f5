"""Loss by depth as a solver found it: layers, evenly lossy within.

With the share s_i of the loss in the layer between the depths a_i and b_i, h_i = b_i - a_i, and the
mean e_i = (1 - exp(-m h_i)) / (m h_i) of exp(-m (z - a_i)) over it,

    E exp(-m Z)        = sum_i s_i exp(-m a_i) e_i
    E exp(-m |Z - Z'|) = sum_i s_i^2 2 (1 - e_i) / (m h_i)
                       + 2 sum_(i < j) s_i s_j exp(-m (a_j - b_i)) e_i e_j

Means of ierfc are differences of its integrals i2erfc and i3erfc between the edges (H. S. Carslaw &
J. C. Jaeger, Conduction of Heat in Solids, 2nd ed. (1959), appendix II); over |Z - Z'|, where ierfc
has an edge, of l^2 i3erfc(|d|/l) + l |d|/4, whose second derivative is ierfc(|d|/l) everywhere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import erfc

from gripscale.interface.loss_depth import Array, ComplexArray, ierfc


@dataclass(frozen=True)
class LossLayers:
    """A distribution of the depth at which energy is lost, by layers.

    Parameters
    ----------
    edges : array, shape (layers + 1,)
        Depths between the layers, rising from the surface [m].
    share : array, shape (layers,)
        Of the loss in each layer [-]; they add up to one.
    """

    edges: Array
    share: Array

    @classmethod
    def of(cls, edges: Array, lost: Array) -> LossLayers:
        """Return the layers of what is lost in each; what a layer gains counts as nothing."""
        positive = np.maximum(lost, 0.0)
        return cls(edges, positive / positive.sum())

    @property
    def mean(self) -> float:
        """Mean depth [m]."""
        return float(self.share @ (0.5 * (self.edges[1:] + self.edges[:-1])))

    def decay(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m Z) for `m` [1/m], same shape."""
        falls = np.exp(-np.multiply.outer(m, self.edges[:-1]))
        return np.asarray((falls * self._within(m)) @ self.share)

    def decay_between(self, m: ComplexArray) -> ComplexArray:
        """Return E exp(-m |Z - Z'|) for `m` [1/m], same shape."""
        within = self._within(m)
        height = np.multiply.outer(m, np.diff(self.edges))
        own = (2.0 * (1.0 - within) / height) @ self.share**2
        lossy = within * self.share
        falls = np.exp(-height)
        above, passed = np.zeros_like(own), np.zeros_like(own)
        for layer in range(self.share.size):
            passed = passed + above * lossy[..., layer]
            above = above * falls[..., layer] + lossy[..., layer]
        return np.asarray(own + 2.0 * passed)

    def spread(self, length: float) -> float:
        """Return E ierfc(Z / length), ierfc the integral of the complementary error function."""
        at_edges = length * _i2erfc(self.edges / length)
        return float(self._density @ -np.diff(at_edges))

    def spread_between(self, length: float) -> float:
        """Return E ierfc(|Z - Z'| / length)."""
        distance = np.abs(self.edges[:, None] - self.edges[None, :])
        return -self._of_two(length**2 * _i3erfc(distance / length) + 0.25 * length * distance)

    def spread_sum(self, length: float) -> float:
        """Return E ierfc((Z + Z') / length)."""
        together = self.edges[:, None] + self.edges[None, :]
        return self._of_two(length**2 * _i3erfc(together / length))

    @property
    def _density(self) -> Array:
        """Share over height [1/m]."""
        return np.asarray(self.share / np.diff(self.edges))

    def _within(self, m: ComplexArray) -> ComplexArray:
        """Return e_i, shape (..., layers)."""
        height = np.multiply.outer(m, np.diff(self.edges))
        return np.asarray(-np.expm1(-height) / height)

    def _of_two(self, at_edges: Array) -> float:
        """Return the mean over pairs of layers of what has these second integrals at the edges."""
        integral = np.diff(np.diff(at_edges, axis=0), axis=1)
        return float(self._density @ integral @ self._density)


def _i2erfc(x: Array) -> Array:
    """Return the integral of ierfc from `x` to infinity."""
    return np.asarray(0.25 * erfc(x) - 0.5 * x * ierfc(x))


def _i3erfc(x: Array) -> Array:
    """Return the integral of i2erfc from `x` to infinity."""
    return np.asarray(ierfc(x) / 6.0 - x * _i2erfc(x) / 3.0)
