"""Tabs for what the case is made of: road, rubber, load with conditions and solver.

Each has the uploads and the fields of its tables; road and rubber have a preview of what is read
and fitted from the files.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import panel as pn
from bokeh.events import SelectionGeometry
from bokeh.models import BoxSelectTool

from gripscale import case_file
from gripscale.app.case import CaseState, with_value
from gripscale.app.case_panel import NewText, file_upload, problem_pane, with_upload
from gripscale.app.elements import column, html, in_worker
from gripscale.app.forms import PreviewPanel, table_form
from gripscale.case import Case
from gripscale.case_file.prepare import raw_surface
from gripscale.case_file.proposals import Proposal, rubber_proposal, surface_proposal
from gripscale.case_file.rubber_tables import NAMED_RUBBERS
from gripscale.charts.bokeh_parts import model
from gripscale.charts.draw import Chart, Picture, image
from gripscale.core import Finding, GripscaleError, Severity
from gripscale.questions.inputs import page, record
from gripscale.questions.inputs.charts_of_rubber import superposition_figure
from gripscale.questions.inputs.charts_of_surface import (
    correlation_charts,
    profile_charts,
    raw_chart,
)
from gripscale.questions.inputs.record import InputRecord
from gripscale.report.elements import Element, Page, Section, Text, as_elements

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
        figure.html_attributes = {"role": "img", "aria-label": chart.alt}
        pane = pn.pane.Bokeh(figure, sizing_mode="stretch_width", margin=(4, 8))
        return column(pane, html(Text(chart.caption)), css_classes=["chart"])


def _range(first: float, last: float) -> list[str]:
    return [f"{end:.4g} mm" for end in sorted((first, last))]


ROAD_FIELDS = (
    *("scales", "smallest_wavelength", "cut_off", "top_height_fraction"),
    *("crop", "x_unit", "z_unit", "z_axis"),
)
RUBBER_FIELDS = (
    *("filled", "name", "reference_temperature", "bulk_modulus", "thickness"),
    *("terms", "extrapolate", "source"),
)
# Tables of the case by name: their title and the fields at the top.
LOAD_TABLES = {
    "load": ("Load", ("pressure", "speed", "footprint", "load_time")),
    "conditions": ("Conditions", ("temperature", "interface", "strain_norm")),
    "solver": ("Solver of one wave", ("model", "points", "columns", "tolerance")),
    "chain": ("Chain of waves", ("pressure_classes",)),
}


def _case_with(file: case_file.CaseFile, **tables: Any) -> Case:
    """Read the case with `tables` in place of its own, and without conditions.

    So the surface can be seen before the rubber is stated, and the rubber before the surface.
    """
    plain = {"conditions": case_file.ConditionsTable(), "measured": case_file.MeasuredTable()}
    return case_file.read_case(replace(file, case=file.case.model_copy(update=plain | tables)))


def surface_page(file: case_file.CaseFile) -> Page:
    """Return the page of the surface: correlation with its waves, cleaning and profiles."""
    any_rubber = case_file.validate(case_file.RubberSource, {"name": NAMED_RUBBERS[0]}, "rubber")
    surface = (case := _case_with(file, rubber=any_rubber)).surface
    inputs = record.inputs(case)
    elements: list[Element] = [Text("The case states the sine waves; no surface is measured.")]
    if surface.measured is not None:
        elements = [
            *correlation_charts(inputs),
            *page.surface_facts(InputRecord(inputs), len(surface.sines)),
            *page.cleaning_tables(InputRecord(inputs)),
            *profile_charts(inputs),
        ]
    section = Section("road", "As read, cleaned and fitted", elements)
    return Page.of("The road", surface.source, surface.findings, [], [section])


def rubber_page(file: case_file.CaseFile) -> Page:
    """Return the page of the rubber: superposition, moduli with the fit and ends of the data."""
    any_wave = {"sines": [{"wavelength": "10 mm", "amplitude": "1 mm"}]}
    case = _case_with(file, surface=case_file.validate(case_file.SurfaceTable, any_wave, "surface"))
    inputs, measured = InputRecord(record.inputs(case)), case.measured_rubber
    doubtful = [Finding(Severity.WARNING, f"{text}.") for text in inputs.findings]
    elements = as_elements(page.shift_parts(measured))
    sweeps, master = measured.sweeps, measured.master
    if sweeps is not None and master is not None and master.shift is not None and len(sweeps) > 1:
        words = "Sweeps as measured and shifted to one temperature."
        alt = "Moduli and loss factor of all sweeps by frequency, as measured and shifted."
        figure = superposition_figure(sweeps, master)
        elements.append(image(Picture("superposition", figure, words, alt)))
    section = Section("rubber", "As read and fitted", [*elements, *page.rubber_section(inputs)])
    findings = [*measured.doubts, *doubtful]
    return Page.of("The rubber", measured.rubber.name, findings, [], [section])


def road_tab(state: CaseState) -> pn.Column:
    """Return the tab of the surface: upload, the surface as measured, fields, preview."""
    preview = PreviewPanel(state, "surface", "Read, clean and fit", surface_page)
    return column(
        problem_pane(state, "surface"),
        file_upload(
            state,
            "surface",
            "Drop profiles or a map; they replace the surface of the case.",
            with_proposal(state, "surface", surface_proposal),
            several=True,
            then=preview.update,
        ),
        RawSurface(state).body,
        table_form(state, "surface", ROAD_FIELDS),
        preview.button,
        preview.body,
    )


def with_proposal(
    state: CaseState, table: str, propose: Callable[[list[Path], list[str]], Proposal]
) -> NewText:
    """Return what states uploads as a table of the case, with what is proposed for them."""

    def new_text(uploads: Mapping[str, bytes]) -> str:
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        paths = [state.visit.path / name for name in names]
        return with_value(state.text, (table,), propose(paths, names).keys)

    return new_text


def rubber_tab(state: CaseState) -> pn.Column:
    """Return the tab of the rubber: uploads, fields, preview."""
    preview = PreviewPanel(state, "rubber", "Read and fit", rubber_page)
    return column(
        problem_pane(state, "rubber"),
        file_upload(
            state,
            "rubber",
            "Drop a master curve, or sweeps at several temperatures; they replace the rubber "
            "of the case.",
            with_proposal(state, "rubber", rubber_proposal),
            several=True,
            then=preview.update,
        ),
        table_form(state, "rubber", RUBBER_FIELDS),
        file_upload(
            state,
            "rubber",
            "Drop a table of shift factors; it replaces the shift law of the rubber.",
            with_upload(state, ("rubber", "shift")),
            then=preview.update,
        ),
        preview.button,
        preview.body,
    )


def load_tab(state: CaseState) -> pn.Column:
    """Return the tab of load, conditions, solver, chain and measured friction."""

    def with_softening(uploads: Mapping[str, bytes]) -> str:
        path = ("conditions", "softening")
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        law = state.get(path)
        table = law if isinstance(law, dict) and law.get("kind") == "table" else {}
        return with_value(state.text, path, {**table, "kind": "table", "files": names})

    parts: list[Any] = []
    for name, (title, first) in LOAD_TABLES.items():
        parts += [pn.pane.Markdown(f"### {title}", margin=(4, 8)), table_form(state, name, first)]
        if name == "conditions":
            prompt = "Drop strain sweeps; they replace the softening of the case."
            parts.append(file_upload(state, name, prompt, with_softening, several=True))
    return column(
        problem_pane(state, *LOAD_TABLES, "measured"),
        *parts,
        pn.pane.Markdown("### Measured friction", margin=(4, 8)),
        file_upload(
            state,
            "measured",
            "Drop a table of speed and friction; the results show it beside the predictions.",
            with_upload(state, ("measured", "friction")),
        ),
    )
