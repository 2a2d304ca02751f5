"""The case file beside the tabs: shown, edited, opened and saved, with what is wrong with it.

Files are uploaded by dropping them; each is stored in the folder of the visit under a safe name.
"""

from __future__ import annotations

import asyncio
import io
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partial
from typing import Any

import panel as pn

from gripscale.app.case import MAX_UPLOAD, CaseState, with_value
from gripscale.app.elements import column, html, in_worker, work_button
from gripscale.case.examples import EXAMPLES
from gripscale.report.elements import Notice

NewText = Callable[[Mapping[str, bytes]], str]
"""From uploads by name to the text of the case with them; may read them, in the worker thread."""


def file_upload(
    state: CaseState,
    table: str,
    label: str,
    new_text: NewText,
    *,
    several: bool = False,
    then: Callable[[], Awaitable[None]] | None = None,
) -> pn.Column:
    """Return an area to drop files on, which gives the case a new text, and what follows `then`.

    What is refused of them is the problem of the case in `table`; the case stays as it is.
    """

    def empty_area() -> pn.widgets.FileDropper:
        area = pn.widgets.FileDropper(
            multiple=several,
            max_file_size=f"{MAX_UPLOAD // 1_000_000}MB",
            sizing_mode="stretch_width",
            margin=(0, 8),
            previews=[],
        )
        area.param.watch(receive, "value")
        return area

    async def receive(event: Any) -> None:
        if holder.loading:
            return  # a further file of those that are awaited
        holder.loading, accepted, uploads = True, False, uploads_in(event.obj)
        try:
            while uploads:
                accepted = False
                with state.refusals(table):
                    state.set_text(await in_worker(partial(new_text, uploads)))
                    accepted = True
                uploads = await further_uploads(event.obj, len(uploads)) if several else {}
            await asyncio.sleep(SETTLING)
            holder[1] = empty_area()
            if accepted and then is not None:
                await then()
        finally:
            holder.loading = False

    holder = column(pn.pane.Markdown(label, margin=(4, 8, 0, 8)))
    holder.append(empty_area())
    return holder


SETTLING = 0.5
"""Seconds in which the widget marks a file as done in the browser; before, it must not go away."""
PAUSE = 3.0
"""Seconds without a further file after which those dropped together are complete.

The browser sends two at a time, with some 2 s between.
"""


async def further_uploads(area: pn.widgets.FileDropper, count: int) -> dict[str, bytes]:
    """Return all files that were dropped together once more than `count` are there, or none."""
    end = time.monotonic() + PAUSE
    while len(area.value) == count and (time.monotonic() < end or area._file_buffer):
        await asyncio.sleep(0.1)
    return uploads_in(area) if len(area.value) > count else {}


def uploads_in(area: pn.widgets.FileDropper) -> dict[str, bytes]:
    """Return the files of an area by name."""
    return {
        name: content.encode("utf-8") if isinstance(content, str) else content
        for name, content in area.value.items()
    }


def with_upload(state: CaseState, path: Sequence[str]) -> NewText:
    """Return what states the file uploaded last at a path of the case."""

    def new_text(uploads: Mapping[str, bytes]) -> str:
        return with_value(state.text, path, state.visit.store(*list(uploads.items())[-1]))

    return new_text


def case_panel(state: CaseState) -> pn.Column:
    """Return the case as text, with the choice of an example and what opens and saves the case."""
    text = pn.widgets.TextAreaInput(
        label="case.toml",
        value=state.text,
        rows=26,
        max_length=1_000_000,
        sizing_mode="stretch_width",
        margin=(4, 8),
        css_classes=["case"],
        stylesheets=["textarea { font: 12.5px/1.4 ui-monospace, Consolas, monospace; }"],
    )
    text.param.watch(lambda event: state.set_text(event.new), "value")
    state.param.watch(lambda event: text.param.update(value=event.new), "text")
    example = pn.widgets.Select(
        label="Shipped example",
        options={f"{name}: {example.about}": name for name, example in EXAMPLES.items()},
        margin=(4, 8),
        sizing_mode="stretch_width",
        styles={"flex": "1 1 180px", "min-width": "0"},
    )

    async def load_example() -> None:
        with state.refusals(""):
            state.set_text(await in_worker(lambda: state.example(example.value)))

    save = pn.widgets.FileDownload(
        callback=lambda: io.BytesIO(state.text.encode("utf-8")),
        filename="case.toml",
        label="Save the case",
        margin=(4, 8),
    )
    prompt = (
        "Drop a case together with its files to open it, or a surface and a measurement of a "
        "rubber to make a case."
    )
    load = work_button("Load the example", load_example)
    return column(
        pn.FlexBox(example, load, align_items="end", sizing_mode="stretch_width"),
        text,
        problem_pane(state),
        save,
        file_upload(state, "", prompt, state.open, several=True),
    )


def problem_pane(state: CaseState, *tables: str) -> pn.Column:
    """Return a pane that shows what is wrong with the case, if it is about one of `tables`.

    Without tables it shows every problem, and says where there is none.
    """
    pane = column()

    def follow(*_: object) -> None:
        problem = state.problem
        if problem is not None and (not tables or problem.table in tables):
            pane.objects = [html(Notice("error", problem.sentence))]
        else:
            pane.objects = [] if tables else [html(Notice("good", "This case can be run."))]

    follow()
    state.param.watch(follow, "problem")
    return pane
