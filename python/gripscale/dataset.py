"""A prediction as a labelled xarray Dataset, and its way to disk and back as netCDF."""

from __future__ import annotations

import math
import os
import platform
from collections.abc import Callable, Mapping, Sequence
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.errors import FileError

if TYPE_CHECKING:
    from gripscale.chain import Prediction
    from gripscale.scale import ScaleResult

LW = "Lind & Wangenheim 2014, IMECE2014-37998"
CHAIN = "gripscale chain"
SOLVER = "gripscale solver of one wave"

# name -> (attribute of ScaleResult, unit, long name, source)
_SCALE_COLUMNS: dict[str, tuple[str, str, str, str]] = {
    "wavelength": ("wavelength", "m", "wavelength", "input: sine waves of the surface"),
    "amplitude": ("amplitude", "m", "amplitude, half peak-to-valley", "input: sine waves"),
    "pressure_received": (
        "pressure_received",
        "Pa",
        "mean pressure on the wave",
        f"{LW}, equation 1",
    ),
    "load_time": ("load_time", "s", "time the wave is loaded", CHAIN),
    "contact_length": ("contact_length", "m", "contact length on the mean plane", SOLVER),
    "contact_fraction": ("contact_fraction", "1", "contact length over wavelength", SOLVER),
    "friction": ("friction", "1", "friction coefficient from the contact traction", SOLVER),
    "friction_from_dissipation": (
        "friction_from_dissipation",
        "1",
        "friction coefficient from the energy lost in the rubber",
        SOLVER,
    ),
    "min_stretch": ("min_stretch", "1", "smallest principal stretch", SOLVER),
    "max_stretch": ("max_stretch", "1", "largest principal stretch", SOLVER),
    "newton_iterations": ("newton_iterations", "1", "Newton iterations", SOLVER),
    "residual": ("residual", "1", "residual force over applied force", SOLVER),
}


def from_prediction(prediction: Prediction) -> xr.Dataset:
    """Return `prediction` as a Dataset over `scale`, contact pressure over `surface_node` too.

    Every variable carries `units`, `long_name` and `source`; the totals, the load and the
    versions of the software are attributes of the Dataset.
    """
    scales = prediction.scales
    data: dict[str, Any] = {}
    for name, (field, unit, long_name, source) in _SCALE_COLUMNS.items():
        values = np.array([getattr(scale, field) for scale in scales])
        data[name] = _labelled("scale", values, unit, long_name, source)
    data.update(_derived(prediction))
    data.update(_along_the_wave(scales))
    data["status"] = _labelled(
        "scale",
        np.array([scale.status for scale in scales], dtype=object),
        "1",
        "converged, or why not",
        SOLVER,
    )
    index = _labelled("scale", np.arange(1, len(scales) + 1), "1", "number of the wave", CHAIN)
    return xr.Dataset(data, coords={"scale": index}, attrs=_attributes(prediction))


def save(
    dataset: xr.Dataset, path: str | Path, groups: Mapping[str, xr.Dataset] | None = None
) -> Path:
    """Write `dataset` as netCDF (HDF5) to `path`, completely or not at all; return the path.

    Each of the named `groups` goes into the same file, as a group beside the root that holds
    `dataset`. Raises `FileError` if the file cannot be written.
    """

    def write(temporary: Path) -> None:
        dataset.to_netcdf(temporary, engine="h5netcdf")
        for name, group in (groups or {}).items():
            group.to_netcdf(temporary, engine="h5netcdf", mode="a", group=name)

    return write_whole(path, write)


def write_whole(path: str | Path, write: Callable[[Path], None]) -> Path:
    """Let `write` fill a temporary neighbour of `path`, then rename it into place.

    Raises `FileError` if either fails; a file that was there before is then untouched.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        if path.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        write(temporary)
        temporary.replace(path)
    except OSError as error:
        reason = error.strerror or str(error)
        raise FileError(f"{path} cannot be written: {reason}") from error
    finally:
        temporary.unlink(missing_ok=True)
    return path


def load(path: str | Path) -> xr.Dataset:
    """Read the Dataset `save` wrote at `path` into memory.

    Raises `FileError` if it does not exist or is not such a file.
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"result file {path} does not exist")
    try:
        return xr.load_dataset(path, engine="h5netcdf")
    except (OSError, ValueError, KeyError) as error:
        raise FileError(f"{path} cannot be read as a netCDF result: {error}") from error


