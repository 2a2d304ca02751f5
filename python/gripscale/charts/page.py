"""The look shared by the interactive figures: axes, colours, tools, legends.

Bokeh: https://bokeh.org. Its core script, 1.3 MB, is a quarter of the size of Plotly's.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from bokeh.models import BasicTickFormatter, FixedTicker, HoverTool, LogTickFormatter, Range1d
from bokeh.models.annotations.legends import Legend, LegendItem
from bokeh.palettes import Viridis256
from bokeh.plotting import figure as Figure
from numpy.typing import ArrayLike

from gripscale.charts.style import BEYOND, FAINT, GREY, INK, stretches

RED = "#B00020"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Liberation Sans', Arial, sans-serif"
HEIGHT = 340
LEGEND_ROW = 28
"""Height of a row of the legend [px]; of more than two rows the figure grows."""
LEGEND_WIDTH = 300
"""Width the legend should keep within [px], that of a telephone; a letter takes about 6."""


def plot(
    x: str,
    y: str,
    *,
    log: str = "",
    wavelengths: ArrayLike | None = None,
    height: int = HEIGHT,
    **options: Any,
) -> Figure:
    """Return an empty figure.

    Parameters
    ----------
    x, y
        Labels of the axes, with units.
    log
        Which axes are logarithmic: "x", "y", "xy" or none.
    wavelengths
        If given [mm], x is a log axis of wavelength that falls to the right, as in the paper.
    height
        Height [px]; the width is that of the page.
    **options
        Passed to Bokeh.
    """
    if wavelengths is not None:
        log += "x"
        low, high = np.min(wavelengths), np.max(wavelengths)
        options["x_range"] = Range1d(start=1.4 * float(high), end=float(low) / 1.4)
    figure = Figure(
        height=height,
        sizing_mode="stretch_width",
        x_axis_type="log" if "x" in log else "linear",
        y_axis_type="log" if "y" in log else "linear",
        x_axis_label=x,
        y_axis_label=y,
        tools="pan,box_zoom,wheel_zoom,reset,save",
        active_drag="box_zoom",
        toolbar_location="right",
        **options,
    )
    _style(figure)
    if wavelengths is not None and high / low < 60.0:
        tick_closely(figure)
    return figure


def tick_closely(figure: Figure) -> None:
    """Put ticks at 1, 2 and 5 times each power of ten below a log axis of less than two decades.

    Bokeh's own labels of a log axis would round 0.2 and 0.5 to 0.1 and 1.
    """
    ticks = [m * 10.0**n for n in range(-6, 5) for m in (1, 2, 5)]
    figure.xaxis.ticker = figure.xgrid.ticker = FixedTicker(ticks=ticks)
    figure.xaxis.formatter = BasicTickFormatter()


def _style(figure: Figure) -> None:
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
            axis.minor_tick_line_color = None


def legend(figure: Figure) -> Figure:
    """Move the legend above the frame; a click on an entry hides or shows its curve."""
    for box in list(figure.legend):
        figure.center = [part for part in figure.center if part is not box]
        figure.add_layout(box, "above")
        rows = _style_legend(box)
        figure.update(height=(figure.height or HEIGHT) + LEGEND_ROW * max(rows - 2, 0))
    return figure


def _style_legend(box: Legend) -> int:
    """Set the look of a legend and return how many rows it has."""
    items = [item for item in box.items if isinstance(item, LegendItem)]
    longest = max((len(str(getattr(item.label, "value", ""))) for item in items), default=1)
    box.orientation = "horizontal"
    columns = min(max(LEGEND_WIDTH // (6 * longest + 33), 1), 4)
    box.ncols = columns
    box.click_policy = "hide"
    box.label_text_font = FONT
    box.label_text_font_size = "12px"
    box.border_line_color = None
    box.update(padding=2, margin=0, spacing=8)
    return -(-len(items) // columns)


def hover(figure: Figure, renderers: Iterable[Any], tips: Sequence[tuple[str, str]]) -> None:
    """Show `tips` over the points of `renderers`."""
    figure.add_tools(HoverTool(renderers=list(renderers), tooltips=list(tips)))


def single(values: ArrayLike) -> np.ndarray:
    """Return `values` in single precision: enough to draw, half the size."""
    return np.asarray(values, dtype=np.float32)


def positive(values: ArrayLike) -> np.ndarray:
    """Return `values` with NaN where a log axis cannot show them."""
    array = np.asarray(values, dtype=float)
    return np.where(array > 0.0, array, np.nan)


def whole_decades(figure: Figure, *values: ArrayLike) -> None:
    """Let a log axis of heights start and end at powers of ten, at least two apart.

    Over less than two decades Bokeh's ticks are those of a linear axis, too few to read.
    """
    everything = np.concatenate([np.ravel(np.asarray(part, dtype=float)) for part in values])
    shown = everything[np.isfinite(everything) & (everything > 0.0)]
    if shown.size:
        first, last = np.log10(shown.min()), np.log10(shown.max())
        high = np.ceil(last - 1e-6)
        low = min(np.floor(first), high - 2.0)
        figure.y_range.update(start=10.0 ** (low - 0.05), end=10.0 ** (high + 0.1))


def curve(
    figure: Figure,
    x: ArrayLike,
    y: ArrayLike,
    colour: str,
    label: str,
    *,
    beyond: ArrayLike | None = None,
    dash: str = "solid",
    fill: str = "",
) -> Any:
    """Draw a line with points on it, dashed where it is `beyond` the measured band.

    `dash` is its own dash, `fill` the colour inside a point.
    """
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    line(figure, x, y, beyond, color=colour, line_width=1.8, line_dash=dash, legend_label=label)
    return figure.scatter(
        x, y, size=7, line_color=colour, fill_color=fill or colour, legend_label=label
    )


def line(
    figure: Figure, x: np.ndarray, y: np.ndarray, beyond: ArrayLike | None, **look: Any
) -> None:
    """Draw a line, dashed where it is `beyond` the measured band."""
    flags = np.zeros(x.size, dtype=bool) if beyond is None else np.asarray(beyond, dtype=bool)
    for part, dashed in stretches(flags):
        figure.line(x[part], y[part], **(look | {"line_dash": "dashed"} if dashed else look))


def dashed_entry(figure: Figure, *beyond: ArrayLike) -> None:
    """Say in the legend what dashed is, if any curve is beyond the measured band."""
    if any(np.any(flags) for flags in beyond):
        nowhere = [np.nan, np.nan]
        figure.line(nowhere, nowhere, color=GREY, line_dash="dashed", legend_label=BEYOND)


def shades(count: int) -> list[str]:
    """Return colours in order, from dark to light."""
    at = np.linspace(0, 215, max(count, 1)).astype(int)
    return [Viridis256[i] for i in at]


def wave_ticks(figure: Figure, count: int) -> None:
    """Put a tick at every wave number."""
    ticker = FixedTicker(ticks=list(range(1, count + 1)))
    figure.xaxis.ticker = ticker
    figure.xgrid.ticker = ticker
