"""Unstructured grids as VTK XML files (.vtu), which ParaView, VisIt, PyVista and meshio open.

Arrays stand in the file as base64 of a length and little-endian numbers. Source: The VTK User's
Guide, 11th ed. (2010), section 19.3; VTK file formats, docs.vtk.org.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
from numpy.typing import NDArray

from gripscale.netcdf import write_whole

Array = NDArray[np.float64]
Fields = Mapping[str, Array]

QUAD, BIQUADRATIC_QUAD = 9, 28
"""VTK's numbers of the elements."""


@dataclass(frozen=True)
class Grid:
    """Points, cells of one kind, and fields on them."""

    points: Array
    """Shape (points, 3)."""
    cells: NDArray[np.int64]
    """Numbers of the points of each cell in VTK's order, shape (cells, points of a cell)."""
    cell_type: int
    point_data: Fields = field(default_factory=dict)
    """Shape (points,) or (points, components)."""
    cell_data: Fields = field(default_factory=dict)
    """Shape (cells,) or (cells, components)."""
    field_data: Mapping[str, float] = field(default_factory=dict)
    """Numbers of the whole grid."""


def write_vtu(grid: Grid, path: Path) -> Path:
    """Write a grid to `path`; return it. Raises `FileError` if it cannot be written."""
    root = ET.Element(
        "VTKFile",
        type="UnstructuredGrid",
        version="1.0",
        byte_order="LittleEndian",
        header_type="UInt64",
    )
    whole = ET.SubElement(root, "UnstructuredGrid")
    numbers = ET.SubElement(whole, "FieldData")
    for name, value in grid.field_data.items():
        _array(numbers, name, np.array([value]), NumberOfTuples="1")
    counts = {"NumberOfPoints": len(grid.points), "NumberOfCells": len(grid.cells)}
    piece = ET.SubElement(whole, "Piece", {name: str(count) for name, count in counts.items()})
    for place, fields in (("PointData", grid.point_data), ("CellData", grid.cell_data)):
        part = ET.SubElement(piece, place)
        for name, values in fields.items():
            _array(part, name, values)
    _array(ET.SubElement(piece, "Points"), "Points", grid.points)
    cells = ET.SubElement(piece, "Cells")
    ends = grid.cells.shape[1] * np.arange(1, len(grid.cells) + 1)
    _array(cells, "connectivity", grid.cells.ravel())
    _array(cells, "offsets", ends)
    _array(cells, "types", np.full(len(grid.cells), grid.cell_type, dtype=np.uint8))
    ET.indent(root)
    text = ET.tostring(root, xml_declaration=True, encoding="utf-8")

    def write(part: Path) -> None:
        part.write_bytes(text)

    return write_whole(path, write)


def _array(into: ET.Element, name: str, values: NDArray[np.generic], **others: str) -> None:
    kinds = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8"), "u": ("UInt8", "u1")}
    kind, form = kinds[values.dtype.kind]
    content = np.ascontiguousarray(values, dtype=form).tobytes()
    attributes = {"type": kind, "Name": name, "format": "binary", **others}
    if values.ndim > 1:
        attributes["NumberOfComponents"] = str(values.shape[1])
    length = np.array([len(content)], dtype="<u8").tobytes()
    element = ET.SubElement(into, "DataArray", attributes)
    element.text = base64.b64encode(length + content).decode("ascii")
