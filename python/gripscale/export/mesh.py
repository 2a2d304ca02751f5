"""The deformed block of a wave, with pressure and stress, as a VTU file.

The mesh follows from columns, rows, depth and order of the elements as in the kernel: rows h_0 q^r
high, h_0 = min(width of an element, depth/rows), whose heights sum up to the depth. The stress is

    P = J^(-2/3) (F H - 1/3 (H : C) F^-T) + p J F^-T,   sigma = P F^T / J
    H = G_inf b + (G(t) - G_inf) 1 + T^-1{ (G(t) - G*(w_k)) T{Y} },   Y = J^(2/3) C^-1

with the letters of docs/export.md (Lubliner, Mech. Res. Commun. 12 (1985) 93; Holzapfel, Nonlinear
Solid Mechanics (2000), section 6.4). VTK User's Guide, 11th ed. (2010), section 19.3.
"""

from __future__ import annotations

import base64
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.core import Array, InputError, checks
from gripscale.io.folders import write_bytes
from gripscale.io.text_table import file_path
from gripscale.wave import ScaleResult
from gripscale.wave.result import EQUILIBRIUM, waves_from_dataset


@dataclass(frozen=True)
class ReferenceBlock:
    """The undeformed mesh of a wave."""

    wavelength: float
    depth: float  # height of the block [m]
    columns: int
    rows: int
    order: int

    @classmethod
    def of(cls, result: ScaleResult) -> ReferenceBlock:
        """Return the mesh on which a wave was solved; `InputError` if its solver has none."""
        names = ("columns", "rows", "depth", "element_order")
        if result.deformed_mesh is None or not set(names) <= set(result.details):
            raise InputError(
                f"result must be of the finite-strain block, which has a mesh; got {result.model}"
            )
        columns, rows, depth, order = (result.details[name] for name in names)
        whole = (int(columns), int(rows), int(order))
        block = cls(result.wavelength, depth * result.wavelength, *whole)
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
        first, row = min(self.width, self.depth / self.rows), np.arange(self.rows)
        # bisection for q with sum q^r = depth/first, q >= 1
        low, high = 1.0, 1.0 + self.depth / first
        for _ in range(200):
            middle = 0.5 * (low + high)
            if (middle**row).sum() < self.depth / first:
                low = middle
            else:
                high = middle
        heights = first * low**row
        return np.asarray(heights * (self.depth / heights.sum()))

    def nodes(self) -> tuple[Array, Array]:
        """Return x and z of the nodes [m], shape (layers, nodes); z = 0 on the surface."""
        x = np.linspace(0.0, self.wavelength, self.shape[1])
        parts = np.repeat(self.heights / self.order, self.order)
        z = np.concatenate([[0.0], np.cumsum(parts)])
        along, up = np.meshgrid(x, z)
        return along, up

    def slopes(self, values: Array) -> Array:
        """Return d/dx and d/dz of nodal values at the Gauss points, shape (rows, ..., along, 2)."""
        local = self.elements(values)
        shape, slope = lagrange(self.order)
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
        constant = np.ones((self.order + 1, self.order + 1))
        linear = [constant * point[None, :], constant * point[:, None]]
        return np.stack([constant, *(linear if self.order == 2 else [])])


def lagrange(order: int) -> tuple[Array, Array]:
    """Return Lagrange functions and their derivatives at the Gauss points, (points, nodes) each."""
    s, _ = np.polynomial.legendre.leggauss(order + 1)
    if order == 1:
        shape = [0.5 * (1.0 - s), 0.5 * (1.0 + s)]
        slope = [np.full_like(s, -0.5), np.full_like(s, 0.5)]
    else:
        shape = [0.5 * s * (s - 1.0), 1.0 - s * s, 0.5 * s * (s + 1.0)]
        slope = [s - 0.5, -2.0 * s, s + 0.5]
    return np.stack(shape, axis=1), np.stack(slope, axis=1)


@dataclass(frozen=True)
class BlockStress:
    """Deformation and stress at the Gauss points of the block.

    Axes are element rows, contact surface first, columns, points across and points along an
    element.
    """

    block: ReferenceBlock = field(repr=False)
    gradient: Array = field(repr=False)
    """F, shape (rows, columns, across, along, 2, 2), components (x, z)."""
    pressure: Array = field(repr=False)
    """Volumetric stress p [Pa], positive in tension, shape (rows, columns, across, along)."""
    cauchy: Array = field(repr=False)
    """sigma [Pa], shape (..., 3, 3), components (x, y, z); y is across the plane of strain."""

    @property
    def jacobian(self) -> Array:
        """J = det F, shape (rows, columns, across, along)."""
        return np.asarray(np.linalg.det(self.gradient))

    def element_mean(self, values: Array) -> Array:
        """Return the mean of values at the points over each deformed element, (rows, columns)."""
        volume = self.block.weights * self.jacobian
        extra = (None,) * (values.ndim - 4)
        total = (volume[(..., *extra)] * values).sum(axis=(2, 3))
        return np.asarray(total / volume.sum(axis=(2, 3))[(..., *extra)])


