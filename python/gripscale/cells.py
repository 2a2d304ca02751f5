"""Cells of a line of a table: which are numbers, which are missing values, what is a row."""

from __future__ import annotations

import re

Line = tuple[int, str]
"""A line with its number in the file, from 1."""

MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "--", "---", "bad"}
NUMBER = re.compile(r"[+-]?(\d++(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
COMMA_NUMBER = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?", re.ASCII)
SEPARATORS = ("\t", ";", ",", None)
"""What may part the cells of a line, in the order they are tried; None: blanks."""
COMMENT = ("#", "%", "!")


def parse_number(cell: str) -> float | None:
    """Return the number a cell holds, or None if it holds none; missing values are NaN."""
    if cell.lower() in MISSING:
        return float("nan")
    return float(cell) if NUMBER.fullmatch(cell) else None


def is_row(line: str) -> bool:
    """Return whether a line is a row: at least two cells, numbers or missing, not all missing."""
    return not is_comment(line) and any(is_row_of(cells_of(line, one)) for one in SEPARATORS)


def is_row_of(cells: list[str]) -> bool:
    """Return whether these are the cells of a row."""
    return len(cells) >= 2 and any(map(is_number, cells)) and all(map(fits, cells))


def is_comment(line: str) -> bool:
    """Return whether a line is a comment."""
    return line.lstrip().startswith(COMMENT)


def is_number(cell: str) -> bool:
    """Return whether a cell holds a number, with either decimal sign."""
    return bool(NUMBER.fullmatch(cell) or COMMA_NUMBER.fullmatch(cell))


def fits(cell: str) -> bool:
    """Return whether a cell may stand in a row of numbers."""
    return cell.lower() in MISSING or is_number(cell)


def cells_of(line: str, separator: str | None) -> list[str]:
    """Return the cells of a line, without quotation marks."""
    return [cell.strip().strip('"').strip() for cell in line.strip(" \r\n").split(separator)]
