"""The elements a page is made of; `page.html` has one macro for each, chosen by `kind`.

All texts are plain: escaping is the template's task. A `gripscale.io.table.Table` renders itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import ClassVar

from gripscale.charts.page_elements import Chart, Image
from gripscale.io import table
from gripscale.io.table import Column, Table, on_page, significant


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str
    kind: ClassVar[str] = "text"


@dataclass(frozen=True)
class Notice:
    """Something the reader must not miss; `level` is "error" or "warning"."""

    level: str
    text: str
    kind: ClassVar[str] = "notice"


@dataclass(frozen=True)
class Facts:
    """Pairs of a name and its value, under a caption."""

    caption: str
    pairs: list[tuple[str, str]]
    kind: ClassVar[str] = "facts"


@dataclass(frozen=True)
class Equation:
    """An equation: its LaTeX, and an SVG picture of it, base64, with its size [px]."""

    name: str
    latex: str
    data: str
    width: int
    height: int
    words: str
    source: str
    kind: ClassVar[str] = "equation"


@dataclass(frozen=True)
class Code:
    """Text to be copied."""

    name: str
    caption: str
    text: str
    kind: ClassVar[str] = "code"


Element = Text | Notice | Facts | Table | Chart | Image | Equation | Code


@dataclass(frozen=True)
class Section:
    """A chapter of the page."""

    name: str
    title: str
    elements: Sequence[Element]
    folded: bool = False
    """Whether the reader has to open it."""


@dataclass(frozen=True)
class Card:
    """One result at the head of the page."""

    label: str
    value: str
    detail: str
    bad: bool = False


MOST_OPEN = 3
"""Notices that a page opens with; further warnings are folded."""


@dataclass(frozen=True)
class Page:
    """A whole report."""

    title: str
    subtitle: str
    notices: Sequence[Notice]
    cards: Sequence[Card]
    sections: Sequence[Section] = field(default_factory=tuple)
    basis: Sequence[str] = ()
    """What the numbers of the cards are for, and what they rest on."""

    @property
    def notices_open(self) -> list[Notice]:
        """Errors, and the first few warnings."""
        errors = [notice for notice in self.notices if notice.level == "error"]
        warnings = [notice for notice in self.notices if notice.level != "error"]
        return errors + warnings[: max(0, MOST_OPEN - len(errors))]

    @property
    def notices_folded(self) -> list[Notice]:
        """The others."""
        return [notice for notice in self.notices if notice not in self.notices_open]

    @property
    def charts(self) -> list[Chart]:
        """All interactive figures, in order."""
        return [e for section in self.sections for e in section.elements if isinstance(e, Chart)]


def number(value: object, size: float = 1.0, format: Callable[[float], str] = significant) -> str:
    """Return `value` / `size` as a page shows it, a dash where it is missing."""
    return on_page(Column("", [value], size=size, format=format).texts()[0])


def percent(value: object) -> str:
    """Return a ratio in per cent as a page shows it."""
    return number(value, format=table.percent)
