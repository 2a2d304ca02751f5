"""Tables side by side: a block of moduli for each temperature in the columns of one sheet.

    f [Hz] | -20 °C |     | 0 °C |          f [Hz] | E' -20 °C | E'' -20 °C | E' 0 °C | ...
           | E'     | E'' | E'   | E''

Blocks are told apart by a mark in the lines above the rows: a temperature or, of ramps, a frequency
such as E' (10 Hz). A mark stands over each of its columns, or once over its block. A line of plain
numbers is one of temperatures. Each block becomes a table of its own, below a line that states its
mark.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

from gripscale.core.errors import FileError
from gripscale.io.cells import (
    MISSING,
    Line,
    cells_of,
    is_comment,
    is_number,
    is_row,
    is_row_of,
)
from gripscale.rubber.columns import MODULI, quantity

_MARK = re.compile(
    r"[\s_,@]*(?:\b(?:at|bei)\b)?\s*[(\[]?\s*(?:\b[Tf]\s*=)?\s*(?P<number>[-+]?\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>(?:°|deg\.?)?\s?[CF]|K|[kM]?Hz)\s*[)\]]?(?![A-Za-z/])"
)
_SEPARATORS = ("\t", ";", ",")
"""Separators of cells that may be empty, as those of a line with one mark for each block are."""
_MOST_TITLES = 4
"""Lines above the rows that may hold titles, units and marks."""
_FEWEST_COLUMNS = 4
"""Two blocks of two moduli."""
_OF_ROWS = ("frequency", "temperature", "strain")


@dataclass(frozen=True)
class _Column:
    """What the lines above the rows say of a column."""

    name: str
    """Its title without its mark."""
    others: list[str]
    """The cells above it without title and mark, such as its unit; a line each."""
    mark: str
    """A line that states the temperature or the frequency, or empty."""

    @property
    def quantity(self) -> str | None:
        """What it holds."""
        return quantity(self.name)


def split_blocks(path: Path, lines: list[Line]) -> list[list[Line]]:
    """Return the lines of each block of tables side by side; the `lines` of any other file.

    Raises `FileError` for a row with more or fewer cells than the first.
    """
    start = _first_row(lines)
    if start is None:
        return [lines]
    first, separator = start
    count = len(cells_of(lines[first][1], separator))
    above: list[Line] = []
    for line in reversed(lines[max(0, first - _MOST_TITLES) : first]):
        if not 2 <= len(cells_of(line[1], separator)) <= count:
            break
        above.insert(0, line)
    columns = _columns([cells_of(text, separator) for _, text in above], count)
    blocks = _blocks(columns)
    if len(blocks) < 2:
        return [lines]
    rows = []
    for number, text in lines[first:]:
        cells = cells_of(text, separator)
        if len(cells) == count:
            rows.append((number, cells))
        elif not is_comment(text) and is_number(cells[0]):
            raise FileError(
                f"{path}, line {number}: expected {count} columns as in line {lines[first][0]}; "
                f"got {len(cells)}"
            )
    sign = separator or " "
    parts = []
    for mark, chosen in blocks.items():
        part = [(above[0][0], mark), (above[-1][0], sign.join(columns[at].name for at in chosen))]
        part += [
            (number, sign.join(columns[at].others[level] for at in chosen))
            for level, (number, _) in enumerate(above)
        ]
        measured = [at for at in chosen if columns[at].quantity in MODULI]
        for number, cells in rows:
            if any(cells[at].lower() not in MISSING for at in measured):
                part.append((number, sign.join(cells[at] for at in chosen)))
        parts.append(part)
    return parts


def _first_row(lines: list[Line]) -> tuple[int, str] | None:
    """Return the index of the first row of numbers, and its separator; None where there is none.

    A line of numbers above titles, or without its first cell, is one of temperatures.
    """
    for at, (_, text) in enumerate(lines):
        for separator in _SEPARATORS:
            cells = cells_of(text, separator)
            if not is_row_of(cells) or is_comment(text):
                continue
            if len(cells) < _FEWEST_COLUMNS:
                return None
            if cells[0] and (at + 1 == len(lines) or is_row(lines[at + 1][1])):
                return at, separator
            break
    return None


def _columns(above: list[list[str]], count: int) -> list[_Column]:
    """Return what the lines of cells above the rows say of each of `count` columns."""
    grid = [[*cells, *[""] * (count - len(cells))] for cells in above]
    plain = [
        sum(map(is_number, cells)) > 1 and all(not c or is_number(c) for c in cells[1:])
        for cells in grid
    ]
    columns: list[_Column] = []
    for at in range(count):
        mark, titles = "", []
        for cells, numbers in zip(grid, plain, strict=True):
            match = _MARK.search(cells[at])
            if match is not None and not is_number(cells[at]):
                kind = "Frequency" if match["unit"].endswith("Hz") else "T"
                mark = f"{kind} = {match['number']} {match['unit'].strip()}"
                titles.append(_MARK.sub("", cells[at], count=1).strip())
            elif numbers and is_number(cells[at]):
                unit = re.search(r"[\[(/]\s*(°?[CFK])\b", cells[0])
                mark = f"T = {cells[at]} {unit[1] if unit else ''}".strip()
                titles.append("")
            else:
                titles.append("" if numbers and at else cells[at])
        name = next((title for title in titles if quantity(title) is not None), "")
        if not name and mark and columns and columns[-1].quantity in MODULI:
            name = columns[-1].name  # one title over the columns of all temperatures
        others = ["" if title == name else title for title in titles]
        columns.append(_Column(name, others, mark))
    return columns


def _blocks(columns: list[_Column]) -> dict[str, list[int]]:
    """Return the columns of each mark; none unless moduli come again, each with its mark."""
    moduli = [at for at, column in enumerate(columns) if column.quantity in MODULI]
    counts = Counter(columns[at].quantity for at in moduli)
    marks = [column.mark for column in columns if column.mark]
    if not marks or len(set(marks)) < 2 or max(counts.values(), default=0) < 2:
        return {}
    blocks: dict[str, list[int]] = {mark: [] for mark in marks}
    once = set(counts.values()) == {len(marks)}
    """Whether each mark stands once, somewhere over its block."""
    seen: Counter[str | None] = Counter()
    current = ""
    for at, column in enumerate(columns):
        current = column.mark or current
        order = seen[column.quantity]
        seen[column.quantity] += 1
        if column.quantity in MODULI:
            mark = column.mark if not once else marks[order]
            if not (mark or current):
                return {}
            blocks[mark or current].append(at)
    of_rows = {name: [a for a, c in enumerate(columns) if c.quantity == name] for name in _OF_ROWS}
    for number, chosen in enumerate(blocks.values()):
        for positions in of_rows.values():
            if len(positions) == len(blocks):
                chosen.insert(0, positions[number])
            elif positions:
                chosen.insert(0, positions[0])
    return blocks
