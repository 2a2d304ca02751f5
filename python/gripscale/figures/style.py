"""The look shared by all figures: sizes, one colour-blind-safe palette, saving.

Colours are from Okabe & Ito, "Color universal design" (2008).
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.ticker import LogLocator
from numpy.typing import NDArray

from gripscale.dataset import write_whole

BLUE, ORANGE, GREEN = "#0072B2", "#D55E00", "#009E73"
SKY, PURPLE, YELLOW = "#56B4E9", "#CC79A7", "#E69F00"
INK, GREY, FAINT = "#222222", "#7F7F7F", "#D9D9D9"
COLOURS = (BLUE, ORANGE, GREEN, PURPLE, YELLOW, SKY)

WIDE, NARROW = 7.0, 4.6
"""Widths of a figure over two columns and a little over one [inch]."""

MILLI = 1e-3
MEGA = 1e6

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
    "pdf.fonttype": 42,
}

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
    figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(wspace=gap))
    return figure, np.asarray(figure.subplots(rows, columns, squeeze=False, **options))


def falling_wavelength(axes: Axes, wavelengths_mm: Iterable[float]) -> None:
    """Give `axes` a log axis of wavelength [mm] that falls to the right, as in the paper."""
    values = list(wavelengths_mm)
    axes.set_xscale("log")
    axes.set_xlim(max(values) * 1.4, min(values) / 1.4)
    axes.xaxis.set_major_locator(LogLocator(numticks=20))
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.set_xlabel("wavelength $\\lambda$ [mm]")


@contextmanager
def _quiet(name: str) -> Iterator[None]:
    """Hold back the warnings a library logs about fonts nobody here can change."""
    logger = logging.getLogger(name)
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)


def save_figure(figure: Figure, folder: Path, name: str) -> list[Path]:
    """Write `figure` as PNG and PDF into `folder`; return the paths.

    Raises `FileError` if one cannot be written.
    """

    def write(path: Path) -> None:
        with mpl.rc_context(RULES), _quiet("fontTools"):
            figure.savefig(path, dpi=200)

    with mpl.rc_context(RULES):
        figure.draw_without_rendering()
    figure.set_layout_engine("none")  # laid out once, not once for each kind of file
    return [write_whole(folder / f"{name}.{kind}", write) for kind in ("png", "pdf")]
