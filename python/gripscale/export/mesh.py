"""The deformed block of a wave, with pressure and stress, as a VTU file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import InputError
from gripscale.export.reference_block import ReferenceBlock
from gripscale.export.stress import EQUILIBRIUM, block_stress
from gripscale.export.vtu import BIQUADRATIC_QUAD, QUAD, Grid, write_vtu
from gripscale.textfile import file_path
from gripscale.wave import WaveResult
from gripscale.wave.dataset import waves_from_dataset

Array = NDArray[np.float64]

NUMBERS = (
    "wavelength",
    "amplitude",
    "pressure_received",
    "speed",
    "load_time",
    "contact_fraction",
    "friction",
)
"""What of the wave stands in the field data, all in SI units."""


def write_mesh(result: WaveResult, path: str | Path) -> Path:
    """Write the deformed block of a wave as VTU; return the path.

    Coordinates are those of gripscale, in m: x along the sliding, z up, y = 0. Points are the
    deformed nodes, with

    - `displacement` [m], from the block at rest with its surface on the mean plane; its mean along
      the surface is zero in x,
    - `contact_pressure` [Pa], zero wherever nothing touches: in the block and on its other sides as
      well, so that filters that integrate or scale meet no missing numbers.

    Cells, bilinear or biquadratic as solved, carry the means over the deformed element of

    - `stress` [Pa], the Cauchy stress, positive in tension, as nine components xx, xy, ... zz,
    - `pressure` [Pa], less a third of its trace,
    - `volume_ratio` [-], J.

    Parameters
    ----------
    result : WaveResult
        Of the finite-strain block, solved or read from a file. Where it is not in equilibrium, its
        status being neither converged nor that of an accuracy missed, the cells carry nothing.
    path : str or Path
        The file.

    Raises
    ------
    InputError
        If the wave has no mesh.
    FileError
        If the file cannot be written.
    """
    checks.instance("result", result, WaveResult)
    block = ReferenceBlock.of(result)
    assert result.deformed_mesh is not None
    grid = Grid(
        points=_vectors(*result.deformed_mesh),
        cells=cells_of(block),
        cell_type=QUAD if block.order == 1 else BIQUADRATIC_QUAD,
        point_data={
            "displacement": _displacement(block, result.deformed_mesh),
            "contact_pressure": _contact_pressure(block, result.pressure),
        },
        cell_data=_cell_data(result),
        field_data={name: float(getattr(result, name)) for name in NUMBERS},
    )
    return write_vtu(grid, file_path(path))


def wave_of(data: xr.Dataset, number: int) -> WaveResult:
    """Return wave `number`, from 1, of a prediction; of blocks on profiles that profile.

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
    place = checks.whole("wave", number, least=1, most=data.sizes[along]) - 1
    (wave,) = waves_from_dataset(data.isel({along: [place]}).rename({along: "scale"}))
    return wave


def cells_of(block: ReferenceBlock) -> NDArray[np.int64]:
    """Return the points of each element in VTK's order, row by row from the contact surface.

    Corners anticlockwise with x to the right and z up, then the middles of the edges in the same
    order, then the centre.
    """
    layers, nodes = block.shape
    number = np.arange(layers * nodes).reshape(layers, nodes).astype(float)
    local = block.elements(number).astype(np.int64)
    last = block.order
    corners = [(0, 0), (0, last), (last, last), (last, 0)]
    inner = [(0, 1), (1, 2), (2, 1), (1, 0), (1, 1)] if last == 2 else []
    points = [local[..., layer, node].ravel() for layer, node in corners + inner]
    return np.stack(points, axis=1)


def _vectors(x: Array, z: Array) -> Array:
    return np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)


def _displacement(block: ReferenceBlock, deformed: tuple[Array, Array]) -> Array:
    x, z = block.nodes()
    return _vectors(deformed[0] - x, deformed[1] - z)


def _contact_pressure(block: ReferenceBlock, pressure: Array) -> Array:
    out = np.zeros(block.shape)
    out[0, :-1] = pressure
    out[0, -1] = pressure[0]
    return out.ravel()


def _cell_data(result: WaveResult) -> dict[str, Array]:
    if result.status not in EQUILIBRIUM or result.rubber is None:
        return {}
    found = block_stress(result)
    stress = found.element_mean(found.cauchy)
    cells = stress.shape[0] * stress.shape[1]
    return {
        "stress": stress.reshape(cells, 9),
        "pressure": -np.trace(stress, axis1=-2, axis2=-1).ravel() / 3.0,
        "volume_ratio": _volume_ratio(found.block, found.jacobian),
    }


def _volume_ratio(block: ReferenceBlock, jacobian: Array) -> Array:
    """Return the deformed over the undeformed area of each element."""
    weights = np.broadcast_to(block.weights, jacobian.shape)
    ratio = (weights * jacobian).sum(axis=(2, 3)) / weights.sum(axis=(2, 3))
    return np.asarray(ratio.ravel())
