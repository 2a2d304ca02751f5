"""Run: start, stop, and what the process says."""

from __future__ import annotations

from typing import Any

import panel as pn

from gripscale.app.elements import code, error, html
from gripscale.app.runs import Runs
from gripscale.app.state import CaseState
from gripscale.errors import GripscaleError
from gripscale.report.elements import Element, Notice, Text

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
