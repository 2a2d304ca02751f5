"""The elements a page is made of; `page.html` has one macro for each, chosen by `kind`.

All texts are plain: escaping is the template's task. A `gripscale.io.table.Table` renders itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import Any, ClassVar

from gripscale.charts.draw import Chart, Image
from gripscale.core.finding import Finding, Severity, ranked
from gripscale.core.provenance import CASE_TITLE, versions
from gripscale.io import table
from gripscale.io.table import Column, Table, on_page, significant


def with_code(text: str) -> str:
    """Return a text as `table.with_code` does, marked as HTML for a template."""
    from markupsafe import Markup  # of Jinja2, which only pages need

    return Markup(table.code_marked(text))


@dataclass(frozen=True)
class Text:
    """A paragraph."""

    text: str
    kind: ClassVar[str] = "text"


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


Element = Text | Finding | Facts | Table | Chart | Image | Equation | Code


def as_elements(parts: Iterable[str | Table]) -> list[Element]:
    """Return sentences as paragraphs, tables as they are."""
    return [Text(part) if isinstance(part, str) else part for part in parts]


_OPEN_FIGURES = 2


@dataclass(frozen=True)
class Section:
    """A chapter of the page."""

    name: str
    title: str
    elements: Sequence[Element]

    @property
    def figures(self) -> list[int]:
        """Places of its figures among its elements."""
        return [at for at, e in enumerate(self.elements) if isinstance(e, Chart | Image)]

    @property
    def opening(self) -> Sequence[Element]:
        """The elements before the first figure that a page does not open with."""
        return self.elements[: next(iter(self.figures[_OPEN_FIGURES:]), None)]


@dataclass(frozen=True)
class Card:
    """A result at the head of the page; one with an interval is larger than those without."""

    label: str
    value: str
    detail: str
    bad: bool = False
    interval: str = ""


_MOST_OPEN = 3  # findings that a page or a terminal opens with; further warnings are folded


@dataclass(frozen=True)
class Page:
    """A whole report."""

    title: str
    subtitle: str
    notices: Sequence[Finding]
    cards: Sequence[Card]
    sections: Sequence[Section] = field(default_factory=tuple)
    basis: Sequence[str] = ()  # what the numbers of the cards are for, and what they rest on

    @classmethod
    def of(
        cls,
        title: str,
        subtitle: str,
        findings: Iterable[Finding],
        cards: Iterable[Card],
        sections: Iterable[Section],
        basis: Iterable[str] = (),
    ) -> Page:
        """Return a page of ranked findings, and of the sections that hold something."""
        chapters = [section for section in sections if section.elements]
        return cls(title, subtitle, ranked(findings), list(cards), chapters, tuple(basis))

    @property
    def errors(self) -> list[Finding]:
        """Those that stand above the numbers."""
        return [notice for notice in self.notices if notice.severity == Severity.ERROR]

    @property
    def warnings(self) -> tuple[list[Finding], list[Finding]]:
        """The first few warnings, below the numbers, and the others, which are folded."""
        rest = [notice for notice in self.notices if notice.severity != Severity.ERROR]
        room = max(0, _MOST_OPEN - len(self.errors))
        return rest[:room], rest[room:]

    @property
    def open_chapters(self) -> int:
        """How many chapters are open: up to the first with figures, all others are folded."""
        drawn = (at for at, section in enumerate(self.sections, start=1) if section.figures)
        return next(drawn, 1)

    @property
    def charts(self) -> list[Chart]:
        """All interactive figures, in order."""
        return [e for section in self.sections for e in section.elements if isinstance(e, Chart)]


def number_text(
    value: object, size: float = 1.0, format: Callable[[float], str] = significant
) -> str:
    """Return `value` / `size` as a page shows it, a dash where it is missing."""
    return on_page(Column("", [value], size=size, format=format).texts()[0])


def percent_text(value: object) -> str:
    """Return a ratio in per cent as a page shows it."""
    return number_text(value, format=table.percent)


def case_name(attrs: dict[Any, Any]) -> str:
    """Return the file name of the case of a result; empty where it is not known."""
    return PurePath(str(attrs.get("case_file", ""))).name


def case_title(attrs: dict[Any, Any]) -> str:
    """Return rubber and surface of a result in words, or what its case is called."""
    return str(attrs.get(CASE_TITLE, "")) or case_name(attrs) or "a case"


def rerun_section(attrs: dict[object, object]) -> Section:
    """Return versions, and the command that made the result with its case file."""
    key, names = "prediction_key", sorted(str(n) for n in attrs if str(n).startswith("version_"))
    solved = [(name.removeprefix("version_"), str(attrs[name])) for name in names]
    solved += [("Key of the result", str(attrs[key]))] if key in attrs else []
    here = ", ".join(f"{name} {version}" for name, version in versions().items())
    elements: list[Element] = [Facts("Solved with", [*solved, ("This page written by", here)])]
    if "case" in attrs:
        name = case_name(attrs) or "case.toml"
        elements += [
            Text(
                f"Save the text below as {name}. Paths of files start at its folder. The inputs "
                "list their checksums."
            ),
            *([Code("command", "Command", str(attrs["command"]))] if "command" in attrs else []),
            Code("case", f"Case file {name}", str(attrs["case"])),
        ]
    return Section("again", "Software, and how to run it again", elements)
