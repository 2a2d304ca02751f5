"""Datasets to disk and back as netCDF (HDF5), completely or not at all.

Behind the end of what HDF5 reads stands a seal, the SHA-256 of all before it: HDF5 itself takes a
flipped bit of a number for a number. A file without one, from elsewhere, is read as it is.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, Final

from gripscale.core.errors import FileError
from gripscale.core.parallel import held_back

if TYPE_CHECKING:
    import xarray as xr


ENGINE: Final = "netcdf4"

_SEAL: Final = b"\ngripscale sha256 "
_SEAL_LENGTH: Final = len(_SEAL) + 65
_PART: Final = 1 << 20
"""Bytes read at once."""

RENAMED: Final = {
    "storage_factor": "storage_modulus_ratio",
    "loss_factor_left": "loss_modulus_ratio",
    "beyond_sweep": "strain_extrapolated",
    "beyond_shift": "temperature_extrapolated",
    "rubber_beyond_shift": "rubber_temperature_extrapolated",
    "warming_uniform": "flash_temperature_rise_uniform",
    "warming_larger_waves": "flash_temperature_rise_larger_waves",
    "warming_own": "flash_temperature_rise_own",
}
"""Variables by their names in files of version 0.1; a file is read with the new names."""


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
        _seal(temporary)

    with held_back():
        return write_whole(path, write)


def load(path: str | Path) -> xr.Dataset:
    """Read the Dataset `save` wrote at `path` into memory, without its groups.

    Raises `FileError` if it does not exist, is not such a file or was damaged since.
    """
    import xarray as xr

    place = _there(path)
    try:
        with held_back():
            return _with_new_names(xr.load_dataset(place, engine=ENGINE))
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
            tree.load()
            # A node that got another dataset would no longer be closed with the tree.
            nodes = {node.path: node.to_dataset(inherit=False) for node in tree.subtree}
            return xr.DataTree.from_dict(
                {path: _with_new_names(data) for path, data in nodes.items()}
            )
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        raise FileError(f"{place} cannot be read as a netCDF result: {error}") from error


def _with_new_names(data: xr.Dataset) -> xr.Dataset:
    return data.rename({name: RENAMED[name] for name in RENAMED if name in data.data_vars})


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
    """Return the path of a file that is there, and whole as far as it tells."""
    place = Path(path)
    if not place.is_file():
        raise FileError(f"result file {place} does not exist")
    try:
        with place.open("rb") as file:
            whole = _is_whole(file)
    except OSError as error:
        raise FileError(f"{place} cannot be read: {error.strerror or error}") from error
    if not whole:
        raise FileError(f"{place} cannot be read as a netCDF result: damaged since it was written")
    return place


def _seal(path: Path) -> None:
    with path.open("r+b") as file:
        digest = _digest(file, path.stat().st_size)
        file.write(_SEAL + digest + b"\n")


def _is_whole(file: BinaryIO) -> bool:
    """Return whether a file has its right seal, or nothing behind its end as HDF5 states it."""
    length = file.seek(0, os.SEEK_END)
    file.seek(max(length - _SEAL_LENGTH, 0))
    seal = file.read()
    if seal.startswith(_SEAL):
        return seal == _SEAL + _digest(file, length - _SEAL_LENGTH) + b"\n"
    return not 0 < _stated_end(file) < length


def _stated_end(file: BinaryIO) -> int:
    """Return where HDF5 says the file ends, 0 where it does not in the way this package writes.

    Superblock of version 2 or 3, with eight bytes an address: HDF5 File Format Specification 3.0,
    section II.A.
    """
    file.seek(0)
    head = file.read(36)
    known = head.startswith(b"\x89HDF\r\n\x1a\n") and head[8:9] in (b"\x02", b"\x03")
    return int.from_bytes(head[28:36], "little") if known else 0


def _digest(file: BinaryIO, length: int) -> bytes:
    """Return the SHA-256 of the first `length` bytes in hexadecimal, the file being left there."""
    file.seek(0)
    found = hashlib.sha256()
    while length > 0 and (part := file.read(min(length, _PART))):
        found.update(part)
        length -= len(part)
    return found.hexdigest().encode()
