"""Draw descriptions of charts; matplotlib and Bokeh are imported at the first use of each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from gripscale.charts.chart import Panel

if TYPE_CHECKING:
    from gripscale.charts.page_elements import Chart, Image, Picture


def panels_on_page(panels: Iterable[Panel]) -> list[Chart]:
    """Draw interactive charts with Bokeh, which is imported here."""
    from gripscale.charts.page import draw_panel

    return [draw_panel(panel) for panel in panels]


def linked_on_page(panels: Sequence[Panel], name: str, caption: str, alt: str) -> Chart:
    """Draw panels below each other with Bokeh, zoomed together along their abscissa."""
    from gripscale.charts.page import draw_linked

    return draw_linked(panels, name, caption, alt)


def image(picture: Picture) -> Image:
    """Return a picture as a page holds it, drawn with matplotlib."""
    from gripscale.charts.picture import packed_image as packed

    return packed(picture)
