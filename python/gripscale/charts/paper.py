"""Charts on paper: draws panels with matplotlib and saves figures."""

from __future__ import annotations

import io
from collections.abc import Sequence
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis as DrawnAxis
from matplotlib.backend_bases import get_registered_canvas_class
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine
from matplotlib.lines import Line2D
from matplotlib.markers import TICKDOWN, TICKLEFT
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

from gripscale.charts import chart
from gripscale.charts.draw import Sheet
from gripscale.charts.style import (
    BEYOND_LABEL,
    DASHES,
    DPI,
    FAINT,
    GREY,
    INK,
    ROUND,
    shades,
    short_number,
    stretches,
)
from gripscale.core import checks
from gripscale.io.folders import write_bytes

_PIECES = 5000  # pieces of an outline: several to a pixel, so that most gaps are still seen
# Width of a letter of a legend in the mean, and of a key with the gaps beside it [inch].
LETTER, _KEY = 0.062, 0.5
# Largest over smallest value of a logarithmic axis with marks between the powers of ten.
MOST_MARKED = 1e7

RULES: Any = {
    "font.size": 9.0,
    "axes.titlesize": 9.0,
    "axes.labelsize": 9.0,
    "figure.titlesize": 9.0,
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
    "svg.fonttype": "none",  # words stay words
    "pdf.fonttype": 3,  # 42 cuts the whole font down for each figure, which costs 0.3 s
}


# Numbers between the powers of ten of a logarithmic axis, by its largest over smallest value.
_STEPS: dict[str, tuple[tuple[float, tuple[float, ...]], ...]] = {
    "x": ((8.0, (1, 2, 3, 5, 7)), (60.0, (1, 2, 5)), (1e3, (1, 3))),
    "y": (
        (3.0, (1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9)),
        (8.0, (1, 1.5, 2, 3, 4, 5, 7)),
        (500.0, (1, 2, 5)),
    ),
}


def figure_rules() -> AbstractContextManager[None]:
    """Apply `RULES` within a block; matplotlib's own rules stay as they are."""
    return mpl.rc_context(RULES)


