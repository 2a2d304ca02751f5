"""The uncertainty that was sampled of a case, found again beside its other results."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale import netcdf
from gripscale.case.read import CaseFile
from gripscale.errors import FileError
from gripscale.study.inputs import digest

FOLDER, RESULT = "uncertainty", "uncertainty.nc"
"""Where it is in the results folder of the case."""

NO_INPUTS = ("uncertainty", "measured", "output", "compare")
"""Tables of a case that change no prediction of it."""

FILES = "file_sha256"
"""Attribute of the result: digests of the files the case names, as JSON."""


def stored_uncertainty(results: Path) -> xr.Dataset | None:
    """Return the uncertainty in the results folder of a case, or None if there is none whole."""
    try:
        return netcdf.load(results / FOLDER / RESULT)
    except FileError:
        return None


def input_digests(file: CaseFile) -> list[str]:
    """Return the digests of the files that predictions of a case depend on.

    Raises `FileError` if one cannot be read.
    """
    named = [name for role, name in file.case.named_files() if role != "measured"]
    return [digest(file.resolve(name)) for name in named]


def of_same_inputs(data: xr.Dataset, text: str, digests: Iterable[str] | None = None) -> bool:
    """Return whether uncertainty `data` is of a case with these inputs.

    Parameters
    ----------
    data
        Of `gripscale.uncertainty.propagate`.
    text
        The case file.
    digests
        Of the files it names; None where they are not known.
    """
    if _inputs(str(data.attrs.get("case", ""))) != _inputs(text):
        return False
    return digests is None or sorted(json.loads(data.attrs.get(FILES, "[]"))) == sorted(digests)


def _inputs(text: str) -> dict[str, Any] | None:
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None
    return {name: table for name, table in tables.items() if name not in NO_INPUTS}
