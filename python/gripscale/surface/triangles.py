"""Surfaces in STL files: the heights of a mesh of triangles, put on an even grid.

A file holds triangles as text, facet ... vertex x y z ... endfacet, or as numbers: 80 bytes, their
count, then 50 bytes each. It states no unit. z is the height; seen from above no triangle may cover
another one. Vertices on an even grid are its points. Other meshes are interpolated within each
triangle at the steps

    d = sqrt(2 A),   A the median area of triangles seen from above,

as two triangles make a square of a grid. Holes are missing heights.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.core import Array, FileError
from gripscale.surface.profile import even_grid

_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_HEAD = 84  # bytes before the first triangle of a binary file
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# Distance of coordinates, in the size of the mesh, that single precision cannot tell apart.
_ROUNDING = 1e-6
_OVERLAP = 1.01  # area of the triangles over that of their rectangle beyond which some cover others
_MOST_POINTS = 10**8


def is_stl(path: Path, raw: bytes) -> bool:
    """Return whether a file holds triangles: by its suffix, as text by its first words, too."""
    return path.suffix.lower() == ".stl" or (
        raw[:512].lstrip().startswith(b"solid") and b"facet" in raw[:1024]
    )


def read_stl(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights of shape (nx, ny) in the unit of the file, NaN in holes.

    Raises `FileError` if the file holds no triangles, or some cover others seen from above.
    """
    corners = _corners(path, raw)
    rounding = np.ptp(corners, axis=(0, 1)).max() * _ROUNDING
    first, second = ((corners[:, at] - corners[:, 0])[:, :2].T for at in (1, 2))
    area = 0.5 * (first[0] * second[1] - first[1] * second[0])
    counted, corner = np.unique(
        np.rint(corners.reshape(-1, 3) / rounding), axis=0, return_inverse=True
    )
    points, triangles = counted * rounding, corner.reshape(-1, 3)
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    seen = np.abs(area) > _ROUNDING * np.median(np.abs(area))
    if (
        len(np.unique(counted[:, :2], axis=0)) < len(counted)
        or len(np.unique(np.sign(area[seen]))) != 1
        or np.abs(area).sum() > _OVERLAP * np.prod(high - low)
    ):
        raise FileError(
            f"{path}: expected a surface with one height at each point (x, y); got triangles that "
            "cover others, or face up and down: a wall, an overhang or a closed body. Export the "
            "upper face alone, with z as its height"
        )
    axes = [np.unique(distances) for distances in points[:, :2].T]
    grids = [even_grid(axis) for axis in axes]
    if len(points) == axes[0].size * axes[1].size and all(g and not g.left_out for g in grids):
        return axes[0], axes[1], points[:, 2].reshape(axes[0].size, axes[1].size)
    step = float(np.sqrt(2.0 * np.median(np.abs(area[seen]))))
    return _interpolated(path, points, triangles[seen], step)


def _corners(path: Path, raw: bytes) -> Array:
    """Return the corners of the triangles, shape (triangles, 3, 3)."""
    count = int.from_bytes(raw[_HEAD - 4 : _HEAD], "little")
    try:
        if len(raw) == _HEAD + _TRIANGLE.itemsize * count:
            corners = np.frombuffer(raw, _TRIANGLE, offset=_HEAD)["corners"].astype(float)
        else:
            corners = np.array(_VERTEX.findall(raw)).astype(float).reshape(-1, 3, 3)
    except ValueError:
        corners = np.empty((0, 3, 3))
    if not len(corners) or not np.isfinite(corners).all():
        raise FileError(f"{path}: expected triangles of three vertices, each of three numbers")
    return corners


def _interpolated(
    path: Path, points: Array, triangles: Array, step: float
) -> tuple[Array, Array, Array]:
    """Return axes in steps and the heights of triangles there."""
    from matplotlib.tri import LinearTriInterpolator, Triangulation

    axes = []
    for low, high in zip(points.min(axis=0)[:2], points.max(axis=0)[:2], strict=True):
        count = np.floor((high - low) / step * (1.0 - _ROUNDING))
        axes.append(0.5 * (low + high) + step * (np.arange(count + 1.0) - 0.5 * count))
    x, y = axes
    if x.size * y.size > _MOST_POINTS:
        raise FileError(f"{path}: expected triangles of a like size; got {x.size} x {y.size} steps")
    try:
        mesh = Triangulation(points[:, 0], points[:, 1], triangles)
        heights = LinearTriInterpolator(mesh, points[:, 2])(*np.meshgrid(x, y, indexing="ij"))
    except (RuntimeError, ValueError) as error:
        raise FileError(f"{path}: expected triangles side by side seen from above") from error
    return x, y, np.ma.filled(heights, np.nan)
