"""Tabs for what comes of the case: run, results, and all runs of the visit compared.

Figures, tables and sentences are those of the report.
"""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import panel as pn
import xarray as xr

from gripscale.analysis.intervals import interval_ends
from gripscale.analysis.measured_comparison import friction_of_case
from gripscale.app.case import CaseState, field_text, tables_of
from gripscale.app.elements import (
    AppElement,
    Cards,
    PageElements,
    code,
    column,
    html,
    in_worker,
    notice_elements,
    panes,
    raw,
    refusals_in,
    wait_for_worker,
)
from gripscale.app.forms import fill
from gripscale.app.runs import COMMANDS, Run, Runs
from gripscale.case import read_case
from gripscale.case.folder import CASE
from gripscale.charts.view import SYMBOLS, PredictionView
from gripscale.charts.wave_and_chain import contact_charts, measured_chart
from gripscale.core.errors import GripscaleError
from gripscale.io.table import Column, Table
from gripscale.model import with_adhesive
from gripscale.report import source, write_report
from gripscale.report.answer import basis_lines, has_answer
from gripscale.report.elements import Code, Element, Notice, Page, Text
from gripscale.report.measured import measured_lines
from gripscale.report.notices import cards, exponent_sentence, notices
from gripscale.report.pages import effects_elements, judgement_elements, page_of
from gripscale.report.waves import wave_tables

POLL = 500
"""Milliseconds between two readings of the events of a run."""
NO_RUN = "<p>No case was run yet.</p>"


def run_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the tab that runs the case: command, start, stop, progress and output."""
    command = pn.widgets.Select(label="Result", options=COMMANDS, margin=(4, 8), width=220)
    start = pn.widgets.Button(label="Run the case", color="primary", margin=(8, 8))
    stop = pn.widgets.Button(label="Stop", color="danger", disabled=True, margin=(8, 8))
    bar = pn.indicators.Progress(value=0, max=100, sizing_mode="stretch_width", visible=False)
    status = column()
    last_state: list[tuple[str, int, str]] = []

    def on_start(_: Any) -> None:
        with refusals_in(status, state.visit.short):
            runs.start(str(command.value))

    def update() -> None:
        run = runs.all[-1] if runs.all else None
        start.disabled, stop.disabled = runs.running is not None, runs.running is None
        if run is None:
            return
        log = state.visit.short(run.log())
        now = (run.state, len(run.events()), log)
        if last_state == [now]:
            return
        ended = bool(last_state) and last_state[0][0] == "running" and not run.running
        last_state[:] = [now]
        share = run.progress().share
        bar.param.update(visible=run.running, value=-1 if share is None else round(100 * share))
        answer = panes(answer_elements(run)) if run.state == "finished" else []
        output = [code("Output", log)] if log else []
        status.objects = [html(run_status(run, state)), *answer, *output]
        if ended:
            runs.changes += 1

    def on_stop(_: Any) -> None:
        runs.stop()
        update()

    start.on_click(on_start)
    stop.on_click(on_stop)
    runs.param.watch(lambda _: update(), "changes")
    pn.state.add_periodic_callback(update, period=POLL)
    return column(command, pn.Row(start, stop), bar, status)


def run_status(run: Run, state: CaseState) -> Element:
    """Return the state of a run in a sentence."""
    progress = run.how_far()
    if run.state == "running":
        return Text(f"{run.name} is running: {progress}.")
    if run.state == "stopped":
        return Notice(
            "warning", f"{run.name} was stopped ({progress}); the same case continues from there."
        )
    if run.state == "failed":
        return Notice("error", f"{run.name}: {state.visit.short(run.failure())}")
    return Notice("good", f"{run.name} has finished; the next tab shows its results.")


def answer_elements(run: Run) -> PageElements:
    """Return the answer of a finished run: of its contact where the surface was measured."""
    try:
        result = wait_for_worker(lambda: source.read_result(run.folder))
    except GripscaleError:
        return []  # the next tab says why
    if isinstance(result, source.Run):
        return [Cards(cards(result))]
    page = page_of(result)
    return [Cards(page.cards), Text(page.subtitle)]


def results_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the tab that shows one run: results, output, downloads and the report."""
    choice = pn.widgets.Select(label="Run", options=[], margin=(4, 8), width=200)
    body = column(raw(NO_RUN))
    footer = column()

    async def show(*_: Any) -> None:
        run = next((run for run in runs.all if run.name == choice.value), None)
        if run is None:
            return
        footer.objects = []
        if run.running:
            body.objects = [raw(f"<p>{run.name} is running; its results follow at its end.</p>")]
            return
        await fill(body, lambda: list(results_elements(run.folder)), state)
        if any(run.folder.glob("*.nc")):
            log = code("Output of the run", state.visit.short(run.log()))
            footer.objects = [log, downloads(run), report_pane(state, run)]

    async def follow(_: Any) -> None:
        names = [run.name for run in runs.all]
        if choice.options != names:
            choice.param.update(options=names, value=names[-1])  # which shows it
        else:
            await show()

    choice.param.watch(show, "value")
    runs.param.watch(follow, "changes")
    return column(choice, body, footer)


