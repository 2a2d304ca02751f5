"""The measurements of a surface one by one: each profile, or the map, as a surface of its own."""

from __future__ import annotations

from collections.abc import Sequence

from gripscale.surface import HeightMap, Measured, Profile, Surface


def with_single_measurement(surface: Surface, measured: Profile | HeightMap) -> Surface:
    """Return the waves of `surface` with one profile or map as the only measurement."""
    heights = measured if isinstance(measured, HeightMap) else [measured]
    return Surface(surface.sines, measured.name, measured=Measured.of(heights))


def each_measured(surface: Surface) -> list[tuple[str, Surface]]:
    """Return names of the profiles of `surface`, or of its map, each with a surface of it alone."""
    measured: Sequence[Profile | HeightMap] = (
        [] if surface.measured is None else surface.measured.surfaces
    )
    return [
        (part.name or f"profile {i}", with_single_measurement(surface, part))
        for i, part in enumerate(measured, 1)
    ]
