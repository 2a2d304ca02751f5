"""Road: measured profiles or a map, their cleaning, their correlation and its sine waves."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any

import panel as pn

from gripscale.analysis.measured_comparison import friction_of_case
from gripscale.app.case import CaseState, tables, words_of
from gripscale.app.case_panel import file_upload, validation_message
from gripscale.app.elements import Cards, beside, code, error, html, in_turn, raw
from gripscale.app.forms import PreviewPanel, Shown, fill, table_form
from gripscale.app.runs import Run, Runs
from gripscale.case import (
    CaseFile,
    CaseResults,
    ConditionsTable,
    MeasuredTable,
    RubberSource,
    Surface,
    prepare_case,
    read_case,
    record,
    validate,
)
from gripscale.case.folder import CASE
from gripscale.case.rubber_tables import NAMED_RUBBERS
from gripscale.charts.page_elements import NONE, Element, Heading, Notice, Table, Text, number
from gripscale.charts.page_inputs import correlation_charts, profile_charts, rubber_charts
from gripscale.charts.page_run import contact_charts, measured_chart
from gripscale.charts.view import PredictionView
from gripscale.core.errors import GripscaleError
from gripscale.model import with_adhesive
from gripscale.report import source, write_report
from gripscale.report.comparison_chapters import effects_elements
from gripscale.report.inputs_text import shift_lines, sines_line
from gripscale.report.notices import cards, exponent_sentence, notices
from gripscale.report.pages import judgement_elements
from gripscale.report.tables_inputs import cleaning_tables, rubber_facts, surface_facts
from gripscale.report.tables_measured import measured_lines
from gripscale.report.wave_tables import wave_tables

# Surface or rubber of a case prepared alone: one can be looked at before the other is stated.

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


ROAD_FIELDS = (
    "scales",
    "smallest_wavelength",
    "cut_off",
    "upper_share",
    "crop",
    "x_unit",
    "z_unit",
)
SCALES = 8
"""Waves of a surface just dropped, as `gripscale fit-surface` has them."""


def road_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about the surface."""
    kind = pn.widgets.RadioButtonGroup(
        options={"Profiles along a line": "files", "A map": "map"}, margin=(4, 8)
    )
    shown = PreviewPanel(state, "Read, clean and fit", surface_elements)

    def taken(dropped: Mapping[str, bytes]) -> None:
        names = [state.place.store(name, content) for name, content in dropped.items()]
        source = names if kind.value == "files" else names[-1]
        state.set(("surface",), {kind.value: source, "scales": SCALES})
        pn.state.execute(shown.look)

    return pn.Column(
        validation_message(state, "surface"),
        kind,
        file_upload(
            "Drop profiles or a map; they replace the surface of the case.", taken, several=True
        ),
        table_form(state, "surface", ROAD_FIELDS),
        shown.button,
        shown.body,
        sizing_mode="stretch_width",
    )


# Rubber: a master curve or sweeps, the fit of its Prony series and the ends of the data.

RUBBER_FIELDS = ("name", "reference_temperature", "bulk_modulus", "terms", "extrapolate", "source")


