"""The case file beside everything: shown, edited, opened and saved; one sentence if it is wrong."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

import panel as pn

from gripscale.app.dropped import dropper
from gripscale.app.elements import error, html
from gripscale.app.state import CaseState
from gripscale.errors import GripscaleError
from gripscale.init import EXAMPLES
from gripscale.report.elements import Notice


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
        dropper("Open a case: drop it together with the files it names.", opened, several=True),
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
