"""What the commands that put things side by side share: their names, and the case of the rest."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from gripscale.errors import InputError


def case_of(given: Sequence[str], case: Path | None, what: str) -> Path:
    """Return the case the rest is taken from: the one stated, or the first of those given.

    Raises `InputError` if there is none; `what` is taken from it.
    """
    chosen = case or next((Path(one) for one in given if one.endswith(".toml")), None)
    if chosen is None:
        raise InputError(f"--case must be given: {what} are taken from a case")
    return chosen


def names_of(given: Sequence[str]) -> list[str]:
    """Return what is put on the table: files, cases by their folder, each name once."""
    names: list[str] = []
    for one in given:
        path = Path(one)
        name = path.resolve().parent.name if path.name == "case.toml" else path.stem
        count = sum(known == name or known.startswith(f"{name} ") for known in names)
        names.append(f"{name} {count + 1}" if count else name)
    return names
