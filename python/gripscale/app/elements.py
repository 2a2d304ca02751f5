"""Elements of a report as panes of the page, and the thread that computes what they show.

All texts are escaped by the template.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar

import panel as pn

from gripscale.charts.bokeh_parts import model
from gripscale.charts.draw import Chart
from gripscale.core.finding import Finding
from gripscale.report.build import template_text, templates
from gripscale.report.elements import Card, Code, Element, Text, open_and_folded

_T = TypeVar("_T")


@dataclass(frozen=True)
class Cards:
    """Results at the head of a page, and what they are for and rest on."""

    cards: Sequence[Card]
    basis: Sequence[str]
    kind: ClassVar[str] = "cards"


@dataclass(frozen=True)
class Folded:
    """Warnings that open at a click."""

    notices: Sequence[Finding]
    kind: ClassVar[str] = "folded"


AppElement = Element | Cards | Folded
PageElements = Sequence[AppElement]


def notice_elements(notices: Sequence[Finding]) -> Iterator[AppElement]:
    """Yield errors and the first few warnings, then the others folded."""
    opened, folded = open_and_folded(notices)
    yield from opened
    if folded:
        yield Folded(folded)


def column(*parts: Any, **options: Any) -> pn.Column:
    """Return a column as wide as the page."""
    return pn.Column(*parts, sizing_mode="stretch_width", **options)


def folded_card(title: str, *parts: Any, **options: Any) -> pn.Card:
    """Return a card that opens at a click."""
    look: dict[str, Any] = {"sizing_mode": "stretch_width", "margin": (6, 8)}
    return pn.Card(*parts, title=title, collapsed=True, **look, **options)


def panes(elements: Iterable[AppElement]) -> list[pn.viewable.Viewable]:
    """Return the panes that show `elements`, in order."""
    return [chart_pane(e) if isinstance(e, Chart) else html(e) for e in elements]


_STYLE = template_text("gripscale.app", "elements.css")


def html(element: AppElement) -> pn.pane.HTML:
    """Return the pane of a text, a notice, a table, facts, code or cards."""
    return raw(templates("gripscale.app").get_template("elements.html").render(e=element))


def raw(markup: str) -> pn.pane.HTML:
    """Return the pane of markup written in this package, in the style of the page."""
    look: Any = {"sizing_mode": "stretch_width", "margin": (4, 8), "stylesheets": [_STYLE]}
    return pn.pane.HTML(markup, **look)


def chart_pane(chart: Chart, figure: Any = None) -> pn.Column:
    """Return the pane of a chart and its caption; `figure` is its Bokeh model, if there is one."""
    figure = figure or model(chart.figure)
    figure.html_attributes = {"role": "img", "aria-label": chart.alt}
    pane = pn.pane.Bokeh(figure, sizing_mode="stretch_width", margin=(4, 8))
    return column(pane, html(Text(chart.caption)), css_classes=["chart"])


def code(text: str) -> pn.pane.HTML:
    """Return the pane of a long text of a terminal, with lines as they are."""
    return html(Code("text", "", text))


# Reads files and prepares cases. One thread: netCDF's library must not be entered by two.
_WORKER = ThreadPoolExecutor(1, thread_name_prefix="gripscale app")


async def in_worker(work: Callable[[], _T]) -> _T:
    """Return the result of `work` from the worker thread; the page stays responsive."""
    return await asyncio.get_running_loop().run_in_executor(_WORKER, work)


BUSY = """\
@keyframes busy { 50% { opacity: 0.35; } }
:host .bk-btn[disabled] { cursor: progress; animation: busy 1s infinite; }
:host .bk-btn[disabled]::after { content: " ..."; }
"""


# Text that is longer than its field ends in dots.
CUT_TEXT = "input, select { text-overflow: ellipsis; }"


def work_button(label: str, work: Callable[[], Awaitable[None]], **look: Any) -> pn.widgets.Button:
    """Return a button that starts `work` and shows until its end that it is under way.

    The browser itself disables it at the click, whatever the server does, and that starts the work:
    no message of the server can come before.
    """
    button = pn.widgets.Button(label=label, margin=(8, 8), stylesheets=[BUSY], **look)
    button.js_on_click(args={"button": button}, code="button.disabled = true")

    async def follow(event: Any) -> None:
        if event.new:
            try:
                await work()
            finally:
                button.disabled = False

    button.param.watch(follow, "disabled")
    return button
