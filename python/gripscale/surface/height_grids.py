"""Maps as numbers of a grid below a header of pairs, or as triangles.

| format | points along x, y | steps | heights |
|---|---|---|---|
| .sdf (ISO 25178) | NumPoints, NumProfiles | Xscale, Yscale [m] | counts of Zscale [m], between * |
| .asc, ESRI | ncols, nrows | cellsize, or dx and dy | north to south; NODATA_value is missing |
| .gsf, Gwyddion | XRes, YRes | XReal, YReal over them | 4-byte numbers behind 1 to 4 empty bytes |

Names are taken in any case, with =, a colon or blanks before their value. BAD is a missing height.
The field is that of http://gwyddion.net/documentation/user-guide-en/gsf.html.

Triangles (.stl) stand as text, facet ... vertex x y z ... endfacet, or as numbers: 80 bytes, their
count, then 50 bytes each. Seen from above none may cover another one. Vertices on an even grid are
its points; other meshes are interpolated at steps of sqrt(2 A), A the median area seen from above,
as two triangles make a square of a grid. No unit is stated, and holes are missing heights.
"""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np

from gripscale.core import Array, FileError, checks
from gripscale.surface.profile import even_grid

_LONGEST_HEADER = 2**16
_PAIR = re.compile(r"^\s*([A-Za-z_]\w*)\s*[=:\s]\s*(.*?)\s*$")
_ESRI = re.compile(rb"\s*ncols[\s=:]", re.IGNORECASE)
_BINARY, _TEXT = (b"bISO", b"bBCR"), (b"aISO", b"aBCR")
# Points along an axis beyond which a header is taken as damaged, and of a whole map of triangles.
_MOST_POINTS = 10**8


def named_units(path: Path, raw: bytes) -> dict[str, str] | None:
    """Return `xyunits` and `zunits` as far as a grid or a mesh states them; None: it is neither."""
    if is_stl(path, raw):
        return {}
    by_suffix = path.suffix.lower() == ".sdf" and not raw.startswith(_BINARY)
    if by_suffix or raw.lstrip().startswith(_TEXT):
        return {"xyunits": "m", "zunits": "m"}
    return _simple_field_header(raw) or ({} if _ESRI.match(raw) else None)


def _simple_field_header(raw: bytes) -> dict[str, str]:
    if not raw.startswith(b"Gwyddion Simple Field"):
        return {}
    return _header(raw.partition(b"\0")[0].decode("utf-8", errors="replace"))[0]


def _simple_field(path: Path, raw: bytes, header: dict[str, str]) -> tuple[Array, Array, Array]:
    end = raw.index(b"\0") if b"\0" in raw else len(raw)
    try:
        points, rows = int(header["xres"]), int(header["yres"])
        dx, dy = float(header["xreal"]) / points, float(header["yreal"]) / rows
        z = np.frombuffer(raw, "<f4", points * rows, end + 4 - end % 4)
    except (KeyError, ValueError, ZeroDivisionError) as error:
        raise FileError(
            f"{path}: expected a simple field of Gwyddion with XRes, YRes, XReal, YReal and as "
            f"many heights; got {len(raw)} bytes with {', '.join(header)}"
        ) from error
    counts = np.array(z, dtype=float).reshape(rows, points)
    return dx * np.arange(points, dtype=float), dy * np.arange(rows, dtype=float), counts.T


def read_height_grid(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
    """Return x, y and heights of shape (points along x, profiles), NaN where missing.

    They are in m of the surface data format, in the units of the file of others. Raises `FileError`
    if the header lacks a number, there are not as many heights as it states, the file holds no
    triangles, or some cover others seen from above.
    """
    if is_stl(path, raw):
        return _mesh(path, raw)
    if field := _simple_field_header(raw):
        return _simple_field(path, raw, field)
    header, start = _header(raw[:_LONGEST_HEADER].decode("latin-1"))
    esri = bool(_ESRI.match(raw))

    def number(name: str, default: str = "") -> float:
        text = header.get(name.lower(), default)
        try:
            value = float(text.replace(",", "."))
        except ValueError as error:
            raise FileError(
                f"{path}: expected a map with the number {name} in its header; got "
                f"{checks.short_repr(text) if text else 'none'}"
            ) from error
        if not default and not 0.0 < value < math.inf:
            got = checks.shortened(text)
            raise FileError(f"{path}: expected {name} finite and above zero; got {got}")
        return value

    along, across = ("ncols", "nrows") if esri else ("NumPoints", "NumProfiles")
    for name in (along, across):
        if not (number(name) <= _MOST_POINTS and number(name) == int(number(name))):
            raise FileError(f"{path}: expected a whole number as {name}; got {number(name):g}")
    points, profiles = int(number(along)), int(number(across))
    by_axis = ("dx", "dy") if "dx" in header else ("cellsize", "cellsize")
    dx, dy = map(number, by_axis if esri else ("Xscale", "Yscale"))
    heights = raw[start:] if esri else raw[start:].partition(b"*")[0]  # a trailer may follow
    cells = heights.replace(b"BAD", b"nan").replace(b",", b".").split()
    if len(cells) != points * profiles:
        raise FileError(
            f"{path}: expected {points} x {profiles} heights by its header; got {len(cells)}"
        )
    try:
        counts = np.array(cells).astype(float).reshape(profiles, points)
    except ValueError as error:
        raise FileError(
            f"{path}: expected numbers as heights ({checks.shortened(str(error))})"
        ) from error
    if esri:
        counts = np.where(counts == number("NODATA_value", "-9999"), np.nan, counts)[::-1]
    else:
        counts *= number("Zscale")
    return dx * np.arange(points, dtype=float), dy * np.arange(profiles, dtype=float), counts.T


def _header(head: str) -> tuple[dict[str, str], int]:
    """Return the pairs of the header by name in small letters, and where the heights begin."""
    header: dict[str, str] = {}
    start = 0
    for line in head.splitlines(keepends=True):
        pair = _PAIR.match(line)
        if pair:
            header[pair[1].lower()] = pair[2]
        elif header and line.strip():
            return header, start + (len(line) if line.strip() == "*" else 0)
        start += len(line)
    return header, start


_VERTEX = re.compile(rb"vertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)
_HEAD = 84  # bytes before the first triangle of a binary file
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# Distance of coordinates, in the size of the mesh, that single precision cannot tell apart.
_ROUNDING = 1e-6
_OVERLAP = 1.01  # area of the triangles over that of their rectangle beyond which some cover others


def is_stl(path: Path, raw: bytes) -> bool:
    """Return whether a file holds triangles: by its suffix, as text by its first words, too."""
    return path.suffix.lower() == ".stl" or (
        raw[:512].lstrip().startswith(b"solid") and b"facet" in raw[:1024]
    )


def _mesh(path: Path, raw: bytes) -> tuple[Array, Array, Array]:
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


def _corners(path: Path, raw: bytes) -> Array:  # of shape (triangles, 3, 3)
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
