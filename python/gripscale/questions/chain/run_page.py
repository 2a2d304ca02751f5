"""The page of a run: the answer, its inputs, the chain wave by wave, and its comparisons."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from gripscale import model
from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.core.provenance import versions
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.measured_friction import friction_doubts
from gripscale.io.table import NONE, Table
from gripscale.questions.answer import page as answer
from gripscale.questions.answer.findings import case_notices, no_answer_notices
from gripscale.questions.answer.reliance import has_answer, is_measured
from gripscale.questions.chain.charts import contact_charts, measured_chart, verification_charts
from gripscale.questions.chain.charts_of_blocks import blocks_image
from gripscale.questions.chain.findings import exponent_sentence, prediction_sentence, wave_notices
from gripscale.questions.chain.page import wave_tables
from gripscale.questions.chain.run_folder import RunSource
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.compare import page as comparison
from gripscale.questions.cut_off.question import CutOff
from gripscale.questions.inputs import page as inputs
from gripscale.questions.uncertainty import page as uncertainty
from gripscale.questions.vary import page_side_by_side as side_by_side
from gripscale.questions.words import OF_THE_PAPER
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import (
    Card,
    Element,
    Facts,
    Page,
    Section,
    Text,
    number_text,
    percent_text,
)
from gripscale.report.equations import method_section
from gripscale.report.failures import Failure, chapter_words
from gripscale.surface import SineStack
from gripscale.wave.result import LARGE_MISMATCH

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
    case = case_title(run.attrs)
    tables = {table.name: table for table in wave_tables(run.by_wave)}
    stale = run.uncertainty is not None and run.own_uncertainty is None
    blocks = ("surface_x", "surface_pressure", "mesh_x")
    meshed = [view for view in run.predictions if all(view.has(name) for name in blocks)]
    surface: list[Element] = []
    if "sines_wavelength" in run.data:
        waves = SineStack(run.data["sines_wavelength"].values, run.data["sines_amplitude"].values)
        surface = inputs.surface_section(run.record, waves)
    moving = next((view.data for view in run.by_wave if view.moving), None)
    effects: list[Element] = []
    if run.effects:
        effects = [Text(_EFFECTS), side_by_side.effects_table(*run.effects)]
    origin: list[Element] = [_load_facts(run)]
    if run.record.has("file_name"):
        origin.append(inputs.files_table(run.record))
    return Page.of(
        f"Contact and friction: {case or 'result'}",
        "; ".join(view.title for view in run.predictions),
        [*notices(run), *([_OF_ANOTHER] if stale else [])],
        [*run_cards(run), *uncertainty.uncertainty_cards(run.own_uncertainty)],
        [
            Section(
                "contact",
                "Rubber on the surface",
                [] if run.direct is None else answer.contact_elements(run.direct, run.record),
            ),
            Section("inputs", "Inputs and their origin", origin),
            Section("surface", "Surface", surface),
            Section("rubber", "Rubber", inputs.rubber_section(run.record, moving)),
            Section("results", _chain_title(run), _results(run, tables)),
            Section("measured", "Measured friction", _measured(run)),
            Section(
                "cut-off",
                "Against the cut-off",
                [] if run.cut_off is None else CutOff(run.cut_off).elements(),
            ),
            Section("effects", "What each effect is worth to the chain", effects),
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


def _chain_title(run: RunSource) -> str:
    """Return the title of the chapter of the chain: beside an answer it is a comparison."""
    if run.direct is None or not is_measured(run.direct):
        return "Contact and friction, wave by wave"
    return f"{OF_THE_PAPER[0].upper()}{OF_THE_PAPER[1:]}, for comparison"


def _load_facts(run: RunSource) -> Facts:
    attrs, data = run.attrs, run.data
    first = run.predictions[0]

    def text(name: str, value: float) -> str:
        display_unit = first.display_unit(name)
        return f"{number_text(display_unit.of(value))} {display_unit.unit}"

    speeds = ", ".join(text("speed", view.speed) for view in run.predictions if view.moving)
    if any(not view.moving for view in run.predictions):
        speeds = f"{speeds or 'none'}; and at rest (relaxed rubber)"
    model = str(attrs.get("model", NONE))
    if "wave_solver" in data:
        solvers = dict.fromkeys(str(name) for name in data["wave_solver"].values)
        model += f", waves by {', '.join(solvers)}"
    record = run.record
    source = inputs.without_folder(str(attrs.get("rubber_source", attrs.get("rubber", ""))))
    # of a strain energy such as "MooneyRivlin(share=0.2)" the name in words, and its parameters
    law, _, parameters = record.text("strain_energy").partition("(")
    energy = "-".join(re.findall(r"[A-Z][a-z]+", law)) or law or NONE
    return Facts(
        "Load and model",
        [
            ("Nominal pressure", text("pressure", float(data["nominal_pressure"]))),
            ("Sliding speed", speeds),
            ("Footprint", text("footprint", float(data["footprint"]))),
            *(
                [("Thickness of the rubber", text("thickness", float(data["thickness"])))]
                if "thickness" in data
                else []
            ),
            ("Rubber", "; ".join(filter(None, [record.text("rubber_name"), source])) or NONE),
            ("Model", model.replace("_", " ")),
            ("Strain energy", ", ".join(filter(None, [energy, parameters.removesuffix(")")]))),
            ("Method", str(attrs.get("method", NONE))),
        ],
    )


def _results(run: RunSource, tables: dict[str, Table]) -> list[Element]:
    sentences = [(view.title, exponent_sentence(view.data)) for view in run.predictions]
    below: list[Element] = [Text(f"{title}. {text}") for title, text in sentences if text]
    judge = run.direct if run.direct is not None and is_measured(run.direct) else None
    if judge is not None:
        below += map(Text, comparison.judgement(run.predictions[0], judge))
    if not run.by_wave:
        return [Text("The model has no waves; its totals stand above."), *below]
    names = ("load", "contact", "conditions", "further")
    elements: list[Element] = [tables[name] for name in names if name in tables]
    if any(not view.moving for view in run.by_wave):
        rest = "A prediction at rest has no friction; its columns are left out."
        elements.insert(0, Text(rest))
    return [*elements, *below, *contact_charts(run.by_wave, judge)]


def _measured(run: RunSource) -> list[Element]:
    """Return the measured friction that the case names, with the predictions."""
    sliding = [view for view in run.predictions if view.moving and view.complete]
    if run.measured is None or not sliding:
        return []
    direct = [] if run.direct is None else [PredictionView(run.direct, "direct contact")]
    return [measured_chart(run.measured, [*sliding, *direct])]


def _comparison(run: RunSource) -> list[Element]:
    """Return the comparison of just this case; another's is named and left out."""
    same = run.compared.of(run.attrs.get("case"))
    stale = len(same.parts) < len(run.compared.parts)
    answered = same.ladder is not None and has_answer(same.ladder)
    lines = answer.answer_lines(same.ladder) if same.ladder is not None and answered else ()
    heads: list[Element] = [Finding(Severity.WARNING, STALE)] if stale else []
    return [*heads, *(Text(line.strip()) for line in lines), *comparison.comparison_elements(same)]


