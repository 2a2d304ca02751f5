"""Charts on the page: draws a `Panel` with Bokeh, to be zoomed and read off under the pointer.

Bokeh: https://bokeh.org. Its core script, 1.3 MB, is a quarter of the size of Plotly's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from bokeh.layouts import gridplot
from bokeh.models import (
    BasicTickFormatter,
    ColumnDataSource,
    FixedTicker,
    HoverTool,
    LinearColorMapper,
    LogTickFormatter,
    Range1d,
)
from bokeh.models.annotations.geometry import BoxAnnotation, Span
from bokeh.models.annotations.legends import ColorBar, LegendItem
from bokeh.plotting import figure as Figure
from numpy.typing import ArrayLike, NDArray

from gripscale.charts import page_elements
from gripscale.charts.chart import (
    Axis,
    Band,
    Bars,
    CrossLine,
    Mark,
    Outline,
    Panel,
    Series,
    ValueMap,
    spelled_out,
)
from gripscale.charts.style import BEYOND, FAINT, GREY, INK, shades, stretches
from gripscale.core.arrays import Array

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
TOOLS = "pan,box_zoom,wheel_zoom,reset,save"
ALONG = "xpan,xbox_zoom,xwheel_zoom,reset,save"
"""Tools of figures that are zoomed together along their abscissa; a drag draws a box."""
LABELS = 70
"""Room for the numbers of the ordinates of linked figures [px], whose frames are aligned."""
COLUMNS = 1000
"""Pieces of an outline as the page is opened, a pixel each."""
LEAST_EXPONENT = -5
"""Powers of ten below it are written as such; 0.0004 is shorter than what Bokeh makes of it."""
LEAST_DECADES = 1000.0
"""From this ratio of largest to least on a log axis, Bokeh labels the decades."""
LEGEND_ROW = 28
"""Height of a row of the legend [px]; of more than two rows the figure grows."""
LEGEND_WIDTH = 300
"""Width the legend should keep within [px], that of a telephone; a letter takes about 6."""
PIXELS = 1.3
"""Pixels of a line on the page for each point of its width on paper."""
LEAST_MARKER = 6.0
"""Size of a marker that a pointer can hit [px]."""
LEAST_RANGE = 2.0
"""Largest over smallest number of a logarithmic ordinate, so that there are numbers along it."""
MOST_HOVERED = 2000
"""Points of a curve that tells its numbers under the pointer."""
MOST_EXACT = 300
"""Points above which a curve is stored in single precision: enough to draw, half the size."""

DASHES = {"dotted": "dotted", "dashed": "dashed", "dashdot": "dotdash", "solid": "solid"}
MARKERS = {
    "o": "circle", ".": "circle", "s": "square", "^": "triangle", "v": "inverted_triangle",
    "D": "diamond", "P": "plus", "X": "x", "x": "x", "+": "cross", "<": "hex", "d": "diamond_cross",
    ">": "star", "*": "star", "h": "square_pin", "p": "triangle_pin", "|": "dash",
}  # fmt: skip
"""Bokeh's word for a marker in matplotlib's letters."""


def draw_panel(panel: Panel) -> page_elements.Chart:
    """Return a chart of the page: the panel's Bokeh figure, with its caption and alternative."""
    return page_elements.Chart(panel.name, panel.caption, panel.alt, _figure(panel, Store()))


def draw_linked(panels: Sequence[Panel], name: str, caption: str, alt: str) -> page_elements.Chart:
    """Return panels below each other as one chart, zoomed together along their abscissa."""
    store = Store()
    figures = [_figure(panel, store, tools=ALONG) for panel in panels]
    for figure in figures[1:]:
        figure.x_range = figures[0].x_range
    for figure in figures:
        figure.update(min_border_left=LABELS, toolbar_location=None)
    figures[0].toolbar_location = "right"
    column = gridplot([[figure] for figure in figures], sizing_mode="stretch_width")
    return page_elements.Chart(name, caption, alt, column, wide=True)


class Store:
    """The columns that the outlines of a chart are drawn from, each array once."""

    def __init__(self) -> None:
        self._sources: dict[int, Any] = {}
        self._names: dict[int, str] = {}

    def source(self, length: int) -> Any:
        """Return the source of the columns of a length: all its columns must be equally long."""
        return self._sources.setdefault(length, ColumnDataSource())

    def name(self, values: ArrayLike) -> str:
        """Return the name of the column of an array."""
        if id(values) not in self._names:
            self._names[id(values)] = name = f"c{len(self._names)}"
            self.source(np.size(values)).data[name] = np.asarray(values)
        return self._names[id(values)]


