"""Finished predictions on disk: one small netCDF file each, named by the key of its task.

A file is written beside its place and renamed into it, so a file that is there is whole. One that
cannot be read back all the same (a disk that was full, a power cut) counts as not there.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr

from gripscale import netcdf
from gripscale.errors import FileError

PREDICTIONS = "predictions"
"""Folder of the finished predictions, in the folder of a result."""


class Store:
    """A folder of finished predictions.

    Parameters
    ----------
    folder
        Made if it is not there.

    Raises
    ------
    FileError
        If the folder cannot be made.
    """

    def __init__(self, folder: str | Path) -> None:
        self.folder = Path(folder)
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            reason = error.strerror or error
            raise FileError(f"folder {self.folder} cannot be made: {reason}") from error

    def path(self, key: str) -> Path:
        """Return where the prediction of `key` is, or would be."""
        return self.folder / f"{key}.nc"

    def get(self, key: str) -> xr.Dataset | None:
        """Return the prediction of `key`, or None if it is not there whole."""
        try:
            found = netcdf.load(self.path(key))
        except FileError:
            return None
        return found if found.attrs.get("prediction_key") == key else None

    def put(self, key: str, solved: xr.Dataset) -> xr.Dataset:
        """Write the prediction of `key` and return it as read back.

        Raises `FileError` if it cannot be written.
        """
        return netcdf.load(netcdf.save(solved, self.path(key)))


@contextmanager
def store_in(folder: str | Path | None) -> Iterator[Store]:
    """Give the store in the folder of a result or, without one, one that is forgotten afterwards.

    Raises `FileError` if it cannot be made.
    """
    if folder is not None:
        yield Store(Path(folder) / PREDICTIONS)
        return
    with TemporaryDirectory(prefix="gripscale-") as forgotten:
        yield Store(forgotten)
