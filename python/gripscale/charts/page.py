"""Charts on the page: draws a `Panel` for Bokeh, to be zoomed and read off under the pointer.

Bokeh: https://bokeh.org. Its core script, 1.3 MB, is a quarter of the size of Plotly's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from bokeh.core.property.vectorization import Field, Value
from numpy.typing import ArrayLike, NDArray

from gripscale.charts.bokeh_parts import Part, columns
from gripscale.charts.chart import (
    CrossLine,
    Mark,
    Outline,
    Panel,
    PlotAxis,
    Series,
    ShadedBand,
    ValueMap,
    spelled_out,
)
from gripscale.charts.draw import Chart
from gripscale.charts.style import BEYOND_LABEL, FAINT, GREY, INK, shades, stretches
from gripscale.core.arrays import Array

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
# Room for the numbers of the ordinates of linked figures [px], whose frames are aligned.
_LABELS = 70
_COLUMNS = 1000  # pieces of an outline as the page is opened, a pixel each
# Powers of ten below it are written as such; 0.0004 is shorter than what Bokeh makes of it.
LEAST_EXPONENT = -5
# From this ratio of largest to least on a log axis, Bokeh labels the decades.
LEAST_DECADES = 1000.0
# Numbers between the powers of ten of a short log axis, by its largest over least value.
_STEPS: tuple[tuple[float, tuple[float, ...]], ...] = (
    (2.0, (1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 7, 8, 9)),
    (4.0, (1, 1.5, 2, 3, 4, 5, 7)),
    (60.0, (1, 2, 5)),
    (LEAST_DECADES, (1, 3)),
)
_AROUND = 75  # height of a figure around its frame [px]: abscissa and a line of the legend
# The legend has as many lines as the width of the frame asks for, and the figure grows by them.
LEGEND_LINES = """\
:host { width: max-content; max-width: 100%; }
.bk-grid { display: flex; flex-wrap: wrap; width: auto; gap: 2px 14px; }
.bk-label.bk-label { white-space: normal; }
"""
PIXELS = 1.3  # pixels of a line on the page for each point of its width on paper
LEAST_MARKER = 6.0  # size of a marker that a pointer can hit [px]
# Largest over smallest number of a logarithmic ordinate, so that there are numbers along it.
_LEAST_RANGE = 2.0
MOST_HOVERED = 2000  # points of a curve that tells its numbers under the pointer
# Points above which a curve is stored in single precision: enough to draw, half the size.
MOST_EXACT = 300
_DASHES = {"dotted": [2, 4], "dashed": [6], "dashdot": [2, 4, 6, 4], "solid": []}
# Bokeh's word for a marker in matplotlib's letters.
_MARKERS = {
    "o": "circle", ".": "circle", "s": "square", "^": "triangle", "v": "inverted_triangle",
    "D": "diamond", "P": "plus", "X": "x", "x": "x", "+": "cross", "<": "hex", "d": "diamond_cross",
    ">": "star", "*": "star", "h": "square_pin", "p": "triangle_pin", "|": "dash",
}  # fmt: skip


def draw_panel(panel: Panel) -> Chart:
    """Return a chart of the page: the panel's figure, with its caption and alternative."""
    return Chart(panel.name, panel.caption, panel.alt, _figure(panel, DataStore()))


def draw_linked(panels: Sequence[Panel], name: str, caption: str, alt: str) -> Chart:
    """Return panels below each other as one chart, zoomed together along their abscissa."""
    store = DataStore()
    figures = [_figure(panel, store, along=True) for panel in panels]
    for figure in figures:
        figure.update(x_range=figures[0]["x_range"], min_border_left=_LABELS, toolbar_location=None)
    alike = zip(*(figure["toolbar"]["tools"][:4] for figure in figures), strict=True)
    shared = [Part("ToolProxy", tools=list(tools)) for tools in alike]
    toolbar = Part("Toolbar", tools=[*shared, Part("SaveTool")], logo=None, active_drag=shared[1])
    rows = [(figure, row, 0) for row, figure in enumerate(figures)]
    column = Part("GridPlot", children=rows, sizing_mode="stretch_width", toolbar=toolbar)
    return Chart(name, caption, alt, column, wide=True)