def _figure(panel: Panel, store: Store, tools: str = TOOLS) -> Any:
    figure = Figure(
        height=panel.height,
        sizing_mode="stretch_width",
        match_aspect=panel.to_scale,
        x_axis_type="log" if panel.x.log else "linear",
        y_axis_type="log" if panel.y.log else "linear",
        x_axis_label=spelled_out(panel.x.label),
        y_axis_label=spelled_out(panel.y.label),
        tools=tools,
        active_drag=tools.split(",")[1],
        toolbar_location="right",
    )
    _style(figure)
    for which, axis in (("x", panel.x), ("y", panel.y)):
        # at equal scales Bokeh finds the limits
        free = replace(axis, low=None, high=None) if panel.to_scale else axis
        _set_axis(figure, which, free, _extent(panel.marks, which))
    points: list[Any] = []
    for mark in panel.marks:
        match mark:
            case Series():
                points += _draw_series(figure, mark, positive=panel.y.log)
            case Outline():
                _draw_outline(figure, mark, store)
            case ValueMap(levels=0):
                _draw_field(figure, mark)
            case Band():
                _draw_band(figure, mark, positive=panel.y.log)
            case Bars():
                x0, x1, y0, y1 = np.broadcast_arrays(
                    *np.atleast_1d(mark.x0, mark.x1, mark.y0, mark.y1)
                )
                figure.quad(left=x0, right=x1, bottom=y0, top=y1, line_color=None,
                            fill_color=mark.colour, fill_alpha=mark.alpha,
                            **_labelled(mark.label))  # fmt: skip
            case CrossLine(to=None):
                _draw_cross_line(figure, mark, panel)
            case CrossLine(to=float(end)):
                look: dict[str, Any] = {"fill_color": mark.colour, "line_color": mark.colour}
                look |= {"fill_alpha": 0.4, "level": "underlay"}
                sides = ("left", "right") if mark.upright else ("bottom", "top")
                look |= dict(zip(sides, (mark.at, end), strict=True))
                figure.add_layout(BoxAnnotation(**look))
    curves = [mark for mark in panel.marks if isinstance(mark, Series)]
    if any(np.any(curve.beyond) for curve in curves):
        figure.line([np.nan] * 2, [np.nan] * 2, color=GREY, line_dash="dashed", legend_label=BEYOND)
    if named := [point for point in points if point.name]:
        points = named
    if points:
        tips = [_tip(panel.x.label, "@x"), _tip(panel.y.label, "@y")]
        if sum(bool(curve.label) for curve in curves) > 1:
            tips.insert(0, ("curve", "$name"))
        figure.add_tools(HoverTool(renderers=points, tooltips=tips))
    if panel.legend == "none":
        boxes = list(figure.legend)
        figure.center = [part for part in figure.center if part not in boxes]
    else:
        _place_legend(figure)
    return figure


def _style(figure: Any) -> None:
    figure.toolbar.logo = None
    figure.outline_line_color = None
    figure.grid.grid_line_color = FAINT
    for axis in figure.axis:
        axis.axis_label_text_font = axis.major_label_text_font = FONT
        axis.axis_label_text_font_style = "normal"
        axis.axis_label_text_font_size = "13px"
        axis.major_label_text_font_size = "12px"
        axis.axis_line_color = axis.major_tick_line_color = INK
        axis.axis_label_text_color = axis.major_label_text_color = INK
        if isinstance(axis.formatter, LogTickFormatter):
            axis.formatter.min_exponent = 4
        else:
            axis.formatter.power_limit_low = LEAST_EXPONENT
            axis.minor_tick_line_color = None


def _extent(marks: Sequence[Mark], which: str) -> Array:
    """Return all finite numbers that marks show along an axis."""
    parts: list[Any] = []
    for mark in marks:
        match mark:
            case Series():
                ends = [end for end in (mark.low, mark.high) if end is not None]
                along = mark.level_bars == (which == "x")
                parts += [getattr(mark, which), *(ends if along else [])]
            case Band() | Outline():
                parts += [mark.x] if which == "x" else [mark.low, mark.high]
            case Bars():
                parts += [mark.x0, mark.x1] if which == "x" else [mark.y0, mark.y1]
            case ValueMap():
                parts.append(getattr(mark, which))
            case CrossLine() if mark.upright == (which == "x"):
                parts.append(mark.at)
    values: Array = np.concatenate([np.ravel(np.asarray(part, float)) for part in (*parts, [])])
    return np.asarray(values[np.isfinite(values)])


