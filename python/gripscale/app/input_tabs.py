"""Tabs for what the case is made of: road, rubber, load with conditions and solver.

Each has the uploads and the fields of its tables; road and rubber have a preview of what is read
and fitted from the files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import panel as pn

from gripscale.app.case import CaseState
from gripscale.app.case_panel import file_upload, validation_pane
from gripscale.app.elements import AppElement, column, notice_elements
from gripscale.app.forms import PreviewPanel, table_form
from gripscale.case import (
    CaseFile,
    CaseResults,
    ConditionsTable,
    MeasuredTable,
    RubberSource,
    SurfaceTable,
    prepare_case,
    record,
    validate,
)
from gripscale.case.proposals import rubber_proposal, surface_proposal
from gripscale.case.rubber_tables import NAMED_RUBBERS
from gripscale.charts.rubber import rubber_charts
from gripscale.charts.surface import correlation_charts, profile_charts
from gripscale.report.elements import Notice, Text
from gripscale.report.inputs import (
    cleaning_tables,
    rubber_facts,
    shift_parts,
    sines_line,
    surface_facts,
)
from gripscale.report.record import InputRecord

ROAD_FIELDS = (
    "scales",
    "smallest_wavelength",
    "cut_off",
    "top_height_fraction",
    "crop",
    "x_unit",
    "z_unit",
)
RUBBER_FIELDS = ("name", "reference_temperature", "bulk_modulus", "terms", "extrapolate", "source")
LOAD_TABLES = {
    "load": ("Load", ("pressure", "speed", "footprint", "static", "load_time")),
    "conditions": ("Conditions", ("temperature", "strain_norm")),
    "solver": ("Solver of one wave", ("model", "points", "columns", "tolerance")),
    "chain": ("Chain of waves", ("pressure_classes",)),
}
"""Tables of the case by name: their title and the fields at the top."""


def _prepared_with(file: CaseFile, **tables: Any) -> CaseResults:
    """Prepare the case with `tables` in place of its own, and without conditions.

    So the surface can be seen before the rubber is stated, and the rubber before the surface.
    """
    plain = {"conditions": ConditionsTable(), "measured": MeasuredTable()}
    return prepare_case(replace(file, case=file.case.model_copy(update=plain | tables)))


def surface_elements(file: CaseFile) -> list[AppElement]:
    """Return warnings, correlation with its waves, cleaning and profiles of the surface."""
    any_rubber = validate(RubberSource, {"name": NAMED_RUBBERS[0]}, "rubber")
    results = _prepared_with(file, rubber=any_rubber)
    inputs = record.inputs(results)
    notes = [*notice_elements([Notice("warning", note) for note in results.surface.notes])]
    if results.surface.measured is None:
        return [*notes, Text("The case states the sine waves; no surface is measured.")]
    return [
        *notes,
        Text(f"{sines_line(results.surface.sines)}."),
        *correlation_charts(inputs),
        *surface_facts(InputRecord(inputs), len(results.surface.sines)),
        *cleaning_tables(InputRecord(inputs)),
        *profile_charts(inputs),
    ]


def rubber_elements(file: CaseFile) -> list[AppElement]:
    """Return findings, moduli with the fit, the ends of the data, and shifts of the sweeps."""
    any_wave = {"sines": [{"wavelength": "10 mm", "amplitude": "1 mm"}]}
    results = _prepared_with(file, surface=validate(SurfaceTable, any_wave, "surface"))
    inputs = record.inputs(results)
    findings = InputRecord(inputs).findings
    elements = [*notice_elements([Notice("warning", f"{text}.") for text in findings])]
    for part in shift_parts(results.rubber):
        elements.append(Text(part) if isinstance(part, str) else part)
    return [*elements, *rubber_charts(inputs, None), rubber_facts(InputRecord(inputs))]


def road_tab(state: CaseState) -> pn.Column:
    """Return the tab of the surface: upload, fields, preview."""
    kind = pn.widgets.RadioButtonGroup(
        options={"Profiles along a line": "files", "A map": "map"}, margin=(4, 8)
    )
    preview = PreviewPanel(state, "Read, clean and fit", surface_elements)

    def upload_surface(uploads: Mapping[str, bytes]) -> None:
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        names = names if kind.value == "files" else names[-1:]
        paths = [state.visit.path / name for name in names]
        state.set(("surface",), surface_proposal(paths, names).keys)
        pn.state.execute(preview.update)

    return column(
        validation_pane(state, "surface"),
        kind,
        file_upload(
            "Drop profiles or a map; they replace the surface of the case.",
            upload_surface,
            several=True,
        ),
        table_form(state, "surface", ROAD_FIELDS),
        preview.button,
        preview.body,
    )


def rubber_tab(state: CaseState) -> pn.Column:
    """Return the tab of the rubber: uploads, fields, preview."""
    preview = PreviewPanel(state, "Read and fit", rubber_elements)

    def upload_rubber(uploads: Mapping[str, bytes]) -> None:
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        paths = [state.visit.path / name for name in names]
        state.set(("rubber",), rubber_proposal(paths, names).keys)
        pn.state.execute(preview.update)

    def upload_shift(uploads: Mapping[str, bytes]) -> None:
        state.set(("rubber", "shift"), store_last(state, uploads))

    return column(
        validation_pane(state, "rubber"),
        file_upload(
            "Drop a master curve, or sweeps at several temperatures; they replace the rubber "
            "of the case.",
            upload_rubber,
            several=True,
        ),
        table_form(state, "rubber", RUBBER_FIELDS),
        file_upload(
            "Drop a table of shift factors; it replaces the shift law of the rubber.", upload_shift
        ),
        preview.button,
        preview.body,
    )


def store_last(state: CaseState, uploads: Mapping[str, bytes]) -> str:
    """Store the file uploaded last; return its name in the case."""
    return state.visit.store(*list(uploads.items())[-1])


def load_tab(state: CaseState) -> pn.Column:
    """Return the tab of load, conditions, solver, chain and measured friction."""

    def upload_softening(uploads: Mapping[str, bytes]) -> None:
        path = ("conditions", "softening")
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        law = state.get(path)
        table = law if isinstance(law, dict) and law.get("kind") == "table" else {}
        state.set(path, {**table, "kind": "table", "files": names})

    def upload_friction(uploads: Mapping[str, bytes]) -> None:
        state.set(("measured", "friction"), store_last(state, uploads))

    parts: list[Any] = []
    for name, (title, first) in LOAD_TABLES.items():
        parts += [pn.pane.Markdown(f"### {title}", margin=(4, 8)), table_form(state, name, first)]
        if name == "conditions":
            prompt = "Drop strain sweeps; they replace the softening of the case."
            parts.append(file_upload(prompt, upload_softening, several=True))
    return column(
        validation_pane(state, *LOAD_TABLES, "measured"),
        *parts,
        pn.pane.Markdown("### Measured friction", margin=(4, 8)),
        file_upload(
            "Drop a table of speed and friction; the results show it beside the predictions.",
            upload_friction,
        ),
    )
