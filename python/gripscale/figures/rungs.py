"""How the rungs of a comparison look, on paper and on pages; needs no drawing library.

A rung is told from the others by dash and marker as well as by colour.
"""

from __future__ import annotations

from typing import NamedTuple

import xarray as xr

from gripscale.figures.palette import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW

JUDGE = "direct"
"""The rung the others are judged by."""


class Look(NamedTuple):
    """Colour, dash and marker of a rung; the words are those of matplotlib and of Bokeh."""

    colour: str
    dash: str
    marker: str
    bokeh_marker: str


_LOOKS = {
    "chain": Look(BLUE, "solid", "o", "circle"),
    "chain_half_plane": Look(SKY, "dashed", "s", "square"),
    "sines": Look(GREEN, "dashdot", "^", "triangle"),
    "random_phases": Look(PURPLE, "dashed", "v", "inverted_triangle"),
    JUDGE: Look(ORANGE, "solid", "D", "diamond"),
    "persson": Look(GREY, "dotted", "P", "plus"),
    "klueppel_heinrich": Look(INK, "dotted", "X", "x"),
}
_OTHERS = (
    Look(YELLOW, "solid", "<", "hex"),
    Look(YELLOW, "dashed", ">", "star"),
    Look(INK, "dashdot", "h", "square_pin"),
    Look(GREY, "dashed", "p", "triangle_pin"),
)
"""For rungs that have no look of their own, in turn."""


def looks(comparison: xr.Dataset) -> list[tuple[str, Look]]:
    """Return name and look of each rung, in order."""
    names = [str(name) for name in comparison["rung"].values]
    strangers = [name for name in names if name not in _LOOKS]
    return [
        (name, _LOOKS.get(name) or _OTHERS[strangers.index(name) % len(_OTHERS)])
        for name in names
    ]


def flawed(comparison: xr.Dataset) -> list[bool]:
    """Return for each rung whether a sample of it failed."""
    counts = comparison["converged_samples"] < comparison["samples"]
    return [bool(one) for one in counts.values]
