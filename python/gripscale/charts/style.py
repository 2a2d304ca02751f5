"""The look shared by all figures on paper, and how they are laid out and saved."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import wraps
from itertools import pairwise
from pathlib import Path
from typing import IO, Any, ParamSpec

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_pdf import FigureCanvasPdf
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.markers import TICKDOWN, TICKLEFT
from matplotlib.ticker import LogLocator, NullLocator
from numpy.typing import ArrayLike, NDArray

from gripscale.io.netcdf import write_whole
from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.rubber.extrapolation import WORTH_SAYING

# Colours, sizes and units that print and page share; nothing here needs a drawing library.
#
# Colours are from Okabe & Ito, "Color universal design" (2008).

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
SKY, PURPLE, YELLOW = "#56B4E9", "#CC79A7", "#E69F00"
INK, GREY, FAINT = "#222222", "#7F7F7F", "#D9D9D9"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY)

WIDE, NARROW = 7.0, 4.6
"""Widths of a figure over two columns and a little over one [inch]."""


# Which parts of a curve rest on the rubber beyond its measured band, on paper and on pages.
#
# They are drawn dashed. Needs no drawing library.

BEYOND = "beyond the measured band"
"""What a dashed line is, in legends."""
BEYOND_BESIDE = "beyond the\nmeasured band"
"""The same in a legend beside panels."""
FLAG = "outside_band"

Flags = NDArray[np.bool_]


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


def predictions_beyond(data: xr.Dataset) -> Flags:
    """Return for each prediction whether some of its friction rests on extrapolation."""
    if FRICTION_OUTSIDE_BAND not in data:
        return np.zeros(data["total_friction"].shape, dtype=bool)
    return np.asarray(data[FRICTION_OUTSIDE_BAND] > WORTH_SAYING)


def waves_beyond(data: xr.Dataset) -> Flags:
    """Return for each wave whether it excites the rubber beyond the band."""
    if FLAG not in data:
        return np.zeros(data["wavelength"].shape, dtype=bool)
    return np.asarray(data[FLAG] == 1.0)


def down_to(beyond: ArrayLike) -> Flags:
    """Return for what is summed up over waves whether one of them so far is beyond the band."""
    return np.asarray(np.logical_or.accumulate(np.asarray(beyond, dtype=bool)))


DPI = 200
"""Pixels per inch of a PNG, and of what is rasterised in a PDF."""

MOST_MARKED = 1e7
"""Largest over smallest value of a logarithmic axis with marks between the powers of ten."""

RULES: Any = {
    "font.size": 9.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 9.0,
    "legend.fontsize": 8.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "axes.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": FAINT,
    "grid.linewidth": 0.5,
    "lines.linewidth": 1.4,
    "lines.markersize": 4.5,
    "legend.frameon": False,
    "pdf.fonttype": 3,  # 42 cuts the whole font down for each figure, which costs 0.3 s
}

DASHED: Any = (0, (4, 2))
"""Lines beyond the measured band, and only those."""
DOTTED: Any = (0, (1, 1.5))

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

P = ParamSpec("P")


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Return `draw` running under the shared rules, without touching matplotlib's own."""

    @wraps(draw)
    def inside(*args: P.args, **kwargs: P.kwargs) -> Figure:
        with mpl.rc_context(RULES):
            return draw(*args, **kwargs)

    return inside


def sheet(
    width: float, height: float, rows: int = 1, columns: int = 1, gap: float = 0.02, **options: Any
) -> tuple[Figure, NDArray[Any]]:
    """Return a figure [inch] and its axes as a 2-D array, without pyplot's global state."""
    layout = ConstrainedLayoutEngine(wspace=gap)
    figure = Figure(figsize=(width, height), dpi=DPI, layout=layout)
    return figure, np.asarray(figure.subplots(rows, columns, squeeze=False, **options))


def log_axis(axes: Axes, which: str, steps: Sequence[float] = (1.0,)) -> None:
    """Make the "x" or "y" axis logarithmic, with a number at `steps` times each power of ten."""
    axes.set(**{f"{which}scale": "log"})
    axis = axes.xaxis if which == "x" else axes.yaxis
    axis.set_major_locator(LogLocator(subs=steps, numticks=12))
    axis.set_major_formatter(lambda value, _: short_number(value))
    axis.set_minor_locator(NullLocator())  # `_mark_between` draws them


