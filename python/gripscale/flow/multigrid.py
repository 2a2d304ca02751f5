"""Pressure in a network of conductances, by conjugate gradients with an algebraic multigrid.

The network has sum_j c_ij (P_i - P_j) = q_i. Nodes i and j, with the sums d of their conductances,
pair by the largest c_ij (1 / d_i + 1 / d_j), at least 2 / 8, which bounds the condition number of
two grids, whatever the conductances (A. Napov & Y. Notay, SIAM J. Sci. Comput. 34 (2012) A1079,
doi:10.1137/100818509). Aggregates are pairs of pairs. Two steps of conjugate gradients on every
coarse grid keep the bound on many (K-cycle: Y. Notay & P. S. Vassilevski, Numer. Linear Algebra
Appl. 15 (2008) 473, doi:10.1002/nla.542).
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import scipy
from numpy.typing import NDArray

from gripscale.core.arrays import Array

_Index = NDArray[np.intp]

LARGEST_CONDITION = 8.0
ROUNDS = 6  # rounds in which nodes that choose each other pair
# Relative random change of the choices: alike nodes would choose alike, and few each other.
JITTER = 0.1
FEWEST_NODES = 1500  # nodes of a coarse grid that is factorised
DAMPING = 0.7
SWEEPS = 2  # smoothing before and after each correction
# Residual over that before, below which a second step on a coarse grid is not worth its cost.
ENOUGH = 0.25
_MOST_STEPS = 200


def laplacian(
    first: _Index, second: _Index, conductance: Array, nodes: int
) -> scipy.sparse.csr_array:
    """Return the matrix of a network of conductances between `first` and `second` nodes.

    One node of each connected part is held at zero by the largest conductance of its own.
    """
    shape = (nodes, nodes)
    upper = scipy.sparse.coo_array((conductance, (first, second)), shape=shape)
    links = scipy.sparse.csr_array(upper + upper.T)
    total: Array = np.asarray(links.sum(axis=1)).reshape(-1)
    part = scipy.sparse.csgraph.connected_components(links, directed=False)[1]
    order = np.lexsort((total, part))
    held = order[np.flatnonzero(np.diff(part[order], append=-1))]
    diagonal = total.copy()
    diagonal[held] *= 2.0
    return scipy.sparse.csr_array(scipy.sparse.diags_array(diagonal) - links)


@dataclass
class Multigrid:
    """A network and its coarse grids, to precondition with."""

    matrix: scipy.sparse.csr_array
    coarse: Multigrid | None = None
    # Node of the coarse grid of each node.
    aggregate: _Index = field(default_factory=lambda: np.empty(0, dtype=np.intp))

    def __post_init__(self) -> None:
        diagonal = self.matrix.diagonal()
        self._inverse = DAMPING / diagonal
        if self.matrix.shape[0] > FEWEST_NODES:
            pairs, half = _paired(self.matrix)
            quads, quarter = _paired(half)
            if quarter.shape[0] < 0.9 * self.matrix.shape[0]:
                self.aggregate, self.coarse = quads[pairs], Multigrid(quarter)
                return
        self._scale = diagonal**-0.5
        scaling = scipy.sparse.diags_array(self._scale)
        scaled = scipy.sparse.csc_array(scaling @ self.matrix @ scaling)
        self._factors = scipy.sparse.linalg.splu(scaled)

    def solve(self, inflow: Array, outset: float, tolerance: float) -> Array:
        """Return the pressures.

        Conjugate gradients lower the dissipation, `outset` at zero pressure, in every iteration.
        They end when the last of them lowered it by less than the tolerance times its value.
        """
        pressure, residual = np.zeros_like(inflow), inflow.copy()
        direction, image = np.zeros_like(inflow), np.zeros_like(inflow)
        dissipation, curvature, falls = outset, 0.0, [np.inf] * 3
        for _ in range(_MOST_STEPS):
            if sum(falls) <= tolerance * dissipation:
                break
            step = self._cycle(residual)
            if curvature > 0.0:
                step -= (step @ image) / curvature * direction
            direction, image = step, self.matrix @ step
            curvature = float(direction @ image)
            if not curvature > 0.0:
                break
            length = float(direction @ residual) / curvature
            pressure += length * direction
            residual -= length * image
            falls = [*falls[1:], length**2 * curvature]
            dissipation -= falls[-1]
        return pressure

    def _cycle(self, right: Array) -> Array:
        """Return an approximate solution by one cycle through the coarse grids."""
        if self.coarse is None:
            return np.asarray(self._scale * self._factors.solve(self._scale * right))
        pressure, residual = self._smoothed(np.zeros_like(right), right)
        collected = np.bincount(self.aggregate, residual, self.coarse.matrix.shape[0])
        correction = self.coarse._two_steps(np.asarray(collected, dtype=float))[self.aggregate]
        residual = residual - self.matrix @ correction
        return self._smoothed(pressure + correction, residual)[0]

    def _smoothed(self, pressure: Array, residual: Array) -> tuple[Array, Array]:
        for _ in range(SWEEPS):
            change = self._inverse * residual
            pressure, residual = pressure + change, residual - self.matrix @ change
        return pressure, residual

    def _two_steps(self, right: Array) -> Array:
        """Return a solution by at most two steps of conjugate gradients, each with one cycle."""
        first = self._cycle(right)
        image = self.matrix @ first
        curvature = float(first @ image)
        if self.coarse is None or not curvature > 0.0:
            return first
        length = float(first @ right) / curvature
        residual = right - length * image
        if np.linalg.norm(residual) > ENOUGH * np.linalg.norm(right):
            second = self._cycle(residual)
            second -= float(second @ image) / curvature * first
            curvature = float(second @ (self.matrix @ second))
            if curvature > 0.0:
                return length * first + float(second @ residual) / curvature * second
        return length * first


def _paired(matrix: scipy.sparse.csr_array) -> tuple[_Index, scipy.sparse.csr_array]:
    """Return the pair of each node, and the matrix of the pairs."""
    nodes, diagonal = matrix.shape[0], matrix.diagonal()
    links = matrix.tocoo()
    first, second = links.coords
    merit = -links.data * (1.0 / diagonal[first] + 1.0 / diagonal[second])
    eligible = (first != second) & (merit > 2.0 / LARGEST_CONDITION)
    first, second, merit = first[eligible], second[eligible], merit[eligible]
    luck = JITTER * np.random.default_rng(0).random(nodes)
    merit *= 1.0 + luck[first] + luck[second]
    pair, count = np.full(nodes, -1), 0
    for _ in range(ROUNDS):
        if first.size == 0:
            break
        starts = np.flatnonzero(np.diff(first, prepend=-1))
        best = np.repeat(np.maximum.reduceat(merit, starts), np.diff(starts, append=first.size))
        chosen = np.flatnonzero(merit == best)
        choice = np.full(nodes, -1)
        choice[first[chosen]] = second[chosen]
        lower = first[starts]
        lower = lower[(choice[choice[lower]] == lower) & (lower < choice[lower])]
        pair[lower] = pair[choice[lower]] = count + np.arange(lower.size)
        count += lower.size
        free = (pair[first] < 0) & (pair[second] < 0)
        first, second, merit = first[free], second[free], merit[free]
    alone = np.flatnonzero(pair < 0)
    pair[alone] = count + np.arange(alone.size)
    shape = (nodes, count + alone.size)
    gathering = scipy.sparse.csr_array((np.ones(nodes), pair, np.arange(nodes + 1)), shape=shape)
    return pair, scipy.sparse.csr_array(gathering.T @ matrix @ gathering)