def rubber_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about the rubber."""
    shown = PreviewPanel(state, "Read and fit", rubber_elements)

    def taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("rubber",), {"file": _stored(state, dropped)})
        pn.state.execute(shown.look)

    def shift_taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("rubber", "shift"), _stored(state, dropped))

    return pn.Column(
        validation_message(state, "rubber"),
        file_upload(
            "Drop a master curve, or sweeps at several temperatures; it replaces the rubber "
            "of the case.",
            taken,
        ),
        table_form(state, "rubber", RUBBER_FIELDS),
        file_upload("A table of shift factors, in place of a law of the shift.", shift_taken),
        shown.button,
        shown.body,
        sizing_mode="stretch_width",
    )


def _stored(state: CaseState, dropped: Mapping[str, bytes]) -> str:
    """Keep the file dropped last; return its name in the case."""
    return state.place.store(*list(dropped.items())[-1])


# Conditions and load: how the rubber is pressed and slid, what else acts, what solves a wave.

TABLES = {
    "load": ("Load", ("pressure", "speed", "footprint", "static", "load_time")),
    "conditions": ("Conditions", ("temperature", "strain_norm")),
    "solver": ("Solver of one wave", ("model", "points", "columns", "tolerance")),
    "chain": ("Chain of waves", ("pressure_classes",)),
}
"""Tables of the case by name: their title and what stands first."""


def load_tab(state: CaseState) -> pn.Column:
    """Return the part of the page about load, conditions and solver."""

    def softening_taken(dropped: Mapping[str, bytes]) -> None:
        path = ("conditions", "softening")
        names = [state.place.store(name, content) for name, content in dropped.items()]
        before = state.get(path)
        kept = before if isinstance(before, dict) and before.get("kind") == "table" else {}
        state.set(path, {**kept, "kind": "table", "files": names})

    def friction_taken(dropped: Mapping[str, bytes]) -> None:
        state.set(("measured", "friction"), state.place.store(*list(dropped.items())[-1]))

    parts: list[Any] = []
    for name, (title, first) in TABLES.items():
        parts += [pn.pane.Markdown(f"### {title}", margin=(4, 8)), table_form(state, name, first)]
        if name == "conditions":
            words = "Strain sweeps of the softening; they replace that of the case."
            parts.append(file_upload(words, softening_taken, several=True))
    return pn.Column(
        validation_message(state, *TABLES, "measured"),
        *parts,
        pn.pane.Markdown("### Measured friction", margin=(4, 8)),
        file_upload("A table of speed and friction, drawn over what is predicted.", friction_taken),
        sizing_mode="stretch_width",
    )


# Run: start, stop, and what the process says.

EVERY = 500
"""Milliseconds between looks at the process."""


def run_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the part of the page that runs the case."""
    start = pn.widgets.Button(label="Run the case", color="primary", margin=(8, 8))
    stop = pn.widgets.Button(label="Stop", color="danger", disabled=True, margin=(8, 8))
    bar = pn.indicators.Progress(value=0, max=100, sizing_mode="stretch_width", visible=False)
    told = pn.Column(sizing_mode="stretch_width")
    seen: list[tuple[str, str]] = []

    def starts(_: Any) -> None:
        try:
            runs.start()
        except GripscaleError as refused:
            told.objects = [error(state.place.short(refused))]

    def look() -> None:
        run = runs.all[-1] if runs.all else None
        start.disabled, stop.disabled = runs.going is not None, runs.going is None
        if run is None or seen == [(run.state, run.said())]:
            return
        ended = bool(seen) and seen[0][0] == "running" and not run.going
        seen[:] = [(run.state, run.said())]
        progress = run.progress()
        share = progress.share
        bar.param.update(visible=run.going, value=-1 if share is None else round(100 * share))
        complaint = state.place.short(run.complaint())
        log = state.place.short(run.said())
        words = html(_words(run.name, run.state, complaint, progress.words))
        told.objects = [words, code("What the run says", log)] if log else [words]
        if ended:
            runs.changes += 1

    def stops(_: Any) -> None:
        runs.stop()
        look()

    start.on_click(starts)
    stop.on_click(stops)
    runs.param.watch(lambda _: look(), "changes")
    pn.state.add_periodic_callback(look, period=EVERY)
    buttons = pn.Row(start, stop)
    return pn.Column(buttons, bar, told, sizing_mode="stretch_width")


def _words(name: str, state: str, complaint: str, far: str) -> Element:
    """Return how a run stands."""
    if state == "running":
        return Text(f"{name} is running: {far}.")
    if state == "stopped":
        return Notice("warning", f"{name} was stopped ({far}); the same case goes on from there.")
    if state == "failed":
        return Notice("error", f"{name}: {complaint}")
    return Notice("good", f"{name} has finished; its results are in the next part of the page.")


# Compare: the runs of this visit side by side, with what their cases have different.

CHARTS = ("contact-area", "friction")
"""Figures of several runs; the others are of one."""
HEADINGS = (
    Heading("run", words=True),
    Heading("at"),
    Heading("A_r/A_0"),
    Heading("μ"),
    Heading("with the area term"),
    Heading("status", words=True),
    Heading("stated differently from the first", words=True),
)


