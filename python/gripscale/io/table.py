"""One table for every result: described once, rendered to the terminal and HTML.

A column holds its numbers in SI units together with the unit and the digits they are read in. The
renderers differ in typography only: a missing number is "-" in the terminal, "–" on a page.
"""

from __future__ import annotations

import html
import io
import itertools
import math
import re
import textwrap
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from gripscale.core import Described

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions
    from rich.text import Text

Flags = Sequence[bool] | NDArray[np.bool_]
NONE = "–"  # a missing number on a page
LEAST_WORDS = 22  # characters a column of words is wrapped to before a table is divided
# Characters beyond which the heading of numbers, or of words, is wrapped in the terminal.
WIDEST_HEAD, WIDEST_WORDS = 14, 30
LONGEST_HEAD = 40  # characters up to which a narrow page may break a heading between any two words
_NARROW = 4  # columns of a table that fits beside a figure


def significant(value: float, digits: int = 3) -> str:
    """Return `value` with so many significant digits, without an exponent where it stays short."""
    if not math.isfinite(value):
        return "-" if math.isnan(value) else "inf"
    if value == 0.0 or 1e-4 <= abs(value) < 1e6:
        decimals = max(digits - 1 - math.floor(math.log10(abs(value))), 0) if value else 0
        return f"{value:.{decimals}f}"
    return f"{value:.{digits - 1}e}"


def least_to_most(values: Any, text: Callable[[float], str] = significant) -> str:
    """Return the ends of finite `values` in words, or one of them if both read the same."""
    low, high = text(float(np.nanmin(values))), text(float(np.nanmax(values)))
    return low if low == high else f"{low} to {high}"


def digits(count: int) -> Callable[[float], str]:
    """Return the format of `count` significant digits."""
    return lambda value: significant(value, count)


def fixed(decimals: int, sign: str = "") -> Callable[[float], str]:
    """Return the format of so many decimals; with `sign` "+", positive numbers have theirs too."""
    return lambda value: f"{value:{sign}z.{decimals}f}"


def percent(value: float) -> str:
    """Return a ratio in per cent, two significant digits."""
    return f"{significant(100.0 * value, 2)} %"


def change(value: float) -> str:
    """Return a relative change in per cent, with its sign."""
    return f"{100.0 * value:+z.1f} %"


def whole_number(value: float) -> str:
    """Return a count, with thin spaces between thousands."""
    return f"{round(value):,}".replace(",", "\u202f")


def on_page(text: str) -> str:
    """Return the text of a number with the minus signs of a page, `NONE` where it is missing."""
    return NONE if text in ("-", "") else text.replace("-", "−")


@dataclass(frozen=True, repr=False)
class Column(Described):
    """One column of a table."""

    name: str
    """Its name, good for a program."""
    values: Any = ()
    """Numbers in SI units or texts, one a row; NaN or None where missing. Of shape (rows, 2) the
    two ends of a range."""
    heading: str | None = None
    """Printed above it; `name` without a heading."""
    unit: str = ""
    size: float = 1.0
    """Of the unit, in SI units."""
    zero: float = 0.0
    """Where the unit begins to count, in SI units."""
    format: Callable[[float], str] = significant
    """Text of a number in this unit."""
    group: str = ""
    """Printed above the headings of neighbouring columns of the same group; a table that is too
    wide for the terminal is divided between groups."""
    marks: Sequence[str] = ()
    """Text behind the number of each row, such as "*"."""
    bad: Flags = ()
    """Flags of rows whose number must not be trusted."""
    words: bool | None = None
    """Whether it is set as text: to the left, wrapped; by default if it holds texts."""
    joint: str = " to "

    def of(self, values: Any, **changes: Any) -> Column:
        """Return this column with `values`, and further fields changed."""
        return replace(self, values=values, **changes)

    @property
    def head(self) -> str:
        """Its heading, or its name."""
        return self.name if self.heading is None else self.heading

    @property
    def as_words(self) -> bool:
        """Whether it is set as text."""
        if self.words is not None:
            return self.words
        return any(isinstance(value, str) and value for value in self.values)

    def texts(self) -> list[str]:
        """Return the text of each row, "-" where it is missing."""
        return [self._text(value) for value in self.values]

    def _text(self, value: Any) -> str:
        if value is None or isinstance(value, str):
            return value or "-"
        if np.ndim(value):
            ends = [self._text(end) for end in value]
            return "-" if "-" in ends else self.joint.join(ends)
        number = float(value)
        if math.isnan(number):
            return "-"
        if math.isinf(number):
            return "∞" if number > 0.0 else "-∞"
        return self.format((number - self.zero) / self.size)

    def mark(self, row: int) -> str:
        """Return the text behind the number of a row."""
        return self.marks[row] if len(self.marks) else ""


