"""Elements of a report as panes of the page, and the thread that computes what they show.

All texts are escaped by the template.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Any, ClassVar, TypeVar

import panel as pn
from jinja2 import Environment, PackageLoader, StrictUndefined

from gripscale.charts.page_elements import Chart
from gripscale.core.errors import GripscaleError
from gripscale.report.elements import Card, Code, Element, Notice, Text, open_and_folded

T = TypeVar("T")


@dataclass(frozen=True)
class Cards:
    """Results at the head of a page."""

    cards: Sequence[Card]
    kind: ClassVar[str] = "cards"


@dataclass(frozen=True)
class Folded:
    """Warnings that open at a click."""

    notices: Sequence[Notice]
    kind: ClassVar[str] = "folded"


AppElement = Element | Cards | Folded
PageElements = Sequence[AppElement]


def notice_elements(notices: Sequence[Notice]) -> Iterator[AppElement]:
    """Yield errors and the first few warnings, then the others folded."""
    opened, folded = open_and_folded(notices)
    yield from opened
    if folded:
        yield Folded(folded)


@cache
def _environment() -> Environment:
    loader = PackageLoader("gripscale.app")
    return Environment(loader=loader, autoescape=True, undefined=StrictUndefined)


@cache
def _style() -> str:
    return files("gripscale.app").joinpath("templates/elements.css").read_text(encoding="utf-8")


def column(*parts: Any, **options: Any) -> pn.Column:
    """Return a column as wide as the page."""
    return pn.Column(*parts, sizing_mode="stretch_width", **options)


def panes(elements: Iterable[AppElement]) -> list[pn.viewable.Viewable]:
    """Return the panes that show `elements`, in order."""
    return [chart_pane(e) if isinstance(e, Chart) else html(e) for e in elements]


def html(element: AppElement) -> pn.pane.HTML:
    """Return the pane of a text, a notice, a table, facts, code or cards."""
    return raw(_environment().get_template("elements.html").render(e=element))


def raw(markup: str, **options: Any) -> pn.pane.HTML:
    """Return the pane of markup written in this package, in the style of the page."""
    look = {"sizing_mode": "stretch_width", "margin": (4, 8), "stylesheets": [_style()]}
    return pn.pane.HTML(markup, **(look | options))


def chart_pane(chart: Chart) -> pn.Column:
    """Return the pane of a chart and its caption."""
    chart.model.html_attributes = {"role": "img", "aria-label": chart.alt}
    figure = pn.pane.Bokeh(chart.model, sizing_mode="stretch_width", margin=(4, 8))
    return column(figure, html(Text(chart.caption)), css_classes=["chart"])


def error_notice(sentence: str) -> pn.pane.HTML:
    """Return the pane of an error."""
    return html(Notice("error", sentence))


@contextmanager
def refusals_in(
    pane: pn.Column, words: Callable[[object], str] = str, above: Sequence[Any] = ()
) -> Iterator[None]:
    """Show what gripscale refuses in `pane`, below what stays `above` it.

    `words` makes a sentence of the error, such as `Visit.short`.
    """
    try:
        yield
    except GripscaleError as refusal:
        pane.objects = [*above, error_notice(words(refusal))]


def code(caption: str, text: str) -> pn.pane.HTML:
    """Return the pane of a long text that opens at a click."""
    return html(Code("text", caption, text))


_WORKER = ThreadPoolExecutor(1, thread_name_prefix="gripscale app")
"""Reads files and prepares cases. One thread: netCDF's library must not be entered by two."""


async def in_worker(work: Callable[[], T]) -> T:
    """Return the result of `work` from the worker thread; the page stays responsive."""
    return await asyncio.get_running_loop().run_in_executor(_WORKER, work)


def wait_for_worker(work: Callable[[], T]) -> T:
    """Return the result of `work` from the worker thread; the page waits for it."""
    return _WORKER.submit(work).result()
