"""Surfaces of different character, grouped by what they are made from.

A variant of the chain may be chosen on some families and judged on another one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

import gripscale as gs
from gripscale.rubber import styrene_butadiene
from gripscale.surface import self_affine_profile
from gripscale.surface.low_pass import followed
from studies.random_phases import random_phases
from studies.shipped import road, tread


class Studied(NamedTuple):
    """A profile and the family it belongs to."""

    family: str
    profile: gs.Profile


def surfaces() -> dict[str, Studied]:
    """Return the surfaces by name."""
    # what rubber meets is turned upside down and worn
    stations = [followed(road(number)) for number in (0, 1)]
    drawn = [random_phases(station, seed) for station, seed in zip(stations, (1, 2), strict=True)]
    smooth = {
        "self-affine, H = 0.7": ("self-affine 0.7", (0.7, 3e-3, 0.6e-3, 1.2, 50e-6, 11)),
        "self-affine, H = 0.7, steep": ("self-affine 0.7", (0.7, 6e-3, 2.0e-3, 1.2, 50e-6, 13)),
        "self-affine, H = 0.8": ("self-affine 0.8", (0.8, 2e-3, 0.6e-3, 1.2, 37.5e-6, 2014)),
        "self-affine, H = 0.9": ("self-affine 0.9", (0.9, 3e-3, 1.0e-3, 1.2, 50e-6, 12)),
    }
    worn = self_affine_profile(0.8, 3e-3, 1e-3, 1.2, 50e-6, 5)
    return {
        "station 0": Studied("station 0", stations[0]),
        "station 0, upside down": Studied("station 0", _upside_down(stations[0])),
        "station 0, random phases": Studied("station 0", drawn[0]),
        "station 0, random phases, worn": Studied(
            "station 0", lowered_tops(random_phases(stations[0], 3), 0.4, 0.2)
        ),
        "station 1": Studied("station 1", stations[1]),
        "station 1, upside down": Studied("station 1", _upside_down(stations[1])),
        "station 1, random phases": Studied("station 1", drawn[1]),
        "station 1, worn": Studied("station 1", lowered_tops(stations[1], 0.3, 0.3)),
        **{
            name: Studied(f, self_affine_profile(*numbers)) for name, (f, numbers) in smooth.items()
        },
        "self-affine, H = 0.8, worn": Studied("self-affine worn", lowered_tops(worn, 0.4, 0.15)),
    }


def rubbers() -> dict[str, gs.Rubber]:
    """Return a filled tread rubber and an unfilled rubber by name."""
    return {"tread": tread(), "SBR": styrene_butadiene()}


def _upside_down(profile: gs.Profile) -> gs.Profile:
    return gs.Profile(profile.x, -profile.z)


def lowered_tops(profile: gs.Profile, share: float, left: float) -> gs.Profile:
    """Return the profile with its highest `share` lowered to `left` of what stands out."""
    level = np.nanquantile(profile.z, 1.0 - share)
    out = np.maximum(profile.z - level, 0.0)
    return gs.Profile(profile.x, profile.z - (1.0 - left) * out)
