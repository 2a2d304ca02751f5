"""What is solved: the shipped road and tread under one load, and sizes of the maps."""

from __future__ import annotations

from typing import Any

STATIONS = (0, 1)
CONSTRUCTIONS = ("spectrum", "heights", "lines")
AREA, FRICTION = "contact_fraction", "friction_from_dissipation"
SMALLEST, POINTS = 0.4e-3, 512
LENGTH = POINTS * SMALLEST / 4
LOAD: dict[str, Any] = {"pressure": 3e5, "speed": 0.3, "smallest_wavelength": SMALLEST}
"""Keyword arguments of every solution [Pa, m/s, m]."""
TOLERANCE = 0.05
