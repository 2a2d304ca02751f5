"""The results folder: checked before the long work, and cleared of an earlier run's results."""

from __future__ import annotations

import os
from pathlib import Path

from gripscale.errors import FileError
from gripscale.netcdf import write_whole

FIGURES = (
    "profile",
    "correlation",
    "master_curve",
    "contact_and_friction",
    "blocks_dynamic",
    "blocks_static",
    "heat",
    "effects",
    "superposition",
    "superposition_tests",
    "shift",
)
RESULTS = (
    "dynamic.nc",
    "static.nc",
    "effects_chain.nc",
    "report.txt",
    "case.toml",
    *(f"figures/{name}.{kind}" for name in FIGURES for kind in ("png", "pdf")),
)
"""Everything a run may write into its folder."""


def require_writable(folder: Path) -> None:
    """Raise `FileError` unless `folder` could be made and written; touch nothing."""
    there = folder
    while not there.exists() and there != there.parent:
        there = there.parent
    if not there.is_dir():
        raise FileError(f"output folder {folder} cannot be made: {there} is not a folder")
    if not os.access(there, os.W_OK | os.X_OK):
        raise FileError(f"output folder {folder} cannot be written: no permission for {there}")


def make(folder: Path) -> None:
    """Make `folder`; raise `FileError` if that fails."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _refusal(folder, error) from error


def prepare(folder: Path) -> None:
    """Make `folder` with its `figures`, and remove what an earlier run left under our names.

    Raises `FileError` if that fails.
    """
    make(folder / "figures")
    try:
        for name in RESULTS:
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise _refusal(folder, error) from error


def _refusal(folder: Path, error: OSError) -> FileError:
    return FileError(f"output folder {folder} cannot be written: {error.strerror or error}")


def write_text(path: Path, text: str) -> Path:
    """Write `text` as UTF-8 to `path`, completely or not at all."""
    return write_whole(path, lambda part: _write(part, text))


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")
