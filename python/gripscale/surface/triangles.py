"""Surfaces in STL files: the heights of a mesh of triangles, put on an even grid.

A file holds triangles as text, facet ... vertex x y z ... endfacet, or as numbers: 80 bytes, their
count, then 50 bytes each. It states no unit. z is the height, so that seen from above no triangle
may cover another one: a wall, an overhang or a closed body is no surface here.

Vertices on an even grid are its points. Other meshes are interpolated linearly within each triangle,
at steps of the median triangle,

    d = sqrt(2 A),   A its area seen from above,

as two triangles make a square of a grid. Holes are missing heights.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.core.arrays import Array
from gripscale.core.errors import FileError
from gripscale.surface.profile import FEWEST_POINTS, even_grid

_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_HEAD, _EACH = 84, 50
"""Bytes before the first triangle, and of each."""
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_FLAT = 1e-6
"""Part of the median area seen from above below which a triangle stands upright."""
_DIGITS = 1e-6
"""Distance of coordinates, in the size of the mesh, that single precision cannot tell apart."""
_OVERLAP = 1.01
"""Area of the triangles over that of their rectangle beyond which some cover others."""
_MOST_POINTS = 10**8


def read_stl(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights of shape (nx, ny) in the unit of the file, NaN in holes.

    Raises `FileError` if the file holds no triangles, or some cover others seen from above.
    """
    corners = _corners(path, raw)
    flat = corners[:, :, :2]
    first, second = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    area = 0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    upright = np.abs(area) <= _FLAT * np.median(np.abs(area))
    rectangle = float(np.prod(np.ptp(flat.reshape(-1, 2), axis=0)))
    size = np.ptp(corners.reshape(-1, 3), axis=0).max() * _DIGITS
    points, triangles = np.unique(
        np.rint(corners.reshape(-1, 3) / size), axis=0, return_inverse=True
    )
    alone = len(np.unique(points[:, :2], axis=0)) == len(points)
    one_way = (area[~upright] > 0.0).all() or (area[~upright] < 0.0).all()
    if not alone or not one_way or np.abs(area).sum() > _OVERLAP * rectangle:
        raise FileError(
            f"{path}: expected a surface with one height at each point (x, y); got triangles that "
            "face up and down, or cover others: a wall, an overhang or a closed body. Export the "
            "upper face alone, with z as its height"
        )
    points *= size
    grid = _on_grid(points)
    if grid is not None:
        return grid
    step = float(np.sqrt(2.0 * np.median(np.abs(area[~upright]))))
    return _interpolated(path, points, triangles.reshape(-1, 3)[~upright], step)


def _corners(path: Path, raw: bytes) -> Array:
    """Return the corners of the triangles, shape (triangles, 3, 3)."""
    count = int.from_bytes(raw[_HEAD - 4 : _HEAD], "little")
    if len(raw) == _HEAD + _EACH * count:
        corners = np.frombuffer(raw, _TRIANGLE, offset=_HEAD)["corners"].astype(float)
    else:
        try:
            corners = np.array(_VERTEX.findall(raw)).astype(float).reshape(-1, 3, 3)
        except ValueError as error:
            raise FileError(f"{path}: expected three numbers for each of three vertices") from error
    if not len(corners) or not np.isfinite(corners).all():
        raise FileError(
            f"{path}: expected an STL file; got {len(raw)} bytes without triangles of finite numbers"
        )
    return corners


def _on_grid(points: Array) -> tuple[Array, Array, Array] | None:
    """Return axes and heights of points on all places of an even grid, or None of others."""
    axes, numbers = [], []
    for distances in points[:, :2].T:
        axis, number = np.unique(distances, return_inverse=True)
        grid = even_grid(axis) if axis.size >= FEWEST_POINTS else None
        if grid is None or grid.left_out:
            return None
        axes.append(np.asarray(grid.points(axis)))
        numbers.append(number)
    x, y = axes
    if len(points) != x.size * y.size:
        return None
    z = np.empty((x.size, y.size))
    z[numbers[0], numbers[1]] = points[:, 2]
    return x, y, z


def _interpolated(
    path: Path, points: Array, triangles: Array, step: float
) -> tuple[Array, Array, Array]:
    """Return axes in steps and the heights of triangles there."""
    from matplotlib.tri import LinearTriInterpolator, Triangulation

    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    counts = np.floor((high - low) / step * (1.0 - _DIGITS)) + 1.0
    if counts.prod() > _MOST_POINTS:
        raise FileError(
            f"{path}: expected triangles of a like size; got a median one of {step:.4g} beside a "
            f"surface of {high[0] - low[0]:.4g} by {high[1] - low[1]:.4g}"
        )
    rest = 0.5 * (high - low - step * (counts - 1.0))
    x, y = (a + step * np.arange(int(n)) for a, n in zip(low + rest, counts, strict=True))
    try:
        mesh = Triangulation(points[:, 0], points[:, 1], triangles)
        heights = LinearTriInterpolator(mesh, points[:, 2])(*np.meshgrid(x, y, indexing="ij"))
    except (RuntimeError, ValueError) as error:
        raise FileError(f"{path}: expected triangles side by side seen from above") from error
    return x, y, np.ma.filled(heights, np.nan)
