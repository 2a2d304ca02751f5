"""Datasets to disk and back as netCDF (HDF5), completely or not at all.

A seal follows the end of the HDF5 data, the SHA-256 of all bytes before it, because HDF5 itself
does not notice a flipped bit of a number. A file without a seal, from elsewhere, is read as it is.
"""

from __future__ import annotations

import hashlib
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, BinaryIO, Final

from gripscale.core import FileError
from gripscale.core.parallel import held_back

if TYPE_CHECKING:
    import xarray as xr


ENGINE: Final = "netcdf4"
_SEAL: Final = b"\ngripscale sha256 "
_SEAL_LENGTH: Final = len(_SEAL) + 65
_PART: Final = 1 << 20


def save(
    data: xr.Dataset, path: str | Path, groups: Mapping[str, xr.Dataset] | None = None
) -> Path:
    """Write `data` and the named `groups` to the file at `path`; return the path.

    Raises `FileError` if the file cannot be written.
    """
    import xarray as xr

    def write(temporary: Path) -> None:
        # `to_netcdf` asks Dask, where it is installed, for a lock: seconds of imports
        lock = xr.backends.netCDF4_.NETCDF4_PYTHON_LOCK
        kind: Any = xr.backends.NetCDF4DataStore
        # arrays after all variables: HDF5 then leaves its define mode only once
        values: list[tuple[Any, Any]] = []
        writer = SimpleNamespace(add=lambda array, target: values.append((target, array)))
        with closing(kind.open(temporary, mode="w", lock=lock)) as store:
            data.dump_to_store(store, writer=writer)
            for name, group in (groups or {}).items():
                group.dump_to_store(store.get_child_store(name), writer=writer)
            for target, array in values:
                target[...] = array
        with temporary.open("r+b") as file:
            digest = _digest(file, temporary.stat().st_size)
            file.write(_SEAL + digest + b"\n")

    with held_back():
        return write_whole(path, write)


def load_dataset(path: str | Path) -> xr.Dataset:
    """Read the Dataset `save` wrote at `path` into memory, without its groups.

    Raises `FileError` if it does not exist, is not such a file or was damaged since.
    """
    import xarray as xr

    with _reading(path) as file:
        return xr.load_dataset(file, engine=ENGINE)


def load_tree(path: str | Path) -> xr.DataTree:
    """Read the Dataset `save` wrote at `path` with its groups into memory.

    Raises `FileError` as `load_dataset` does.
    """
    import xarray as xr

    with _reading(path) as file, xr.open_datatree(file, engine=ENGINE) as tree:
        return tree.load()


@contextmanager
def _reading(path: str | Path) -> Iterator[Path]:
    """Yield the path of an undamaged file; raise `FileError` if it is missing or unreadable."""
    path = Path(path)
    if path.is_dir():
        names = ", ".join(sorted(file.name for file in path.glob("[!.]*.nc"))) or "none is there"
        raise FileError(f"{path} is a folder; expected one of its result files: {names}")
    if not path.is_file():
        raise FileError(f"result file {path} does not exist")
    if path.suffix.lower() == ".toml":
        raise FileError(
            f"{path} is a case, not a result: `gripscale run` solves it; then name its results "
            "folder, or a .nc file in it"
        )
    try:
        with path.open("rb") as file:
            whole = _is_whole(file)
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}") from error
    if not whole:
        raise FileError(f"{path} cannot be read as a netCDF result: damaged since it was written")
    try:
        with held_back():
            yield path
    except (OSError, ValueError, KeyError, RuntimeError) as error:
        with path.open("rb") as file:
            understood = file.read(8).startswith((_HDF5, b"CDF"))
        reason = error if understood else "it is of another format"
        raise FileError(f"{path} cannot be read as a netCDF result: {reason}") from error


# What a file of HDF5, and so of netCDF-4, begins with; one of netCDF-3 begins with CDF.
_HDF5 = b"\x89HDF\r\n\x1a\n"
_FULL = 2**16  # free bytes below which a disk counts as full: a file system keeps some for itself


def write_whole(path: str | Path, write: Callable[[Path], object]) -> Path:
    """Let `write` fill a temporary neighbour of `path`, then rename it into place.

    Raises `FileError` if either fails; an existing file is then untouched.
    """
    path = Path(path)
    temporary = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        if path.is_dir():
            raise IsADirectoryError(21, "it is a folder")
        write(temporary)
        temporary.replace(path)
    except Exception as error:
        # libraries turn a full disk into errors of their own
        full = path.parent.is_dir() and shutil.disk_usage(path.parent).free < _FULL
        if not full and not isinstance(error, OSError):
            raise
        reason = "the disk is full" if full else getattr(error, "strerror", None) or str(error)
        raise FileError(f"{path} cannot be written: {reason}") from error
    finally:
        temporary.unlink(missing_ok=True)
    return path


def _is_whole(file: BinaryIO) -> bool:
    """Return whether a file has its right seal, or ends where HDF5 states its end.

    The end is the end-of-file address in a superblock of version 2 or 3 with eight bytes an
    address, as this package writes it: HDF5 File Format Specification 3.0, section II.A.
    """
    length = file.seek(0, os.SEEK_END)
    file.seek(max(length - _SEAL_LENGTH, 0))
    seal = file.read()
    if seal.startswith(_SEAL):
        return seal == _SEAL + _digest(file, length - _SEAL_LENGTH) + b"\n"
    file.seek(0)
    head = file.read(36)
    if not head.startswith(_HDF5) or head[8:9] not in (b"\x02", b"\x03"):
        return True
    return not 0 < int.from_bytes(head[28:36], "little") < length


def _digest(file: BinaryIO, length: int) -> bytes:
    """Return the SHA-256 of the first `length` bytes in hexadecimal; the file stays after them."""
    file.seek(0)
    digest = hashlib.sha256()
    while length > 0 and (part := file.read(min(length, _PART))):
        digest.update(part)
        length -= len(part)
    return digest.hexdigest().encode()
