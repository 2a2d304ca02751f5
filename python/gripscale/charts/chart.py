r"""What a chart shows, described once: series, bands, bars and levels over two axes with units.

`gripscale.charts.draw` draws panels: side by side on paper, or each alone on a page. A description
needs no library for it. Letters of equations stand between dollar signs, such as
"friction $\mu$ [-]"; the page spells them out.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from gripscale.charts.style import BLUE, GREY, INK
from gripscale.core.arrays import Array

LETTERS = {
    "\\lambda": "λ", "\\mu": "μ", "\\omega": "ω", "\\tau": "τ", "\\epsilon": "ε", "'": "′",
    "^*": "*", "^2": "²", "^3": "³", "_i": "ᵢ", "_{10}": "₁₀", "\\ln": "ln ", "\\": "",
}  # fmt: skip


def spelled_out(text: str) -> str:
    """Return words with their letters of equations spelled out in Unicode."""

    def letters_of(match: re.Match[str]) -> str:
        letters = match[1].replace("''", "″")
        for name, letter in LETTERS.items():
            letters = letters.replace(name, letter)
        return letters

    return re.sub(r"\$(.*?)\$", letters_of, text)


@dataclass(frozen=True)
class PlotAxis:
    """An axis with its label, which ends with the unit; `low` above `high` turns it round."""

    label: str = ""
    log: bool = False
    low: float | None = None
    high: float | None = None
    ticks: Mapping[float, str] | None = None  # names of positions, in place of numbers
    bold: frozenset[str] = frozenset()
    numbers: int = 0  # most numbers along the axis on paper; 0 for as many as matplotlib finds good
    whole: bool = False
    grid: bool = True
    margin: float | None = None  # room beside what is drawn, over its extent


def wavelength_axis(wavelengths: ArrayLike) -> PlotAxis:
    """Return a logarithmic axis of wavelengths [mm] that falls to the right, as in the paper."""
    values = np.ravel(np.asarray(wavelengths, dtype=float))
    values = values[np.isfinite(values)]
    if not values.size:
        return PlotAxis(ticks={})
    ends = 1.4 * float(values.max()), float(values.min()) / 1.4
    return PlotAxis("wavelength $\\lambda$ [mm]", True, *ends)


@dataclass(frozen=True)
class Series:
    """Points of a curve; NaN leaves a gap."""

    x: ArrayLike
    y: ArrayLike
    colour: str = BLUE
    label: str = ""
    dash: str = "solid"  # A key of `gripscale.charts.style.DASHES`; empty for points without a line
    width: float = 1.4  # of the line, in points on paper
    marker: str = ""  # in matplotlib's letters; the page has a table of its own
    size: float = 4.5  # of a marker, in points on paper
    filled: ArrayLike = True  # whether markers are filled: all, or one flag for each point
    # Which points rest on the rubber beyond its measured band; the line there is dashed.
    beyond: ArrayLike = False
    low: ArrayLike | None = None
    high: ArrayLike | None = None  # ends of error bars
    level_bars: bool = False
    alpha: float = 1.0
    order: float = 2.0  # what is drawn later, above, on paper
    clip: bool = True
    coarse: bool = False  # whether paper has pixels in place of a drawing, for very many points
    listed: bool = True


@dataclass(frozen=True)
class Outline:
    """A curve of very many points by the lowest and highest value of pieces, NaN for a gap.

    What is drawn has every extreme; the page draws anew what its frame shows.
    """

    x: ArrayLike
    low: ArrayLike
    high: ArrayLike
    colour: str = BLUE
    label: str = ""
    width: float = 1.4

    def drawn(self, pieces: int) -> tuple[Array, Array]:
        """Return abscissa and ordinate of the curve in so many equal pieces of the abscissa."""
        x = np.asarray(self.x, dtype=float)
        index = np.clip(((x - x[0]) / (x[-1] - x[0]) * pieces).astype(int), 0, pieces - 1)
        first = np.flatnonzero(np.diff(index, prepend=-1))
        low, high = np.fmin.reduceat(self.low, first), np.fmax.reduceat(self.high, first)
        return np.repeat(x[first], 2), np.column_stack([low, high]).ravel()


@dataclass(frozen=True)
class ShadedBand:
    """The area between two curves."""

    x: ArrayLike
    low: ArrayLike
    high: ArrayLike
    colour: str = GREY
    label: str = ""
    alpha: float = 0.2
    edged: bool = False


@dataclass(frozen=True)
class Bars:
    """Rectangles from `x0` to `x1` and from `y0` to `y1`."""

    x0: ArrayLike
    x1: ArrayLike
    y0: ArrayLike
    y1: ArrayLike
    colour: str = BLUE
    label: str = ""
    alpha: float = 1.0
    order: float = 1.0


@dataclass(frozen=True)
class CrossLine:
    """A straight line across the panel at a height, or upright at an abscissa; or a shade."""

    at: float
    colour: str = GREY
    label: str = ""
    dash: str = "solid"
    width: float = 0.8
    upright: bool = False
    order: float = 1.5
    to: float | None = None  # other end of a shade; None for a line


@dataclass(frozen=True)
class Note:
    """Words at a point, on paper only: on the page numbers show under the pointer."""

    x: float
    y: float
    text: str
    colour: str = INK
    offset: tuple[float, float] = (0.0, 0.0)  # from the point [points]
    align: str = "left"
    frame: str = ""  # coordinates that are shares of the frame: "x", "xy" or none
    top: bool = False  # whether the point is at the top of the words, not in their middle
    size: float = 7.0  # of the letters [points]
    boxed: bool = False
    italic: bool = False


@dataclass(frozen=True)
class ValueMap:
    """Values over a plane, shape (y, x), to scale with a colour bar; NaN is left white."""

    x: ArrayLike
    y: ArrayLike
    values: ArrayLike
    label: str


Mark = Series | Outline | ShadedBand | Bars | CrossLine | Note | ValueMap


@dataclass(frozen=True)
class Panel:
    """Marks over two axes; `name`, `caption` and `alt` are those of a chart of the page."""

    x: PlotAxis
    y: PlotAxis
    marks: Sequence[Mark] = ()
    title: str = ""
    name: str = ""
    caption: str = ""
    alt: str = ""
    height: int = 340  # on the page with one line of the legend [px]
    # Where the panel has a legend of its own on paper, such as "lower right"; "none" nowhere.
    legend: str = ""
    to_scale: bool = False  # whether lengths along both axes are equal

    def with_marks(self, marks: Iterable[Mark]) -> Panel:
        """Return the panel with more marks, drawn above the others."""
        return replace(self, marks=[*self.marks, *marks])


@dataclass(frozen=True)
class ColourBar:
    """What colours from a scale of `gripscale.charts.style.shades` mean."""

    low: float
    high: float
    scale: str
    label: str
    first_row: bool = False  # whether it belongs to the first row of panels only
