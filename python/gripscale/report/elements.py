"""The elements a page is made of; `page.html` has one macro for each, chosen by `kind`.

All texts are plain: escaping is the template's task.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar


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
class Heading:
    """Head of a column: what it holds, and its unit; `words` if it holds texts, not numbers."""

    text: str
    unit: str = ""
    words: bool = False


@dataclass(frozen=True)
class Table:
    """A table whose first column names its rows.

    `groups` are (label, number of columns) of a row above the headings, or empty.
    `bad` are the cells that must not be trusted, as (row, column).
    """

    name: str
    caption: str
    headings: Sequence[Heading]
    rows: Sequence[Sequence[str]]
    groups: Sequence[tuple[str, int]] = ()
    bad: frozenset[tuple[int, int]] = frozenset()
    note: str = ""
    kind: ClassVar[str] = "table"

    @property
    def narrow(self) -> bool:
        """Whether it fits beside a figure."""
        return len(self.headings) <= 4 and not any(heading.words for heading in self.headings)


@dataclass(frozen=True)
class Chart:
    """An interactive figure: a Bokeh model, its caption and a text for who cannot see it."""

    name: str
    caption: str
    alt: str
    model: Any
    wide: bool = False
    kind: ClassVar[str] = "chart"


@dataclass(frozen=True)
class Image:
    """A picture inside the page, base64."""

    name: str
    caption: str
    alt: str
    data: str
    media_type: str
    width: int
    height: int
    kind: ClassVar[str] = "image"


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


@dataclass(frozen=True)
class Card:
    """One result at the head of the page."""

    label: str
    value: str
    detail: str
    bad: bool = False


@dataclass(frozen=True)
class Page:
    """A whole report."""

    title: str
    subtitle: str
    notices: Sequence[Notice]
    cards: Sequence[Card]
    sections: Sequence[Section] = field(default_factory=tuple)

    @property
    def charts(self) -> list[Chart]:
        """All interactive figures, in order."""
        return [e for section in self.sections for e in section.elements if isinstance(e, Chart)]
