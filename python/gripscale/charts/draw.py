"""Draw descriptions of charts; matplotlib and Bokeh are imported at the first use of each."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from gripscale.charts.chart import ColourBar, Mark, Panel
from gripscale.charts.style import WIDE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.charts.bokeh_parts import Part


@dataclass(frozen=True)
class Chart:
    """An interactive figure: its part for Bokeh, caption and a text for who cannot see it."""

    name: str
    caption: str
    alt: str
    figure: Part
    wide: bool = False
    kind: ClassVar[str] = "chart"


@dataclass(frozen=True)
class Picture:
    """A figure of a results folder and its page: the name of its file, caption and alternative."""

    name: str
    figure: Figure
    caption: str
    alt: str


@dataclass(frozen=True)
class Image:
    """A picture inside the page, base64."""

    name: str
    caption: str
    alt: str
    data: str
    media_type: str
    width: int
    height: int
    kind: ClassVar[str] = "image"


@dataclass(frozen=True)
class Sheet:
    """A figure of panels on paper, row by row."""

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
        from gripscale.charts.paper import draw_sheet

        return draw_sheet(self)


def panels_on_page(panels: Iterable[Panel]) -> list[Chart]:
    """Draw interactive charts with Bokeh."""
    from gripscale.charts.page import draw_panel

    return [draw_panel(panel) for panel in panels]


PICTURE_DPI = 170
SHADES = 96  # colours a picture is reduced to: a third of the bytes, no visible loss


def image(picture: Picture) -> Image:
    """Return a picture as a page holds it, drawn with matplotlib."""
    import PIL.Image

    from gripscale.charts.paper import figure_file

    drawn, packed = io.BytesIO(figure_file(picture.figure, dpi=PICTURE_DPI)), io.BytesIO()
    pixels = PIL.Image.open(drawn).convert("RGB")
    pixels.quantize(SHADES).save(packed, "PNG")
    data = base64.b64encode(packed.getvalue()).decode("ascii")
    name = picture.name.replace("_", "-")
    return Image(name, picture.caption, picture.alt, data, "image/png", *pixels.size)


@dataclass(frozen=True)
class FigureFolder:
    """A folder of figures and what they are written as."""

    path: Path
    kinds: Sequence[str] | None = None  # out of `gripscale.charts.paper.KINDS`; png by default

    def save(self, figure: Sheet | Figure, name: str) -> None:
        """Write a figure or what describes it; `FileError` if that fails."""
        from gripscale.charts.paper import save_figure

        drawn = figure.on_paper() if isinstance(figure, Sheet) else figure
        save_figure(drawn, self.path, name, self.kinds or ("png",))