def block_stress(result: ScaleResult) -> BlockStress:
    """Return the stress in the block of a wave, by the material law in its deformed mesh.

    The `result` is of the finite-strain block, solved or read from a file. Raises `InputError` if
    it has no mesh or no rubber, or is not in equilibrium.
    """
    checks.instance("result", result, ScaleResult)
    block, rubber = ReferenceBlock.of(result), result.rubber
    if result.status not in EQUILIBRIUM or rubber is None or result.deformed_mesh is None:
        raise InputError(
            "result must be in equilibrium and have its rubber for the stress to be known; got a "
            f"wave with status {result.status}"
        )
    gradient = np.stack([block.slopes(values) for values in result.deformed_mesh], axis=-2)
    volume = np.linalg.det(gradient)
    # p = K (J - 1) projected on the pressure modes of each element
    modes, weights = block.modes(), block.weights
    change = np.einsum("rcpq,rcpq,mpq->rcm", *np.broadcast_arrays(weights, volume - 1.0), modes)
    mass = np.einsum("rcpq,mpq->rcm", weights, modes**2)
    pressure = np.asarray(rubber.bulk_modulus * np.einsum("rcm,mpq->rcpq", change / mass, modes))
    full = np.zeros((*gradient.shape[:-2], 3, 3))  # F with components (x, y, z), plane strain
    full[..., 1, 1] = 1.0
    full[..., ::2, ::2] = gradient
    factor = (volume ** (-2.0 / 3.0))[..., None, None]
    isochoric = factor * (np.swapaxes(full, -1, -2) @ full)
    # the permanent network, G_inf b with b = w1 1 + w2 (I1 1 - Cbar)
    first = np.trace(isochoric, axis1=-2, axis2=-1)
    second = 0.5 * (first**2 - np.einsum("...ij,...ij->...", isochoric, isochoric))
    w1, w2 = rubber.strain_energy.slopes(first - 3.0, second - 3.0)
    b = (w1 + w2 * first)[..., None, None] * np.eye(3) - w2[..., None, None] * isochoric
    history = rubber.equilibrium_shear_modulus * b
    if result.speed > 0.0 and len(rubber.moduli):
        # the temporary networks, from Y = Cbar^-1 along the lines of points
        inverse = np.linalg.inv(isochoric)
        columns = inverse.shape[1]
        omega = result.angular_frequency * np.arange(1, columns // 2 + 1)
        mean = float(rubber.relaxation_modulus(result.load_time)) / 3.0
        transfer = np.zeros(columns // 2 + 1, dtype=complex)
        transfer[1:] = mean - rubber.complex_modulus(omega) / 3.0
        harmonics = np.fft.rfft(inverse, axis=1) * transfer[:, None, None, None, None]
        frozen = mean - rubber.equilibrium_shear_modulus
        history = history + (np.fft.irfft(harmonics, columns, axis=1) + frozen * np.eye(3))
    pushed = factor * (full @ history @ np.swapaxes(full, -1, -2))
    trace = np.trace(pushed, axis1=-2, axis2=-1)[..., None, None]
    deviator = (pushed - trace / 3.0 * np.eye(3)) / volume[..., None, None]
    return BlockStress(block, gradient, pressure, deviator + pressure[..., None, None] * np.eye(3))


# VTK's numbers of the bilinear and the biquadratic quadrilateral, by their points.
CELL_TYPES = {4: 9, 9: 28}


def write_vtu(
    path: Path,
    points: Array,
    cells: NDArray[np.int64],
    data: Mapping[str, Mapping[str, Array]],
    numbers: Mapping[str, float],
) -> Path:
    """Write quadrilaterals; `cells` are numbers of points in VTK's order, (cells, points of each).

    `data` holds fields by name of `PointData` and `CellData`, `numbers` those of the whole grid.
    """
    form = {"version": "1.0", "byte_order": "LittleEndian", "header_type": "UInt64"}
    root = ET.Element("VTKFile", {"type": "UnstructuredGrid", **form})
    whole = ET.SubElement(root, "UnstructuredGrid")
    part = ET.SubElement(whole, "FieldData")
    for name, value in numbers.items():
        _array(part, name, np.array([value]), NumberOfTuples="1")
    counts = {"NumberOfPoints": len(points), "NumberOfCells": len(cells)}
    piece = ET.SubElement(whole, "Piece", {name: str(count) for name, count in counts.items()})
    for tag, fields in data.items():
        part = ET.SubElement(piece, tag)
        for name, values in fields.items():
            _array(part, name, values)
    _array(ET.SubElement(piece, "Points"), "Points", points)
    part = ET.SubElement(piece, "Cells")
    count, corners = cells.shape
    _array(part, "connectivity", cells.ravel())
    _array(part, "offsets", corners * np.arange(1, count + 1))
    _array(part, "types", np.full(count, CELL_TYPES[corners], dtype=np.uint8))
    ET.indent(root)
    return write_bytes(path, ET.tostring(root, xml_declaration=True, encoding="utf-8"))


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


def write_mesh(result: ScaleResult, path: str | Path) -> Path:
    """Write the deformed block of a wave as VTU to `path`; return the path.

    Coordinates are those of gripscale, in m: x along the sliding, z up, y = 0. Points are the
    deformed nodes, with `displacement` [m] and `contact_pressure` [Pa], zero outside the contact.
    Cells, bilinear or biquadratic as solved, carry means over the deformed element: `stress` [Pa],
    positive in tension, as xx, xy, ... zz, `pressure` [Pa], `volume_ratio` [-] (docs/export.md).

    The `result` is of the finite-strain block, solved or read from a file. If it is not in
    equilibrium (its status is neither converged nor that of a missed accuracy), cells have no data.
    Raises `InputError` if it has no mesh, `FileError` if the file cannot be written.
    """
    checks.instance("result", result, ScaleResult)
    block = ReferenceBlock.of(result)
    assert result.deformed_mesh is not None
    x, z = result.deformed_mesh
    rest_x, rest_z = block.nodes()
    contact_pressure = np.zeros(block.shape)
    contact_pressure[0] = np.append(result.pressure, result.pressure[0])
    cell_data = {}
    if result.status in EQUILIBRIUM and result.rubber is not None:
        solved = block_stress(result)
        stress, weights = solved.element_mean(solved.cauchy), block.weights
        areas = (weights * solved.jacobian).sum(axis=(2, 3))
        cell_data = {
            "stress": stress.reshape(-1, 9),
            "pressure": -np.trace(stress, axis1=-2, axis2=-1).ravel() / 3.0,
            "volume_ratio": (areas / weights.sum(axis=(2, 3))).ravel(),
        }
    point_data = {
        "displacement": _vectors(x - rest_x, z - rest_z),
        "contact_pressure": contact_pressure.ravel(),
    }
    data = {"PointData": point_data, "CellData": cell_data}
    names = ("wavelength", "amplitude", "pressure_received", "speed", "load_time")
    numbers = {n: float(getattr(result, n)) for n in (*names, "contact_fraction", "friction")}
    return write_vtu(file_path(path), _vectors(x, z), element_nodes(block), data, numbers)


def wave_of(data: xr.Dataset, number: int) -> ScaleResult:
    """Return wave `number`, from 1, of a prediction, or that profile of blocks on profiles.

    Raises `InputError` if the prediction has no meshes, or not so many.
    """
    checks.instance("data", data, xr.Dataset)
    mesh = data.get("mesh_x")
    if mesh is None or mesh.ndim != 3:
        raise InputError(
            "data must be a prediction with meshes, as waves solved by the finite-strain block "
            f"give it; got one of {data.attrs.get('model', 'no model')} without"
        )
    along = str(mesh.dims[0])
    index = checks.whole("wave", number, least=1, most=data.sizes[along]) - 1
    (wave,) = waves_from_dataset(data.isel({along: [index]}).rename({along: "scale"}))
    return wave


def element_nodes(block: ReferenceBlock) -> NDArray[np.int64]:
    """Return the points of each element in VTK's order, row by row from the contact surface."""
    layers, nodes = block.shape
    number = np.arange(layers * nodes).reshape(layers, nodes).astype(float)
    local = block.elements(number).astype(np.int64)
    last = block.order
    # anticlockwise with x to the right and z up; then the middles of the edges, then the centre
    corners = [(0, 0), (0, last), (last, last), (last, 0)]
    inner = [(0, 1), (1, 2), (2, 1), (1, 0), (1, 1)] if last == 2 else []
    points = [local[..., layer, node].ravel() for layer, node in corners + inner]
    return np.stack(points, axis=1)


def _vectors(x: Array, z: Array) -> Array:
    return np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
