"""Tables side by side: a block of moduli for each temperature in the columns of one sheet.

    f [Hz] | -20 °C |     | 0 °C |          f [Hz] | E' -20 °C | E'' -20 °C | E' 0 °C | ...
           | E'     | E'' | E'   | E''

Blocks are told apart by a mark in the lines above the rows: a temperature or, of ramps, a frequency
such as E' (10 Hz). A mark stands over each of its columns, or once over its block. A line of plain
numbers is one of temperatures. Each block becomes a table of its own, below a line with its mark.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

from gripscale.io.cells import Line, cells_of, is_comment, is_number, is_row, is_row_of
from gripscale.rubber.columns import MODULI, quantity

_MARK = re.compile(
    r"[\s_,@]*(?:\b(?:at|bei)\b)?\s*[(\[]?\s*(?:\b[Tf]\s*=)?\s*(?P<number>[-+]?\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>(?:°|deg\.?)?\s?[CF]|K|[kM]?Hz)\s*"
    r"(?:[)\]](?![A-Za-z])|(?![A-Za-z/]))"
)
_UNIT = re.compile(r"[\[(/]\s*(°?[CFK])\b")
# Separators of cells that may be empty, as those of a line with one mark for each block are.
_SEPARATORS = ("\t", ";", ",")
_MOST_TITLES = 4  # lines above the rows that may hold titles, units and marks
_FEWEST_COLUMNS = 4  # two blocks of two moduli


@dataclass(frozen=True)
class _Column:
    """What the lines above the rows say of a column."""

    name: str  # its title without its mark
    others: list[str]  # the cells above it without title and mark, such as its unit; a line each
    mark: str  # a line that states the temperature or the frequency, or empty

    @classmethod
    def of(cls, titles: list[list[str]], at: int) -> _Column:
        """Return what lines of cells above the rows say of the column `at`."""
        mark, texts = "", []
        for cells in titles:
            plain = all(not cell or is_number(cell) for cell in cells[1:])
            match, text = _MARK.search(cells[at]), cells[at]
            if plain and is_number(text):
                unit = _UNIT.search(cells[0])
                mark, text = f"T = {text} {unit[1] if unit else ''}".strip(), ""
            elif plain and any(cells[1:]):
                text = text if quantity(text) == "frequency" else ""
            elif match is not None:
                kind = "Frequency" if match["unit"].endswith("Hz") else "T"
                mark = f"{kind} = {match['number']} {match['unit'].strip()}"
                text = _MARK.sub("", text, count=1).strip()
            texts.append(text)
        name = next((text for text in texts if quantity(text) is not None), "")
        return cls(name, ["" if text == name else text for text in texts], mark)


def split_blocks(lines: list[Line]) -> list[list[Line]]:
    """Return the lines of each block of tables side by side; the `lines` of any other file."""
    start = _first_row(lines)
    if start is None:
        return [lines]
    first, separator = start
    count = len(cells_of(lines[first][1], separator))
    above = [(number, text.lstrip("#%! ")) for number, text in lines[:first][-_MOST_TITLES:]]
    below = [(number, text) for number, text in lines[first:] if not is_comment(text)]
    table = [
        (number, [*cells_of(text, separator), *[""] * count][:count])
        for number, text in [*above, *below]
        if separator in text
    ]
    titles = [row for row in table if row[0] < lines[first][0]]
    columns = [_Column.of([cells for _, cells in titles], at) for at in range(count)]
    for at in range(1, count):  # one title over the columns of all temperatures
        column, before = columns[at], columns[at - 1]
        if not column.name and column.mark and quantity(before.name) in MODULI:
            columns[at] = _Column(before.name, column.others, column.mark)
    parts = []
    for mark, chosen in _blocks(columns).items():
        names = separator.join(columns[at].name for at in chosen)
        part = [(titles[0][0], mark), (titles[-1][0], names)]
        for level, (number, _) in enumerate(titles):
            part.append((number, separator.join(columns[at].others[level] for at in chosen)))
        for number, cells in table[len(titles) :]:
            part.append((number, separator.join(cells[at] for at in chosen)))
        parts.append(part)
    return parts or [lines]


def _first_row(lines: list[Line]) -> tuple[int, str] | None:
    """Return the index of the first row of numbers, and its separator; None where there is none.

    A line of numbers above titles, or without its first cell, is one of temperatures.
    """
    for at, (_, text) in enumerate(lines):
        for separator in _SEPARATORS:
            cells = cells_of(text, separator)
            enough = len(cells) >= _FEWEST_COLUMNS and bool(cells[0]) and is_row_of(cells)
            if enough and (at + 1 == len(lines) or is_row(lines[at + 1][1])):
                return at, separator
    return None


def _blocks(columns: list[_Column]) -> dict[str, list[int]]:
    """Return the columns of each mark; none unless moduli come again, each with its mark."""
    quantities = [quantity(column.name) for column in columns]
    counts = Counter(quantities)
    marks = [column.mark for column in columns if column.mark]
    repeated = [counts[name] for name in MODULI if counts[name]]
    if len(set(marks)) < 2 or max(repeated, default=0) < 2:
        return {}
    once = set(repeated) == {len(marks)}  # each mark stands once, somewhere over its block
    blocks: dict[str, list[int]] = {mark: [] for mark in marks}
    seen: Counter[str | None] = Counter()
    current = marks[0]
    for at, name in enumerate(quantities):
        current = columns[at].mark or current
        if name in MODULI:
            blocks[marks[seen[name]] if once else current].append(at)
        seen[name] += 1
    for of_rows in ("frequency", "temperature"):
        positions = [at for at, name in enumerate(quantities) if name == of_rows]
        for number, chosen in enumerate(blocks.values()):
            if positions:
                chosen.insert(0, positions[number if len(positions) == len(blocks) else 0])
    return blocks
