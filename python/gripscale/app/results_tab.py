"""Results: area and friction, the scale that makes the grip, what the chain is worth, downloads."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

import panel as pn

from gripscale.app.elements import Cards, code, error, raw
from gripscale.app.looked_at import fill
from gripscale.app.run import Run
from gripscale.app.runs import Runs
from gripscale.app.state import CaseState
from gripscale.app.worker import beside, in_turn
from gripscale.case import read_case
from gripscale.case.saved import CASE
from gripscale.errors import GripscaleError
from gripscale.figures.view import PredictionView
from gripscale.measured.of_case import friction_of_case
from gripscale.report import source, write_report
from gripscale.report.charts.contact import contact_charts
from gripscale.report.charts.measured import measured_chart
from gripscale.report.cut_off import exponent_sentence
from gripscale.report.effects_chapter import effects_elements
from gripscale.report.elements import Element, Text
from gripscale.report.measured_lines import measured_lines
from gripscale.report.notices import cards, notices
from gripscale.report.run_page import judgement_elements
from gripscale.report.wave_tables import wave_tables


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
