"""Tables of numbers in text and Excel files: one set of rules for every instrument's export.

- A sheet of an Excel file (.xlsx) is read as a text whose cells are parted by tabs.
- UTF-8, UTF-16 (with a byte order mark), Windows-1252 or latin-1; any line ends. Control codes mean
  binary data.
- Lines that begin with #, % or ! are comments. Titles may stand in one.
- Cells are parted by tabs, semicolons, commas or blanks: by the first of these that makes numbers
  of all cells of a line. That line is the first row; every later line must have as many cells.
- The decimal sign is the point or, where commas do not part the cells, the comma; not both.
- Empty cells, nan, n/a, - and the like are missing values.
- The last line above the rows that names as many columns holds the titles. A unit stands in
  brackets, behind a slash or a blank, or in a line of units.
"""

from __future__ import annotations

import math
import os
import re
import sys
from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass
from decimal import Decimal
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.checks import MOST, short_repr, shortened, whole
from gripscale.core.errors import FileError, InputError
from gripscale.core.units import spelled

# Cells of a line of a table: which are numbers, which are missing values, what is a row.

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


# Sheets of an Excel file as rows of cells, and as the lines a text file would have.

EXCEL = (".xlsx", ".xlsm")
"""Suffixes of the files that are read as Excel's."""

Rows = list[tuple[object, ...]]


def is_excel(path: Path) -> bool:
    """Return whether a file is read as Excel's, by its suffix."""
    return path.suffix.lower() in EXCEL


def import_openpyxl(path: Path) -> Any:
    """Return openpyxl, which reads and writes the xlsx file at `path`.

    Raises `FileError`, with the command that installs it, if it is missing.
    """
    try:
        return import_module("openpyxl")
    except ImportError as error:
        raise FileError(
            f"{path}: xlsx needs openpyxl, which is not installed; "
            "install it with: pip install 'gripscale[export]'"
        ) from error


def read_sheets(path: Path) -> dict[str, Rows]:
    """Return the rows of each sheet by its name, in the order of the file.

    Raises `FileError` if openpyxl is missing (`pip install 'gripscale[export]'`), or the file is no
    xlsx file or has no sheet of cells.
    """
    if path.is_dir():
        raise FileError(f"{path}: expected a file; got a directory")
    if not path.is_file():
        raise FileError(f"{path}: cannot be read (no such file)")
    if not path.stat().st_size:
        raise FileError(f"{path}: expected an xlsx file; got an empty file")
    openpyxl = import_openpyxl(path)
    try:
        with path.open("rb") as file:  # openpyxl leaves open what it cannot read
            book = openpyxl.load_workbook(file, read_only=True, data_only=True)
            sheets = {
                sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book.worksheets
            }
    except Exception as error:  # openpyxl, zipfile and the XML parser fail each in their own way
        raise FileError(f"{path}: expected an xlsx file ({type(error).__name__})") from error
    if not sheets:
        raise FileError(f"{path}: expected a sheet of cells; got none")
    return sheets


def sheet_lines(path: Path, sheet: str | int | None) -> list[Line]:
    """Return a sheet as lines whose cells are parted by tabs, without its empty columns.

    Without a `sheet`, by name or number from 1, the one that holds rows of numbers.

    Raises
    ------
    FileError
        As `read_sheets` does.
    InputError
        If there is no such sheet, or several hold rows of numbers and none is named.
    """
    sheets = {name: _lines(rows) for name, rows in read_sheets(path).items()}
    if sheet is None:
        full = [name for name, lines in sheets.items() if any(is_row(line) for _, line in lines)]
        if len(full) > 1:
            raise InputError(
                f"{path}: sheet must be given, because {len(full)} sheets hold rows of numbers "
                f"({', '.join(full)})"
            )
        return sheets[full[0]] if full else next(iter(sheets.values()))
    if isinstance(sheet, str):
        return sheets[checks.one_of(f"{path}: sheet", sheet, sheets)]
    return list(sheets.values())[checks.counted(f"{path}: sheet", sheet, len(sheets))]


def _lines(rows: Rows) -> list[Line]:
    cells = [[_cell(one) for one in row] for row in rows]
    width = max(map(len, cells), default=0)
    used = [at for at in range(width) if any(row[at : at + 1] not in ([], [""]) for row in cells)]
    return [
        (number, "\t".join("".join(row[at : at + 1]) for at in used))
        for number, row in enumerate(cells, start=1)
        if any(row)
    ]


