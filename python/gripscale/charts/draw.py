"""Draw descriptions of charts; matplotlib and Bokeh are imported at the first use of each."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from gripscale.charts.chart import Panel, PanelGrid
from gripscale.charts.page_elements import Chart, Image, Picture

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class Sheet(PanelGrid):
    """A figure of panels."""

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
