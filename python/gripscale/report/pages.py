"""The pages of a report, one for each kind of result: cards, notices and chapters."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np
import xarray as xr

from gripscale.charts.draw import image
from gripscale.charts.page_elements import words_of
from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.experiment.measured_friction import FRICTION_DOUBTS
from gripscale.io.table import Table
from gripscale.model import FRICTION_OUTSIDE_BAND
from gripscale.questions.answer import findings
from gripscale.questions.answer import page as answer
from gripscale.questions.answer.charts import contact_pictures
from gripscale.questions.answer.reliance import has_answer
from gripscale.questions.calibration import page as calibration
from gripscale.questions.calibration.page_of_measured import measured_lines
from gripscale.questions.chain.charts import contact_charts, measured_chart, verification_charts
from gripscale.questions.chain.charts_of_blocks import blocks_image
from gripscale.questions.chain.page import wave_tables
from gripscale.questions.chain.view import SYMBOLS, PredictionView
from gripscale.questions.compare import page as comparison
from gripscale.questions.compare.charts import axis_charts, ladder_charts
from gripscale.questions.compare.charts_of_ladder import varied
from gripscale.questions.cut_off import page as cut_off
from gripscale.questions.design import page as design
from gripscale.questions.design.charts import design_pictures
from gripscale.questions.inputs import page as inputs
from gripscale.questions.inputs.charts_of_rubber import rubber_charts
from gripscale.questions.inputs.charts_of_surface import correlation_charts, profile_charts
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.result import Result
from gripscale.questions.sensitivity import page as sensitivity
from gripscale.questions.sensitivity.charts import height_charts, sensitivity_charts
from gripscale.questions.uncertainty import page as uncertainty
from gripscale.questions.uncertainty.charts import calibration_pictures
from gripscale.questions.vary import page as study
from gripscale.questions.vary import page_side_by_side as side_by_side
from gripscale.questions.vary.charts import study_charts
from gripscale.questions.vary.charts_side_by_side import compound_pictures, road_pictures
from gripscale.report import notices
from gripscale.report.again import case_name, rerun_section
from gripscale.report.elements import Card, Element, Facts, Page, Section, Text
from gripscale.report.equations import method_equations
from gripscale.report.failures import Failure, explained
from gripscale.report.source import Compared, ReportSource, RunSource, StudySource
from gripscale.surface import SineStack

METHOD = (
    "The measured surface is approximated by superposed sine waves. On each wave, largest first, "
    "a rubber block at finite strain is pressed and slid. The next wave receives the pressure in "
    "its contact."
)
_PICTURE = (
    "The direct contact of the measured surface. Friction is made where pressure acts on flanks "
    "that rise in the sliding direction. The page holds the lowest and highest values of pieces of "
    "the surface, and every point where most of the friction is made."
)
_EVIDENCE = (
    "The two friction coefficients of a wave are found independently, from the traction in the "
    "contact and from the energy lost in the rubber; by the balance of energy they are equal. "
    "Their difference is the error of the discretisation."
)
_LADDER = (
    "All models use the same measurements. From each model to the next one assumption is given up. "
    "A factor relates a model to the one before, a theory to the direct contact of the measured "
    "profile. Spread is the standard deviation over the samples, error the estimate of the model "
    "itself; both are relative."
)
STALE = (
    "The comparison in this folder belongs to another version of the case and is left out; run "
    "`gripscale compare` again."
)
_EFFECTS = (
    "The case with all effects of its conditions, without each effect in turn, and without any. "
    "A change is the change by the effects that are left out."
)
ROADS = (
    "The same rubber under the same load on each road: in the chain of its sine waves, and in the "
    "direct contact of its whole profile. A range holds 90 % of what other stretches of the same "
    "road might give. A difference is significant if its range does not contain zero."
)
COMPOUNDS = (
    "Each compound on the same road under the same load. A range is what the measured moduli leave "
    "open. A difference is significant if its range does not contain zero."
)
CALIBRATION = (
    "A law of the shear stress in the real contact area, fitted so that the predicted hysteresis "
    "and this area term together give the measured friction. The hysteresis is not fitted."
)
_OF_ANOTHER = Finding(Severity.WARNING, uncertainty.OF_ANOTHER, topic=Topic.SOURCE)
SENSITIVITY = (
    "Per cent of friction for a per cent of a modulus, by frequency. The direct contact of the "
    "measured surface is solved once; one adjoint solution gives all derivatives. Factors on the "
    "friction, such as that from lines to a surface, do not change them."
)
NAMED_FAILURES = 12
"""Failed predictions named one by one at the head of the page."""


def page_of(source: ReportSource) -> Page:
    """Return the page of a result."""
    if isinstance(source, RunSource):
        return run_page(source)
    if isinstance(source, Compared):
        return comparison_page(source)
    if isinstance(source, Result):
        return source.page_content()
    pages = {
        "study": study_page,
        "compounds": compounds_page,
        "roads": roads_page,
        "sensitivity": sensitivity_page,
        "design": design_page,
        "calibration": calibration_page,
    }
    return pages[source.kind](source)


def _page(
    title: str,
    subtitle: str,
    heads: Iterable[Finding],
    numbers: Iterable[Card],
    sections: Iterable[Section],
    answered: xr.Dataset | None = None,
) -> Page:
    """Return a page of the sections that hold something; `answered` holds a best estimate."""
    chapters = [section for section in sections if section.elements]
    lines = () if answered is None else tuple(answer.basis_lines(answered))
    return Page(title, subtitle, ranked(heads), list(numbers), chapters, lines)


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
    return _page(
        f"Contact and friction: {case or 'result'}",
        "; ".join(view.title for view in run.predictions),
        [*notices.notices(run), *([_OF_ANOTHER] if stale else [])],
        [*notices.run_cards(run), *uncertainty.uncertainty_cards(run.own_uncertainty)],
        [
            Section(
                "contact",
                "Rubber on the surface",
                [] if run.direct is None else contact_elements(run.direct, run.record),
            ),
            Section("inputs", "Inputs and their origin", origin),
            Section(
                "surface", "Surface", [] if waves is None else surface_section(run.record, waves)
            ),
            Section("rubber", "Rubber", rubber_section(run.record, moving)),
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
        run.direct,
    )


def contact_elements(direct: xr.Dataset, record: InputRecord) -> list[Element]:
    """Return the direct contact of the measured surface as pictures and by slope."""
    if not (pictures := contact_pictures(direct, record.data)):
        return []
    first, *others = pictures
    return [Text(_PICTURE), first, *comparison.slopes_table(direct), *others]


def surface_section(record: InputRecord, waves: SineStack | None = None) -> list[Element]:
    """Return cleaning, profiles, texture and correlation of a surface, and its sine waves."""
    if record.is_empty:
        return []
    elements: list[Element] = []
    if record.has("profile_name"):
        cleaning = inputs.cleaning_tables(record) if record.has("cleaning_points") else []
        elements += [*cleaning, *profile_charts(record.data)]
    if record.has("texture_of"):
        elements.append(inputs.texture_table(record.data))
    if record.has("lag"):
        facts = inputs.surface_facts(record, 0 if waves is None else len(waves))
        elements += [*facts, *correlation_charts(record.data)]
    else:
        elements.append(Text("The sine waves are stated in the case; no surface was measured."))
    if waves is None:
        return elements
    return [*elements, inputs.waves_table(waves.wavelength, waves.amplitude)]


def _waves(run: RunSource) -> SineStack | None:
    if "sines_wavelength" not in run.data:
        return None
    return SineStack(run.data["sines_wavelength"].values, run.data["sines_amplitude"].values)


def rubber_section(record: InputRecord, moving: PredictionView | None = None) -> list[Element]:
    """Return facts, moduli with their fit and Prony series of a rubber.

    `moving` is a prediction of the chain in motion, whose waves are marked.
    """
    if not record.has("equilibrium_modulus_Pa"):
        return []
    charts = rubber_charts(record.data, moving)
    elements: list[Element] = [inputs.rubber_facts(record), *charts]
    times, moduli = record.relaxation_times
    return [*elements, inputs.prony_table(times, moduli)] if np.size(times) else elements


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
    return [*heads, *(Text(line.strip()) for line in lines), *comparison_elements(same)]


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


def method_section() -> Section:
    """Return the equations with their sources."""
    return Section("method", "Method", [Text(METHOD), *method_equations()])


def study_page(source: StudySource) -> Page:
    """Return the report of a study."""
    data = source.data
    collapsed = [(f"{words} over a_T v", text) for words, text in study.collapse_sentences(data)]
    axes: list[Element] = [study.axes_table(data)]
    axes += [Facts("Speed and temperature", collapsed)] if collapsed else []
    return _page(
        str(data.attrs.get("title", f"Study {source.name}")),
        f"varied: {', '.join(words_of(data, axis) for axis in source.axes)}",
        _study_notices(data),
        _study_cards(source),
        [
            Section("axes", "What was varied", axes),
            *_study_sections(source),
            method_section(),
            rerun_section(data.attrs),
        ],
    )


def _study_sections(source: StudySource) -> list[Section]:
    """Return the chapters on inputs, totals and curves."""
    totals = study.totals_table(source.data)
    return [
        *inputs.input_sections(source),
        Section("totals", "Totals of every prediction", [] if totals is None else [totals]),
        Section("curves", "Curves", study_charts(source.data)),
    ]


def _study_notices(data: xr.Dataset) -> list[Finding]:
    failed = list(study.study_failures(data))
    heads = _errors(failed[:NAMED_FAILURES])
    if len(failed) > NAMED_FAILURES:
        rest = len(failed) - NAMED_FAILURES
        heads.append(
            Finding(Severity.ERROR, f"{rest} more did not converge; see the table of totals.")
        )
    beyond = notices.study_sentence(data)
    if beyond:
        share = float(data[FRICTION_OUTSIDE_BAND].max())
        text = f"{beyond} There the Prony series is an extrapolation."
        heads.append(Finding(Severity.WARNING, text, share, topic=Topic.RUBBER))
    notes = [study.shift_sentence(data), *str(data.attrs.get("notes", "")).splitlines()]
    return [
        *heads,
        *(Finding(Severity.WARNING, text, topic=Topic.SURFACE) for text in notes if text),
    ]


def _errors(failed: Iterable[Failure]) -> list[Finding]:
    """Return what has no result, with what to do about it."""
    return [Finding(Severity.ERROR, explained(each)) for each in failed]


def _study_cards(source: StudySource) -> list[Card]:
    failed = len(list(study.study_failures(source.data)))
    count = math.prod(source.data.sizes[name] for name in source.axes)
    axes = " × ".join(words_of(source.data, axis) for axis in source.axes)
    return [
        Card("Predictions", str(count), axes),
        Card("Not converged", str(failed), "see the table of totals", bad=failed > 0),
    ]


def comparison_page(compared: Compared) -> Page:
    """Return the report of a comparison alone."""
    first = compared.parts[0]
    case = case_name(first.attrs) or "case.toml"
    elements = comparison_elements(compared)
    sampled = compared.own_uncertainty
    stale = sampled is None and compared.uncertainty is not None
    return _page(
        f"Models side by side: {case}",
        str(first.attrs.get("title", "")),
        [
            *notices.friction_notices(str(first.attrs.get(FRICTION_DOUBTS, "")).splitlines()),
            *_of_ladder(compared.ladder),
            *(element for element in elements if isinstance(element, Finding)),
            *([_OF_ANOTHER] if stale else []),
        ],
        [*comparison.ladder_cards(compared.ladder), *uncertainty.uncertainty_cards(sampled)],
        [
            Section("comparison", "Models side by side", elements),
            rerun_section(first.attrs),
        ],
        compared.ladder,
    )


def _of_ladder(ladder: xr.Dataset | None) -> Iterator[Finding]:
    """Yield what is to be known of the answer of a comparison of one load."""
    if ladder is not None:
        yield from findings.no_answer_notices(ladder)
        yield from findings.answer_notices(ladder)


def comparison_elements(compared: Compared) -> list[Element]:
    """Return tables, best estimate and figures of what there is; nothing if there is nothing."""
    if not compared.parts:
        return []
    elements: list[Element] = [Text(_LADDER)]
    for data in compared.parts:
        for where, failure in comparison.comparison_failures(data):
            placed = replace(failure, sentence=f"{where}: {failure}")
            level = "warning" if bool(data.best_friction.notnull().all()) else "error"
            text = f"{explained(placed)}."
            elements.append(Finding(level, text, topic=Topic.SOLUTION))
    for data in compared.over:
        over = f"Over {varied(data).replace('_', ' ')}"
        for notice in notices.comparison_notices(data):
            elements.append(replace(notice, sentence=f"{over}, {notice.sentence}"))
    ladder = compared.ladder
    if ladder is not None:
        elements.append(comparison.comparison_table(ladder))
        elements += map(Text, comparison.temperature_only(ladder))
        elements += ladder_charts(ladder)
    for data in compared.over:
        elements += [comparison.axis_table(data, varied(data), name) for name in SYMBOLS]
        elements += axis_charts(data)
    return elements


def roads_page(source: StudySource) -> Page:
    """Return the report of roads side by side."""
    data = source.data
    statistics, friction = map(image, road_pictures(data))
    sentences = [
        *side_by_side.roads_sentences(data),
        *str(data.attrs.get("notes", "")).splitlines(),
    ]
    return _page(
        f"Roads side by side: {', '.join(data.surface.values.tolist())}",
        str(data.attrs.get("title", "")),
        _errors(side_by_side.failed_totals(data)),
        [],
        [
            Section(
                "roads",
                "Contact and friction",
                [Text(ROADS), *side_by_side.roads_tables(data), *map(Text, sentences), friction],
            ),
            Section("statistics", "The roads", [statistics]),
            rerun_section(data.attrs),
        ],
    )


def compounds_page(source: StudySource) -> Page:
    """Return the report of compounds side by side: differences, then what a study has."""
    data = source.data
    names = [str(name) for name in data.rubber.values]
    elements: list[Element] = [Text(COMPOUNDS), side_by_side.compounds_table(data)]
    elements += map(Text, side_by_side.compounds_sentences(data))
    rubbers = inputs.rubbers_of(data)
    moduli = dict(zip(names, rubbers, strict=True)) if len(rubbers) == len(names) else {}
    elements += map(image, compound_pictures(data, moduli))
    return _page(
        f"Compounds side by side: {', '.join(names)}",
        str(data.attrs.get("title", "")),
        _study_notices(data),
        _study_cards(source),
        [
            Section("compounds", "Contact and friction", elements),
            *_study_sections(source),
            method_section(),
            rerun_section(data.attrs),
        ],
    )


def calibration_page(source: StudySource) -> Page:
    """Return the report of a calibration."""
    data = source.data
    case, failed = case_name(data.attrs), calibration.calibration_failure(data)
    tables, facts = (
        uncertainty.as_elements(calibration.calibration_parts(data)),
        calibration.law_facts(data),
    )
    fit, residuals, profiles = map(image, calibration_pictures(data))
    return _page(
        f"{data.attrs.get('title', 'Calibration')}{f': {case}' if case else ''}",
        str(data.attrs.get("model", "")).replace("_", " "),
        [
            *([Finding(Severity.ERROR, f"{explained(failed)}.")] if failed else []),
            *findings.case_notices(data, source.record),
        ],
        calibration.calibration_cards(data),
        [
            Section("law", "The law", [Text(CALIBRATION), facts, *tables[1:]]),
            Section("points", "Point by point", [fit, residuals, tables[0]]),
            Section("profiles", "How well the data determine the law", [profiles]),
            rerun_section(data.attrs),
        ],
    )


def sensitivity_page(source: StudySource) -> Page:
    """Return the report of what decides the friction."""
    data = source.data
    lead, *below = sensitivity.sensitivity_lines(data)
    parts = [*below, *sensitivity.sensitivity_parts(data)]
    return _page(
        f"What decides the friction of {case_name(data.attrs) or 'a case'}",
        str(lead),
        [
            *_errors(sensitivity.sensitivity_failures(data)),
            *findings.case_notices(None, source.record),
        ],
        sensitivity.sensitivity_cards(data),
        [
            Section("effects", "What the friction depends on", uncertainty.as_elements(parts)),
            Section(
                "curves", "Over the master curve", [Text(SENSITIVITY), *sensitivity_charts(data)]
            ),
            Section("heights", "Which heights count", height_charts(data, source.record.data)),
            rerun_section(data.attrs),
        ],
    )


def design_page(source: StudySource) -> Page:
    """Return the report of a compound that was designed."""
    data, case = source.data, case_name(source.data.attrs)
    answer_line, *basis = design.design_lines(data)
    tables = [design.design_table(data), design.designed_compounds_table(data)]
    page = _page(
        f"Compound for {case or 'a case'}",
        answer_line,
        findings.case_notices(None, source.record),
        design.design_cards(data),
        [
            Section(
                "curve", "Friction over rolling resistance", [*map(image, design_pictures(data))]
            ),
            Section("points", "Points of the curve", [each for each in tables if each is not None]),
            rerun_section(data.attrs),
        ],
    )
    return replace(page, basis=[line.strip() for line in basis])