def _set_axis(figure: Any, which: str, axis: Axis, values: Array) -> None:
    """Set the limits of an axis and where its numbers stand."""
    drawn, grid = getattr(figure, f"{which}axis"), getattr(figure, f"{which}grid")
    limits = getattr(figure, f"{which}_range")
    if axis.ticks is not None:
        drawn.ticker = grid.ticker = FixedTicker(ticks=list(axis.ticks))
        drawn.major_label_overrides = {at: spelled_out(name) for at, name in axis.ticks.items()}
    if axis.low is not None and axis.high is not None:
        # room for markers at the ends, which Bokeh would cut
        ends = np.log([axis.low, axis.high]) if axis.log else np.array([axis.low, axis.high])
        ends += 0.02 * (ends[1] - ends[0]) * np.array([-1.0, 1.0])
        start, end = np.exp(ends) if axis.log else ends
        setattr(figure, f"{which}_range", Range1d(start=float(start), end=float(end)))
    elif not axis.log:
        limited = {"start": axis.low, "end": axis.high}
        limits.update(**{end: at for end, at in limited.items() if at is not None})
    if axis.whole and values.size and axis.ticks is None:
        whole = list(range(int(np.ceil(values.min())), int(values.max()) + 1))
        drawn.ticker = grid.ticker = FixedTicker(ticks=whole)
    values = values[values > 0.0]
    if not axis.log or not values.size:
        return
    if which == "y" and (axis.low is None or axis.high is None):
        room = max(LEAST_RANGE * values.min() / values.max(), 1.2) ** 0.5
        limits.update(start=values.min() / room, end=values.max() * room)
    span = values.max() / values.min()
    longest = LEAST_DECADES if values.min() > 10.0**LEAST_EXPONENT else 60.0
    if span < longest and axis.ticks is None:
        # Bokeh's own labels of a short log axis are few, and would round 0.2 and 0.5 to 0.1 and 1;
        # of one of two decades they crowd at its upper end.
        first = int(np.floor(np.log10(values.min()))) - 1
        steps: tuple[float, ...] = (1, 3)
        if span < 4.0:
            steps = (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)
        elif span < 60.0:
            steps = (1, 2, 5)
        ticks = [step * 10.0**n for n in range(first, first + 5) for step in steps]
        drawn.ticker = grid.ticker = FixedTicker(ticks=ticks)
        drawn.formatter = BasicTickFormatter(power_limit_low=LEAST_EXPONENT)


def _draw_series(figure: Any, series: Series, *, positive: bool) -> list[Any]:
    """Draw a curve, dashed beyond the measured band; return what shows its numbers."""
    x, y = _stored(series.x), _stored(series.y, positive=positive)
    width, label = PIXELS * series.width, spelled_out(series.label)
    look: dict[str, Any] = {"color": series.colour, "alpha": series.alpha, "name": label}
    look |= _labelled(series.label)
    drawn = []
    if series.low is not None and series.high is not None:
        low, high = _stored(series.low, positive=positive), _stored(series.high)
        ends = (low, y, high, y) if series.level_bars else (x, low, x, high)
        figure.segment(*ends, line_width=1.6, **look)
    if series.dash:
        for part, dashed in stretches(np.broadcast_to(series.beyond, x.shape)):
            dash = "dashed" if dashed else DASHES[series.dash]
            drawn.append(figure.line(x[part], y[part], line_width=width, line_dash=dash, **look))
    if series.marker:
        filled = np.broadcast_to(np.asarray(series.filled, dtype=bool), x.shape)
        size = 4.5 if series.marker == "." else max(1.2 * PIXELS * series.size, LEAST_MARKER)
        for chosen, face in ((filled, series.colour), (~filled, "white")):
            if chosen.any():
                drawn.append(figure.scatter(
                    x[chosen], y[chosen], marker=MARKERS[series.marker], size=size,
                    line_width=max(width, 1.0) if series.marker in "x+|" else 1.2,
                    angle=0.5 * np.pi if series.marker == "|" else 0.0,
                    **(look | {"fill_color": face}),
                ))  # fmt: skip
        drawn = [part for part in drawn if part.glyph.__class__.__name__ == "Scatter"]
    return drawn if x.size <= MOST_HOVERED else []


