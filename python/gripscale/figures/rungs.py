"""How the rungs of a comparison look, on paper and on pages; needs no drawing library.

A rung is told from the others by marker as well as by colour. Its own line is solid or dotted:
dashed is what rests on the rubber beyond its measured band.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.figures.palette import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW

JUDGE = "direct"
"""The rung the others are judged by."""
ASIDE = ("windows", "map")
"""Groups of other surfaces, which only give the factors of the best estimate."""
SEEN = 0.01
"""Share of friction or area from which on a wavelength is drawn: longer waves do nothing."""


class Look(NamedTuple):
    """Colour, dash and marker of a rung; the words are those of matplotlib and of Bokeh."""

    colour: str
    dash: str
    marker: str
    bokeh_marker: str


_LOOKS = {
    "chain": Look(BLUE, "solid", "o", "circle"),
    "chain_half_plane": Look(SKY, "solid", "s", "square"),
    "chain_upper": Look(SKY, "dotted", "<", "hex"),
    "sines": Look(GREEN, "solid", "^", "triangle"),
    "random_phases": Look(PURPLE, "solid", "v", "inverted_triangle"),
    JUDGE: Look(ORANGE, "solid", "D", "diamond"),
    "persson": Look(GREY, "dotted", "P", "plus"),
    "klueppel_heinrich": Look(YELLOW, "dotted", "X", "x"),
}
_OTHERS = (
    Look(YELLOW, "solid", "d", "diamond_cross"),
    Look(YELLOW, "dotted", ">", "star"),
    Look(INK, "solid", "h", "square_pin"),
    Look(GREY, "dotted", "p", "triangle_pin"),
)
"""For rungs that have no look of their own, in turn."""


def look_of(rung: str) -> Look:
    """Return the look of a rung of its own, or of a stranger."""
    return _LOOKS.get(rung) or _OTHERS[0]


def looks(comparison: xr.Dataset) -> list[tuple[str, Look]]:
    """Return name and look of each rung, in order."""
    names = [str(name) for name in comparison["rung"].values]
    strangers = [name for name in names if name not in _LOOKS]
    return [
        (name, _LOOKS.get(name) or _OTHERS[strangers.index(name) % len(_OTHERS)]) for name in names
    ]


def flawed(comparison: xr.Dataset) -> list[bool]:
    """Return for each rung whether a sample of it failed."""
    counts = comparison["converged_samples"] < comparison["samples"]
    return [bool(one) for one in counts.values]


def varied(comparison: xr.Dataset) -> str:
    """Return the axis of a comparison, or an empty text if nothing was varied."""
    return next((str(dim) for dim in comparison.total_friction.dims if dim != "rung"), "")


def worth_drawing(comparison: xr.Dataset) -> NDArray[np.bool_]:
    """Return for each octave whether a rung has friction or lost area down to it."""
    friction, area = comparison.running_friction, comparison.running_contact_fraction
    begun = np.abs(friction) > SEEN * np.abs(friction).max("wavelength")
    return np.asarray((begun | (area < 1.0 - SEEN)).any("rung").values)


def on_the_surface(comparison: xr.Dataset) -> xr.Dataset:
    """Return the comparison without the rungs that are not of the surface itself."""
    return comparison.isel(rung=[str(group) not in ASIDE for group in comparison.group.values])
