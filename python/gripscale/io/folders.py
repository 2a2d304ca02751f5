"""Folders of results: checked before the long work, and files written completely or not at all."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.core.errors import FileError
from gripscale.io.netcdf import write_whole

if TYPE_CHECKING:
    import pandas as pd


def require_writable(folder: Path) -> None:
    """Raise `FileError` unless `folder` could be made and written; touch nothing."""
    parent = next((step for step in (folder, *folder.parents) if step.exists()), folder)
    if not parent.is_dir():
        raise FileError(f"output folder {folder} cannot be made: {parent} is not a folder")
    if not os.access(parent, os.W_OK | os.X_OK):
        raise FileError(f"output folder {folder} cannot be written: no permission for {parent}")


def path_between(folder: Path, path: Path) -> str:
    """Return a path from a folder, or where none leads there, on another drive, the whole path."""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:
        return path.resolve().as_posix()


def make_folder(folder: Path) -> None:
    """Make `folder`; raise `FileError` if that fails."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(folder, error) from error


def unwritable(folder: Path, error: OSError) -> FileError:
    """Return the error that says why a folder cannot be written."""
    return FileError(f"output folder {folder} cannot be written: {error.strerror or error}")


def write_text(path: Path, text: str) -> Path:
    """Write `text` as UTF-8 to `path`, completely or not at all."""
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> Path:
    """Write `content` to `path`, completely or not at all."""
    return write_whole(path, lambda part: part.write_bytes(content))


def write_csv(table: pd.DataFrame, path: Path) -> Path:
    """Write a table as CSV: commas, points, UTF-8, all digits, empty cells for missing values."""
    return write_whole(path, lambda part: table.to_csv(part, index=False, lineterminator="\n"))
