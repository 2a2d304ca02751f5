"""Colours and sizes that all charts share, and which parts of a curve lie beyond the measured band.

Colours are from Okabe & Ito, "Color universal design" (2008).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.rubber.extrapolation import WORTH_SAYING

if TYPE_CHECKING:
    import xarray as xr

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
SKY, PURPLE, YELLOW = "#56B4E9", "#CC79A7", "#E69F00"
INK, GREY, FAINT = "#222222", "#7F7F7F", "#D9D9D9"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY)
# Of what did not converge.
RED = "#B00020"
WIDE, NARROW = 7.0, 4.6  # widths of a figure over two columns and a little over one [inch]
DPI = 200  # pixels per inch of a PNG, and of what is rasterised in a PDF
ROUND = (1, 2, 5, 10)  # steps between the numbers of a linear axis that has few

# Lines on paper by name; dashed are only those beyond the measured band.
DASHES: dict[str, Any] = {
    "": "",
    "solid": "-",
    "dashed": (0, (4, 2)),
    "dotted": (0, (1, 1.5)),
    "dashdot": (0, (6, 1.5, 1, 1.5)),
}

BEYOND_LABEL = "beyond the measured band"  # what a dashed line means, in legends
FLAG = "outside_band"

RowFlags = NDArray[np.bool_]

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def shades(count: int, scale: str = "Viridis") -> list[str]:
    """Return colours in order, from dark to light, of one of matplotlib's scales."""
    import matplotlib as mpl

    top = 0.88 if scale in ("Viridis", "Plasma") else 1.0  # their ends are too pale for lines
    drawn = mpl.colormaps[scale.lower()](np.linspace(0.0, top, max(count, 1)), bytes=True)
    return [f"#{bytes(colour[:3]).hex()}" for colour in drawn]


def colours(count: int, *, ordered: bool) -> list[str]:
    """Return so many colours: of the palette, or along a scale if they are in order or many."""
    return shades(count) if ordered or count > len(COLOURS) else list(COLOURS[:count])


def stretches(beyond: ArrayLike) -> Iterator[tuple[slice, bool]]:
    """Yield runs of points, which share their ends, and whether one end of each line is beyond."""
    flags = np.asarray(beyond, dtype=bool)
    joined = flags[1:] | flags[:-1]
    if not joined.size:
        yield slice(0, flags.size), bool(flags.any())
        return
    changes = [0, *(np.flatnonzero(np.diff(joined)) + 1), joined.size]
    for first, last in pairwise(changes):
        yield slice(int(first), int(last) + 1), bool(joined[first])


def predictions_beyond(data: xr.Dataset) -> RowFlags:
    """Return for each prediction whether some of its friction rests on extrapolation."""
    if FRICTION_OUTSIDE_BAND not in data:
        return np.zeros(data["total_friction"].shape, dtype=bool)
    return np.asarray(data[FRICTION_OUTSIDE_BAND] > WORTH_SAYING)


def waves_beyond(data: xr.Dataset) -> RowFlags:
    """Return for each wave whether it excites the rubber beyond the band."""
    if FLAG not in data:
        return np.zeros(data["wavelength"].shape, dtype=bool)
    return np.asarray(data[FLAG] == 1.0)


def down_to(beyond: ArrayLike) -> RowFlags:
    """Return for sums over waves, largest first, whether a wave of the sum is beyond the band."""
    return np.asarray(np.logical_or.accumulate(np.asarray(beyond, dtype=bool)))


def short_number(value: float) -> str:
    """Return a number for an axis: plain where it stays short, else with raised figures."""
    if value <= 0.0 or 0.99e-4 < value < 0.99e5:
        return f"{value:g}"
    factor, _, exponent = f"{value:.0e}".partition("e")
    power = power_of_ten(int(exponent))
    return power if factor == "1" else f"{factor}·{power}"


def power_of_ten(exponent: int) -> str:
    """Return 10 to `exponent` in plain letters."""
    return "10" + str(exponent).translate(RAISED)
