"""Loss by depth as a solver found it: layers, evenly lossy within.

With the share s_i of the loss in the layer between the depths a_i and b_i, h_i = b_i - a_i, and the
mean e_i = (1 - exp(-m h_i)) / (m h_i) of exp(-m (z - a_i)) over it,

    E exp(-m Z)        = sum_i s_i exp(-m a_i) e_i
    E exp(-m |Z - Z'|) = sum_i s_i^2 2 (1 - e_i) / (m h_i)
                       + 2 sum_(i < j) s_i s_j exp(-m (a_j - b_i)) e_i e_j
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from gripscale.interface.loss_depth import Array, ComplexArray, ierfc

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)


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
        depth, share = self._points
        return float(share @ ierfc(depth / length))

    def spread_between(self, length: float) -> float:
        """Return E ierfc(|Z - Z'| / length)."""
        return self._of_two(np.subtract, length)

    def spread_sum(self, length: float) -> float:
        """Return E ierfc((Z + Z') / length)."""
        return self._of_two(np.add, length)

    def _within(self, m: ComplexArray) -> ComplexArray:
        """Return e_i, shape (..., layers)."""
        height = np.multiply.outer(m, np.diff(self.edges))
        return np.asarray(-np.expm1(-height) / height)

    def _of_two(self, together: Callable[[Array, Array], Array], length: float) -> float:
        depth, share = self._points
        distance = np.abs(together(depth[:, None], depth[None, :]))
        return float(share @ ierfc(distance / length) @ share)

    @property
    def _points(self) -> tuple[Array, Array]:
        """Return Gauss points of every layer and their shares."""
        middle, half = 0.5 * (self.edges[1:] + self.edges[:-1]), 0.5 * np.diff(self.edges)
        depth = middle[:, None] + half[:, None] * _NODES
        share = self.share[:, None] * (0.5 * _WEIGHTS)
        return depth.reshape(-1), share.reshape(-1)
