"""The versions of gripscale and of what it computes with."""

from __future__ import annotations

import platform
from functools import lru_cache
from importlib import metadata


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