def _cell(value: object) -> str:
    if isinstance(value, float):
        return repr(value)
    return "" if value is None else " ".join(str(value).split())


_BINARY = {
    b"\xd0\xcf\x11\xe0": "an old Office file (.xls), to be saved as .xlsx",
    b"PK\x03\x04": "a zip file; an Excel file must end in .xlsx",
    b"%PDF": "a PDF",
}
"""First bytes of files that are mistaken for text."""
_LINE_END = re.compile(r"\r*\n|\r")
MOST_LINES = 10**6
"""Lines above the rows, at most."""
_TITLE_SEPARATORS = (r"\t", r";", r",", r"\s{2,}", r"\s+")
_CUT = re.compile(r"\s*[\[(]\s*([^\[\]()]+?)\s*[\])]|[\s/_,]+(?=(.+))")
_STATED = re.compile(r"(.*?)(?:\s*[\[(]\s*([^\[\]()]+?)\s*[\])]|\s+/\s*(\S+))\s*")
_TITLES_IN_BRACKETS = re.compile(r"[^()\[\]]+[(\[][^()\[\]]*[)\]]")
_DIGITS = frozenset("0123456789+-.")
_PLAIN = _DIGITS | {"e", "E"}
"""Letters of numbers that can be read all at once."""


@dataclass(frozen=True)
class Column:
    """A column as its title names it; the unit is the file's own word for it."""

    name: str = ""
    unit: str | None = None

    def __bool__(self) -> bool:
        """Return whether the file says anything of the column."""
        return bool(self.name or self.unit)


@dataclass(frozen=True)
class TextTable:
    """Rows of cells as printed, the titles above them, and the line each row stood in."""

    path: Path
    columns: list[Column]
    """One a column, nameless where the file has no titles."""
    rows: list[list[str]]
    line_numbers: list[int]
    decimal: str

    @property
    def names(self) -> list[str]:
        """The names of the columns; empty if the file has no titles."""
        names = [column.name for column in self.columns]
        return names if any(names) else []

    @property
    def titles(self) -> str:
        """The names of the columns as a message lists them, empty if the file has no titles."""
        return shortened(", ".join(self.names))

    def numbers(self, column: int, expected: str, *, missing: bool = False) -> Array:
        """Return a column of numbers, NaN where a value is `missing` and may be.

        Raises `FileError` with the line of the first other cell, or number beyond reason, and what
        was `expected`.
        """
        cells = [self._with_point(row[column]) for row in self.rows]
        if _PLAIN.issuperset("".join(cells)):
            with suppress(ValueError):  # a word of these letters, which the loop below names
                plain = np.array(cells, dtype=float)
                if (np.abs(plain) <= MOST).all():
                    return plain
        values = np.empty(len(self.rows))
        for at, row in enumerate(self.rows):
            value = parse_number(self._with_point(row[column]))
            if value is None or not (abs(value) <= MOST or (missing and math.isnan(value))):
                raise FileError(
                    f"{self.path}, line {self.line_numbers[at]}: expected {expected}; "
                    f"got {short_repr(row[column])}"
                )
            values[at] = value
        return values

    def resolution(self, column: int) -> float:
        """Return the last decimal place to which any number of a column is printed, as 0.001."""
        cells = [self._with_point(row[column]) for row in self.rows]
        if _DIGITS.issuperset("".join(cells)):
            return float(10.0 ** -max(len(cell.partition(".")[2]) for cell in cells))
        places = (Decimal(cell).as_tuple().exponent for cell in cells)
        return 10.0 ** min(max(place, -300) for place in places if isinstance(place, int))

    def _with_point(self, cell: str) -> str:
        return cell.replace(",", ".") if self.decimal == "," else cell


def read_table(
    path: Path,
    expected: str,
    *,
    kinds: Collection[str],
    named: Callable[[str], bool],
    sheet: str | int | None = None,
) -> TextTable:
    """Read the rows of a text or Excel file and the titles above them.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    expected : str
        What the rows hold, for messages.
    kinds : collection of str
        Kinds of units (see `gripscale.core.units`) the titles may name.
    named : callable
        Whether a text is the name of a column. A line with such a name, or with a known unit,
        holds the titles.
    sheet : str or int, optional
        Name of the Excel sheet or its number from 1, where several hold numbers.

    Raises
    ------
    FileError
        If the file cannot be read, is not text or has no rows; if a row has another number of
        cells than the first; if the decimal sign changes. The message names path and line.
    InputError
        If `sheet` is missing or none of the file.
    """
    return table_in(path, read_lines(path, sheet=sheet), expected, kinds=kinds, named=named)


