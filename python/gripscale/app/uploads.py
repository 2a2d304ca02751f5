"""Files that are dropped on the page: each is stored in the folder of the visit under a safe name.

What a drop replaces in the case is a function of the tab; reading happens in the worker thread.
"""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable, Mapping, Sequence
from functools import partial
from typing import Any

import panel as pn
from bokeh.document import Document
from bokeh.models import CustomJS

from gripscale.app.case import MAX_UPLOAD, CaseState, with_value
from gripscale.app.elements import column, in_worker

NewText = Callable[[Mapping[str, bytes]], str]
"""From uploads by name to the text of the case with them; may read them, in the worker thread."""
PAUSE = 3.0
"""Seconds without a further file after which those dropped together are complete.

The browser sends two at a time, with some 2 s between.
"""
READING = """\
:host([data-reading])::before { content: attr(data-reading); display: block; font-weight: 600;
    overflow-wrap: anywhere; padding: 0.2rem 0; }
[data-filepond-item-state="processing-complete"] .filepond--item-panel { background: #64605e; }
"""
"""What is read is named; a file that arrived is not green: it may be refused yet."""
AT_ONCE = """\
const holds = part => part.shadowRoot?.querySelector('.filepond--root')
const area_of = event => event.composedPath().find(holds)
const name = (event, files) => {
    const area = area_of(event)
    const names = [...files ?? []].map(file => file.name)
    if (area && names.length) area.setAttribute('data-reading', `Reading ${names.join(', ')} ...`)
}
document.addEventListener('drop', event => name(event, event.dataTransfer?.files), true)
document.addEventListener('input', event => name(event, event.composedPath()[0].files), true)
document.addEventListener('FilePond:addfile', event => {
    if (event.detail.error) area_of(event)?.removeAttribute('data-reading')
})
"""
"""Names files at the drop, in the browser itself: the widget plays 1 s before it sends them."""


def name_at_once(page: Document) -> None:
    """Let the areas of a page name files as soon as they are dropped."""
    page.js_on_event("document_ready", CustomJS(code=AT_ONCE))


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
            stylesheets=[READING],
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
            # the widget still marks its files as done: it stays, out of sight, until the next drop
            event.obj.visible = False
            holder[1:] = [empty_area(), event.obj]
            if accepted and then is not None:
                await then()
        finally:
            holder.loading = False

    holder = column(pn.pane.Markdown(label, margin=(4, 8, 0, 8)))
    holder.append(empty_area())
    return holder


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