def _verification(run: RunSource, tables: dict[str, Table]) -> list[Element]:
    if not run.by_wave:
        return []
    errors: list[Element] = list(run_failures(run))
    names = ("errors", "solution", "mesh")
    return [
        *(errors or [Finding(Severity.GOOD, "Every wave converged.")]),
        Text(_EVIDENCE),
        *(tables[name] for name in names if name in tables),
        *verification_charts(run.by_wave),
    ]


def notices(run: RunSource) -> list[Finding]:
    """Return errors first, then warnings by what they change."""
    direct, here = run.direct, versions()["gripscale"]
    answered = direct is not None and has_answer(direct)
    findings = [
        *run_failures(run),
        *friction_doubts(run.measured, run.predictions[0].speed),
        *([] if direct is None else no_answer_notices(direct)),
        *case_notices(direct, run.record),
    ]
    for view in run.predictions:
        beyond, share = prediction_sentence(view), model.extrapolation_of(view.data).share
        if beyond and not answered:
            text = f"{view.title}: {beyond} There the Prony series is an extrapolation."
            findings.append(Finding(Severity.WARNING, text, share, topic=Topic.RUBBER))
    for view in run.by_wave:
        findings += [
            replace(notice, sentence=f"{view.title}: {notice.sentence}")
            for notice in wave_notices(view, run.record.bulk_modulus)
        ]
    if len({str(view.data.attrs.get("case", "")) for view in run.predictions}) > 1:
        text = "The dynamic and the static result come from different case files."
        findings.append(Finding(Severity.DOUBT, text))
    solved = run.attrs.get("version_gripscale")
    if solved is not None and solved != here:
        text = f"Solved with gripscale {solved}, reported with {here}."
        findings.append(Finding(Severity.WARNING, text, topic=Topic.SOURCE))
    return ranked(findings)


