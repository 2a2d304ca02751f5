"""The case file beside the tabs: shown, edited, opened and saved, with what is wrong with it."""

from __future__ import annotations

import io

import panel as pn

from gripscale.app.case import CaseState
from gripscale.app.elements import CUT_TEXT, column, html, in_worker, work_button
from gripscale.app.uploads import file_upload
from gripscale.case_file.examples import EXAMPLES
from gripscale.core.finding import Finding, Severity


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