def load_groups(path: str | Path) -> dict[str, xr.Dataset]:
    """Read the groups beside the Dataset that `save` wrote at `path` into memory, by name.

    Raises `FileError` as `load` does.
    """
    path = Path(path)
    if not path.is_file():
        raise FileError(f"result file {path} does not exist")
    try:
        opened = xr.open_groups(path, engine="h5netcdf")
    except (OSError, ValueError, KeyError) as error:
        raise FileError(f"{path} cannot be read as a netCDF result: {error}") from error
    groups = {}
    for place, group in opened.items():
        with group:
            if place != "/":
                groups[place.removeprefix("/")] = group.load()
    return groups


def versions() -> dict[str, str]:
    """Return the versions of gripscale and of what it computes with."""
    names = ("gripscale", "numpy", "scipy", "xarray")
    return {**{name: _version(name) for name in names}, "python": platform.python_version()}


def _version(name: str) -> str:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "unknown (not installed)"


def _derived(prediction: Prediction) -> dict[str, xr.DataArray]:
    """Return what the chain adds to the solver's numbers."""
    scales = prediction.scales
    slope = np.array([2.0 * math.pi * s.amplitude / s.wavelength for s in scales])
    moving = prediction.speed > 0.0
    mismatch = [s.friction_mismatch if moving else math.nan for s in scales]
    rubber = "input: rubber, at the fundamental frequency"
    rows: list[tuple[str, Any, str, str, str]] = [
        ("slope", slope, "1", "largest slope, 2 pi amplitude/wavelength", CHAIN),
        (
            "angular_frequency",
            prediction.angular_frequency,
            "rad/s",
            "fundamental excitation, 2 pi speed/wavelength",
            CHAIN,
        ),
        ("modulus", prediction.modulus, "Pa", "absolute complex Young's modulus", rubber),
        ("loss_factor", prediction.loss_factor, "1", "loss factor", rubber),
        (
            "outside_band",
            prediction.outside_band.astype(np.int8),
            "1",
            "1 where the wave excites the rubber outside the measured frequencies",
            rubber,
        ),
        (
            "running_contact_fraction",
            prediction.running_contact_fraction,
            "1",
            "real over nominal contact area down to the wave",
            f"{LW}, equation 2",
        ),
        (
            "running_friction",
            prediction.running_friction,
            "1",
            "friction coefficient down to the wave",
            f"{LW}, equation 3",
        ),
        (
            "friction_mismatch",
            mismatch,
            "1",
            "relative difference of the two friction coefficients, not stated when static",
            CHAIN,
        ),
    ]
    return {n: _labelled("scale", np.array(v), u, t, s) for n, v, u, t, s in rows}


def _along_the_wave(scales: Sequence[ScaleResult]) -> dict[str, xr.DataArray]:
    """Return abscissa and contact pressure of the surface nodes, padded with NaN."""
    dims = ("scale", "surface_node")
    x, pressure = _padded([s.x for s in scales]), _padded([s.pressure for s in scales])
    return {
        "surface_x": _labelled(dims, x, "m", "deformed abscissa, crest of the wave at 0", SOLVER),
        "surface_pressure": _labelled(dims, pressure, "Pa", "contact pressure", SOLVER),
    }


def _padded(rows: Sequence[NDArray[np.float64]]) -> NDArray[np.float64]:
    out = np.full((len(rows), max((len(row) for row in rows), default=0)), math.nan)
    for i, row in enumerate(rows):
        out[i, : len(row)] = row
    return out


def _labelled(dims: Any, values: Any, units: str, long_name: str, source: str) -> xr.DataArray:
    attrs = {"units": units, "long_name": long_name, "source": source}
    return xr.DataArray(values, dims=dims, attrs=attrs)


def _attributes(prediction: Prediction) -> dict[str, Any]:
    """Return totals, load and versions; numbers carry their unit in their name."""
    return {
        "title": "Real contact area and friction of rubber on a rough surface",
        "contact_fraction": prediction.contact_fraction,
        "friction": prediction.friction,
        "friction_from_dissipation": prediction.friction_from_dissipation,
        "converged": int(prediction.converged),
        "nominal_pressure_Pa": prediction.pressure,
        "sliding_speed_m_per_s": prediction.speed,
        "footprint_m": prediction.footprint,
        "rubber": f"{prediction.rubber.name}; {prediction.rubber.source}".strip("; "),
        "model": ", ".join(sorted({scale.model for scale in prediction.scales})),
        "method": f"{LW}, equations 1 to 3",
        **{f"version_{name}": version for name, version in versions().items()},
    }
