"""What the commands that put things side by side share: names, the case of the rest, the end."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from gripscale.cli.terminal import NOT_CONVERGED, complain, say_all
from gripscale.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table


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


def keep(console: Console, path: Path, told: Sequence[Table], below: Sequence[str]) -> None:
    """Print tables with the sentences below them, and write both to `path`."""
    from gripscale.case import folder
    from gripscale.report import tables

    parts = [*told, *below]
    say_all(console, parts)
    folder.write_text(path, tables.as_text(*parts))


def fail_if_any(failed: Sequence[str], what: str) -> None:
    """Complain of what has no totals, with the reason of the first, and end the command."""
    if failed:
        complain(f"{len(failed)} of the {what} have no totals; the first: {failed[0]}")
        raise typer.Exit(NOT_CONVERGED)
