"""Surface or rubber of a case prepared alone: one can be looked at before the other is stated."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from gripscale.case import (
    CaseFile,
    CaseResults,
    ConditionsTable,
    MeasuredTable,
    RubberSource,
    Surface,
    prepare_case,
    record,
    validate,
)
from gripscale.case.rubber_table import NAMED_RUBBERS
from gripscale.report.charts.rubber import rubber_charts
from gripscale.report.charts.surface import correlation_charts, profile_charts
from gripscale.report.elements import Element, Notice, Text
from gripscale.report.input_tables import cleaning_tables, rubber_facts, surface_facts
from gripscale.report.inputs_text import shift_lines, sines_line

WAVE = {"sines": [{"wavelength": "10 mm", "amplitude": "1 mm"}]}
"""A surface that needs no file."""


def surface_elements(file: CaseFile) -> list[Element]:
    """Return doubts, correlation with its waves, cleaning and profiles of the surface."""
    named = validate(RubberSource, {"name": NAMED_RUBBERS[0]}, "rubber")
    results = _alone(file, rubber=named)
    inputs = record.inputs(results)
    notes = [Notice("warning", note) for note in results.surface.notes]
    if "lag" not in inputs:
        return [*notes, Text("The sine waves are stated in the case; no surface is measured.")]
    count = len(results.surface.sines)
    return [
        *notes,
        Text(f"{sines_line(results.surface.sines)}."),
        *correlation_charts(inputs),
        *surface_facts(inputs, count),
        *cleaning_tables(inputs),
        *profile_charts(inputs),
    ]


def rubber_elements(file: CaseFile) -> list[Element]:
    """Return findings, moduli with the fit and the ends of the data, and where sweeps meet."""
    wave = validate(Surface, WAVE, "surface")
    results = _alone(file, surface=wave)
    inputs = record.inputs(results)
    findings = str(inputs.attrs.get("prony_findings", "")).splitlines()
    elements: list[Element] = [Notice("warning", f"{text}.") for text in findings]
    elements += [Text(line) for line in shift_lines(results.rubber)]
    return [*elements, *rubber_charts(inputs, None), rubber_facts(inputs)]


def _alone(file: CaseFile, **tables: Any) -> CaseResults:
    """Prepare the case with `tables` in place of its own, and without conditions."""
    plain = {"conditions": ConditionsTable(), "measured": MeasuredTable()}
    return prepare_case(replace(file, case=file.case.model_copy(update=plain | tables)))