@dataclass(frozen=True, repr=False)
class Table(Described):
    """A table whose first column names its rows."""

    name: str
    """Good for a file, a sheet or an anchor."""
    columns: Sequence[Column]
    caption: str = ""
    notes: Sequence[str] = ()
    keys: int = 1
    """Leading columns that every part of a table divided for the terminal begins with."""
    bad: Flags = ()
    strong: Collection[int] = ()
    kind: ClassVar[str] = "table"

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0

    def is_bad(self, column: Column, row: int) -> bool:
        """Return whether a cell must not be trusted."""
        return any(bool(flags[row]) for flags in (self.bad, column.bad) if len(flags))

    # Terminal.

    def __str__(self) -> str:
        return as_text(self)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Text]:
        from rich.text import Text

        if self.caption:
            yield Text(self.caption, style="bold")
        for number, columns in enumerate(self._parts(options.max_width)):
            yield from (Text("") for _ in range(bool(number)))
            for pieces in self._lines(columns, options.max_width):
                yield Text.assemble(*pieces)
        if self.columns and self.notes:
            yield Text("")
        yield from map(Text, self.notes)

    def _parts(self, width: int) -> Iterator[Sequence[Column]]:
        """Yield all columns, or where they are too wide as many as fit behind the keys.

        Columns of a group stay together.
        """
        if not self.columns or _width(self.columns, 1) <= width:
            yield from [self.columns] if self.columns else []
            return
        keys, part = list(self.columns[: self.keys]), list[Column]()
        rest = self.columns[self.keys :]
        for _, group in itertools.groupby(rest, key=lambda column: column.group or id(column)):
            columns = list(group)
            if part and _width([*keys, *part, *columns], 1) > width:
                yield [*keys, *part]
                part = []
            part += columns
        yield [*keys, *part]

    def _lines(self, columns: Sequence[Column], width: int) -> Iterator[tuple[Any, ...]]:
        gap = " " * (2 if _width(columns, 2) <= width else 1)
        widths = _widths(columns)
        # words take what the numbers leave, each column in proportion to what it lacks
        lacking = [
            max(map(len, [*_heading(column), *_marked(column)])) - wide
            for column, wide in zip(columns, widths, strict=True)
        ]
        free = max(width - sum(widths) - len(gap) * (len(columns) - 1), 0)
        share = min(free / max(sum(lacking), 1), 1.0)
        widths = [wide + int(share * lack) for wide, lack in zip(widths, lacking, strict=True)]
        if len({column.group for column in self.columns} - {""}) > 1:
            above = []
            pairs = zip(columns, widths, strict=True)
            for group, members in itertools.groupby(pairs, lambda pair: pair[0].group):
                spanned = [wide for _, wide in members]
                span = sum(spanned) + len(gap) * (len(spanned) - 1)
                above.append(
                    (group if len(group) <= span else group[: span - 1] + "…").center(span)
                )
            yield (gap.join(above).rstrip(),)
        heads = [_heading(column) for column in columns]
        deepest = max(map(len, heads))
        for line in range(deepest, 0, -1):
            titles = [head[-line] if line <= len(head) else "" for head in heads]
            yield (gap.join(map(_placed, titles, columns, widths)).rstrip(),)
        yield ("─" * (sum(widths) + len(gap) * (len(widths) - 1)),)
        cells = zip(*map(_marked, columns), strict=True)
        for row, texts in enumerate(cells):
            folded = [
                textwrap.wrap(text, wide) or [""] if column.as_words else [text]
                for text, column, wide in zip(texts, columns, widths, strict=True)
            ]
            strong = "bold" if row in self.strong else ""
            styles = ["bold red" if self.is_bad(column, row) else strong for column in columns]
            for lines in itertools.zip_longest(*folded, fillvalue=""):
                pieces = zip(map(_placed, lines, columns, widths), styles, strict=True)
                yield tuple(part for piece in pieces for part in (piece, gap))[:-1]

    # Page.

    @property
    def narrow(self) -> bool:
        """Whether it fits beside a figure."""
        return len(self.columns) <= _NARROW and not any(column.as_words for column in self.columns)

    def __html__(self) -> str:
        caption = html.escape(self.caption)
        groups = [(g, len(list(c))) for g, c in itertools.groupby(c.group for c in self.columns)]
        above = "".join(
            f'<th scope="colgroup" colspan="{count}">{html.escape(group)}</th>'
            if group
            else f'<td colspan="{count}"></td>'
            for group, count in groups
        )
        words = ["words" if column.as_words else "" for column in self.columns]
        heads = "".join(
            f'<th scope="col" class="{kind}">{html.escape(_bound(column.head))}'
            + (f'<span class="unit">{html.escape(column.unit)}</span>' if column.unit else "")
            + "</th>"
            for column, kind in zip(self.columns, words, strict=True)
        )
        texts = [column.texts() for column in self.columns]
        body = []
        for row, of_row in enumerate(zip(*texts, strict=True)):
            cells = []
            for at, (column, kind, text) in enumerate(
                zip(self.columns, words, of_row, strict=True)
            ):
                tag = "td" if at else 'th scope="row"'
                cell = (NONE if text == "-" else text) if kind else on_page(text)
                cells.append(
                    f'<{tag} class="{kind}{" bad" if self.is_bad(column, row) else ""}">'
                    f"{html.escape(cell + column.mark(row))}</{tag[:2]}>"
                )
            strong = ' class="strong"' if row in self.strong else ""
            body.append(f"<tr{strong}>{''.join(cells)}</tr>")
        notes = "".join(f'<p class="note">{code_marked(note)}</p>' for note in self.notes)
        return (
            f'<div class="scroll{" narrow" if self.narrow else ""}" tabindex="0" role="region" '
            f'aria-label="{caption}">\n'
            f'<table class="data" id="table-{html.escape(self.name)}">\n'
            f"<caption>{caption}</caption>\n<thead>\n"
            + (f'<tr class="groups">{above}</tr>\n' if any(group for group, _ in groups) else "")
            + f"<tr>{heads}</tr>\n</thead>\n<tbody>\n"
            + "\n".join(body)
            + f"\n</tbody>\n</table>\n{notes}</div>\n"
        )