def results_elements(folder: Path) -> Iterator[AppElement]:
    """Yield the results in the folder of a run, in the order of the page."""
    run = source.read_result(folder)
    if not isinstance(run, source.Run):
        yield from page_elements(page_of(run))
        return
    yield Cards(cards(run))
    if run.direct is not None:
        yield from map(Text, basis_lines(run.direct))
    yield from notice_elements(notices(run))
    yield from judgement_elements(run)
    for prediction in run.predictions:
        sentence = exponent_sentence(prediction.data)
        if sentence:
            yield Text(f"{prediction.title}. {sentence}")
    yield from contact_charts(run.by_wave, run.direct)
    yield from measured_elements(folder, run)
    tables = {table.name: table for table in wave_tables(run.by_wave)}
    yield from (tables[name] for name in ("contact", "load", "conditions") if name in tables)
    yield from effects_elements(run.effects)


def page_elements(page: Page) -> Iterator[AppElement]:
    """Yield what a page shows, without how to run it again."""
    yield Cards(page.cards)
    yield from map(Text, (page.subtitle, *page.basis))
    yield from notice_elements(page.notices)
    for section in page.sections:
        yield from (each for each in section.elements if not isinstance(each, Code))


def measured_elements(folder: Path, run: source.Run) -> Iterator[Element]:
    """Yield the measured friction the case of the run names, with the predictions."""
    friction = friction_of_case(read_case(folder / CASE))
    sliding = [view for view in run.predictions if view.moving and view.complete]
    if friction is None or not sliding:
        return
    direct = [] if run.direct is None else [PredictionView(run.direct, "direct contact")]
    yield measured_chart(friction, [*sliding, *direct])
    lines = measured_lines(friction, sliding[0].speed, sliding[0].display_unit("speed"))
    yield from (Text(line) for line in lines)


def downloads(run: Run) -> pn.FlexBox:
    """Return buttons that save the report, each data file and the whole folder."""

    def zipped() -> io.BytesIO:
        buffer = io.BytesIO()
        with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
            for path in sorted(path for path in run.folder.rglob("*") if path.is_file()):
                archive.write(path, path.relative_to(run.folder.parent))
        buffer.seek(0)
        return buffer

    report = pn.widgets.FileDownload(
        callback=lambda: io.BytesIO(wait_for_worker(lambda: new_report(run))),
        filename=f"{run.name}.html",
        label="Save the report",
    )
    data = [
        pn.widgets.FileDownload(
            file=str(path), filename=f"{run.name}-{path.name}", label=f"Save {path.name}"
        )
        for path in sorted(run.folder.glob("*.nc"))
    ]
    folder = pn.widgets.FileDownload(
        callback=zipped, filename=f"{run.name}.zip", label="Save everything"
    )
    return pn.FlexBox(report, *data, folder)


def new_report(run: Run) -> bytes:
    """Return the report of a run, written now."""
    return write_report(run.folder).read_bytes()


def report_pane(state: CaseState, run: Run) -> pn.Column:
    """Return a button that shows the report of a run inside the page."""
    button = pn.widgets.Button(label="Show the report here", margin=(8, 8))
    pane = column(button)

    async def show(_: Any) -> None:
        with refusals_in(pane, state.visit.short, above=[button]):
            page = (await in_worker(lambda: new_report(run))).decode("utf-8")
            options = f'title="Report of {run.name}" sandbox="allow-scripts"'
            pane.objects = [raw(f'<iframe {options} srcdoc="{escape(page)}"></iframe>')]

    button.on_click(show)
    return pane


COMPARED_CHARTS = ("contact-area", "friction")
"""Figures with one curve a run; the others show one run alone."""


