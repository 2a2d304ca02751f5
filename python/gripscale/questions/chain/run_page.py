"""What a run left in its folder, and its page.

The page has the answer, its inputs, the chain wave by wave, and what was asked of them since.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.chain.chain import Chain
from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.core.provenance import versions
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.measured_friction import (
    MeasuredFriction,
    friction_doubts,
    stored_measurement,
)
from gripscale.io.table import NONE
from gripscale.questions.answer import page as answer
from gripscale.questions.answer.answer import ANSWER_FILE
from gripscale.questions.answer.findings import case_notices, no_answer_notices
from gripscale.questions.answer.reliance import has_answer, is_measured
from gripscale.questions.chain.charts import contact_charts, measured_chart
from gripscale.questions.chain.findings import prediction_sentence, wave_notices
from gripscale.questions.chain.page import heat_table, prediction_table, totals
from gripscale.questions.chain.run import DYNAMIC, STATIC
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.compare import page as comparison
from gripscale.questions.cut_off.question import CutOff
from gripscale.questions.inputs import page as inputs
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.stored import predicted_tree
from gripscale.questions.uncertainty import page as uncertainty
from gripscale.questions.uncertainty.propagation import of_same_inputs, stored_uncertainty
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


@dataclass(frozen=True)
class RunSource:
    """The predictions of one run, the record of its inputs and comparisons; both may be missing."""

    predictions: list[PredictionView]
    inputs: xr.Dataset
    # Models side by side over the same case, as far as they are there.
    compared: comparison.Compared = field(default_factory=comparison.Compared)
    uncertainty: xr.Dataset | None = None  # what was sampled of it, or of another case
    direct: xr.Dataset | None = None  # totals of the direct contact of the measured profiles
    cut_off: xr.Dataset | None = None  # contact and friction against the cut-off

    @property
    def data(self) -> xr.Dataset:
        """The first prediction: load, waves, provenance, versions."""
        return self.predictions[0].data

    @property
    def attrs(self) -> dict[Any, Any]:
        """Attributes of the first prediction."""
        return self.data.attrs

    @property
    def record(self) -> InputRecord:
        """The record of its inputs."""
        return InputRecord(self.inputs)

    @property
    def measured(self) -> MeasuredFriction | None:
        """Measured friction that its case names."""
        return stored_measurement(self.inputs)

    @property
    def by_wave(self) -> list[PredictionView]:
        """The predictions of models that go wave by wave."""
        return [prediction for prediction in self.predictions if prediction.waves]

    @property
    def own_uncertainty(self) -> xr.Dataset | None:
        """What was sampled of its very inputs, or None."""
        data, case = self.uncertainty, str(self.attrs.get("case", ""))
        if data is None or not of_same_inputs(data, case, self.record.digests):
            return None
        return data


def read_run(folder: Path) -> RunSource | None:
    """Return what a run left in a folder; None if there is no prediction of a run in it.

    Raises `FileError` if a file is damaged or is no result of gripscale.
    """
    paths = [folder / f"{name}.nc" for name in (DYNAMIC, STATIC)]
    trees = {path.stem: predicted_tree(path) for path in paths if path.is_file()}
    if not trees:
        return None
    run = run_of(trees)
    case = run.attrs.get("case")

    def of_this_case(path: Path) -> xr.Dataset | None:
        data = predicted_tree(path).to_dataset() if path.is_file() else None
        return data if data is not None and data.attrs.get("case") == case else None

    return replace(
        run,
        compared=comparison.stored_comparisons(folder / comparison.COMPARISON),
        uncertainty=stored_uncertainty(folder),
        direct=of_this_case(folder / ANSWER_FILE),
        cut_off=of_this_case(folder / "cut_off.nc"),
    )


def run_of(trees: dict[str, xr.DataTree]) -> RunSource:
    """Return the run of its predictions by name, with the record of inputs of the first."""
    views = [PredictionView(tree.to_dataset(), name) for name, tree in trees.items()]
    return RunSource(views, InputRecord.of_tree(next(iter(trees.values()))).data)


STALE = (
    "The comparison in this folder belongs to another version of the case and is left out; run "
    "`gripscale compare` again."
)
_OF_ANOTHER = Finding(Severity.WARNING, uncertainty.OF_ANOTHER, topic=Topic.SOURCE)


def run_page(run: RunSource) -> Page:
    """Return the report of `run`."""
    stale = run.uncertainty is not None and run.own_uncertainty is None
    return Page.of(
        f"Contact and friction: {case_title(run.attrs) or 'result'}",
        "; ".join(view.title for view in run.predictions),
        [*notices(run), *([_OF_ANOTHER] if stale else [])],
        [*run_cards(run), *uncertainty.uncertainty_cards(run.own_uncertainty)],
        [
            *_sections_of_inputs(run),
            *_sections_of_results(run),
            method_section(
                [] if run.direct is None else answer.method_of_answer(run.direct),
                Chain.method if run.by_wave else (),
            ),
            rerun_section(run.attrs),
        ],
        () if run.direct is None else answer.basis_lines(run.direct),
    )


def _sections_of_inputs(run: RunSource) -> Iterator[Section]:
    """Yield the contact of the measured surface, and what the result rests on."""
    contact = [] if run.direct is None else answer.contact_elements(run.direct, run.record)
    yield Section("contact", "Rubber on the surface", contact)
    files = [inputs.files_table(run.record)] if run.record.has("file_name") else []
    yield Section("inputs", "Inputs and their origin", [_load_facts(run), *files])
    surface: list[Element] = []
    if "sines_wavelength" in run.data:
        waves = SineStack(run.data["sines_wavelength"].values, run.data["sines_amplitude"].values)
        surface = inputs.surface_section(run.record, waves)
    yield Section("surface", "Surface", surface)
    moving = next((view.data for view in run.by_wave if view.moving), None)
    yield Section("rubber", "Rubber", inputs.rubber_section(run.record, moving))


def _load_facts(run: RunSource) -> Facts:
    attrs, data, record = run.attrs, run.data, run.record

    def text(name: str, value: float) -> str:
        unit = run.predictions[0].display_unit(name)
        return f"{number_text(unit.of(value))} {unit.unit}"

    speeds = ", ".join(text("speed", view.speed) for view in run.predictions if view.moving)
    if any(not view.moving for view in run.predictions):
        speeds = f"{speeds or 'none'}; and at rest (relaxed rubber)"
    pairs = [
        ("Nominal pressure", text("pressure", float(data["nominal_pressure"]))),
        ("Sliding speed", speeds),
        ("Footprint", text("footprint", float(data["footprint"]))),
    ]
    if "thickness" in data:
        pairs.append(("Thickness of the rubber", text("thickness", float(data["thickness"]))))
    solver = str(attrs.get("model", NONE))
    if "wave_solver" in data:
        names = dict.fromkeys(str(name) for name in data["wave_solver"].values)
        solver += f", waves by {', '.join(names)}"
    source = inputs.without_folder(str(attrs.get("rubber_source", attrs.get("rubber", ""))))
    # of a strain energy such as "MooneyRivlin(share=0.2)" the name in words, and its parameters
    law, _, parameters = record.text("strain_energy").partition("(")
    energy = "-".join(re.findall(r"[A-Z][a-z]+", law)) or law or NONE
    pairs += [
        ("Rubber", "; ".join(filter(None, [record.text("rubber_name"), source])) or NONE),
        ("Model", solver.replace("_", " ")),
        ("Strain energy", ", ".join(filter(None, [energy, parameters.removesuffix(")")]))),
        ("Method", str(attrs.get("method", NONE))),
    ]
    return Facts("Load and model", pairs)


def _sections_of_results(run: RunSource) -> Iterator[Section]:
    """Yield the chain wave by wave, what stands beside it, and how far it is to be trusted."""
    yield _results(run)
    direct = [] if run.direct is None else [PredictionView(run.direct, "direct contact")]
    sliding = [view for view in run.predictions if view.moving and view.complete]
    measured: list[Element] = []
    if run.measured is not None and sliding:
        measured.append(measured_chart(run.measured, [*sliding, *direct]))
    yield Section("measured", "Measured friction", measured)
    cut_off = [] if run.cut_off is None else CutOff(run.cut_off).elements()
    yield Section("cut-off", "Against the cut-off", cut_off)
    # the comparison of just this case; another's is named and left out
    same = run.compared.of(run.attrs.get("case"))
    lines: list[Element] = []
    if len(same.parts) < len(run.compared.parts):
        lines.append(Finding(Severity.WARNING, STALE))
    if same.ladder is not None and has_answer(same.ladder):
        lines += (Text(line.strip()) for line in answer.answer_lines(same.ladder))
    compared = [*lines, *comparison.comparison_elements(same)]
    yield Section("comparison", "Models side by side", compared)


def _results(run: RunSource) -> Section:
    """Return the chapter of the chain; beside an answer it is a comparison."""
    title, judge = "Contact and friction, wave by wave", None
    elements: list[Element] = []
    for view in run.predictions:
        table = replace(prediction_table(view.data, view.title), name=view.name)
        elements.append(table if view.waves else Text(totals(view.data)))
        if view.has("contact_temperature"):
            elements.append(replace(heat_table(view.data), name=f"heat-{view.name}"))
    if run.direct is not None and is_measured(run.direct):
        title, judge = f"{OF_THE_PAPER[0].upper()}{OF_THE_PAPER[1:]}, for comparison", run.direct
        elements += map(Text, comparison.judgement(run.predictions[0], judge))
    return Section("results", title, [*elements, *contact_charts(run.by_wave, judge)])


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
        for notice in wave_notices(view, run.record.bulk_modulus):
            titled = replace(notice, sentence=f"{view.title}: {notice.sentence}")
            if answered:  # by another model, which the waves do not change
                titled = replace(titled, friction=math.nan, area=math.nan)
            findings.append(titled)
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
        failed = np.flatnonzero(~view.converged).tolist()
        texts = [
            f"wave {i + 1} did NOT converge ({view.why(i)}). Its numbers are not to be used, the "
            "waves after it were not solved, and there are no totals. "
            f"{_advice(str(view.data['status'].values[i]))}"
            for i in failed
        ]
        if not view.complete and not failed and view.status == CONVERGED:
            texts.append(
                f"the run ended after wave {view.waves} of {view.planned}. The totals would lack "
                "the smaller waves and are not shown; run the case again."
            )
        elif not view.complete and not failed:
            advice = _advice(str(model.status_words(view.data).item()))
            texts.append(f"{view.status}. There are no totals. {advice}")
        for text in texts:
            yield Finding(Severity.ERROR, f"{view.title}: {text}".rstrip())


def _advice(word: str) -> str:
    """Return what to do about a status as sentences of their own; empty where nothing is known."""
    status = Failure("", word).status
    return "" if status is None else f"{status.advice} See {chapter_words(status.chapter)}."


def run_cards(run: RunSource) -> Iterator[Card]:
    """Yield the answer; without one, the totals of each prediction."""
    answered = [] if run.direct is None else list(answer.answer_cards(run.direct))
    yield from answered
    for view in run.predictions:
        if not view.complete:
            yield Card("No totals", "not converged", view.title, bad=True)
        if not view.complete or answered:
            continue
        area = number_text(view.total("contact_fraction"))
        waves = f"; {view.waves} wave{'s' if view.waves != 1 else ''}" if view.waves else ""
        yield Card("Real contact area A_r/A_0", area, f"{view.title}{waves}")
        if not view.moving:
            continue
        lost = number_text(view.total("friction_from_dissipation"))
        friction = number_text(view.total("friction"))
        yield Card("Friction coefficient μ", friction, f"{view.title}; {lost} from energy lost")
        both = model.with_adhesive(view.data)
        if both is not None:
            yield Card(
                "With the area term, μ", number_text(float(both)), f"{view.title}; as stated"
            )
        if view.has("friction_mismatch"):
            mismatch = float(np.fmax.reduce(view.usable("friction_mismatch")))
            text, bad = percent_text(mismatch), mismatch > LARGE_MISMATCH
            yield Card("Largest mismatch of μ", text, "traction against energy lost", bad)