def code_marked(text: str) -> str:
    """Return a text as HTML; what stands between backticks, such as a command, is code."""
    return re.sub("`([^`]+)`", r"<code>\1</code>", html.escape(text))


def _bound(head: str) -> str:
    """Return a heading, the words of a long one bound to some four lines, broken between them."""
    if len(head) <= LONGEST_HEAD:
        return head
    lines = textwrap.wrap(head, max(len(head) // 4, 1), break_long_words=False)
    return " ".join(line.replace(" ", "\N{NO-BREAK SPACE}") for line in lines)


def _heading(column: Column) -> list[str]:
    widest = WIDEST_WORDS if column.as_words else WIDEST_HEAD
    lines = textwrap.wrap(column.head, widest) or [""]
    return [*lines, *([column.unit] if column.unit else [])]


def _marked(column: Column) -> list[str]:
    """Return the texts of a column with their marks, digits below digits."""
    widest = max(map(len, column.marks), default=0)
    return [f"{text}{column.mark(i):<{widest}}" for i, text in enumerate(column.texts())]


def _widths(columns: Sequence[Column]) -> list[int]:
    """Return the least characters of each column; words are wrapped where they are long."""
    widths = []
    for column in columns:
        head, body = (max(map(len, texts)) for texts in (_heading(column), ["", *_marked(column)]))
        widths.append(max(head, min(body, LEAST_WORDS) if column.as_words else body))
    return widths


def _width(columns: Sequence[Column], gap: int) -> int:
    """Return the least characters of a line with `gap` spaces between columns."""
    return sum(_widths(columns)) + gap * (len(columns) - 1)


def _placed(text: str, column: Column, width: int) -> str:
    return text.ljust(width) if column.as_words else text.rjust(width)


def spaced(parts: Iterable[str | Table]) -> Iterator[str | Table]:
    """Yield sentences and tables with an empty line between a table and its neighbours."""
    before: str | Table = ""
    for part in parts:
        if "" not in (part, before) and not (isinstance(part, str) and isinstance(before, str)):
            yield ""
        yield part
        before = part


def wrapped(text: str, width: int) -> str:
    """Return a line, continued with its own indent; words, paths and numbers with % stay whole."""
    indent = " " * (len(text) - len(text.lstrip()))
    lines = textwrap.wrap(
        text.replace(" %", "\N{NO-BREAK SPACE}%"),
        width,
        subsequent_indent=f"{indent}  ",
        break_long_words=False,
        break_on_hyphens=False,
        replace_whitespace=False,
    )
    return "\n".join(lines).replace("\N{NO-BREAK SPACE}%", " %")


def as_text(*parts: str | Table, width: int = 100) -> str:
    """Return tables and sentences as plain text, as written to the results folder."""
    from rich.console import Console

    paper = Console(
        file=io.StringIO(), width=width, color_system=None, highlight=False, markup=False
    )
    with paper.capture() as captured:
        for part in spaced(parts):
            paper.print(wrapped(part, width) if isinstance(part, str) else part)
    return "".join(f"{line.rstrip()}\n" for line in captured.get().splitlines())
