"""A rubber into the file of a finite element program."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from pathlib import Path
from typing import Any

from gripscale import checks
from gripscale.export.abaqus import abaqus_rubber
from gripscale.export.ansys import ansys_rubber
from gripscale.export.febio import febio_rubber
from gripscale.export.program_file import ProgramFile
from gripscale.rubber import Rubber

PROGRAMS: dict[str, Callable[..., ProgramFile]] = {
    "abaqus": abaqus_rubber,
    "ansys": ansys_rubber,
    "febio": febio_rubber,
}
"""Functions that turn a rubber into the input of a program."""


def write_rubber(rubber: Rubber, path: str | Path, *, to: str, **options: Any) -> ProgramFile:
    """Write a rubber for a finite element program; return what was written.

    Parameters
    ----------
    rubber : Rubber
        The rubber, at the temperature wanted (`Rubber.at`).
    path : str or Path
        The file.
    to : str
        abaqus, ansys or febio.
    options
        Those of `abaqus_rubber`, `ansys_rubber` and `febio_rubber`.

    Raises
    ------
    InputError
        If the program is unknown, does not take an option, or cannot carry the rubber.
    FileError
        If the file cannot be written.
    """
    made = PROGRAMS[checks.one_of("to", to, PROGRAMS)]
    taken = [name for name in signature(made).parameters if name != "rubber"]
    checks.known(f"option of {to}", options, taken)
    found = made(rubber, **options)
    found.write(path)
    return found
