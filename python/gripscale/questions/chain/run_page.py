"""The page of a run: the answer, its inputs, the chain wave by wave, and its comparisons."""

from __future__ import annotations

import xarray as xr

from gripscale.core.finding import Finding, Severity, Topic
from gripscale.io.table import Table
from gripscale.questions.answer import page as answer
from gripscale.questions.answer.reliance import has_answer
from gripscale.questions.calibration.page import measured_lines
from gripscale.questions.chain import findings as notices
from gripscale.questions.chain.charts import contact_charts, measured_chart, verification_charts
from gripscale.questions.chain.charts_of_blocks import blocks_image
from gripscale.questions.chain.page import wave_tables
from gripscale.questions.chain.run_folder import RunSource
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.compare import page as comparison
from gripscale.questions.cut_off import page as cut_off
from gripscale.questions.inputs import page as inputs
from gripscale.questions.uncertainty import page as uncertainty
from gripscale.questions.vary import page_side_by_side as side_by_side
from gripscale.report.again import case_name, rerun_section
from gripscale.report.elements import Element, Page, Section, Text
from gripscale.report.equations import method_section
from gripscale.surface import SineStack

_EVIDENCE = (
    "The two friction coefficients of a wave are found independently, from the traction in the "
    "contact and from the energy lost in the rubber; by the balance of energy they are equal. "
    "Their difference is the error of the discretisation."
)
STALE = (
    "The comparison in this folder belongs to another version of the case and is left out; run "
    "`gripscale compare` again."
)
_EFFECTS = (
    "The case with all effects of its conditions, without each effect in turn, and without any. "
    "A change is the change by the effects that are left out."
)
_OF_ANOTHER = Finding(Severity.WARNING, uncertainty.OF_ANOTHER, topic=Topic.SOURCE)


def run_page(run: RunSource) -> Page:
    """Return the report of `run`."""
    case = case_name(run.attrs)
    tables = {table.name: table for table in wave_tables(run.by_wave)}
    stale = run.uncertainty is not None and run.own_uncertainty is None
    blocks = ("surface_x", "surface_pressure", "mesh_x")
    meshed = [view for view in run.predictions if all(view.has(name) for name in blocks)]
    waves = _waves(run)
    moving = next((view for view in run.by_wave if view.moving), None)
    origin: list[Element] = [inputs.load_facts(run)]
    if run.record.has("file_name"):
        origin.append(inputs.files_table(run.record))
    return Page.of(
        f"Contact and friction: {case or 'result'}",
        "; ".join(view.title for view in run.predictions),
        [*notices.notices(run), *([_OF_ANOTHER] if stale else [])],
        [*notices.run_cards(run), *uncertainty.uncertainty_cards(run.own_uncertainty)],
        [
            Section(
                "contact",
                "Rubber on the surface",
                [] if run.direct is None else answer.contact_elements(run.direct, run.record),
            ),
            Section("inputs", "Inputs and their origin", origin),
            Section(
                "surface",
                "Surface",
                [] if waves is None else inputs.surface_section(run.record, waves),
            ),
            Section("rubber", "Rubber", inputs.rubber_section(run.record, moving)),
            Section("results", "Contact and friction, wave by wave", _results(run, tables)),
            Section("measured", "Measured friction", _measured(run)),
            Section("cut-off", "Against the cut-off", cut_off.cut_off_elements(run.cut_off)),
            Section("effects", "What each effect is worth", effects_elements(run.effects)),
            Section(
                "blocks",
                "Deformed blocks",
                list(map(blocks_image, meshed)) or [Text("The result holds no deformed meshes.")],
            ),
            Section("comparison", "Models side by side", _comparison(run)),
            Section("verification", "Verification", _verification(run, tables)),
            method_section(),
            rerun_section(run.attrs),
        ],
        () if run.direct is None else answer.basis_lines(run.direct),
    )


def _waves(run: RunSource) -> SineStack | None:
    if "sines_wavelength" not in run.data:
        return None
    return SineStack(run.data["sines_wavelength"].values, run.data["sines_amplitude"].values)


def _results(run: RunSource, tables: dict[str, Table]) -> list[Element]:
    sentences = [(view.title, notices.exponent_sentence(view.data)) for view in run.predictions]
    below: list[Element] = [Text(f"{title}. {text}") for title, text in sentences if text]
    below += judgement_elements(run)
    if not run.by_wave:
        return [Text("The model has no waves; its totals stand above."), *below]
    names = ("load", "contact", "conditions", "further")
    elements: list[Element] = [tables[name] for name in names if name in tables]
    if any(not view.moving for view in run.by_wave):
        rest = "A prediction at rest has no friction; its columns are left out."
        elements.insert(0, Text(rest))
    return [*elements, *below, *contact_charts(run.by_wave, run.direct)]


def _measured(run: RunSource) -> list[Element]:
    """Return the measured friction that the case names, with the predictions."""
    sliding = [view for view in run.predictions if view.moving and view.complete]
    if run.measured is None or not sliding:
        return []
    direct = [] if run.direct is None else [PredictionView(run.direct, "direct contact")]
    first = sliding[0]
    lines = measured_lines(run.measured, first.speed, first.display_unit("speed"))
    return [measured_chart(run.measured, [*sliding, *direct]), *map(Text, lines)]


def judgement_elements(run: RunSource) -> list[Element]:
    """Return the direct contact of the profiles, and the first prediction against it."""
    if run.direct is None:
        return []
    return [Text(" ".join(comparison.judgement(run.predictions[0], run.direct)))]


def effects_elements(results: list[xr.Dataset]) -> list[Element]:
    """Return the answers of each model with and without each effect; nothing without any."""
    return [Text(_EFFECTS), side_by_side.effects_table(*results)] if results else []


def _comparison(run: RunSource) -> list[Element]:
    """Return the comparison of just this case; another's is named and left out."""
    same = run.compared.of(run.attrs.get("case"))
    stale = len(same.parts) < len(run.compared.parts)
    answered = same.ladder is not None and has_answer(same.ladder)
    lines = answer.answer_lines(same.ladder) if answered else ()
    heads: list[Element] = [Finding(Severity.WARNING, STALE)] if stale else []
    return [*heads, *(Text(line.strip()) for line in lines), *comparison.comparison_elements(same)]


def _verification(run: RunSource, tables: dict[str, Table]) -> list[Element]:
    if not run.by_wave:
        return []
    errors: list[Element] = list(notices.run_failures(run))
    names = ("errors", "solution", "mesh")
    return [
        *(errors or [Finding(Severity.GOOD, "Every wave converged.")]),
        Text(_EVIDENCE),
        *(tables[name] for name in names if name in tables),
        *verification_charts(run.by_wave),
    ]