def compare_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the tab that compares all runs of the visit."""
    body = column(raw(NO_RUN))

    async def follow(_: Any) -> None:
        if any(not run.running for run in runs.all):
            await fill(body, lambda: compared_elements(runs), state)

    runs.param.watch(follow, "changes")
    return body


class ComparedRun(NamedTuple):
    """A prediction of a run, and the answer at its speed where the surface was measured."""

    run: Run
    view: PredictionView
    direct: xr.Dataset | None


def compared_elements(runs: Runs) -> PageElements:
    """Return table and figures of all runs that have results."""
    compared: list[ComparedRun] = []
    for run in runs.all:
        try:
            result = None if run.running else source.read_result(run.folder)
        except GripscaleError:
            continue  # stopped or failed before its first wave
        if isinstance(result, source.Run):
            for view in result.by_wave:
                name = run.name + ("" if view.moving else ", at rest")
                direct = result.direct
                if direct is None or not has_answer(direct) or direct.nominal_speed != view.speed:
                    direct = None
                compared.append(ComparedRun(run, replace(view, name=name), direct))
    if not compared:
        return [Text("No run of this visit has results.")]
    charts = contact_charts([view for _, view, _ in compared])
    return [runs_table(compared), *(chart for chart in charts if chart.name in COMPARED_CHARTS)]


def runs_table(compared: Sequence[ComparedRun]) -> Table:
    """Return the answer and the chain of each prediction, and the keys in which cases differ."""
    first = compared[0][0].text
    totals, states = [], []
    for _, view, _ in compared:
        with_area_term = with_adhesive(view.data)
        numbers = [
            view.total("contact_fraction"),
            view.total("friction") if view.moving else math.nan,
            math.nan if with_area_term is None else float(with_area_term),
        ]
        totals.append(numbers if view.complete else [math.nan] * len(numbers))
        states.append("complete" if view.complete else f"{view.waves} of {view.planned} waves")
    speeds = [view.display_unit("speed").text(view.speed, 3) for _, view, _ in compared]
    changes = [", ".join(changed_keys(first, run.text)) for run, _, _ in compared]
    area, friction, with_term = zip(*totals, strict=True)
    columns = [
        Column("run", [view.name for _, view, _ in compared]),
        Column("speed", speeds, words=False),
        *_best_columns([direct for _, _, direct in compared]),
        Column("friction", friction, "μ", group=CHAIN),
        Column("contact_fraction", area, "A_r/A_0", group=CHAIN),
    ]
    if np.isfinite(with_term).any():
        columns.append(Column("with_area_term", with_term, "μ with the area term", group=CHAIN))
    columns += [
        Column("status", states),
        Column("changes", changes, "keys that differ from the first", words=True),
    ]
    return Table("runs", columns, "The runs of this visit")


CHAIN = "chain of waves"
"""Over the numbers of the chain, beside the best estimates."""


def _best_columns(answers: Sequence[xr.Dataset | None]) -> Iterator[Column]:
    """Yield best estimates and their intervals; nothing where no surface was measured."""
    for name in reversed(SYMBOLS) if any(answer is not None for answer in answers) else ():
        numbers = [
            (math.nan,) * 3
            if answer is None
            else (float(answer[f"best_{name}"]), *map(float, _interval(answer, name)))
            for answer in answers
        ]
        value, low, high = zip(*numbers, strict=True)
        yield Column(f"best_{name}", value, SYMBOLS[name], group="best estimate")
        ends = np.stack([low, high], axis=1)
        if np.isfinite(ends).any():
            yield Column(f"best_{name}_interval", ends, "90 %", group="best estimate")


def _interval(answer: xr.Dataset, name: str) -> tuple[xr.DataArray, xr.DataArray]:
    """Return the ends of the interval of a best estimate."""
    return interval_ends(answer[f"best_{name}"], answer[f"best_{name}_half_width"])


def changed_keys(first: str, other: str) -> Iterator[str]:
    """Yield the keys that two cases state differently, with the values of the other."""
    before, after = (dict(_flat(tables_of(text))) for text in (first, other))
    for key in dict.fromkeys([*before, *after]):
        if before.get(key) != after.get(key):
            yield f"{key} = {field_text(after[key])}" if key in after else f"no {key}"


def _flat(table: dict[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in table.items():
        if isinstance(value, dict):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value