class DataStore:
    """The columns that the outlines of a chart are drawn from, each array once."""

    def __init__(self) -> None:
        self._sources: dict[int, Part] = {}
        self._names: dict[int, str] = {}

    def source(self, length: int) -> Part:
        """Return the source of the columns of a length: all its columns must be equally long."""
        return self._sources.setdefault(length, columns({}))

    def name(self, values: ArrayLike) -> str:
        """Return the name of the column of an array."""
        if id(values) not in self._names:
            self._names[id(values)] = name = f"c{len(self._names)}"
            self.source(np.size(values))["data"][name] = np.asarray(values)
        return self._names[id(values)]


def _figure(panel: Panel, store: DataStore, *, along: bool = False) -> Part:
    # `along` the abscissa only where it is zoomed with others
    sides = "width" if along else "both"
    moving = [Part(name, dimensions=sides) for name in ("PanTool", "BoxZoomTool", "WheelZoomTool")]
    tools = [*moving, Part("ResetTool"), Part("SaveTool")]
    # a click on an entry hides or shows its curve
    legend = Part("Legend", items=[], orientation="horizontal", click_policy="hide", margin=2,
                  glyph_height=18, label_height=18, border_line_color=None, label_text_font=FONT,
                  label_text_font_size="12px", stylesheets=[LEGEND_LINES])  # fmt: skip
    figure = Part("Figure", height=None, frame_height=panel.height - _AROUND,
                  sizing_mode="stretch_width", match_aspect=panel.to_scale,
                  outline_line_color=None, renderers=[], center=[], right=[], above=[legend],
                  toolbar=Part("Toolbar", tools=tools, active_drag=moving[1], logo=None)
                  )  # fmt: skip
    for which, axis in (("x", panel.x), ("y", panel.y)):
        # at equal scales Bokeh finds the limits
        free = replace(axis, low=None, high=None) if panel.to_scale else axis
        _set_axis(figure, which, free, _extent(panel.marks, which))
    points = [point for mark in panel.marks for point in _draw_mark(figure, mark, panel, store)]
    curves = [mark for mark in panel.marks if isinstance(mark, Series)]
    if any(np.any(curve.beyond) for curve in curves):
        nowhere = columns({"x": [np.nan] * 2, "y": [np.nan] * 2})
        dash = _DASHES["dashed"]
        _draw_line(figure, nowhere, BEYOND_LABEL, line_color=GREY, line_dash=dash)
    if named := [point for point in points if point["name"]]:
        points = named
    if points:
        tips = [_tip(panel.x.label, "@x"), _tip(panel.y.label, "@y")]
        if sum(bool(curve.label) for curve in curves) > 1:
            tips.insert(0, ("curve", "$name"))
        figure["toolbar"]["tools"].append(Part("HoverTool", renderers=points, tooltips=tips))
    if not figure["above"][0]["items"]:
        figure.update(above=[])
    return figure


def _draw_mark(figure: Part, mark: Mark, panel: Panel, store: DataStore) -> list[Part]:
    """Draw a mark; return what shows its numbers under the pointer."""
    match mark:
        case Series():
            return _draw_series(figure, mark, positive=panel.y.log)
        case Outline():  # `templates/outlines.js` draws it anew as the reader zooms
            x, y = mark.drawn(_COLUMNS)
            names = [store.name(values) for values in (mark.x, mark.low, mark.high)]
            tags = ["outline", store.source(np.size(mark.x)), *names]
            width = PIXELS * mark.width
            source = columns({"x": _stored(x), "y": _stored(y)}, tags=tags)
            _draw_line(figure, source, mark.label, line_color=mark.colour, line_width=width)
        case ValueMap():
            _draw_field(figure, mark)
        case ShadedBand():
            low = _stored(mark.low, positive=panel.y.log)
            arrays = np.broadcast_arrays(_stored(mark.x), low, mark.high)
            finite = np.isfinite(arrays).all(axis=0)
            if finite.any():
                shape = (array[finite] for array in arrays)
                source = columns(dict(zip(("x", "y1", "y2"), shape, strict=True)))
                look = {"fill_color": mark.colour, "fill_alpha": mark.alpha}
                area = Part("VArea", **{name: Field(name) for name in source["data"]}, **look)
                _draw_glyph(figure, source, area, mark.label)
        case CrossLine(to=None):
            _draw_cross_line(figure, mark, panel)
        case CrossLine(to=float(end)):
            edges = ("left", "right") if mark.upright else ("bottom", "top")
            shade = dict(zip(edges, (mark.at, end), strict=True))
            look = {"fill_color": mark.colour, "line_color": mark.colour, "fill_alpha": 0.4}
            figure["center"].append(Part("BoxAnnotation", level="underlay", **look, **shade))
    return []


