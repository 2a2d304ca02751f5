"""Tabs for what comes of the case: run, and the page of a result."""

from __future__ import annotations

import asyncio
import shlex
import shutil
from collections.abc import Mapping
from typing import Any

import panel as pn

from gripscale.app import elements
from gripscale.app.case import CaseState
from gripscale.app.case_panel import file_upload, problem_pane
from gripscale.app.runs import COMMANDS, AppRun, Runs
from gripscale.core.errors import FileError, InputError
from gripscale.questions.registry import Form
from gripscale.report.elements import Element, Text

POLL = 500  # milliseconds between two readings of the text of a run
NO_RUN = "<p>No case was run yet.</p>"


def run_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the tab that runs the case: command, options, start, stop, progress and answer."""
    choice = pn.widgets.Select(
        label="Question",
        options={command.title: command for command in COMMANDS},
        margin=(4, 8),
        width=300,
    )
    form = elements.column()
    others = pn.widgets.TextInput(
        label="others, by name", margin=(4, 8), sizing_mode="stretch_width", max_width=420
    )
    fields: dict[str, pn.widgets.TextInput | pn.widgets.Select] = {}
    bar = pn.indicators.Progress(value=-1, sizing_mode="stretch_width", visible=False)
    status, answer, output = elements.column(), elements.column(), elements.code("")
    folded_output = elements.folded_card("Command and output", output, visible=False)

    def with_others(uploads: Mapping[str, bytes]) -> str:
        names = [state.visit.store(name, content) for name, content in uploads.items()]
        others.value = ", ".join([*filter(None, [others.value]), *names])
        return state.text

    def show_options(*_: Any) -> None:
        command: Form = choice.value
        fields.clear()
        for option in command.fields:
            look = {"label": option.label, "value": option.value, "margin": (4, 8), "width": 220}
            if option.choices:
                fields[option.label] = pn.widgets.Select(options=dict(option.choices), **look)
            else:
                fields[option.label] = pn.widgets.TextInput(**look)
        drop = []
        if command.others:
            others.value = ""
            words = f"Drop other {command.others}; they are compared with that of the case."
            drop = [others, file_upload(state, "run", words, with_others, several=True)]
        form.objects = [elements.html(Text(command.about)), pn.FlexBox(*fields.values()), *drop]

    async def start() -> None:
        names = [name.strip() for name in (others.value or "").split(",") if name.strip()]
        command: Form = choice.value
        values = {label: str(field.value or "") for label, field in fields.items()}
        answer.objects = []
        with state.refusals("run"):
            run = runs.start(command, values, names if command.others else ())
            stop.visible = True
            while run.running:
                bar.visible = True
                show_output(run)
                await asyncio.sleep(POLL / 1e3)
            await conclude(run)

    def show_output(run: AppRun) -> None:
        status.objects = [elements.html(run_status(run))]
        command = f"$ {shlex.join(['gripscale', *run.words])}"
        output.object = elements.code(f"{command}\n{state.visit.short(run.log())}").object
        folded_output.visible = True

    async def conclude(run: AppRun) -> None:
        bar.visible = stop.visible = False
        show_output(run)
        if run.state == "finished":
            title = f"Answer of {run.name}"
            answer.objects = [elements.page_frame(state.visit, run.page(), title, "answer")]
        runs.changes += 1
        if run.state == "failed":
            raise InputError(f"{run.name}: {run.failure()}")

    async def end() -> None:
        if runs.running is not None:  # what started it sees its end
            await asyncio.get_running_loop().run_in_executor(None, runs.running.stop)

    choice.param.watch(show_options, "value")
    show_options()
    stop = elements.work_button("Stop", end, color="danger", visible=False)
    return elements.column(
        problem_pane(state, "run"),
        answer,
        choice,
        form,
        pn.Row(elements.work_button("Run", start, color="primary"), stop),
        bar,
        status,
        folded_output,
    )


def run_status(run: AppRun) -> Element:
    """Return the state of a run in a sentence; what it failed with is the problem of the case."""
    words = {
        "running": f"is running: {run.how_far()}.",
        "stopped": f"was stopped ({run.how_far()}).",
        "failed": "failed.",
        "finished": "has finished; the next tab shows its page.",
    }
    return Text(f"{run.name}, {run.command.title.lower()}, {words[run.state]}")


def results_tab(state: CaseState, runs: Runs) -> pn.Column:
    """Return the tab that shows the page of one run, and saves its files."""
    choice = pn.widgets.Select(label="Run", options=[], margin=(4, 8), width=320)
    body = elements.column(elements.raw(NO_RUN))

    def show(*_: Any) -> None:
        run = choice.value
        if run is None:
            return
        if run.running:
            waiting = f"<p>{run.name} is running; its page follows at its end.</p>"
            body.objects = [elements.raw(waiting)]
            return
        try:
            frame = elements.page_frame(state.visit, run.page(), f"Report of {run.name}")
        except FileError as error:
            why = state.visit.short(error)
            body.objects = [elements.html(Text(f"{run.name} has no page: {why}"))]
        else:
            body.objects = [downloads(run), frame]

    def follow(_: Any) -> None:
        options = {f"{run.name}: {run.command.title}": run for run in runs.all}
        if options and choice.options != options:
            choice.param.update(options=options, value=runs.all[-1])  # which shows it
        else:
            show()

    choice.param.watch(show, "value")
    runs.param.watch(follow, "changes")
    return elements.column(choice, body)


def downloads(run: AppRun) -> pn.FlexBox:
    """Return buttons that save the report, each data file and the whole folder."""

    def zipped() -> str:
        return shutil.make_archive(str(run.folder), "zip", run.folder.parent, run.folder.name)

    files = [
        pn.widgets.FileDownload(
            file=str(path), filename=f"{run.name}-{path.name}", label=f"Save {path.name}"
        )
        for path in sorted([*run.folder.glob("*.html"), *run.folder.glob("*.nc")])
    ]
    whole = {"filename": f"{run.name}.zip", "label": "Save everything"}
    return pn.FlexBox(*files, pn.widgets.FileDownload(callback=zipped, **whole))
