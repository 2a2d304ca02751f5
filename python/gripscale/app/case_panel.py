"""The case file beside everything: shown, edited, opened and saved; one sentence if it is wrong."""

from __future__ import annotations

import io
from collections.abc import Callable, Mapping
from typing import Any

import panel as pn

from gripscale.app.case import MOST, CaseState
from gripscale.app.elements import error, html
from gripscale.case.examples import EXAMPLES
from gripscale.charts.page_elements import Notice
from gripscale.core.errors import GripscaleError

# Places to drop files: what is dropped is kept in the folder of the visit under a safe name.

Taken = Callable[[Mapping[str, bytes]], None]


def file_upload(label: str, taken: Taken, *, several: bool = False) -> pn.Column:
    """Return a place to drop files, which `taken` gets by name; what it raises is shown there."""
    place = pn.widgets.FileDropper(
        multiple=several,
        max_file_size=f"{MOST // 1_000_000}MB",
        sizing_mode="stretch_width",
        margin=(0, 8),
        previews=[],
    )
    complaint = pn.Column(sizing_mode="stretch_width")

    def dropped(_: object) -> None:
        given = {name: _bytes(content) for name, content in place.value.items()}
        complaint.objects = []
        if not given:
            return
        try:
            taken(given)
        except GripscaleError as refused:
            complaint.objects = [error(str(refused))]

    place.param.watch(dropped, "value")
    title = pn.pane.Markdown(label, margin=(4, 8, 0, 8), sizing_mode="stretch_width")
    return pn.Column(title, place, complaint, sizing_mode="stretch_width")


def _bytes(content: bytes | str) -> bytes:
    return content.encode("utf-8") if isinstance(content, str) else content


def case_side(state: CaseState) -> pn.Column:
    """Return the case as text, with what opens and saves it."""
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
    verdict = pn.Column(sizing_mode="stretch_width")
    text.param.watch(lambda event: state.show(event.new), "value")

    def follow(*_: Any) -> None:
        text.value = state.text
        good = html(Notice("good", "This case can be run."))
        verdict.objects = [error(state.complaint) if state.complaint else good]

    follow()
    state.param.watch(follow, ["text", "complaint"])

    def opened(dropped: Mapping[str, bytes]) -> None:
        state.open(dropped)

    save = pn.widgets.FileDownload(
        callback=lambda: io.BytesIO(state.text.encode("utf-8")),
        filename="case.toml",
        label="Save the case",
        margin=(4, 8),
    )
    return pn.Column(
        _examples(state, verdict),
        text,
        verdict,
        save,
        file_upload("Open a case: drop it together with the files it names.", opened, several=True),
        sizing_mode="stretch_width",
    )


def _examples(state: CaseState, verdict: pn.Column) -> pn.FlexBox:
    """Return the choice of a shipped example."""
    names = {f"{name}: {one.about}": name for name, one in EXAMPLES.items()}
    choice = pn.widgets.Select(
        label="Shipped example",
        options=names,
        margin=(4, 8),
        sizing_mode="stretch_width",
        styles={"flex": "1 1 180px", "min-width": "0"},
    )
    load = pn.widgets.Button(label="Load the example", margin=(4, 8))

    def loads(_: Any) -> None:
        try:
            state.load_example(choice.value)
        except GripscaleError as refused:
            verdict.objects = [error(state.place.short(refused))]

    load.on_click(loads)
    return pn.FlexBox(choice, load, align_items="end", sizing_mode="stretch_width")


# What is wrong with the case, said in the part of the page where it can be mended.


def validation_message(state: CaseState, *tables: str) -> pn.Column:
    """Return a place that shows the complaint about the case if it is about one of `tables`."""
    place = pn.Column(sizing_mode="stretch_width")

    def follow(*_: object) -> None:
        own = any(f"[{name}{end}" in state.complaint for name in tables for end in "].[")
        own = own or any(state.complaint.startswith(f"{name} file ") for name in tables)
        place.objects = [error(state.complaint)] if own else []

    follow()
    state.param.watch(follow, "complaint")
    return place