def run_failures(run: RunSource) -> Iterator[Finding]:
    """Yield what has no numbers in a run: waves and predictions."""
    for view in run.predictions:
        text = ""
        for i in np.flatnonzero(~view.converged):
            text = (
                f"wave {i + 1} did NOT converge ({view.why(int(i))}). Its numbers are not to be "
                "used, the waves after it were not solved, and there are no totals. "
                f"{_advice(str(view.data['status'].values[i]))}"
            )
            yield Finding(Severity.ERROR, f"{view.title}: {text}".rstrip())
        if view.complete or text:
            continue
        text = (
            f"the run ended after wave {view.waves} of {view.planned}. The totals would lack the "
            "smaller waves and are not shown; run the case again."
        )
        if view.status != CONVERGED:
            text = f"{view.status}. There are no totals. {_advice(view.status_word)}"
        yield Finding(Severity.ERROR, f"{view.title}: {text}".rstrip())


def _advice(word: str) -> str:
    """Return what to do about a status as sentences of their own; empty where nothing is known."""
    status = Failure("", word).status
    if status is None:
        return ""
    return f"{status.advice} See {chapter_words(status.chapter)}."


def run_cards(run: RunSource) -> Iterator[Card]:
    """Yield the answer; without one, the totals of each prediction."""
    answered = [] if run.direct is None else list(answer.answer_cards(run.direct))
    yield from answered
    for view in run.predictions:
        if not answered or not view.complete:
            yield from _cards(view)


def _cards(view: PredictionView) -> Iterator[Card]:
    if not view.complete:
        yield Card("No totals", "not converged", view.title, bad=True)
        return
    area = number_text(view.total("contact_fraction"))
    waves = f"; {view.waves} wave{'s' if view.waves != 1 else ''}" if view.waves else ""
    yield Card("Real contact area A_r/A_0", area, f"{view.title}{waves}")
    if not view.moving:
        return
    lost = number_text(view.total("friction_from_dissipation"))
    friction = number_text(view.total("friction"))
    yield Card("Friction coefficient μ", friction, f"{view.title}; {lost} from energy lost")
    both = model.with_adhesive(view.data)
    if both is not None:
        yield Card("With the area term, μ", number_text(float(both)), f"{view.title}; as stated")
    if not view.has("friction_mismatch"):
        return
    mismatch = view.usable("friction_mismatch")
    largest = percent_text(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
    bad = bool(np.nanmax(mismatch, initial=0.0) > LARGE_MISMATCH)
    yield Card("Largest mismatch of μ", largest, "traction against energy lost", bad=bad)
