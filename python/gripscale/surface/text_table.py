"""Numbers in columns, found in a text file whatever its header, separator and line ends."""

from __future__ import annotations

import re
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path

from gripscale.errors import FileError

_LINE_END = re.compile(r"\r*\n|\r")
_MISSING = {"", "nan", "na", "n/a", "null", "none", "-", "--", "---", "bad"}
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_LINES_OF_HEADER = 200
_SEPARATORS: tuple[tuple[str | None, str], ...] = (
    ("\t", "."),
    (";", "."),
    (",", "."),
    (None, "."),
    ("\t", ","),
    (";", ","),
    (None, ","),
)


@dataclass(frozen=True)
class TextTable:
    """Rows of cells of a text file, the titles above them, and where each row stood."""

    header: list[str]
    titles: list[str]
    rows: list[list[str]]
    line_numbers: list[int]


def read_text(path: Path) -> str:
    """Return the text of a file; raise `FileError` if it is unreadable, empty or binary."""
    raw = read_bytes(path)
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return raw.decode("utf-16", errors="replace")
    control = sum(raw[:4096].count(code) for code in (*range(9), *range(14, 32)))
    if control:
        raise FileError(f"{path}: expected text with two columns of numbers; got binary data")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def read_bytes(path: Path) -> bytes:
    """Return the content of a file; raise `FileError` if it cannot be read or holds nothing."""
    if path.is_dir():
        raise FileError(f"{path}: expected a file; got a directory")
    try:
        raw = path.read_bytes()
    except FileNotFoundError as error:
        raise FileError(f"{path}: no such file") from error
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: cannot be read ({error})") from error
    if not raw.strip():
        raise FileError(f"{path}: expected a surface profile; got an empty file")
    return raw


def read_table(path: Path) -> TextTable:
    """Split a text file into a header, column titles and rows of at least two cells."""
    lines = [
        (number, line)
        for number, line in enumerate(_LINE_END.split(read_text(path)), start=1)
        if line.strip()
    ]
    first, separator, comma = _first_row(path, lines)
    rows = [_cells(line, separator, comma) for _, line in lines[first:]]
    above = [line for _, line in lines[:first]]
    titles = _titles(above[-1], separator, len(rows[0])) if above else []
    table = TextTable(above, titles, rows, [number for number, _ in lines[first:]])
    _check_row_lengths(path, table)
    return table


def parse_number(cell: str) -> float | None:
    """Return the number a cell holds, or None if it holds none; missing values are NaN."""
    if cell.lower() in _MISSING:
        return float("nan")
    return float(cell) if _NUMBER.fullmatch(cell) else None


def printed_resolution(cells: list[str]) -> float:
    """Return the last decimal place to which any of the numbers is printed, such as 0.001."""
    places = (Decimal(cell).as_tuple().exponent for cell in cells)
    return float(10.0 ** min(place for place in places if isinstance(place, int)))


def _first_row(path: Path, lines: list[tuple[int, str]]) -> tuple[int, str | None, str]:
    for at, (_, line) in enumerate(lines[:_LINES_OF_HEADER]):
        for separator, comma in _SEPARATORS:
            cells = _cells(line, separator, comma)
            parsed = [parse_number(cell) for cell in cells]
            if len(cells) >= 2 and None not in parsed and any(p == p for p in parsed):
                return at, separator, comma
    seen = f"from line {lines[0][0]} ({lines[0][1].strip()[:40]!r}) on" if lines else "at all"
    raise FileError(f"{path}: expected rows with two columns of numbers; found none {seen}")


def _cells(line: str, separator: str | None, comma: str) -> list[str]:
    cells = [cell.strip().strip('"') for cell in line.strip(" \r\n").split(separator)]
    return [cell.replace(",", ".") for cell in cells] if comma == "," else cells


def _titles(line: str, separator: str | None, columns: int) -> list[str]:
    """Return one title per column, or none if the line above the numbers does not name them."""
    for split in (separator, "\t", ";", ","):
        titles = [title.strip().strip('"') for title in line.lstrip("#%").strip().split(split)]
        if len(titles) == columns:
            return titles
    # Words and their units, parted by blanks: "x [mm] z [um]".
    titles = re.findall(r"\S+\s*[\[(][^\])]*[\])]", line)
    return titles if len(titles) == columns else []


def _check_row_lengths(path: Path, table: TextTable) -> None:
    columns = len(table.rows[0])
    for number, row in zip(table.line_numbers, table.rows, strict=True):
        if len(row) != columns:
            raise FileError(
                f"{path}, line {number}: expected {columns} columns as in line "
                f"{table.line_numbers[0]}; got {len(row)}"
            )
