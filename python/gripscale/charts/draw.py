"""Draw descriptions of charts; matplotlib and Bokeh are imported at the first use of each."""

from __future__ import annotations

import base64
import io
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from gripscale.charts.chart import Mark, Panel
from gripscale.charts.page_elements import Chart, Image, Picture
from gripscale.charts.style import WIDE

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Drawing(ABC):
    """What a figure on paper is drawn from."""

    @abstractmethod
    def on_paper(self) -> Figure:
        """Draw it with matplotlib."""


@dataclass(frozen=True)
class ColourBar:
    """What colours from a scale of `gripscale.charts.style.shades` mean."""

    low: float
    high: float
    scale: str
    label: str
    first_row: bool = False  # whether it belongs to the first row of panels only


@dataclass(frozen=True)
class Sheet(Drawing):
    """Panels of a figure on paper, row by row."""

    panels: Sequence[Panel]
    columns: int = 2
    width: float = WIDE
    height: float = 3.1  # of the figure [inch]
    # Where the legend of all panels is: "above", "beside", "below" or nowhere.
    legend: str = "above"
    legend_columns: int = 3
    legend_title: str = ""
    keys: Sequence[Mark] = ()  # entries of the legend that no panel has
    title: str = ""
    gap: float = 0.06
    colour_bar: ColourBar | None = None
    # `sharex`, `sharey`, `width_ratios` and `height_ratios` of matplotlib's `subplots`.
    layout: Mapping[str, Any] = field(default_factory=dict)

    def on_paper(self) -> Figure:
        """Draw the panels with matplotlib, whose own rules stay as they are."""
        from gripscale.charts import paper

        with paper.house_rules():
            figure, axes = paper.draw_panels(
                self.panels, self.columns, (self.width, self.height), self.gap, self.layout
            )
            if self.legend:
                columns = self.legend_columns
                paper.add_legend(figure, axes, self.keys, self.legend, self.legend_title, columns)
            if self.colour_bar is not None:
                bar = self.colour_bar
                near = axes[: self.columns] if bar.first_row else axes
                paper.add_colour_bar(figure, near, (bar.low, bar.high), bar.scale, bar.label)
            if self.title:
                figure.suptitle(self.title)
        return figure


def panels_on_page(panels: Iterable[Panel]) -> list[Chart]:
    """Draw interactive charts with Bokeh."""
    from gripscale.charts.page import draw_panel

    return [draw_panel(panel) for panel in panels]


PICTURE_DPI = 170
SHADES = 96  # colours a picture is reduced to: a third of the bytes, no visible loss


def image(picture: Picture) -> Image:
    """Return a picture as a page holds it, drawn with matplotlib."""
    import PIL.Image

    from gripscale.charts.paper import png

    drawn, packed = io.BytesIO(png(picture.figure, PICTURE_DPI)), io.BytesIO()
    pixels = PIL.Image.open(drawn).convert("RGB")
    pixels.quantize(SHADES).save(packed, "PNG")
    data = base64.b64encode(packed.getvalue()).decode("ascii")
    name = picture.name.replace("_", "-")
    return Image(name, picture.caption, picture.alt, data, "image/png", *pixels.size)