def read_lines(
    path: Path, *, sheet: str | int | None = None, header: int | None = None
) -> list[Line]:
    """Return the lines of a text file or of a sheet of an Excel file that are not empty.

    Among the first `header` lines numbers are no rows: they are made comments.

    Raises `FileError` and `InputError` as `read_table` does, also if `header` is no number of
    lines.
    """
    above = 0 if header is None else whole("header", header, least=0, most=MOST_LINES)
    if is_excel(path):
        lines = sheet_lines(path, sheet)
    elif sheet is None:
        split = enumerate(_LINE_END.split(read_text(path)), start=1)
        lines = [(number, line) for number, line in split if line.strip()]
    else:
        raise InputError(
            f"{path}: sheet must be left out, a text file has none; got {short_repr(sheet)}"
        )
    return [
        (number, f"# {line}" if number <= above and is_row(line) else line)
        for number, line in lines
    ]


def table_in(
    path: Path,
    lines: list[Line],
    expected: str,
    *,
    kinds: Collection[str],
    named: Callable[[str], bool],
) -> TextTable:
    """Return the table in `lines` of the file `path`, as `read_table` does."""
    if not lines:
        raise FileError(f"{path}: expected {expected}; got 0 in an empty file")
    first, separator = _first_row(path, lines, expected)
    numbers = [number for number, line in lines[first:] if not is_comment(line)]
    rows = [cells_of(line, separator) for _, line in lines[first:] if not is_comment(line)]
    count = len(rows[0])
    _check_faults(path, lines[:first], separator, range(count, count + 1))
    _check_lengths(path, rows, numbers)
    decimal = _decimal_sign(path, rows, numbers)
    above = [line for _, line in lines[:first]]
    full = _full_columns(rows)
    columns = _columns(above, count, kinds, named)[full]
    rows = [row[full] for row in rows]
    if not any(columns) and len(columns) < count:  # titles that have not those empty cells
        columns = _columns(above, len(columns), kinds, named)
    return TextTable(path, columns, rows, numbers, decimal)


def file_path(path: object) -> Path:
    """Return `path` as one; raise `InputError` if it cannot be the path of a file."""
    if not isinstance(path, str | os.PathLike):
        raise InputError(f"path must be the path of a file; got {short_repr(path)}")
    return Path(path)


def file_paths(path: object) -> list[Path]:
    """Return one path or several; raise `InputError` if there is none or something else."""
    if isinstance(path, Sequence) and not isinstance(path, str | bytes):
        if not path:
            raise InputError("path must name at least one file; got none")
        return [file_path(one) for one in path]
    return [file_path(path)]


def read_bytes(path: Path) -> bytes:
    """Return the content of a file; raise `FileError` if it cannot be read."""
    if path.is_dir():
        raise FileError(f"{path}: expected a file; got a directory")
    try:
        return path.read_bytes()
    except FileNotFoundError as error:
        raise FileError(f"{path}: cannot be read (no such file)") from error
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: cannot be read ({error})") from error


def read_text(path: Path) -> str:
    """Return the text of a file; raise `FileError` if it is unreadable or binary."""
    raw = read_bytes(path)
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return raw.decode("utf-16", errors="replace")
    if raw.startswith(tuple(_BINARY)) or any(
        raw[:4096].count(code) for code in (*range(9), *range(14, 32))
    ):
        raise FileError(f"{path}: expected a text file; got {_binary(raw)}")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return _western(raw)


def _binary(raw: bytes) -> str:
    """Return what a file that is no text is, from its first bytes."""
    return next((what for first, what in _BINARY.items() if raw.startswith(first)), "binary data")