def line(
    axes: Axes, x: Any, y: Any, beyond: ArrayLike, label: str | None = None, **look: Any
) -> None:
    """Draw a curve, dashed where it rests on the rubber beyond its measured band."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if not np.any(beyond):
        axes.plot(x, y, **look, label=label)
        return
    for part, dashed in stretches(beyond):
        axes.plot(x[part], y[part], **(look | {"ls": DASHED, "gid": BEYOND} if dashed else look))
    if label is not None:  # nothing, unclipped, has no place on a logarithmic axis
        axes.plot([], [], **(look | {"clip_on": True}), label=label)


def dashed_entry(axes: Axes, text: str = BEYOND) -> None:
    """Say in the legend of `axes` what dashed is, where something is dashed."""
    if any(one.get_gid() == BEYOND for one in axes.lines):
        axes.plot([], [], ls=DASHED, color=GREY, label=text)


def area_axis(axes: Axes, top: float | None = None) -> None:
    """Make the upright axis one of relative area: logarithmic, with enough numbers to read it."""
    axes.set_yscale("log")  # before any limit is asked for: a linear axis may start below zero
    axes.set_ylim(top=top)
    low, high = axes.get_ylim()
    log_axis(axes, "y", (1.0, 2.0, 5.0) if high < 500.0 * low else (1.0,))


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


def falling_wavelength(axes: Axes, wavelengths_mm: Iterable[float]) -> None:
    """Give `axes` a log axis of wavelength [mm] that falls to the right, as in the paper."""
    values = list(wavelengths_mm)
    log_axis(axes, "x")
    axes.set_xlim(max(values) * 1.4, min(values) / 1.4)
    axes.set_xlabel("wavelength $\\lambda$ [mm]")


def _mark_between(figure: Figure) -> None:
    """Mark 2 to 9 times each power of ten on logarithmic axes, all marks as one line.

    As ticks, each with its grid line and label, they would be half of the drawing.
    """
    for axes in figure.axes:
        for axis, marker in ((axes.xaxis, TICKDOWN), (axes.yaxis, TICKLEFT)):
            low, high = sorted(axis.get_view_interval())
            if axis.get_scale() != "log" or high > MOST_MARKED * low:
                continue
            places = np.asarray(LogLocator(subs=range(2, 10), numticks=99).tick_values(low, high))
            places = places[(places >= low) & (places <= high)]
            along = (places, np.zeros_like(places))
            x, y = along if axis is axes.xaxis else along[::-1]
            where = axes.get_xaxis_transform() if axis is axes.xaxis else axes.get_yaxis_transform()
            look: dict[str, Any] = {"marker": marker, "ms": 2.0, "mew": 0.6, "ls": "", "color": INK}
            figure.add_artist(Line2D(x, y, transform=where, in_layout=False, **look))


def write_png(figure: Figure, target: Path | IO[bytes], dpi: float = DPI) -> None:
    """Write `figure` as PNG; its layout is solved now, and stays."""
    with mpl.rc_context(RULES):
        figure.set_dpi(dpi)
        layout = figure.get_layout_engine()
        if isinstance(layout, ConstrainedLayoutEngine):
            _mark_between(figure)
            layout.execute(figure)
            figure.set_layout_engine("none")
        # `savefig` would draw twice: once more to find out what it has to show.
        canvas: Any = FigureCanvasAgg(figure)
        canvas.print_png(target, pil_kwargs={"compress_level": 1})


def save_figure(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write `figure` as PNG and PDF into `folder`; return the paths.

    Raises `FileError` if one cannot be written.
    """

    def write_pdf(target: Path) -> None:
        with mpl.rc_context(RULES):
            canvas: Any = FigureCanvasPdf(figure)
            canvas.print_pdf(target)

    return [
        write_whole(folder / f"{name}.png", lambda target: write_png(figure, target)),
        write_whole(folder / f"{name}.pdf", write_pdf),
    ]
