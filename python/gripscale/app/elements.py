"""Parts of the page: texts, figures, pages of results in frames, buttons, and the worker thread.

All texts are escaped by the template.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, TypeVar

import panel as pn

from gripscale.app.case import VisitFolder
from gripscale.report.build import template_text, templates
from gripscale.report.elements import Code, Element

_T = TypeVar("_T")


REPORTS = "reports"  # where the server gives pages of results and previews, by visit


def column(*parts: Any, **options: Any) -> pn.Column:
    """Return a column as wide as the page."""
    return pn.Column(*parts, sizing_mode="stretch_width", **options)


def folded_card(title: str, *parts: Any, **options: Any) -> pn.Card:
    """Return a card that opens at a click."""
    look: dict[str, Any] = {"sizing_mode": "stretch_width", "margin": (6, 8)}
    return pn.Card(*parts, title=title, collapsed=True, **look, **options)


_STYLE = template_text("gripscale.app", "elements.css")


def html(element: Element) -> pn.pane.HTML:
    """Return the pane of a text, a notice, a table or code."""
    return raw(templates("gripscale.app").get_template("elements.html").render(e=element))


def raw(markup: str) -> pn.pane.HTML:
    """Return the pane of markup written in this package, in the style of the page."""
    look: Any = {"sizing_mode": "stretch_width", "margin": (4, 8), "stylesheets": [_STYLE]}
    return pn.pane.HTML(markup, **look)


def page_frame(visit: VisitFolder, page: Path, title: str, kind: str = "") -> pn.pane.HTML:
    """Return a page of a visit in a frame, as a document of its own, with a link to it alone."""
    written = page.stat().st_mtime_ns  # a page that was written anew is read anew
    address = f"{REPORTS}/{page.relative_to(visit.path.parent).as_posix()}?{written}"
    return raw(
        f'<p><a href="{address}" target="_blank">Open this page alone</a></p>'
        f'<iframe class="report {kind}" title="{title}" src="{address}"></iframe>'
    )


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
