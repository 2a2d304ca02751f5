"""Colours and sizes that all charts share, and which parts of a curve lie beyond the measured band.

Colours are from Okabe & Ito, "Color universal design" (2008). No drawing library is needed here.

Colour scales of charts: every eighth colour of matplotlib's scales of those names.
Neither matplotlib nor Bokeh is needed; between two of these colours any other is interpolated, with
an error of 5 in 255 at most.
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

SCALES = {
    "Viridis": (
        "440154 460c5f 47186a 482273 472c7b 453681 424085 3e4989 3a528b 365a8c 32628d "
        "2f6a8d 2c728e 287a8e 26818e 23898d 20908c 1e978a 1e9e88 21a685 27ad80 30b47a "
        "3dbb74 4bc26c 5bc862 6dce58 81d34c 95d73f aadb32 bfdf24 d4e11a e9e419 fde724"
    ),
    "Plasma": (
        "0c0786 21058f 310496 3f039c 4c02a1 5901a4 6500a7 7200a8 7e03a7 8908a5 9511a1 "
        "9f1a9b a92395 b22c8e bb3586 c33e7f cb4777 d14f71 d8586a df6163 e56b5c ea7455 "
        "ef7e4e f48947 f79341 fa9f3a fcaa33 fdb62d fdc328 fbd024 f8dd24 f4ea26 eff821"
    ),
    "Cividis": (
        "00204c 00265a 002b68 00306f 06366e 1e3c6c 2c416b 37476b 414d6b 49536b 51586c "
        "595e6d 60646e 686a70 6f6f72 757575 7c7b78 838178 8b8778 938d78 9b9377 a39a75 "
        "aba174 b4a771 bcae6e c5b56b cdbc67 d6c363 dfcb5d e8d257 f1da50 fbe147 ffe945"
    ),
    "Inferno": (
        "000003 030212 0a0723 140b36 200c4a 2e0a5a 3c0965 4a0b6a 570f6d 63146e 70196e "
        "7d1d6c 892269 962666 a32b61 af315b bb3754 c53d4d d04544 da4e3b e35832 ea6428 "
        "f0701e f57e14 f98c09 fb9b06 fbaa0e fbb91e f8c931 f5d948 f1e864 f2f485 fcfea4"
    ),
}


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
    """Return colours in order, from dark to light, of one of `SCALES`."""
    anchors = np.array([list(bytes.fromhex(colour)) for colour in SCALES[scale].split()])
    top = 0.88 if scale in ("Viridis", "Plasma") else 1.0  # their ends are too pale for lines
    at = np.linspace(0.0, top, max(count, 1)) * (len(anchors) - 1)
    parts = [np.interp(at, np.arange(len(anchors)), part).round() for part in anchors.T]
    return [f"#{bytes(colour).hex()}" for colour in np.array(parts, dtype=np.uint8).T.tolist()]


def colours(count: int, *, ordered: bool) -> list[str]:
    """Return so many colours: of the palette, or along a scale if they are in order or many."""
    return shades(count) if ordered or count > len(COLOURS) else list(COLOURS[:count])


def stretches(beyond: ArrayLike) -> Iterator[tuple[slice, bool]]:
    """Yield runs of points that are joined in one way, and whether that is beyond the band.

    A line is beyond the band if one of its ends is; neighbouring runs share a point.
    """
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
    """Return a number for an axis: plain where it stays short, else with a power of ten.

    The font has raised figures; set as mathematics each number would take 5 ms.
    """
    if value <= 0.0 or 0.99e-4 < value < 0.99e5:
        return f"{value:g}"
    factor, _, exponent = f"{value:.0e}".partition("e")
    power = power_of_ten(int(exponent))
    return power if factor == "1" else f"{factor}·{power}"


def power_of_ten(exponent: int) -> str:
    """Return 10 to `exponent` in plain letters."""
    return "10" + str(exponent).translate(RAISED)