def _draw_outline(figure: Any, outline: Outline, store: Store) -> None:
    """Draw a curve in pieces; `templates/outlines.js` draws it anew as the reader zooms."""
    x, y = outline.drawn(COLUMNS)
    columns = [store.name(values) for values in (outline.x, outline.low, outline.high)]
    source = ColumnDataSource({"x": _stored(x), "y": _stored(y)})
    source.tags = ["outline", store.source(np.size(outline.x)), *columns]
    width = PIXELS * outline.width
    figure.line("x", "y", source=source, color=outline.colour, line_width=width,
                **_labelled(outline.label))  # fmt: skip


def _draw_field(figure: Any, field: ValueMap) -> None:
    x, y = np.asarray(field.x), np.asarray(field.y)
    values = np.asarray(field.values, dtype=np.float32)
    palette = shades(256, "Inferno")
    colours = LinearColorMapper(
        palette=palette, low=0.0, high=float(np.nanmax(values)), nan_color="white"
    )
    steps = float(x[1] - x[0]), float(y[1] - y[0])
    figure.image(image=[values], x=float(x[0]), y=float(y[0]), dw=steps[0] * x.size,
                 dh=steps[1] * y.size, color_mapper=colours)  # fmt: skip
    bar = ColorBar(color_mapper=colours, title=spelled_out(field.label), title_text_font=FONT,
                   title_text_font_style="normal")  # fmt: skip
    figure.add_layout(bar, "right")


def _draw_band(figure: Any, band: Band, *, positive: bool) -> None:
    arrays = np.broadcast_arrays(_stored(band.x), _stored(band.low, positive=positive), band.high)
    finite = np.isfinite(arrays).all(axis=0)
    x, low, high = (array[finite] for array in arrays)
    look = {"fill_color": band.colour, "fill_alpha": band.alpha} | _labelled(band.label)
    if x.size:
        figure.varea(x=x, y1=low, y2=high, **look)


def _draw_cross_line(figure: Any, line: CrossLine, panel: Panel) -> None:
    """Draw a line across the limits of the abscissa or all that is drawn, or upright as a span."""
    look: dict[str, Any] = {
        "line_color": line.colour,
        "line_dash": DASHES[line.dash],
        "line_width": PIXELS * line.width,
    }
    if line.upright:
        figure.add_layout(Span(location=line.at, dimension="height", **look))
    across = [end for end in (panel.x.low, panel.x.high) if end is not None]
    x = across or _extent(panel.marks, "x")
    ends = [np.nan] * 2 if line.upright or not len(x) else [min(x), max(x)]
    figure.line(ends, [line.at] * 2, **look, **_labelled(line.label))


def _labelled(label: str) -> dict[str, Any]:
    """Return the entry of the legend, if there is one."""
    return {"legend_label": spelled_out(label)} if label else {}


def _stored(values: ArrayLike, *, positive: bool = False) -> NDArray[Any]:
    """Return values as the page keeps them, NaN where a log axis cannot show them."""
    array = np.asarray(values, dtype=float)
    array = np.where(array > 0.0, array, np.nan) if positive else array
    return array.astype(np.float32) if array.size > MOST_EXACT else array


def _tip(label: str, value: str) -> tuple[str, str]:
    """Return name and value of a coordinate under the pointer, with the unit of its axis."""
    words, _, unit = spelled_out(label).rpartition(" [")
    unit = unit.partition("]")[0]
    return words or value.removeprefix("@"), value if unit in ("-", "") else f"{value} {unit}"


def _place_legend(figure: Any) -> None:
    """Move the legend above the frame; a click on an entry hides or shows its curve."""
    for box in list(figure.legend):
        figure.center = [part for part in figure.center if part is not box]
        items = [item for item in box.items if isinstance(item, LegendItem)]
        longest = max((len(str(getattr(item.label, "value", ""))) for item in items), default=1)
        box.ncols = min(max(LEGEND_WIDTH // (6 * longest + 33), 1), 4)
        box.orientation = "horizontal"
        box.click_policy = "hide"
        box.label_text_font = FONT
        box.label_text_font_size = "12px"
        box.border_line_color = None
        box.update(padding=2, margin=0, spacing=8)
        figure.add_layout(box, "above")
        rows = -(-len(items) // box.ncols)
        figure.update(height=figure.height + LEGEND_ROW * max(rows - 2, 0))
