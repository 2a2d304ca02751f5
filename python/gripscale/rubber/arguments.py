"""Arguments of what reads and shifts sweeps: of the right kind, or refused in a sentence."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

from gripscale import checks
from gripscale.errors import InputError

Kind = TypeVar("Kind")


def instance(name: str, value: Any, kind: type[Kind]) -> Kind:
    """Return `value`; raise `InputError` unless it is one of `kind`."""
    if not isinstance(value, kind):
        raise InputError(f"{name} must be of the kind {kind.__name__}; got {checks.shown(value)}")
    return value


def file_path(value: Any) -> Path:
    """Return a path; raise `InputError` if `value` cannot be one."""
    if not isinstance(value, str | os.PathLike):
        raise InputError(f"path must be the path of a file; got {checks.shown(value)}")
    return Path(value)


def file_paths(value: Any) -> list[Path]:
    """Return one path or several; raise `InputError` if `value` holds none or something else."""
    if isinstance(value, Sequence) and not isinstance(value, str | bytes):
        if not value:
            raise InputError("path must name at least one file; got none")
        return [file_path(one) for one in value]
    return [file_path(value)]
