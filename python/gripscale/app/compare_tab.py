"""Compare: the runs of this visit side by side, with what their cases have different."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import panel as pn

from gripscale.app.case_text import tables, words_of
from gripscale.app.elements import raw
from gripscale.app.looked_at import Shown, fill
from gripscale.app.run import Run
from gripscale.app.runs import Runs
from gripscale.app.state import CaseState
from gripscale.errors import GripscaleError
from gripscale.figures.view import PredictionView
from gripscale.model import with_adhesive
from gripscale.report import source
from gripscale.report.charts.contact import contact_charts
from gripscale.report.elements import Heading, Table, Text
from gripscale.report.numbers import NONE, number

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
