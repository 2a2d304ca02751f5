"""What is solved: the shipped road and tread under one load, and sizes of the maps."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import gripscale as gs
from gripscale.surface import Profile

DATA = Path(__file__).parents[2] / "examples/data"
STATIONS = (0, 1)
CONSTRUCTIONS = ("spectrum", "heights", "lines")
AREA, FRICTION = "contact_fraction", "friction_from_dissipation"
SMALLEST, POINTS = 0.4e-3, 512
LENGTH = POINTS * SMALLEST / 4
LOAD: dict[str, Any] = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": SMALLEST}
"""Keyword arguments of every solution [Pa, m/s, m]."""
TOLERANCE = 0.05


def road(station: int) -> Profile:
    """Return a station of the shipped road, cleaned."""
    path = DATA / "road" / f"20211011_aylesbury_dec_station_{station}.dat"
    cleaned = gs.clean(gs.read_profile(path), crop=(0.12, 1.78))[0]
    return Profile(cleaned.x, cleaned.z, f"station {station}")


def tread() -> gs.Rubber:
    """Return the shipped tread rubber."""
    return gs.fit_prony(gs.read_master_curve(DATA / "rubber/measured_dma.txt"))
