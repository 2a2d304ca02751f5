"""Elements of a report as parts of the page; all texts are escaped by the template."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any, ClassVar, TypeVar

import panel as pn
from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from gripscale.charts.page_elements import Card, Chart, Code, Element, Notice, Text


@dataclass(frozen=True)
class Cards:
    """Results at the head of a page."""

    cards: Sequence[Card]
    kind: ClassVar[str] = "cards"


def panes(elements: Iterable[Element | Cards]) -> list[pn.viewable.Viewable]:
    """Return what shows `elements`, in order."""
    return [_chart(e) if isinstance(e, Chart) else html(e) for e in elements]


def html(element: Any) -> pn.pane.HTML:
    """Return a text, a table, facts or cards."""
    return raw(_template().render(e=element))


def raw(markup: str, **options: Any) -> pn.pane.HTML:
    """Return markup of this package in the look of the page."""
    look = {"sizing_mode": "stretch_width", "margin": (4, 8), "stylesheets": [_style()]}
    return pn.pane.HTML(markup, **(look | options))


def error(sentence: str) -> pn.pane.HTML:
    """Return what went wrong, in its sentence."""
    return html(Notice("error", sentence))


def _chart(chart: Chart) -> pn.Column:
    chart.model.html_attributes = {"role": "img", "aria-label": chart.alt}
    figure = pn.pane.Bokeh(chart.model, sizing_mode="stretch_width", margin=(4, 8))
    return pn.Column(
        figure, html(Text(chart.caption)), sizing_mode="stretch_width", css_classes=["chart"]
    )


def code(caption: str, text: str) -> pn.pane.HTML:
    """Return a long text that opens at a click."""
    return html(Code("text", caption, text))


@lru_cache(maxsize=1)
def _template() -> Template:
    environment = Environment(
        loader=PackageLoader("gripscale.app"), autoescape=True, undefined=StrictUndefined
    )
    return environment.get_template("elements.html")


@lru_cache(maxsize=1)
def _style() -> str:
    return files("gripscale.app").joinpath("templates/elements.css").read_text(encoding="utf-8")


# The one thread that reads files and prepares cases beside the page.
#
# One, because the library under netCDF must not be entered by two threads.

T = TypeVar("T")

_ONE = ThreadPoolExecutor(1, thread_name_prefix="beside the page")


async def beside(work: Callable[[], T]) -> T:
    """Return what `work` returns; the page stays alive meanwhile."""
    return await asyncio.get_running_loop().run_in_executor(_ONE, work)


def in_turn(work: Callable[[], T]) -> T:
    """Return what `work` returns, once the thread has come to it; the page waits."""
    return _ONE.submit(work).result()
