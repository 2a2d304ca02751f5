"""The case file beside the tabs: shown, edited, opened and saved, with what is wrong with it.

Files are uploaded by dropping them; each is stored in the folder of the visit under a safe name.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any

import panel as pn

from gripscale.app.case import MAX_UPLOAD, CaseState
from gripscale.app.elements import column, error_notice, html, refusals_in
from gripscale.case.examples import EXAMPLES
from gripscale.report.elements import Notice

OnUpload = Callable[[Mapping[str, bytes]], None]


def file_upload(label: str, on_upload: OnUpload, *, several: bool = False) -> pn.Column:
    """Return an area to drop files on; `on_upload` gets them by name, its error is shown below."""
    area = pn.widgets.FileDropper(
        multiple=several,
        max_file_size=f"{MAX_UPLOAD // 1_000_000}MB",
        sizing_mode="stretch_width",
        margin=(0, 8),
        previews=[],
    )
    message = column()

    def receive(_: object) -> None:
        message.objects = []
        uploads = {
            name: content.encode("utf-8") if isinstance(content, str) else content
            for name, content in area.value.items()
        }
        if uploads:
            with refusals_in(message):
                on_upload(uploads)

    area.param.watch(receive, "value")
    title = pn.pane.Markdown(label, margin=(4, 8, 0, 8), sizing_mode="stretch_width")
    return column(title, area, message)


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
    message = column()
    text.param.watch(lambda event: state.set_text(event.new), "value")

    def follow(*_: Any) -> None:
        text.value = state.text
        valid = html(Notice("good", "This case can be run."))
        invalid = error_notice(state.validation_message)
        message.objects = [invalid if state.validation_message else valid]

    follow()
    state.param.watch(follow, ["text", "validation_message"])

    example = pn.widgets.Select(
        label="Shipped example",
        options={f"{name}: {example.about}": name for name, example in EXAMPLES.items()},
        margin=(4, 8),
        sizing_mode="stretch_width",
        styles={"flex": "1 1 180px", "min-width": "0"},
    )
    load = pn.widgets.Button(label="Load the example", margin=(4, 8))

    def load_example(_: Any) -> None:
        with refusals_in(message, state.visit.short):
            state.load_example(example.value)

    load.on_click(load_example)
    save = pn.widgets.FileDownload(
        callback=lambda: io.BytesIO(state.text.encode("utf-8")),
        filename="case.toml",
        label="Save the case",
        margin=(4, 8),
    )
    prompt = (
        "Drop a case together with the files it names to open it, or a surface and a measurement "
        "of a rubber to make one."
    )
    return column(
        pn.FlexBox(example, load, align_items="end", sizing_mode="stretch_width"),
        text,
        message,
        save,
        file_upload(prompt, state.open, several=True),
    )


def validation_pane(state: CaseState, *tables: str) -> pn.Column:
    """Return a pane that shows what is wrong with the case if it is about one of `tables`."""
    pane = column()

    def follow(*_: object) -> None:
        message = state.validation_message
        starts = [f"[{name}{end}" for name in tables for end in "].["]
        relevant = any(start in message for start in starts)
        relevant = relevant or message.startswith(tuple(f"{name} file " for name in tables))
        pane.objects = [error_notice(message)] if relevant else []

    follow()
    state.param.watch(follow, "validation_message")
    return pane
