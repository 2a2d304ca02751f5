"""Datasets to disk and back as netCDF (HDF5), completely or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

from gripscale.errors import FileError
from gripscale.interrupts import held_back

if TYPE_CHECKING:
    import xarray as xr

ENGINE: Final = "netcdf4"


def save(
    data: xr.Dataset, path: str | Path, groups: Mapping[str, xr.Dataset] | None = None
) -> Path:
    """Write `data` to `path`, with the named `groups` beside it in the file; return the path.

    Raises `FileError` if the file cannot be written.
    """
    import xarray as xr

    def write(temporary: Path) -> None:
        if groups:
            tree = xr.DataTree.from_dict({"/": data, **groups})
            tree.to_netcdf(temporary, engine=ENGINE)
        else:
            data.to_netcdf(temporary, engine=ENGINE)

    with held_back():
        return write_whole(path, write)


def load(path: str | Path) -> xr.Dataset:
    """Read the Dataset `save` wrote at `path` into memory, without its groups.

    Raises `FileError` if it does not exist or is not such a file.
    """
    import xarray as xr

    place = _there(path)
    try:
        with held_back():
            return xr.load_dataset(place, engine=ENGINE)
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise FileError(f"{place} cannot be read as a netCDF result: {error}") from error


def load_tree(path: str | Path) -> xr.DataTree:
    """Read the Dataset `save` wrote at `path` with its groups into memory.

    Raises `FileError` as `load` does.
    """
    import xarray as xr

    place = _there(path)
    try:
        with held_back(), xr.open_datatree(place, engine=ENGINE) as tree:
            return tree.load()
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise FileError(f"{place} cannot be read as a netCDF result: {error}") from error


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


def _there(path: str | Path) -> Path:
    place = Path(path)
    if not place.is_file():
        raise FileError(f"result file {place} does not exist")
    return place