def compare_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the part of the page with all runs."""
    body = pn.Column(raw("<p>Nothing was run yet.</p>"), sizing_mode="stretch_width")

    async def follow(_: Any) -> None:
        if any(not run.going for run in runs.all):
            await fill(body, lambda: _elements(runs), state)

    runs.param.watch(follow, "changes")
    return body


def _elements(runs: Runs) -> Shown:
    """Return table and figures of all runs that have results."""
    found = [(run, view) for run in runs.all if not run.going for view in _views(run)]
    if not found:
        return [Text("No run of this visit has results.")]
    charts = contact_charts([view for _, view in found])
    return [_table(found), *(chart for chart in charts if chart.name in CHARTS)]


def _views(run: Run) -> list[PredictionView]:
    """Return the predictions of a run, named by it; none of one without results."""
    try:
        result = source.read_result(run.folder)
    except GripscaleError:
        return []
    found = result.by_wave if isinstance(result, source.Run) else []
    return [replace(one, name=run.name + ("" if one.moving else ", at rest")) for one in found]


def _table(found: list[tuple[Run, PredictionView]]) -> Table:
    first = found[0][0].text
    rows = []
    for run, view in found:
        both = with_adhesive(view.data)
        totals = [view.total("contact_fraction")]
        totals.append(view.total("friction") if view.moving else float("nan"))
        totals.append(float("nan") if both is None else float(both))
        shown = [number(value) if view.complete else NONE for value in totals]
        status = "complete" if view.complete else f"{view.waves} of {view.planned} waves"
        speed = view.shown("speed").text(view.speed, 3)
        rows.append(
            [view.name, speed, *shown, status, ", ".join(_changes(first, run.text)) or NONE]
        )
    return Table("runs", "The runs of this visit", HEADINGS, rows)


def _changes(first: str, other: str) -> Iterator[str]:
    """Yield the keys that two cases state differently, as the other does."""
    before, after = (dict(_flat(tables(text))) for text in (first, other))
    for key in dict.fromkeys([*before, *after]):
        if before.get(key) != after.get(key):
            yield f"{key} = {words_of(after[key])}" if key in after else f"no {key}"


def _flat(table: dict[str, Any], above: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value


# Results: area and friction, the scale that makes the grip, what the chain is worth, downloads.


def results_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the part of the page that shows one run."""
    choice = pn.widgets.Select(label="Run", options=[], margin=(4, 8), width=200)
    body = pn.Column(raw("<p>Nothing was run yet.</p>"), sizing_mode="stretch_width")
    below = pn.Column(sizing_mode="stretch_width")

    async def show(*_: Any) -> None:
        run = next((one for one in runs.all if one.name == choice.value), None)
        if run is None:
            return
        if run.going:
            body.objects = [raw(f"<p>{run.name} is running; its results come when it ends.</p>")]
            below.objects = []
            return
        await fill(body, lambda: list(results_elements(run.folder)), state)
        below.objects = _below(state, run) if any(run.folder.glob("*.nc")) else []

    async def follow(_: Any) -> None:
        names = [run.name for run in runs.all]
        if choice.options != names:
            choice.param.update(options=names, value=names[-1])  # which shows it
        else:
            await show()

    choice.param.watch(show, "value")
    runs.param.watch(follow, "changes")
    return pn.Column(choice, body, below, sizing_mode="stretch_width")


def _below(state: CaseState, run: Run) -> list[Any]:
    """Return what a run with results says and lets be saved."""
    said = state.place.short(run.said())
    return [code("Everything the run says", said), _downloads(run), _report(state, run)]


def results_elements(folder: Path) -> Iterator[Element | Cards]:
    """Yield what the folder of a run tells, in the order of the page."""
    run = source.read_result(folder)
    if not isinstance(run, source.Run):
        return
    yield Cards(cards(run))
    yield from notices(run)
    yield from judgement_elements(run)
    for one in run.predictions:
        sentence = exponent_sentence(one.data)
        if sentence:
            yield Text(f"{one.title}. {sentence}")
    yield from contact_charts(run.by_wave, run.direct)
    yield from _measured(folder, run)
    tables = {table.name: table for table in wave_tables(run.by_wave)}
    yield from (tables[name] for name in ("contact", "load", "conditions") if name in tables)
    yield from effects_elements(run.effects)


def _measured(folder: Path, run: source.Run) -> Iterator[Element]:
    """Yield the measured friction that the case of the run names, with what was predicted."""
    found = friction_of_case(read_case(folder / CASE))
    moving = [one for one in run.predictions if one.moving and one.complete]
    if found is None or not moving:
        return
    direct = [] if run.direct is None else [PredictionView(run.direct, "direct contact")]
    yield measured_chart(found, [*moving, *direct])
    yield from (
        Text(line) for line in measured_lines(found, moving[0].speed, moving[0].shown("speed"))
    )


def _downloads(run: Run) -> pn.FlexBox:
    """Return buttons that save report, data and everything."""
    report = pn.widgets.FileDownload(
        callback=lambda: io.BytesIO(in_turn(lambda: _page(run))),
        filename=f"{run.name}.html",
        label="Save the report",
    )
    data = [
        pn.widgets.FileDownload(
            file=str(path), filename=f"{run.name}-{path.name}", label=f"Save {path.name}"
        )
        for path in sorted(run.folder.glob("*.nc"))
    ]
    everything = pn.widgets.FileDownload(
        callback=lambda: _zipped(run.folder),
        filename=f"{run.name}.zip",
        label="Save everything",
    )
    return pn.FlexBox(report, *data, everything)


def _page(run: Run) -> bytes:
    """Return the report of a run, written anew."""
    return write_report(run.folder).read_bytes()


def _zipped(folder: Path) -> io.BytesIO:
    """Return a folder as a zip file."""
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(path for path in folder.rglob("*") if path.is_file()):
            archive.write(path, path.relative_to(folder.parent))
    held.seek(0)
    return held


def _report(state: CaseState, run: Run) -> pn.Column:
    """Return the report inside the page, once it is asked for."""
    button = pn.widgets.Button(label="Show the report here", margin=(8, 8))
    place = pn.Column(button, sizing_mode="stretch_width")

    async def show(_: Any) -> None:
        try:
            text = (await beside(lambda: _page(run))).decode("utf-8")
        except GripscaleError as refused:
            place.objects = [button, error(state.place.short(refused))]
            return
        frame = (
            f'<iframe title="Report of {run.name}" sandbox="allow-scripts" srcdoc="{{}}"></iframe>'
        )
        place.objects = [raw(frame.format(escape(text)))]

    button.on_click(show)
    return place