def _extent(marks: Sequence[Mark], which: str) -> Array:
    parts: list[Any] = []
    for mark in marks:
        match mark:
            case Series():
                parts.append(getattr(mark, which))
            case ShadedBand() | Outline():
                parts += [mark.x] if which == "x" else [mark.low, mark.high]
            case ValueMap():
                parts.append(getattr(mark, which))
            case CrossLine() if mark.upright == (which == "x"):
                parts.append(mark.at)
    values: Array = np.concatenate([np.ravel(np.asarray(part, float)) for part in (*parts, [])])
    return np.asarray(values[np.isfinite(values)])


def _set_axis(figure: Part, which: str, axis: PlotAxis, values: Array) -> None:
    """Draw an axis with its grid: where its numbers stand, and its limits."""
    kind = "Log" if axis.log else "Linear"
    drawn = Part(
        f"{kind}Axis",
        axis_label=spelled_out(axis.label) or None,
        axis_label_text_font=FONT,
        axis_label_text_font_style="normal",
        axis_label_text_font_size="13px",
        axis_label_text_color=INK,
        major_label_text_font=FONT,
        major_label_text_font_size="12px",
        major_label_text_color=INK,
        axis_line_color=INK,
        major_tick_line_color=INK,
    )
    if axis.log:
        formatter = Part("LogTickFormatter", min_exponent=4)
        drawn.update(ticker=Part("LogTicker", num_minor_ticks=10), formatter=formatter)
    else:
        formatter = Part("BasicTickFormatter", power_limit_low=LEAST_EXPONENT)
        drawn.update(minor_tick_line_color=None, formatter=formatter)
    grid = Part("Grid", axis=drawn, dimension="xy".index(which), grid_line_color=FAINT)
    figure["center"].append(grid)
    side = "below" if which == "x" else "left"
    figure.update(**{side: [drawn], f"{which}_scale": Part(f"{kind}Scale")})
    figure.update(**{f"{which}_range": _limits(which, axis, values)})
    _set_ticks(drawn, axis, values)


def _limits(which: str, axis: PlotAxis, values: Array) -> Part:
    """Return the limits of an axis, which Bokeh finds where they are not set."""
    if axis.low is not None and axis.high is not None:
        # room for markers at the ends, which Bokeh would cut
        ends = np.log([axis.low, axis.high]) if axis.log else np.array([axis.low, axis.high])
        ends += 0.02 * (ends[1] - ends[0]) * np.array([-1.0, 1.0])
        start, end = np.exp(ends) if axis.log else ends
        return Part("Range1d", start=float(start), end=float(end))
    limited = {"start": axis.low, "end": axis.high}
    if axis.log:
        values = values[values > 0.0]
        if which == "x" or not values.size:
            return Part("DataRange1d")
        room = max(_LEAST_RANGE * values.min() / values.max(), 1.2) ** 0.5
        limited = {"start": float(values.min() / room), "end": float(values.max() * room)}
    return Part("DataRange1d", **{end: at for end, at in limited.items() if at is not None})


def _set_ticks(drawn: Part, axis: PlotAxis, values: Array) -> None:
    """Set where the numbers of an axis stand, if Bokeh would not find it well."""
    values = values[values > 0.0]
    if not axis.log or not values.size:
        return
    span = values.max() / values.min()
    if span < (LEAST_DECADES if values.min() > 10.0**LEAST_EXPONENT else 60.0):
        # Bokeh's own labels of a short log axis are few, and would round 0.2 and 0.5 to 0.1 and 1;
        # of one of two decades they crowd at its upper end.
        first = int(np.floor(np.log10(values.min()))) - 1
        steps = next(steps for most, steps in _STEPS if span < most)
        ticks = [step * 10.0**n for n in range(first, first + 5) for step in steps]
        formatter = Part("BasicTickFormatter", power_limit_low=LEAST_EXPONENT)
        drawn.update(ticker=Part("FixedTicker", ticks=ticks), formatter=formatter)


