"""Lines of measured files as cells: numbers, marks of missing values, words, comments."""

from __future__ import annotations

import csv
import re
from collections import Counter
from contextlib import suppress

# A line with its number in the file, from 1.
Line = tuple[int, str]
# What marks a missing value, in small letters; Excel has words for errors in each language.
MISSING = {
    *("inf", "-inf", "+inf", "infinity", "-infinity", "nodata", "no_data", "missing", "void"),
    *("invalid", "masked", "overflow", "*", "***", "****", "*****", "- -"),
    *("1.#qnan", "-1.#ind", "1.#inf", "-1.#inf", "nan(ind)", "-nan(ind)", "<nodata>"),
    "out of range",
    *("", "nan", "na", "n/a", "n.a.", "n. a.", "n.v.", "n.b.", "k.a.", "k. a.", "null", "none"),
    *("-", "--", "---", "–", "—", "bad", "#nv", "#n/v", "#na", "#n/a"),
    *("#num!", "#zahl!", "#value!", "#wert!", "#div/0!", "#ref!", "#bezug!", "#name?", "#null!"),
}
MISSING_MARKS = "an empty cell, NaN, n/a, - or #NV marks a missing value"
NUMBER = re.compile(r"[+-]?(\d++(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
COMMA_NUMBER = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?", re.ASCII)
# The whole part of a number with parted thousands, before its decimal sign.
_THOUSANDS = re.compile(
    r"(?<![\d.,])(?:\d{1,3}(?:\.\d{3})+(?=,\d+(?![\d.,]))|\d{1,3}(?:,\d{3})+(?=\.\d+(?![\d.,])))"
)
# Separators of the cells of a line, in the order they are tried; None: blanks.
SEPARATORS = ("\t", ";", ",", None)
# How a comment begins.
COMMENT = ("#", "%", "!")
_NO_COMMENT = re.compile(
    rf"({'|'.join(re.escape(word) for word in MISSING if word.startswith('#'))})\s*[\t;, ]", re.I
)
# A comment behind the cells of a row.
_REMARK = re.compile(r"(?<=[\d\s;,])#\s.*")
_MINUS = str.maketrans("\u2212", "-")
# Thousands parted by a blank of a fixed width or, between tabs or semicolons, by any blank.
_THIN = re.compile(r"(?<=\d)[\u00a0\u2009\u202f'’](?=\d{3}(?!\d))")
_BLANK = re.compile(r"(?<![\d.,])([+-]?\d{1,3})((?: \d{3})+)(?=[.,]\d|\s*[\t;\"]|\s*$)")
_NO_DATA = re.compile(r"\bno data\b", re.IGNORECASE)


def parse_number(cell: str) -> float | None:
    """Return the number in a cell, NaN for a missing value, or None if there is neither."""
    if cell.lower() in MISSING:
        return float("nan")
    return float(cell) if NUMBER.fullmatch(cell) else None


def is_row(line: str) -> bool:
    """Return whether a line is a row: at least two cells, numbers or missing, not all missing."""
    return not is_comment(line) and any(
        is_row_of(cells_of(line, separator)) for separator in SEPARATORS
    )


def is_row_of(cells: list[str]) -> bool:
    """Return whether these are the cells of a row."""
    return len(cells) >= 2 and any(map(is_number, cells)) and all(map(fits, cells))


def is_comment(line: str) -> bool:
    """Return whether a line is a comment."""
    text = line.lstrip()
    return text.startswith(COMMENT) and not _NO_COMMENT.match(text)


def is_number(cell: str) -> bool:
    """Return whether a cell holds a number, with either decimal sign."""
    return bool(NUMBER.fullmatch(cell) or COMMA_NUMBER.fullmatch(cell))


def fits(cell: str) -> bool:
    """Return whether a cell may stand in a row of numbers."""
    return cell.lower() in MISSING or is_number(cell)


def cells_of(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, without quotation marks and parted thousands."""
    if not line.isascii():
        line = _THIN.sub("", line.translate(_MINUS))
    if "'" in line:
        line = _THIN.sub("", line)
    if separator in ("\t", ";") and " " in line:
        line = _BLANK.sub(lambda match: match[1] + match[2].replace(" ", ""), line)
    if separator in ("\t", ";") and "," in line and "." in line:
        line = _THOUSANDS.sub(lambda match: re.sub("[.,]", "", match[0]), line)
    if "# " in line and not is_comment(line):
        line = _REMARK.sub("", line).rstrip("\t;, ")
    if "data" in line or "Data" in line or "DATA" in line:
        line = _NO_DATA.sub("nodata", line)
    if separator == "," and '"' in line:  # a comma between quotation marks parts no cells
        with suppress(csv.Error, StopIteration):
            return list(map(str.strip, next(csv.reader([line.strip(" \r\n")]))))
    cells = list(map(str.strip, line.strip(" \r\n").split(separator)))
    return [cell.strip('"').strip() for cell in cells] if '"' in line else cells


_NUMBER_WITH_UNIT = re.compile(r"(\d[\d.,]*(?:[eE][-+]?\d+)?)\s*([^\W\d_]\S*?)(?=[\t;,]|\s*$)")


def _units_above(lines: list[Line]) -> list[Line]:
    """Return lines of numbers with their units, 0.1 mm, as numbers with a line of units above.

    A bar parts cells as a tab does.
    """
    bars = [(number, text.strip("| ").replace("|", "\t")) for number, text in lines]
    rows = {
        at: (number, _NUMBER_WITH_UNIT.sub(r"\1", text))
        for at, (number, text) in enumerate(bars)
        if not is_comment(text) and is_row(_NUMBER_WITH_UNIT.sub(r"\1", text))
    }
    units = {tuple(u for _, u in _NUMBER_WITH_UNIT.findall(bars[at][1])) for at in rows}
    if len(units) != 1:
        return lines
    first = min(rows)
    above = [(bars[first][0], "\t".join(units.pop()))]
    bare = [rows.get(at, line) for at, line in enumerate(bars)]
    return [*bare[:first], *(above if above[0][1] else []), *bare[first:]]


_ROWS_WITH_WORDS = 2  # fewest rows by which a column of words is known


def without_words(lines: list[Line]) -> list[Line]:
    """Return lines whose columns of words, such as dates or samples, are empty below the titles.

    A column is one of words if no row of the table has a number or a missing value in it. Lines
    with a row of numbers only are returned as they are.
    """
    if any(is_row(text) for _, text in lines):
        return lines
    lines = _units_above(lines)
    for separator in SEPARATORS[:3]:
        rows = {
            at: cells
            for at, (_, text) in enumerate(lines)
            if not is_comment(text) and sum(map(is_number, cells := cells_of(text, separator))) > 1
        }
        count = Counter(map(len, rows.values())).most_common(1)
        if not count or count[0][1] < _ROWS_WITH_WORDS:
            continue
        table = {at: cells for at, cells in rows.items() if len(cells) == count[0][0]}
        words = [not any(map(fits, column)) for column in zip(*table.values(), strict=True)]
        sign = separator or " "
        return [
            (number, sign.join("" if w else c for w, c in zip(words, table[at], strict=True)))
            if at in table
            else (number, text)
            for at, (number, text) in enumerate(lines)
        ]
    return lines