def _western(raw: bytes) -> str:
    """Return text in Windows' or, where that has no such letter, ISO's code of western Europe."""
    try:
        return raw.decode("cp1252")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _first_row(path: Path, lines: list[Line], expected: str) -> tuple[int, str | None]:
    """Return the index of the first line of numbers, and what parts its cells."""
    for at, (_, line) in enumerate(lines):
        for separator in () if is_comment(line) else SEPARATORS:
            if is_row_of(cells_of(line, separator)):
                return at, separator
    for separator in SEPARATORS:
        _check_faults(path, lines, separator, range(2, sys.maxsize))
    number, line = lines[0]
    raise FileError(
        f"{path}: expected {expected}; found none from line {number} ({line.strip()[:40]!r}) on"
    )


def _check_faults(path: Path, lines: list[Line], separator: str | None, counts: range) -> None:
    """Refuse a line that begins as a row of so many cells, but has a word in another cell."""
    for number, line in lines:
        cells = cells_of(line, separator)
        if not is_comment(line) and len(cells) in counts and is_number(cells[0]):
            fault = next(at for at, cell in enumerate(cells) if not fits(cell))
            raise FileError(
                f"{path}, line {number}: expected a number in column {fault + 1}; "
                f"got {short_repr(cells[fault])}"
            )


def _check_lengths(path: Path, rows: list[list[str]], numbers: list[int]) -> None:
    for number, row in zip(numbers, rows, strict=True):
        if len(row) != len(rows[0]):
            raise FileError(
                f"{path}, line {number}: expected {len(rows[0])} columns as in line "
                f"{numbers[0]}; got {len(row)}"
            )


def _decimal_sign(path: Path, rows: list[list[str]], numbers: list[int]) -> str:
    """Return the sign all numbers of the file use."""
    comma = _first_cell(rows, lambda cell: "," in cell and bool(COMMA_NUMBER.fullmatch(cell)))
    if comma is None:
        return "."
    point = _first_cell(rows, lambda cell: "." in cell and bool(NUMBER.fullmatch(cell)))
    if point is None:
        return ","
    (first, one), (second, other) = sorted((comma, point))
    raise FileError(
        f"{path}, line {numbers[second]}: expected one decimal sign throughout; "
        f"got {short_repr(other)} after {short_repr(one)} in line {numbers[first]}"
    )


def _first_cell(rows: list[list[str]], fits: Callable[[str], bool]) -> tuple[int, str] | None:
    return next(((at, cell) for at, row in enumerate(rows) for cell in row if fits(cell)), None)


def _full_columns(rows: list[list[str]]) -> slice:
    """Return all columns without the empty ones that separators at the ends of all lines make."""
    first = 0 if any(row[0] for row in rows) else 1
    last = len(rows[0]) - (0 if any(row[-1] for row in rows) else 1)
    return slice(first, last)


def _columns(
    above: list[str], count: int, kinds: Collection[str], named: Callable[[str], bool]
) -> list[Column]:
    """Return what the lines `above` the rows say of the columns."""
    columns, units = [Column()] * count, [""] * count
    for cells in filter(None, (_titles(line, count) for line in above)):
        bare = [cell.strip("()[] ") for cell in cells]
        if any(_known(cell, kinds) for cell in bare):
            units = bare
            continue
        found = [_column(cell, kinds) for cell in cells]
        if any(named(column.name) or _known(column.unit, kinds) for column in found):
            columns = found
    return [
        Column(column.name, column.unit or unit or None)
        for column, unit in zip(columns, units, strict=True)
    ]


def _titles(line: str, count: int) -> list[str] | None:
    """Return the line cut into `count` titles, or None if it cannot be."""
    line = line.strip(" ").lstrip("".join(COMMENT)).strip(" ")
    for text in (line, line.strip(" \t;,")):
        for separator in _TITLE_SEPARATORS:
            cells = [cell.strip().strip('"').strip() for cell in re.split(separator, text)]
            if len(cells) == count:
                return cells
    cells = [cell.strip(" ,;\t") for cell in _TITLES_IN_BRACKETS.findall(line)]
    return cells if len(cells) == count else None


def _column(title: str, kinds: Collection[str]) -> Column:
    """Return the name and the unit of a title: x [mm], x / mm or, of known units, x mm or x_mm."""
    for cut in _CUT.finditer(title):
        unit = cut[1] or cut[2]
        if _known(unit, kinds):
            return Column(title[: cut.start()], unit)
    stated = _STATED.fullmatch(title)
    return Column(stated[1], stated[2] or stated[3]) if stated else Column(title)


def _known(unit: str | None, kinds: Collection[str]) -> bool:
    return any(spelled(unit, kind) for kind in kinds)