def _draw_glyph(figure: Part, source: Part, glyph: Part, label: str = "", name: str = "") -> Part:
    """Draw the columns of a source, with an entry of the legend if there is a label."""
    curve = Part("GlyphRenderer", data_source=source, glyph=glyph, name=name)
    figure["renderers"].append(curve)
    if label:
        words = Value(spelled_out(label))
        items = figure["above"][0]["items"]
        for item in items:
            if item["label"] == words:
                item["renderers"].append(curve)
                break
        else:
            items.append(Part("LegendItem", label=words, renderers=[curve]))
    return curve


def _draw_line(figure: Part, source: Part, label: str, name: str = "", **look: Any) -> Part:
    line = Part("Line", x=Field("x"), y=Field("y"), **look)
    return _draw_glyph(figure, source, line, label, name)


def _draw_series(figure: Part, series: Series, *, positive: bool) -> list[Part]:
    """Draw a curve, dashed beyond the measured band; return what shows its numbers."""
    x, y = _stored(series.x), _stored(series.y, positive=positive)
    width, name = PIXELS * series.width, spelled_out(series.label)
    look: dict[str, Any] = {"line_color": series.colour, "line_alpha": series.alpha}
    lines: list[Part] = []
    points: list[Part] = []
    if series.dash:
        for part, dashed in stretches(np.broadcast_to(series.beyond, x.shape)):
            source = columns({"x": x[part], "y": y[part]})
            drawn = {"line_width": width, "line_dash": _DASHES["dashed" if dashed else series.dash]}
            lines.append(_draw_line(figure, source, series.label, name, **drawn, **look))
    if series.marker:
        filled = np.broadcast_to(np.asarray(series.filled, dtype=bool), x.shape)
        size = 4.5 if series.marker == "." else max(1.2 * PIXELS * series.size, LEAST_MARKER)
        for chosen, face in ((filled, series.colour), (~filled, "white")):
            if chosen.any():
                source = columns({"x": x[chosen], "y": y[chosen]})
                markers = _glyph(
                    "Scatter", source, marker=_MARKERS[series.marker], size=size,
                    line_width=max(width, 1.0) if series.marker in "x+|" else 1.2,
                    angle=0.5 * np.pi if series.marker == "|" else 0.0,
                    fill_color=face, fill_alpha=series.alpha, **look,
                )  # fmt: skip
                points.append(_draw_glyph(figure, source, markers, series.label, name))
    return (points or lines) if x.size <= MOST_HOVERED else []


def _glyph(kind: str, source: Part, **look: Any) -> Part:
    """Return how all points of a source look, with an attribute for each of its columns."""
    look = {name: Value(constant) for name, constant in look.items()}
    return Part(kind, **{name: Field(name) for name in source["data"]}, **look)


def _draw_field(figure: Part, drawn: ValueMap) -> None:
    x, y = np.asarray(drawn.x), np.asarray(drawn.y)
    values = np.asarray(drawn.values, dtype=np.float32)
    palette, high = shades(256, "Inferno"), float(np.nanmax(values))
    colours = Part("LinearColorMapper", palette=palette, low=0.0, high=high, nan_color="white")
    steps = float(x[1] - x[0]), float(y[1] - y[0])
    glyph = Part("Image", image=Field("image"), color_mapper=colours, x=Value(float(x[0])),
                 y=Value(float(y[0])), dw=Value(steps[0] * x.size),
                 dh=Value(steps[1] * y.size))  # fmt: skip
    _draw_glyph(figure, columns({"image": [values]}), glyph)
    figure["right"].append(Part("ColorBar", color_mapper=colours, title=spelled_out(drawn.label),
                                title_text_font=FONT, title_text_font_style="normal"))  # fmt: skip


def _draw_cross_line(figure: Part, line: CrossLine, panel: Panel) -> None:
    """Draw a line across the limits of the abscissa or all that is drawn, or upright as a span."""
    look: dict[str, Any] = {"line_color": line.colour, "line_dash": _DASHES[line.dash]}
    look["line_width"] = PIXELS * line.width
    if line.upright:
        figure["center"].append(Part("Span", location=line.at, dimension="height", **look))
    across = [end for end in (panel.x.low, panel.x.high) if end is not None]
    x = across or _extent(panel.marks, "x")
    ends = [np.nan] * 2 if line.upright or not len(x) else [min(x), max(x)]
    _draw_line(figure, columns({"x": ends, "y": [line.at] * 2}), line.label, **look)


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