def draw_sheet(sheet: Sheet) -> Figure:
    """Return the figure of a sheet; matplotlib's own rules stay as they are."""
    columns, count, layout = sheet.columns, len(sheet.panels), sheet.layout
    size: Any = {"figsize": (sheet.width, sheet.height), "dpi": DPI}
    with figure_rules():
        figure = Figure(layout=ConstrainedLayoutEngine(wspace=sheet.gap), **size)
        options: dict[str, Any] = {"squeeze": False, **layout}
        grid = list(figure.subplots(-(-count // columns), columns, **options).flat)
        for axes in grid[count:]:
            axes.set_visible(False)
        for axes, panel in zip(grid, sheet.panels, strict=False):
            _draw_panel(figure, axes, panel)
        # Limits come last: those of a shared axis are found from all of its panels.
        for i, (axes, panel) in enumerate(zip(grid, sheet.panels, strict=False)):
            _end_axis(axes, "x", panel.x)
            _end_axis(axes, "y", panel.y)
            if layout.get("sharey") and i % columns:
                axes.set_ylabel("")
            if layout.get("sharex"):
                if i + columns < count:
                    axes.set_xlabel("")
                else:
                    axes.tick_params(labelbottom=True)
        if sheet.legend:
            _add_legend(figure, grid, sheet)
        if sheet.colour_bar is not None:
            bar = sheet.colour_bar
            colours = ListedColormap(shades(256, bar.scale))
            near = grid[:columns] if bar.first_row else grid
            look: Any = {"label": bar.label, "ax": near, "aspect": 40, "pad": 0.02}
            scale = ScalarMappable(Normalize(bar.low, bar.high), colours)
            figure.colorbar(scale, **look).outline.set_visible(False)
        if sheet.title:
            figure.suptitle(sheet.title)
    return figure


def _draw_panel(figure: Figure, axes: Axes, panel: chart.Panel) -> None:
    which: Any
    for which, axis in (("x", panel.x), ("y", panel.y)):
        if axis.log:  # before anything is drawn: a linear axis may start below zero
            axes.set(**{f"{which}scale": "log"})
        axes.set(**{f"{which}label": axis.label})
        axes.grid(axis.grid, axis=which)
        if axis.margin is not None:
            (axes.set_xmargin if which == "x" else axes.set_ymargin)(axis.margin)
        if axis.low != axis.high and None not in (axis.low, axis.high):  # nothing need be drawn
            axes.set(**{f"{which}lim": (axis.low, axis.high)})
    for mark in panel.marks:
        _draw_mark(figure, axes, mark)
    if panel.to_scale:
        axes.set_aspect("equal", adjustable="box")
    if any(isinstance(mark, chart.Bars) for mark in panel.marks):
        axes.use_sticky_edges = False  # of bars upon bars, which would leave no room above
    if panel.title:
        axes.set_title(panel.title)
    if panel.legend not in ("", "none"):
        corner: Any = panel.legend
        axes.legend(loc=corner)


def _end_axis(axes: Axes, which: str, axis: chart.PlotAxis) -> None:
    """Set the limits of an axis, and place numbers or names along it."""
    drawn: DrawnAxis = axes.xaxis if which == "x" else axes.yaxis
    if axis.low != axis.high:
        axes.set(**{f"{which}lim": (axis.low, axis.high)})
    if axis.ticks is not None:
        drawn.set_ticks(list(axis.ticks), list(axis.ticks.values()))
        for label in drawn.get_ticklabels() if axis.bold else []:
            label.set_fontweight("bold" if label.get_text() in axis.bold else "normal")
        axes.tick_params(axis=which, length=0)  # type: ignore[arg-type]
    elif axis.log:
        low, high = sorted(drawn.get_view_interval())
        steps = next((steps for most, steps in _STEPS[which] if high < most * low), (1,))
        drawn.set_major_locator(LogLocator(subs=steps, numticks=axis.numbers or 12))
        drawn.set_major_formatter(lambda value, _: short_number(value))
        drawn.set_minor_locator(NullLocator())  # `_mark_between` draws them
    elif axis.numbers:
        drawn.set_major_locator(MaxNLocator(axis.numbers, steps=ROUND, integer=axis.whole))


def _draw_mark(figure: Figure, axes: Axes, mark: chart.Mark) -> None:
    match mark:
        case chart.Series():
            _draw_series(axes, mark)
        case chart.Outline():
            _draw_series(axes, chart.Series(*mark.drawn(_PIECES), mark.colour, mark.label,
                                      width=mark.width, coarse=True))  # fmt: skip
        case chart.ShadedBand():
            curves = (np.asarray(values, float) for values in (mark.x, mark.low, mark.high))
            x, low, high = np.broadcast_arrays(*curves)
            look: dict[str, Any] = {"color": mark.colour, "alpha": mark.alpha}
            look |= {"lw": 0.3, "ec": "white"} if mark.edged else {"lw": 0.0}
            axes.fill_between(x, low, high, label=mark.label or None, **look)
        case chart.Bars():
            x0, x1, y0, y1 = np.broadcast_arrays(mark.x0, mark.x1, mark.y0, mark.y1)
            look = {"color": mark.colour, "alpha": mark.alpha, "lw": 0}
            axes.bar(x0, y1 - y0, x1 - x0, y0, align="edge", zorder=mark.order,
                     label=mark.label or None, **look)  # fmt: skip
        case chart.CrossLine(to=None):
            look = {"color": mark.colour, "ls": DASHES[mark.dash], "lw": mark.width}
            across = axes.axvline if mark.upright else axes.axhline
            across(mark.at, label=mark.label or None, zorder=mark.order, **look)
        case chart.CrossLine(to=float(end)):
            shade = axes.axvspan if mark.upright else axes.axhspan
            look = {"color": mark.colour, "alpha": 0.5, "lw": 0}
            shade(mark.at, end, label=mark.label or None, **look)
        case chart.Note():
            frames: dict[str, Any] = {"x": ("axes fraction", "data"), "xy": "axes fraction"}
            look = {"xycoords": frames.get(mark.frame, "data"), "textcoords": "offset points"}
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0} if mark.boxed else None
            look |= {"va": "top" if mark.top else "center", "ha": mark.align, "bbox": box}
            look |= {"fontsize": mark.size, "fontstyle": "italic" if mark.italic else "normal"}
            axes.annotate(mark.text, (mark.x, mark.y), mark.offset, color=mark.colour, **look)
        case chart.ValueMap():
            _draw_field(figure, axes, mark)


def _draw_series(axes: Axes, series: chart.Series) -> None:
    """Draw a curve, dashed where it rests on the rubber beyond its measured band."""
    x, y = np.asarray(series.x, dtype=float), np.asarray(series.y, dtype=float)
    filled = np.broadcast_to(np.asarray(series.filled, dtype=bool), x.shape)
    look: dict[str, Any] = {
        "color": series.colour,
        "ls": DASHES[series.dash],
        "lw": series.width,
        "marker": series.marker,
        "ms": series.size,
        "mew": 0.0 if series.coarse else None if filled.all() else 0.9,
        "mfc": series.colour if filled.any() or not x.size else "white",
        "alpha": series.alpha,
        "zorder": series.order,
        "rasterized": series.coarse,
    }
    if series.low is not None and series.high is not None:
        middle = x if series.level_bars else y
        error = [middle - np.asarray(series.low), np.asarray(series.high) - middle]
        which = "xerr" if series.level_bars else "yerr"
        axes.errorbar(x, y, **{which: np.nan_to_num(error)}, fmt="none", ecolor=series.colour,
                      elinewidth=1.0, capsize=2.2, capthick=0.8, zorder=series.order)  # fmt: skip
    parts = list(stretches(np.broadcast_to(series.beyond, x.shape)))
    if not any(dashed for _, dashed in parts):
        parts = [(slice(None), False)]
    mixed = filled.any() and not filled.all()
    if mixed:
        for chosen, face in ((filled, series.colour), (~filled, "white")):
            points = look | {"ls": "", "mfc": face, "clip_on": series.clip}
            axes.plot(x[chosen], y[chosen], **points)
    label = series.label if series.listed else f"_{series.label}"
    for part, dashed in sorted(parts, key=lambda part: part[1]):
        part_look = look | ({"ls": DASHES["dashed"], "gid": BEYOND_LABEL} if dashed else {})
        part_look |= {"marker": ""} if mixed else {}
        # nothing, unclipped, has no place on a logarithmic axis
        part_look["clip_on"] = series.clip or not np.isfinite(y[part]).any()
        named: dict[str, Any] = {"label": label} if label and not dashed and not mixed else {}
        axes.plot(x[part], y[part], **part_look, **named)
        label = "" if named else label
    if label:
        axes.plot([], [], label=label, **look)


def _draw_field(figure: Figure, axes: Axes, field: chart.ValueMap) -> None:
    x, y, values = (np.asarray(part, dtype=float) for part in (field.x, field.y, field.values))
    coloured = axes.pcolormesh(x, y, values, cmap="inferno", rasterized=True)
    axes.set_aspect("equal")
    # beside the frame, which an equal scale makes narrower than its place
    strip = axes.inset_axes((1.02, 0.0, 0.03, 1.0))
    bar = figure.colorbar(coloured, label=field.label, cax=strip)
    bar.outline.set_linewidth(0.0)
    bar.ax.yaxis.set_major_formatter(lambda value, _: short_number(value))


def _add_legend(figure: Figure, panels: Sequence[Axes], sheet: Sheet) -> None:
    """Add the labels and keys of a sheet, and what dashed means where it occurs."""
    entries: dict[str, Any] = {}
    dashed = False
    for axes in panels:
        if axes.get_legend() is None:
            for handle, label in zip(*axes.get_legend_handles_labels(), strict=True):
                entries.setdefault(label, handle)
        dashed |= any(line.get_gid() == BEYOND_LABEL for line in axes.lines)
    for key in sheet.keys:
        entries |= {getattr(key, "label", ""): _key(key)}
    at_side = sheet.legend == "beside"
    beyond = BEYOND_LABEL.replace("the ", "the\n") if at_side else BEYOND_LABEL
    if dashed:
        entries[beyond] = Line2D([], [], ls=DASHES["dashed"], color=GREY)
    if not entries:
        return
    look: dict[str, Any] = {"loc": "outside right center", "alignment": "left"}
    if not at_side:
        columns = _legend_columns(list(entries), sheet.legend_columns, sheet.width)
        side = "upper" if sheet.legend == "above" else "lower"
        look = {"loc": f"outside {side} center", "ncols": columns}
    title = sheet.legend_title or None
    figure.legend(list(entries.values()), list(entries), title=title, **look)


def _legend_columns(labels: Sequence[str], most: int, width: float) -> int:
    """Return how many columns of a legend fit into a figure of a width [inch], up to `most`."""
    lengths = [len(chart.spelled_out(label)) for label in labels]
    for columns in range(most, 1, -1):
        widest = [max(part, default=0) for part in np.array_split(lengths, columns)]
        if float(LETTER * sum(widest) + _KEY * columns) <= width:
            return columns
    return 1


def _key(mark: chart.Mark) -> Any:
    """Return what stands in the legend for a mark that no panel has."""
    if isinstance(mark, chart.Series | chart.CrossLine):
        look: dict[str, Any] = {"color": mark.colour, "lw": mark.width, "ls": DASHES[mark.dash]}
        if isinstance(mark, chart.Series):
            face = mark.colour if np.all(mark.filled) else "white"
            look |= {"marker": mark.marker, "ms": mark.size, "mfc": face}
        return Line2D([], [], **look)
    return Patch(color=getattr(mark, "colour", GREY), alpha=getattr(mark, "alpha", 1.0))


def _mark_between(figure: Figure) -> None:
    """Mark 2 to 9 times each power of ten on logarithmic axes, as one line: faster than ticks."""
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


KINDS = ("png", "pdf", "svg")


def figure_file(figure: Figure, kind: str = "png", dpi: float = DPI) -> bytes:
    """Return `figure` as a file of a kind out of `KINDS`; its layout is solved now, and stays.

    Raises `InputError` for another kind.
    """
    checks.one_of("kinds", kind, KINDS)
    target, layout = io.BytesIO(), figure.get_layout_engine()
    with figure_rules():
        figure.set_dpi(dpi)
        if isinstance(layout, ConstrainedLayoutEngine):
            _mark_between(figure)
            layout.execute(figure)
            if any(axes.get_aspect() != "auto" for axes in figure.axes):
                layout.execute(figure)  # the labels of a panel to scale moved with its frame
            figure.set_layout_engine("none")
        # `savefig` would draw twice: once more to find out what it has to show
        canvas: Any = get_registered_canvas_class(kind)(figure)
        options = {"pil_kwargs": {"compress_level": 1}} if kind == "png" else {}
        getattr(canvas, f"print_{kind}")(target, **options)
    return target.getvalue()


def save_figure(
    figure: Figure, folder: Path, name: str, kinds: Sequence[str] = ("png", "pdf")
) -> list[Path]:
    """Write `figure` into `folder` as each of `kinds`: "png", "pdf" or "svg"; return the paths.

    Raises `FileError` if one cannot be written, `InputError` for another kind.
    """
    files = {kind: figure_file(figure, kind) for kind in kinds}
    return [write_bytes(folder / f"{name}.{kind}", content) for kind, content in files.items()]
