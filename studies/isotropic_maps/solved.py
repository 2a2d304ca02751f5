"""Contacts and statistics of the measured windows, and of maps with their lines."""

from __future__ import annotations

from typing import NotRequired, TypedDict

import numpy as np
from numpy.typing import NDArray

import gripscale as gs
from gripscale.half_space import windows
from gripscale.surface import HeightMap
from gripscale.surface.low_pass import followed
from studies.isotropic_maps.line_statistics import periodic_lines
from studies.isotropic_maps.map_factor import solve_map_and_lines
from studies.isotropic_maps.setting import AREA, FRICTION, LENGTH, LOAD, SMALLEST, TOLERANCE
from studies.isotropic_maps.window_contacts import solve_windows
from studies.shipped import road

LAGS = (0.2e-3, 0.8e-3, 3.2e-3, 12.8e-3)

Numbers = dict[str, float]
Lines = NDArray[np.float64]
"""Shape (lines, points) [m]."""


class OfLines(TypedDict):
    """Of the measured lines, as stored."""

    windows: dict[str, list[float]]
    """Contact of each window."""
    statistics: Numbers


OfMap = TypedDict(
    "OfMap",
    {
        "map": Numbers,
        "lines": Numbers,
        "between directions": Numbers,
        "statistics": Numbers,
        "map at 45 degrees": NotRequired[Numbers],
    },
)
"""Of a map and its lines, as stored."""


def statistics(lines: Lines, step: float) -> Numbers:
    """Return heights, slopes and C_z of lines without the waves that the contact does not see."""
    waves = np.fft.rfft(lines - lines.mean(), axis=1)
    q = 2.0 * np.pi * np.fft.rfftfreq(lines.shape[1], step)
    waves[:, q > 2.0 * np.pi / SMALLEST * (1.0 + 1e-9)] = 0.0
    z = np.fft.irfft(waves, lines.shape[1], axis=1)
    slope = np.fft.irfft(1j * q * waves, lines.shape[1], axis=1)
    high = z >= np.quantile(z, 0.9, axis=1, keepdims=True)
    found = {
        "rms height": float(z.std()),
        "skewness": float(np.mean(z**3) / z.std() ** 3),
        "rms slope": float(slope.std()),
        "rms slope, top tenth": float(slope[high].std()),
    }
    for lag in LAGS:
        moved = np.fft.irfft(waves * np.exp(1j * q * lag), lines.shape[1], axis=1)
        found[f"C_z({lag * 1e3:g} mm)"] = float(np.mean((moved - z) ** 2))
    return found


def of_lines(rubber: gs.Rubber, station: int) -> OfLines:
    """Return contacts and statistics of the windows of a station."""
    profile = followed(road(station))
    contacts = solve_windows(rubber, profile, LENGTH, tolerance=TOLERANCE, **LOAD)
    joined = []
    for window in windows(profile, LENGTH):
        known = np.isfinite(window.z)
        z = np.interp(window.x, window.x[known], window.z[known])
        joined.append(z - np.linspace(z[0], z[-1], z.size))
    # a window has no mean of its own: heights are those of the whole line that maps are made from
    heights = periodic_lines([profile], LENGTH)[0].heights[None, :]
    whole = statistics(heights, profile.step)
    of_windows = statistics(np.array(joined), profile.step)
    own = {name: whole[name] for name in ("rms height", "skewness")}
    return {
        "windows": {name: contacts.values(name).tolist() for name in (AREA, FRICTION)},
        "statistics": of_windows | own,
    }


def of_map(rubber: gs.Rubber, surface: HeightMap, *, turned: bool) -> OfMap:
    """Return contacts and statistics of a map and its lines; of it turned by 45 degrees, too."""
    contact = solve_map_and_lines(rubber, surface, tolerance=TOLERANCE, **LOAD)
    lines = np.concatenate([surface.z[:, ::16].T, surface.z[::16, :]])
    found: OfMap = {
        "map": contact.whole,
        "lines": contact.lines,
        "between directions": contact.between_directions,
        "statistics": statistics(lines, surface.step[0]),
    }
    if turned:
        diagonal = gs.solve_rough_contact(
            rubber, turned_by_45_degrees(surface), periodic=True, tolerance=None, **LOAD
        )
        found["map at 45 degrees"] = {
            name: float(getattr(diagonal, name)) for name in (AREA, FRICTION)
        }
    return found


def turned_by_45_degrees(surface: HeightMap) -> HeightMap:
    """Return the same periodic surface along its diagonals: a square of twice the area."""
    points = surface.z.shape[0]
    waves = np.fft.fftshift(np.fft.fft2(surface.z))
    waves[0, :] = waves[:, 0] = 0.0  # the highest waves have no phase
    finer = np.fft.ifft2(np.fft.ifftshift(np.pad(waves, points // 2))).real * 4.0
    along, across = np.meshgrid(np.arange(2 * points), np.arange(2 * points), indexing="ij")
    z = finer[(along + across) % (2 * points), (along - across) % (2 * points)]
    x = np.arange(2 * points, dtype=np.float64) * surface.step[0] / np.sqrt(2.0)
    return HeightMap(x, x, z, surface.name)


def cut_off(heights: NDArray[np.float64]) -> HeightMap:
    """Return a map without the waves that the contact does not see, whatever their direction."""
    points = heights.shape[0]
    q = 2.0 * np.pi * np.fft.fftfreq(points, LENGTH / points)
    seen = np.hypot(q[:, None], q) <= 2.0 * np.pi / SMALLEST * (1.0 + 1e-9)
    x = LENGTH / points * np.arange(points, dtype=np.float64)
    return HeightMap(x, x, np.fft.ifft2(np.where(seen, np.fft.fft2(heights), 0.0)).real)
