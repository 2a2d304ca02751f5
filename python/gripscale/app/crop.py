"""The surface as measured, before any cleaning, and its crop: dragged on the figure."""

from __future__ import annotations

from typing import Any

import panel as pn
from bokeh.events import SelectionGeometry
from bokeh.models import BoxSelectTool

from gripscale.app.case import CaseState
from gripscale.app.elements import chart_pane, column, in_worker
from gripscale.case_file.prepare import raw_surface
from gripscale.charts.bokeh_parts import model
from gripscale.charts.page_elements import Chart
from gripscale.core.errors import GripscaleError
from gripscale.questions.inputs.charts_of_surface import raw_chart

# Keys of [surface] that this figure depends on.
READ_BY = (
    *("files", "map", "x_unit", "z_unit", "z_axis", "direction", "reader", "channel", "sheet"),
    *("step", "crop"),
)
HINT = "Drag along the road to keep only that part; an empty crop keeps everything."


class RawSurface:
    """The figure of the surface as measured, which follows the case and writes its crop."""

    def __init__(self, state: CaseState) -> None:
        self._state = state
        self._drawn: list[Any] = []
        self.body = column(min_height=60)
        if pn.state.curdoc is not None:  # else there is no page that could show it
            state.param.watch(lambda _: pn.state.execute(self.update), "text")
            pn.state.onload(self.update)

    async def update(self) -> None:
        """Read and draw the surface, if what it is read from has changed."""
        if (keys := self._keys()) == self._drawn:
            return
        self._drawn = keys
        try:
            surface = self._state.file()
        except GripscaleError:
            return  # the problem of the case says why
        table = surface.case.surface
        self.body.loading, self.body.objects = True, []
        try:
            with self._state.refusals("surface"):
                if table.measured_files:
                    chart = await in_worker(
                        lambda: raw_chart(raw_surface(table, surface.resolve), table.crop)
                    )
                    self.body.objects = [pn.pane.Markdown(HINT, margin=(0, 8)), self._live(chart)]
        finally:
            self.body.loading = False

    def _keys(self) -> list[Any]:
        return [self._state.get(("surface", name)) for name in READ_BY]

    def _live(self, chart: Chart) -> pn.Column:
        """Return the chart, on which a selection is the new crop."""
        of_map = self._state.get(("surface", "map")) is not None
        tool = BoxSelectTool(dimensions="both" if of_map else "width", renderers=[])
        figure = model(chart.figure)
        figure.add_tools(tool)
        figure.toolbar.active_drag = tool

        def select(event: SelectionGeometry) -> None:
            if event.final and self._drawn == self._keys():  # a late drag is on another road
                ends: Any = event.geometry
                self._state.set(("surface", "crop"), _range(ends["x0"], ends["x1"]))
                if of_map:
                    self._state.set(("surface", "crop_across"), _range(ends["y0"], ends["y1"]))

        figure.on_event(SelectionGeometry, select)
        return chart_pane(chart, figure)


def _range(first: float, last: float) -> list[str]:
    return [f"{end:.4g} mm" for end in sorted((first, last))]
