"""The versions of gripscale and of what it computes with."""

from __future__ import annotations

import hashlib
import platform
from functools import lru_cache
from importlib import metadata
from pathlib import Path

import gripscale
from gripscale import _kernel


def versions() -> dict[str, str]:
    """Return versions by name."""
    names = ("gripscale", "numpy", "scipy", "xarray")
    return {**{name: version_of(name) for name in names}, "python": platform.python_version()}


def attributes() -> dict[str, str]:
    """Return the versions as attributes of a result."""
    return {f"version_{name}": version for name, version in versions().items()}


@lru_cache
def version_of(name: str) -> str:
    """Return the version of an installed package."""
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return "unknown (not installed)"


# The fingerprint of what turns inputs into results: compiled kernel and numeric modules.

FACES = ("charts", "cli", "report")
"""Rooms that start runs or show results; all others are taken to make them."""


@lru_cache(maxsize=1)
def software() -> str:
    """Return version and fingerprint of the software that solves."""
    home = Path(gripscale.__file__).parent
    digest = fingerprint(home, Path(str(_kernel.__file__)))
    return f"gripscale {version_of('gripscale')} {digest[:16]}"


def fingerprint(home: Path, kernel: Path) -> str:
    """Return a hash of the package at `home`, without the faces, and of the `kernel`."""
    found = hashlib.sha256(kernel.read_bytes())
    for path in sorted(home.rglob("*.py")):
        place = path.relative_to(home)
        if place.parts[0] not in FACES:
            found.update(f"{place.as_posix()} {path.stat().st_size}\n".encode())
            found.update(path.read_bytes())
    return found.hexdigest()
