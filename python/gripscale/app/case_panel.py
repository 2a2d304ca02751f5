"""The case file beside the tabs: shown, edited, opened and saved, with what is wrong with it.

Files that are dropped on the page: each is stored in the folder of the visit under a safe name.
What a drop replaces in the case is a function of the tab; reading happens in the worker thread.
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
from gripscale.app.elements import CUT_TEXT, column, html, in_worker, work_button
from gripscale.case_file.examples import EXAMPLES
from gripscale.core import Finding, InputError, Severity

# From uploads by name to the text of the case with them; may read them, in the worker thread.
NewText = Callable[[Mapping[str, bytes]], str]
PAUSE = 3.0  # seconds without a further file after which those that are still announced do not come
# What is read is named; a file that arrived is not green: it may be refused yet.
DROP_STYLE = """\
:host([data-reading])::before { content: attr(data-reading); display: block; font-weight: 600;
    overflow-wrap: anywhere; padding: 0.2rem 0; }
[data-filepond-item-state="processing-complete"] .filepond--item-panel { background: #64605e; }
"""
TOO_LARGE = "too large"  # type that the browser announces of a file that it does not send


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
            previews=["image"],  # without any, Panel would load that of PDFs too, which fails
            stylesheets=[DROP_STYLE],
        )
        area.param.watch(receive, "value")
        return area

    async def receive(event: Any) -> None:
        if holder.loading:
            return  # a further file of those that are awaited
        area, taken, accepted = event.obj, 0, False
        holder.loading = True
        try:
            while len(area.value) > taken:
                uploads = await dropped_together(area)
                taken, accepted = len(uploads), False
                with state.refusals(table):
                    for name, kind in area.mime_type.items():
                        if kind == TOO_LARGE:
                            raise InputError(
                                f"{name} is too large; expected files of at most "
                                f"{MAX_UPLOAD / 1e6:.0f} MB, and none of these was read"
                            )
                    state.set_text(await in_worker(partial(new_text, uploads)))
                    accepted = True
            # the widget still marks its files as done: it stays, out of sight, until the next drop
            area.visible = False
            holder[1:] = [empty_area(), area]
            if accepted and then is not None:
                await then()
        finally:
            holder.loading = False

    holder = column(pn.pane.Markdown(label, margin=(4, 8, 0, 8)))
    holder.append(empty_area())
    return holder


async def dropped_together(area: pn.widgets.FileDropper) -> dict[str, bytes]:
    """Return files of an area by name once all that the browser announced have come."""
    received, end = -1, 0.0
    while {n for n, kind in area.mime_type.items() if kind != TOO_LARGE} - area.value.keys():
        if len(area.value) > received or area._file_buffer:
            received, end = len(area.value), time.monotonic() + PAUSE
        if time.monotonic() > end:
            break  # its sending was ended in the browser
        await asyncio.sleep(0.02)
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
        styles={"flex": "1 1 340px", "min-width": "0"},
        stylesheets=[CUT_TEXT],
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
            pane.objects = [html(Finding(Severity.ERROR, problem.sentence))]
        else:
            pane.objects = [] if tables else [html(Finding(Severity.GOOD, "This case can be run."))]

    follow()
    state.param.watch(follow, "problem")
    return pane
