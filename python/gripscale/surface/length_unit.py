"""The unit of length of a measurement: stated by its file or given by the caller, never guessed."""

from __future__ import annotations

from pathlib import Path

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.units import in_si, spelled


def length_unit(
    path: Path, part: str, stated: object, name: str, given: str | None, *, how: str = "give"
) -> str:
    """Return the unit of a `part` of a file.

    Parameters
    ----------
    path : pathlib.Path
        The file, and `part` ("column 1") of it, for messages.
    stated : object
        What the file says the unit is.
    name, given : str, str or None
        The argument with the caller's unit.
    how : str
        How to make up for a missing unit, before `name`.

    Raises
    ------
    FileError
        If neither the file nor the caller names a unit of length.
    InputError
        If the caller's unit is unknown or contradicts the file.
    """
    found = spelled(stated, "length")
    if given is not None:
        if found is not None and in_si(1.0, found, "length") != in_si(1.0, given, "length", name):
            raise InputError(f"{name} is {given!r}, but {path} says {found!r}; give one of them")
        return given
    if found is not None:
        return found
    if stated:
        raise FileError(
            f"{path}: {part} is in {checks.shown(stated)}, which is no known unit of "
            f"length; give {name}"
        )
    raise FileError(f"{path}: {part} names no unit of length; {how} {name}")
