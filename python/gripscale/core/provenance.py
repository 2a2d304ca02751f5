"""Versions of gripscale and its dependencies, and the fingerprint of the software that solves."""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Collection
from contextvars import ContextVar
from functools import lru_cache
from importlib import metadata
from pathlib import Path

import gripscale._kernel as _kernel

CASE_TITLE = "case_title"  # attribute of a result: rubber and surface of its case, in words
# The command that makes a result, as it was typed; empty in Python.
COMMAND: ContextVar[str] = ContextVar("command", default="")


def versions() -> dict[str, str]:
    """Return versions by name."""
    names = ("gripscale", "numpy", "scipy", "xarray")
    return {**{name: version_of(name) for name in names}, "python": platform.python_version()}


def version_attributes() -> dict[str, str]:
    """Return the versions as attributes of a result."""
    return {f"version_{name}": version for name, version in versions().items()}


@lru_cache
def version_of(name: str) -> str:
    """Return the version of an installed package."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "unknown (not installed)"


# First words of the names of packages and files that only show results: they change no number.
SHOWING = ("app", "charts", "cli", "page", "report", "summary")


@lru_cache(maxsize=1)
def software() -> str:
    """Return version and fingerprint of the compiled kernel and the numeric modules."""
    home = Path(__file__).parents[1]
    digest = fingerprint(home, Path(str(_kernel.__file__)), SHOWING)
    return f"gripscale {version_of('gripscale')} {digest[:16]}"


def fingerprint(home: Path, kernel: Path, without: Collection[str] = ()) -> str:
    """Return a hash of the package at `home`, `without` some packages, and of the `kernel`."""
    digest = hashlib.sha256(kernel.read_bytes())
    for path in sorted(home.rglob("*.py")):
        name = path.relative_to(home)
        if not any(Path(part).stem.split("_")[0] in without for part in name.parts):
            digest.update(f"{name.as_posix()} {path.stat().st_size}\n".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()
