"""The block before it was pressed: its nodes, and what they make of deformed ones at every point.

Lengths are in m. The kernel keeps deformed positions only; its mesh follows from columns, rows,
depth and order of the elements, and is made here by the same rule:

    h_r = h_0 q^r,   sum h_r = depth,   h_0 = min(width of an element, depth/rows)

with square first elements. Quadrature is the (order + 1)^2 Gauss rule, pressures are one number in
an element of order 1 and linear in one of order 2 (rust/fem).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale.errors import InputError
from gripscale.wave import WaveResult

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ReferenceBlock:
    """The undeformed mesh of a wave."""

    wavelength: float
    depth: float
    """Height of the block [m]."""
    columns: int
    rows: int
    order: int

    @classmethod
    def of(cls, result: WaveResult) -> ReferenceBlock:
        """Return the mesh a wave was solved on.

        Raises `InputError` if it has none: it is of a solver without a mesh.
        """
        wanted = ("columns", "rows", "depth", "element_order")
        if result.deformed_mesh is None or not set(wanted) <= set(result.details):
            raise InputError(
                f"result must be of the finite-strain block, which has a mesh; got {result.model}"
            )
        columns, rows, depth, order = (result.details[name] for name in wanted)
        block = cls(
            result.wavelength, depth * result.wavelength, int(columns), int(rows), int(order)
        )
        x, z = result.deformed_mesh
        if x.shape != block.shape or z.shape != block.shape:
            raise InputError(
                f"deformed_mesh must be of {block.shape} nodes, layers by columns; got {x.shape}"
            )
        return block

    @property
    def shape(self) -> tuple[int, int]:
        """Layers of nodes, and nodes of each with both ends."""
        return self.order * self.rows + 1, self.order * self.columns + 1

    @property
    def width(self) -> float:
        """Width of an element [m]."""
        return self.wavelength / self.columns

    @property
    def heights(self) -> Array:
        """Heights of the element rows [m], contact surface first, shape (rows,)."""
        first = min(self.width, self.depth / self.rows)
        heights = first * _ratio(self.rows, self.depth / first) ** np.arange(self.rows)
        return np.asarray(heights * (self.depth / heights.sum()))

    def nodes(self) -> tuple[Array, Array]:
        """Return x and z of the nodes [m], shape (layers, nodes); z = 0 on the surface."""
        x = np.linspace(0.0, self.wavelength, self.shape[1])
        parts = np.repeat(self.heights / self.order, self.order)
        z = np.concatenate([[0.0], np.cumsum(parts)])
        along, up = np.meshgrid(x, z)
        return along, up

    def gradients(self, x: Array, z: Array) -> Array:
        """Return F at the Gauss points of deformed nodes [m].

        Shape (rows, columns, points across, points along, 2, 2), components (x, z).
        """
        return np.stack([self.slopes(x), self.slopes(z)], axis=-2)

    def slopes(self, values: Array) -> Array:
        """Return d/dx and d/dz of nodal values at the Gauss points [1/m times their unit].

        Shape (rows, columns, points across, points along, 2).
        """
        local = self.elements(values)
        shape, slope = shapes(self.order), slopes(self.order)
        along = np.einsum("rclk,pl,qk->rcpq", local, shape, slope) * (2.0 / self.width)
        up = np.einsum("rclk,pl,qk->rcpq", local, slope, shape)
        up = up * (2.0 / self.heights)[:, None, None, None]
        return np.stack([along, up], axis=-1)

    def elements(self, values: Array) -> Array:
        """Return nodal values element by element, shape (rows, columns, order + 1, order + 1)."""
        layer = self.order * np.arange(self.rows)[:, None] + np.arange(self.order + 1)
        node = self.order * np.arange(self.columns)[:, None] + np.arange(self.order + 1)
        return np.asarray(values[layer[:, None, :, None], node[None, :, None, :]])

    @property
    def weights(self) -> Array:
        """Areas of the Gauss points [m^2], shape (rows, 1, points across, points along)."""
        _, weight = np.polynomial.legendre.leggauss(self.order + 1)
        area = 0.25 * self.width * self.heights
        return np.asarray(area[:, None, None, None] * np.outer(weight, weight))

    def modes(self) -> Array:
        """Return the pressure modes at the Gauss points, shape (modes, across, along)."""
        point, _ = np.polynomial.legendre.leggauss(self.order + 1)
        one = np.ones((self.order + 1, self.order + 1))
        linear = [one * point[None, :], one * point[:, None]]
        return np.stack([one, *(linear if self.order == 2 else [])])


def shapes(order: int) -> Array:
    """Return the Lagrange functions at the Gauss points, shape (points, nodes)."""
    s, _ = np.polynomial.legendre.leggauss(order + 1)
    if order == 1:
        return np.stack([0.5 * (1.0 - s), 0.5 * (1.0 + s)], axis=1)
    return np.stack([0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)], axis=1)


def slopes(order: int) -> Array:
    """Return their derivatives on [-1, 1] at the Gauss points, shape (points, nodes)."""
    s, _ = np.polynomial.legendre.leggauss(order + 1)
    if order == 1:
        return np.stack([np.full_like(s, -0.5), np.full_like(s, 0.5)], axis=1)
    return np.stack([s - 0.5, -2.0 * s, s + 0.5], axis=1)


def _ratio(rows: int, total: float) -> float:
    """Return q with sum q^r = `total`, r from 0 to rows - 1; 1 or more."""
    low, high = 1.0, 1.0 + total
    power = np.arange(rows)
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if (middle**power).sum() < total else (low, middle)
    return low
