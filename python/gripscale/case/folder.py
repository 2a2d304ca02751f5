"""The results folder: checked before the long work, and cleared of an earlier run's results.

Only files with the names of results, and copies that the saved case names, are ever removed.
"""

from __future__ import annotations

import os
import time
from collections.abc import Collection
from pathlib import Path

from gripscale.case.read import CaseFile
from gripscale.case.saved import CASE, INPUTS, SavedCase, saved_case, saved_inputs
from gripscale.errors import FileError
from gripscale.netcdf import write_whole

FIGURES = (
    "profile",
    "correlation",
    "master_curve",
    "contact_and_friction",
    "blocks_dynamic",
    "blocks_static",
)
AT_TIMES = ("heat", "effects", "superposition", "superposition_tests", "shift")
"""Figures of cases with conditions, or with sweeps at several temperatures."""
RESULTS = (
    "dynamic.nc",
    "static.nc",
    "direct.nc",
    "effects_chain.nc",
    "report.txt",
    CASE,
    *(f"figures/{name}.{kind}" for name in (*FIGURES, *AT_TIMES) for kind in ("png", "pdf")),
)
"""Everything a run may write into its folder, beside copies of the files the case names."""


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


def earlier_run(folder: Path, keep: Collection[str] = ()) -> str:
    """Return a sentence on what an earlier run left in `folder` but for `keep`, or nothing."""
    replaced = [name for name in RESULTS if (folder / name).exists() and name not in keep]
    if not replaced:
        return ""
    newest = max((folder / name).stat().st_mtime for name in replaced)
    when = time.strftime("%Y-%m-%d %H:%M", time.localtime(newest))
    files = "1 file" if len(replaced) == 1 else f"{len(replaced)} files"
    return f"Replaces {files} of an earlier run, of {when}, in {folder}."


def prepare(folder: Path, file: CaseFile, keep: Collection[str] = ()) -> None:
    """Make `folder`, remove what an earlier run left but for `keep`, and save the case in it.

    Raises `FileError` if that fails, or a file that the case names cannot be read.
    """
    saved = saved_case(file, folder)
    make(folder / "figures")
    try:
        for name in {*RESULTS, *saved_inputs(folder)} - {*keep, *saved.copies, CASE}:
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise _refusal(folder, error) from error
    _save(saved, folder)


def save_case(file: CaseFile, folder: Path) -> None:
    """Save the case in `folder` with copies of its files, so that it runs from there.

    Raises `FileError` if one cannot be read or written.
    """
    _save(saved_case(file, folder), folder)


def _save(saved: SavedCase, folder: Path) -> None:
    if saved.copies:
        make(folder / INPUTS)
    for place, content in saved.copies.items():
        write_bytes(folder / place, content)
    write_text(folder / CASE, saved.text)


def _refusal(folder: Path, error: OSError) -> FileError:
    return FileError(f"output folder {folder} cannot be written: {error.strerror or error}")


def write_text(path: Path, text: str) -> Path:
    """Write `text` as UTF-8 to `path`, completely or not at all."""
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: Path, content: bytes) -> Path:
    """Write `content` to `path`, completely or not at all."""
    return write_whole(path, lambda part: _write(part, content))


def _write(path: Path, content: bytes) -> None:
    path.write_bytes(content)
