"""Instrument formats, read by SurfaceTopography (the extra `gripscale[formats]`).

SurfaceTopography: https://github.com/ContactEngineering/SurfaceTopography,
doi:10.1088/2051-672X/ac860a.
"""

from __future__ import annotations

import io
import math
import warnings
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.surface.height_map import line_label
from gripscale.surface.length_unit import length_unit
from gripscale.surface.profile import FloatArray, Profile
from gripscale.textfile import read_bytes
from gripscale.units import in_si

MOST_POINTS_PER_BYTE = 1032
"""Deflate, the densest packing of all formats, makes at most 1032 bytes of one."""


@dataclass(frozen=True)
class HeightField:
    """Heights [m] on a line (points, 1) or a map (points along x, points along y)."""

    heights: FloatArray
    x: FloatArray
    y: FloatArray | None
    reliable: float | None = None
    """Shortest wavelength [m] free of the instrument's artifacts, where the file tells."""

    def lines(self, direction: str) -> int:
        """Return how many profiles the field has along a direction."""
        return int(self.heights.shape[1 if direction == "x" else 0])

    def profile(self, path: Path, direction: str, line: int) -> Profile:
        """Return one line along a direction as a profile."""
        along = self.x if direction == "x" else self.y
        heights = self.heights[:, line] if direction == "x" else self.heights[line, :]
        name, source = path.stem, str(path)
        if self.y is not None:
            name, source = (line_label(text, line, direction) for text in (name, source))
        try:
            return Profile(np.asarray(along), heights, name, source, self.reliable)
        except InputError as error:
            raise FileError(f"{source}: {error}") from error


def read_instrument_file(
    path: Path,
    *,
    x_unit: str | None,
    z_unit: str | None,
    channel: str | int | None = None,
    step: tuple[float, float] | None = None,
) -> HeightField:
    """Read the heights of an instrument file.

    Parameters
    ----------
    path : pathlib.Path
        A line scan or a map in any format SurfaceTopography reads.
    x_unit, z_unit : str or None
        Units of distance and height, needed only where the file names none.
    channel : str, int or None
        Name of the channel, or its number from 1, where several hold heights.
    step : (float, float) or None
        Steps along x and y [m], needed only where the file has none.

    Raises
    ------
    FileError
        If SurfaceTopography is not installed or cannot read the file, or the file has no heights
        or no lateral size.
    InputError
        If an argument is wrong or contradicts the file.
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
                topography = _topography(path, reader, channel, step)
                _check_count(path, topography.nb_grid_pts, len(raw))
                heights: FloatArray = np.ma.filled(
                    np.ma.asarray(topography.heights(), dtype=float), np.nan
                )
                positions = topography.positions()
                unit = topography.unit
                reliable = topography.short_reliability_cutoff()
            finally:
                reader.close()
        except (FileError, InputError):
            raise
        except Exception as error:  # each of its forty readers fails in its own way
            raise FileError(
                f"{path}: expected a surface in a known instrument format; "
                f"SurfaceTopography cannot read it ({type(error).__name__})"
            ) from error
    x_unit = "m" if step else length_unit(path, "the file", unit, "x_unit", x_unit)
    z_unit = length_unit(path, "the file", unit, "z_unit", z_unit)
    field = _height_field(path, heights, positions, x_unit, z_unit)
    return field if reliable is None else replace(field, reliable=in_si(reliable, x_unit, "length"))


def _topography(
    path: Path, reader: Any, channel: str | int | None, step: tuple[float, float] | None
) -> Any:
    """Return the heights of one channel, with its lateral size."""
    chosen = _channel(path, reader.channels, channel)
    if chosen.physical_sizes is not None:
        if step is not None:
            raise InputError(f"step must be left out; {path} states the size of its surface")
        return chosen.topography()
    if step is None:
        raise FileError(f"{path}: expected a lateral size; the file gives none")
    sizes = tuple(n * d for n, d in zip(chosen.nb_grid_pts, step, strict=False))
    return chosen.topography(physical_sizes=sizes)


def _check_count(path: Path, points: tuple[int, ...], length: int) -> None:
    """Refuse a header with more points than any packing gets into the bytes of the file."""
    if math.prod(points) > MOST_POINTS_PER_BYTE * length:
        raise FileError(
            f"{path}: expected a surface; its header states {' x '.join(map(str, points))} points, "
            f"which {length} bytes cannot hold"
        )


def _channel(path: Path, channels: list[Any], wanted: str | int | None) -> Any:
    """Return the one channel of heights, or the one of them that is `wanted`."""
    known = [channel for channel in channels if channel.is_height_channel]
    named = ", ".join(f"{channel.index + 1} {channel.name!r}" for channel in known)
    if not known:
        others = ", ".join(repr(channel.name) for channel in channels)
        raise FileError(f"{path}: expected a channel of heights; got {others or 'none'}")
    if wanted is not None:
        known = [channel for channel in known if wanted in (channel.name, channel.index + 1)]
        if not known:
            raise InputError(
                f"channel of {path} must be one of {named}, counted from 1; got "
                f"{checks.shown(wanted)}"
            )
    if len(known) > 1:
        raise FileError(f"{path}: expected one channel of heights; got {named}; give channel")
    return known[0]


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
