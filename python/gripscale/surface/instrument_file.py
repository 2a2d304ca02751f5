"""Profiles from instrument formats, read by SurfaceTopography (the extra `gripscale[formats]`).

SurfaceTopography: https://github.com/ContactEngineering/SurfaceTopography,
doi:10.1088/2051-672X/ac860a.
"""

from __future__ import annotations

import io
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.errors import FileError, InputError
from gripscale.surface.length_unit import length_unit
from gripscale.surface.profile import FloatArray, Profile
from gripscale.textfile import read_bytes
from gripscale.units import in_si


@dataclass(frozen=True)
class HeightField:
    """Heights [m] on a line (points, 1) or a map (points along x, points along y)."""

    heights: FloatArray
    x: FloatArray
    y: FloatArray | None

    def lines(self, direction: str) -> int:
        """Return how many profiles the field has along a direction."""
        return int(self.heights.shape[1 if direction == "x" else 0])

    def profile(self, path: Path, direction: str, line: int) -> Profile:
        """Return one line along a direction as a profile."""
        along = self.x if direction == "x" else self.y
        heights = self.heights[:, line] if direction == "x" else self.heights[line, :]
        label = "" if self.y is None else f", line {line} along {direction}"
        try:
            return Profile(
                np.asarray(along), heights, name=f"{path.stem}{label}", source=f"{path}{label}"
            )
        except InputError as error:
            raise FileError(f"{path}{label}: {error}") from error


def read_instrument_file(path: Path, *, x_unit: str | None, z_unit: str | None) -> HeightField:
    """Read the default channel of an instrument file.

    Parameters
    ----------
    path : pathlib.Path
        A line scan or a map in any format SurfaceTopography reads.
    x_unit, z_unit : str or None
        Units of distance and height, needed only where the file names none.

    Raises
    ------
    FileError
        If SurfaceTopography is not installed, or cannot read the file.
    InputError
        If a unit is unknown or contradicts the file.
    """
    raw = read_bytes(path)
    if not raw.strip():
        raise FileError(f"{path}: expected a surface; got an empty file")
    open_topography = _open_topography(path)
    # Its readers warn about pictures, missing dates and the like, none of which is the caller's.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            reader = open_topography(io.BytesIO(raw))
            try:
                if reader.default_channel.physical_sizes is None:
                    raise FileError(f"{path}: expected a lateral size; the file gives none")
                topography = reader.topography()
                heights: FloatArray = np.ma.filled(
                    np.ma.asarray(topography.heights(), dtype=float), np.nan
                )
                positions = topography.positions()
                unit = topography.unit
            finally:
                reader.close()
        except FileError:
            raise
        except Exception as error:  # each of its forty readers fails in its own way
            raise FileError(
                f"{path}: expected a surface in a known instrument format; "
                f"SurfaceTopography cannot read it ({type(error).__name__})"
            ) from error
    x_unit = length_unit(path, "the file", unit, "x_unit", x_unit)
    z_unit = length_unit(path, "the file", unit, "z_unit", z_unit)
    return _height_field(path, heights, positions, x_unit, z_unit)


def _open_topography(path: Path) -> Any:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from SurfaceTopography import open_topography
    except ImportError as error:
        raise FileError(
            f"{path}: instrument formats need SurfaceTopography; "
            "install it with: pip install 'gripscale[formats]'"
        ) from error
    return open_topography


def _height_field(
    path: Path, heights: FloatArray, positions: Any, x_unit: str, z_unit: str
) -> HeightField:
    if heights.ndim not in (1, 2) or min(heights.shape) == 0:
        raise FileError(f"{path}: expected a line or a map; got heights of shape {heights.shape}")
    heights = in_si(heights, z_unit, "length")
    if heights.ndim == 1:
        return HeightField(heights[:, None], in_si(np.asarray(positions), x_unit, "length"), None)
    x, y = (in_si(np.asarray(axis, dtype=float), x_unit, "length") for axis in positions)
    return HeightField(heights, x[:, 0], y[0, :])
