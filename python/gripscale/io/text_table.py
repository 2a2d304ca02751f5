"""Tables of numbers in text and Excel files: one set of rules for every instrument's export.

The rules, the same for heights and moduli, are in docs/inputs.md. Cells are parted by the first of
tabs, semicolons, commas and blanks that makes numbers of all cells of a line: the first row. Every
later row has as many cells. Titles are in the last line above that names as many columns.
"""

from __future__ import annotations

import io
import math
import os
import re
import sys
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass
from decimal import Decimal
from importlib import import_module
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from gripscale.core import Array, FileError, InputError, checks, spelled, unstated, using_extra
from gripscale.core.checks import MOST, short_repr, shortened
from gripscale.io.cells import (
    COMMA_NUMBER,
    COMMENT,
    MISSING,
    MISSING_MARKS,
    NUMBER,
    SEPARATORS,
    Line,
    cells_of,
    fits,
    is_comment,
    is_number,
    is_row,
    is_row_of,
    parse_number,
    without_words,
)

EXCEL = (".xlsx", ".xlsm")
_ZIP, _WORKBOOK = b"PK\x03\x04", b"xl/workbook"  # the second is a name in an Excel file's zip
_Rows = list[tuple[object, ...]]
T = TypeVar("T")


def is_excel(path: Path) -> bool:
    """Return whether a file is an Excel file, by its content, or by its suffix if it is no text."""
    excel = path.suffix.lower() in EXCEL
    try:
        with path.open("rb") as file:
            content = file.read(len(_ZIP))
            if not (excel or content == _ZIP):  # of a large file that is none this is enough
                return False
            content += file.read()
    except (OSError, ValueError):  # said by whoever reads it
        return excel
    if content.startswith(_ZIP) and _WORKBOOK in content:
        return True
    return excel and not (content.strip() and is_text(content) and not content.startswith(_ZIP[:2]))


def read_sheets(path: Path) -> dict[str, _Rows]:
    """Return the rows of each sheet by its name, in the order of the file."""
    content = read_bytes(path)
    if not content:
        raise FileError(f"{path}: expected an xlsx file; got an empty file")
    with using_extra("export", f"{path}: xlsx", "openpyxl", kind=FileError):
        openpyxl = import_module("openpyxl")
    try:
        book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
        sheets = {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in book.worksheets}
    except Exception as error:  # openpyxl, zipfile and the XML parser each fail in their own way
        raise FileError(
            f"{path}: expected an xlsx file; got a damaged file or another kind with this ending: "
            "save it as .xlsx from the program that wrote it"
        ) from error
    if not sheets:
        raise FileError(f"{path}: expected a sheet of cells; got none")
    return sheets


def sheets_as_lines(path: Path, *, header: int | None = None) -> dict[str, list[Line]]:
    """Return the sheets of an Excel file by name, as `read_lines` returns one of them."""
    sheets = {}
    for name, rows in read_sheets(path).items():
        texts = [["" if value is None else str(value) for value in row] for row in rows]
        cells = [[" ".join(text.split()) for text in row] for row in texts]
        width = max(map(len, cells), default=0)
        used = [i for i in range(width) if any(row[i : i + 1] not in ([], [""]) for row in cells)]
        lines = [
            (number, "\t".join("".join(row[i : i + 1]) for i in used))
            for number, row in enumerate(cells, start=1)
            if any(row)
        ]
        sheets[name] = _below_header(lines, header)
    return sheets


# Binary files that are mistaken for text, by their first bytes.
OLD_OFFICE = b"\xd0\xcf\x11\xe0"
_BINARY = {
    OLD_OFFICE: "an old Office file (.xls), to be saved as .xlsx",
    _ZIP: "a zip file that is no Excel file",
}
_LINE_END = re.compile(r"\r*\n|\r")
MOST_LINES = 10**6
_MANY = 10**5  # rows from which on a table is known by its first and last ones
_ENOUGH_CELLS = 2000  # numbers of a column that show the decimals of all
_TITLE_SEPARATORS = (r"\t", r";", r",", r"\s{2,}", r"\s+")
_CUT = re.compile(r"\s*[\[(]\s*([^\[\]()]+?)\s*[\])]|[\s/_,]+(?=(.+))")
_FACTOR = re.compile(r"(?:10 ?(?:\^|\*\*) ?|[x×·*] ?1[eE])[-+]?\d+|10[⁰¹²³⁴-⁹⁻]+")
_NAME_AND_UNIT = re.compile(r"(.*?)(?:\s*[\[(]\s*([^\[\]()]+?)\s*[\])]|\s+/\s*(\S+))\s*")
_TITLES_IN_BRACKETS = re.compile(r"[^()\[\]]+[(\[][^()\[\]]*[)\]]")
_DIGITS = frozenset("0123456789+-.")
_PLAIN = _DIGITS | {"e", "E"}  # letters of numbers that numpy reads all at once


@dataclass(frozen=True)
class ColumnTitle:
    """Name and unit of a column by its title, in the words of the file."""

    name: str = ""
    unit: str | None = None

    def __bool__(self) -> bool:
        """Return whether the file names the column or its unit."""
        return bool(self.name or self.unit)


class PlainRows(Sequence[list[str]]):
    """Rows of numbers with a decimal point, or `nan`; cells are cut when asked for."""

    def __init__(self, lines: Sequence[str], separator: str | None) -> None:
        """Parse all numbers; raise `ValueError` if a cell is something else."""
        self.lines, self.separator = lines, separator
        self.values = np.loadtxt(lines, delimiter=separator, comments=None, ndmin=2)
        """The numbers, shape (rows, columns)."""
        missing = np.isnan(self.values)
        if missing[-1].all() or not (missing | (np.abs(self.values) <= MOST)).all():
            raise ValueError("a remark below the table, or a number that is too large")

    def __len__(self) -> int:
        return len(self.lines)

    def __getitem__(self, at: Any) -> Any:
        """Return the cells of a row, or of several."""
        if isinstance(at, slice):
            return [cells_of(line, self.separator) for line in self.lines[at]]
        return cells_of(self.lines[at], self.separator)


_kept: ContextVar[dict[object, Any] | None] = ContextVar("_kept", default=None)


@contextmanager
def files_read_once() -> Iterator[None]:
    """Keep what is read of files inside a block, or one around it, in which readers try them."""
    kept = _kept.get()
    token = _kept.set({} if kept is None else kept)
    try:
        yield
    finally:
        _kept.reset(token)


_noted: ContextVar[dict[int, ColumnTitle] | None] = ContextVar("_noted", default=None)


@contextmanager
def columns_noted() -> Iterator[dict[int, ColumnTitle]]:
    """Note the columns of a file whose numbers are read inside a block, by number from 1."""
    columns: dict[int, ColumnTitle] = {}
    token = _noted.set(columns)
    try:
        yield columns
    finally:
        _noted.reset(token)


def read_once(key: object, make: Callable[[], T]) -> T:
    """Return what `make` makes, or what it made for the key inside `files_read_once`."""
    kept = _kept.get()
    if kept is None:
        return make()
    if key not in kept:
        kept[key] = make()
    made: T = kept[key]
    return made


@dataclass(frozen=True)
class TextTable:
    """Rows of cells as printed, the titles above them, and the line number of each row."""

    path: Path
    columns: list[ColumnTitle]
    rows: Sequence[list[str]]
    line_numbers: list[int]
    decimal: str
    empty: int = 0
    """Columns of the file without numbers before the first one: they count, too."""

    @property
    def names(self) -> list[str]:
        """The names of the columns; empty if the file has no titles."""
        names = [column.name for column in self.columns]
        return names if any(names) else []

    @property
    def titles(self) -> str:
        """The names of the columns as a message lists them, empty if the file has no titles."""
        return shortened(", ".join(self.names))

    def label(self, column: int) -> str:
        """Return the title of a column, or its number from 1."""
        return shortened(self.columns[column].name) or str(column + 1)

    def numbers(self, column: int, expected: str, *, missing: bool = False) -> Array:
        """Return a column of numbers up to `MOST`; with `missing`, NaN where a value is missing."""
        if (noted := _noted.get()) is not None:
            noted[self.empty + column + 1] = self.columns[column]
        if isinstance(self.rows, PlainRows):
            values = self.rows.values[:, column].copy()
            if missing or not np.isnan(values).any():
                return values
        cells = self._cells(column)
        if missing:
            cells = ["nan" if cell.lower() in MISSING else cell for cell in cells]
        letters = "".join(cells).replace("nan", "") if missing else "".join(cells)
        if _PLAIN.issuperset(letters):
            with suppress(ValueError):  # a word of these letters: the loop below names it
                plain = np.array(list(map(float, cells)))
                if not (np.abs(plain) > MOST).any():
                    return plain
        values = np.empty(len(cells))
        for at, cell in enumerate(cells):
            value = parse_number(cell)
            if value is None or not (abs(value) <= MOST or (missing and math.isnan(value))):
                wanted, marks = expected, ""
                if value is None and missing:
                    wanted, marks = f"a number in column {self.label(column)}", f"; {MISSING_MARKS}"
                raise FileError(
                    f"{self.path}, line {self.line_numbers[at]}: expected {wanted}; "
                    f"got {short_repr(self.rows[at][column])}{marks}"
                )
            values[at] = value
        return values

    def resolution(self, column: int) -> float:
        """Return the last decimal place of any printed number of a column, such as 0.001."""
        if isinstance(self.rows, PlainRows):  # an axis of a map has few numbers, printed alike
            once = np.unique(self.rows.values[:, column], return_index=True)[1]
            some = np.linspace(0, once.size - 1, _ENOUGH_CELLS).astype(int)
            once = np.concatenate([once[:_ENOUGH_CELLS], once[some]])  # decimals come again
            cells = [self.rows[at][column] for at in once.tolist()]
        else:
            cells = self._cells(column)
        if _DIGITS.issuperset("".join(cells)):
            return float(10.0 ** -max(len(cell.partition(".")[2]) for cell in cells))
        numbers = filter(NUMBER.fullmatch, cells)  # others are marks of missing values
        exponents = (Decimal(cell).as_tuple().exponent for cell in numbers)
        return 10.0 ** min(max(power, -300) for power in exponents if isinstance(power, int))

    def _cells(self, column: int) -> list[str]:
        cells = [row[column] for row in self.rows]
        return [cell.replace(",", ".") for cell in cells] if self.decimal == "," else cells


def read_table(
    path: Path,
    expected: str,
    *,
    kinds: Collection[str],
    named: Callable[[str], bool],
    sheet: str | int | None = None,
) -> TextTable:
    """Read the rows of a text or Excel file and the titles above them.

    `expected` is the content of the rows, for messages. A line with a unit of one of the `kinds` of
    `gripscale.core.units`, or a name of a column by `named`, holds the titles. `sheet` is the name
    of the Excel sheet or its number from 1, where several hold numbers.
    """
    return table_in(path, read_lines(path, sheet=sheet), expected, kinds=kinds, named=named)


def read_lines(
    path: Path, *, sheet: str | int | None = None, header: int | None = None
) -> list[Line]:
    """Return the lines of a text file or of a sheet of an Excel file that are not empty.

    A sheet is stated by its name or its number from 1; by default it is the only one with numbers.
    Rows of numbers among the first `header` lines are turned into comments.
    """
    return read_once(("lines", path, sheet, header), lambda: _lines_of(path, sheet, header))


def _lines_of(path: Path, sheet: str | int | None, header: int | None) -> list[Line]:
    if not is_excel(path):
        if sheet is not None:
            raise InputError(
                f"{path}: sheet must be left out, a text file has none; got {short_repr(sheet)}"
            )
        text = read_text(path).replace("\r\n", "\n")
        split = enumerate(_LINE_END.split(text) if "\r" in text else text.split("\n"), start=1)
        return _below_header([(number, line) for number, line in split if line.strip()], header)
    sheets = sheets_as_lines(path, header=header)
    if isinstance(sheet, str):
        return sheets[checks.one_of(f"{path}: sheet", sheet, sheets)]
    if sheet is not None:
        return list(sheets.values())[checks.counted(f"{path}: sheet", sheet, len(sheets))]
    full = [name for name, lines in sheets.items() if any(is_row(line) for _, line in lines)]
    if len(full) > 1:
        hold = f"{len(full)} sheets hold rows of numbers ({', '.join(full)})"
        raise unstated(f"{path}: ", "sheet", f" must be given, because {hold}")
    return sheets[full[0]] if full else next(iter(sheets.values()))


def _below_header(lines: list[Line], header: int | None) -> list[Line]:
    """Return lines whose rows of numbers within the header are comments, without words in rows."""
    above = 0 if header is None else checks.whole("header", header, least=0, most=MOST_LINES)
    commented = [
        (number, f"# {line}" if number <= above and is_row(line) else line)
        for number, line in (lines if above else ())
    ]
    return without_words(commented or lines)


def column_in(path: Path, lines: list[Line], *, kinds: Collection[str]) -> TextTable | None:
    """Return the one number of each of `lines`, with the title above; None if they are no such."""
    titles: list[ColumnTitle] = []
    numbers: list[int] = []
    cells: list[list[str]] = []
    above = ""
    for number, line in lines:
        cell = line.strip().strip('"').rstrip(";,").strip()
        if is_comment(line):
            continue
        if fits(cell) and (cells or is_number(cell)):
            numbers.append(number)
            cells.append([cell])
        elif cells or is_row(line):
            return None
        else:
            above = cell
            titles.append(_column_title(cell, kinds))
    if not cells or "\t" in above:  # titles of several columns, of which only one has numbers
        return None
    if len(cells) == 1 and "," in cells[0][0]:  # the only row of two columns
        return None
    title = next((title for title in reversed(titles) if _is_unit(title.unit, kinds)), None)
    decimal = _decimal_sign(path, cells, numbers)
    return TextTable(path, [title or ColumnTitle()], cells, numbers, decimal)


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
    with suppress(ValueError):  # the rules below say what is wrong with a cell, or allow it
        texts = [line for _, line in lines[first:]]
        # a file may hold many tables of as many rows, but only one of very many
        table = tuple(texts) if len(texts) < _MANY else (len(texts), *texts[:2], texts[-1])
        plain = read_once(("rows", path, table), lambda: PlainRows(texts, separator))
        numbers = [number for number, _ in lines[first:]]
        above, count = [line for _, line in lines[:first]], plain.values.shape[1]
        _check_faults(path, lines[:first], separator, range(count, count + 1))
        return TextTable(path, _columns(above, count, kinds, named), plain, numbers, ".")
    titles = {line.strip() for _, line in lines[:first]}  # which come again on each page
    below = [(number, line) for number, line in lines[first:] if not is_comment(line)]
    cells = [(n, cells_of(line, separator)) for n, line in below if line.strip() not in titles]
    while not any(map(is_number, cells[-1][1])):  # remarks below the table
        cells.pop()
    count = len(cells[0][1])
    cells = [(n, row) for n, row in cells if len(row) == count or any(map(fits, row))]
    numbers, rows = [number for number, _ in cells], [row for _, row in cells]
    _check_faults(path, lines[:first], separator, range(count, count + 1))
    for number, row in cells:
        if len(row) != count:
            raise FileError(
                f"{path}, line {number}: expected {count} columns as in line {numbers[0]}; "
                f"got {len(row)}"
            )
    decimal = _decimal_sign(path, rows, numbers)
    above = [line for _, line in lines[:first]]
    # separators at the ends of all lines make empty columns
    used = [at for at in range(count) if any(row[at] for row in rows)]
    full = slice(used[0], used[-1] + 1)
    columns = _columns(above, count, kinds, named)
    for at in {0, count - 1} - set(range(count)[full]):
        if named(columns[at].name):
            raise FileError(
                f"{path}: expected numbers in column {at + 1}, {short_repr(columns[at].name)}; "
                f"got none in {len(rows)} rows"
            )
    columns, rows = columns[full], [row[full] for row in rows]
    for more in (0, 1):  # titles without those empty cells, or with one of them
        if not any(columns) and len(columns) < count:
            columns = _columns(above, len(columns) + more, kinds, named)[: len(columns)]
    return TextTable(path, columns, rows, numbers, decimal, full.start)


def file_path(path: object) -> Path:
    """Return `path` as `Path`; raise `InputError` if it cannot be the path of a file."""
    if not isinstance(path, str | os.PathLike):
        raise InputError(f"path must be the path of a file; got {short_repr(path)}")
    return Path(path)


def file_paths(path: object) -> list[Path]:
    """Return one path or several as a list; raise `InputError` for none or something else."""
    if isinstance(path, Sequence) and not isinstance(path, str | bytes):
        if not path:
            raise InputError("path must name at least one file; got none")
        return [file_path(item) for item in path]
    return [file_path(path)]


# Files that show measured values instead of holding them, by their first bytes.
PICTURES = {b"\x89PNG": "PNG", b"\xff\xd8\xff": "JPEG", b"GIF8": "GIF", b"%PDF": "PDF"}


def read_bytes(path: Path) -> bytes:
    """Return the content of a file; raise `FileError` if it cannot be read or is a picture."""
    if path.is_dir():
        raise FileError(f"{path}: expected a file; got a directory")
    try:
        content = path.read_bytes()
    except FileNotFoundError as error:
        raise FileError(f"{path}: cannot be read (no such file)") from error
    except (OSError, ValueError) as error:
        raise FileError(f"{path}: cannot be read ({error})") from error
    require_numbers(path, content)
    return content


def require_numbers(name: object, content: bytes) -> None:
    """Raise `FileError` if the content of a file is a picture."""
    for start, kind in PICTURES.items():
        if content.startswith(start):
            raise FileError(f"{name}: expected a file with measured values; got a picture ({kind})")


def read_text(path: Path) -> str:
    """Return the text of a file; raise `FileError` if it is unreadable or binary."""
    raw = read_bytes(path)
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return raw.decode("utf-16", errors="replace")
    if code := _wide(raw):
        return raw.decode(code, errors="replace")
    if raw.startswith(tuple(_BINARY)) or any(
        raw[:4096].count(code) for code in (*range(9), *range(14, 32))
    ):
        kind = next((k for start, k in _BINARY.items() if raw.startswith(start)), "binary data")
        raise FileError(f"{path}: expected a text file; got {kind}")
    eastern = [code for code, of in (("gb18030", _is_chinese), ("cp932", _is_japanese)) if of(raw)]
    for code in ("utf-8-sig", *eastern, "cp1252"):
        with suppress(UnicodeDecodeError):
            return raw.decode(code)
    return raw.decode("latin-1")


def _wide(raw: bytes) -> str:
    """Return the code of UTF-16 without a byte order mark, by its empty bytes, or nothing."""
    start = raw[:4096]
    for first, code in ((1, "utf-16-le"), (0, "utf-16-be")):
        half = start[first::2]
        if len(half) > 8 and half.count(0) > 0.9 * len(half) and not start[1 - first :: 2].count(0):
            return code
    return ""


_PART = 2**16  # bytes by which the lines of a file are counted


def lines_by_size(path: Path) -> float:
    """Return about how many lines a text has, by its size and its middle; 0 of other files."""
    size = path.stat().st_size
    with path.open("rb") as file:
        text = is_text(file.read(_PART))
        file.seek(max(0, (size - _PART) // 2))  # numbers grow: first lines are shorter
        part = file.read(_PART)
    return part.count(b"\n") * size / len(part) if text and part else 0.0


_BEYOND_ASCII = re.compile(rb"[\x80-\xff]+")


def is_text(raw: bytes) -> bool:
    """Return whether the content of a file is text: no empty bytes but those of UTF-16."""
    marked = raw.startswith((b"\xff\xfe", b"\xfe\xff"))
    return marked or bool(_wide(raw)) or not (b"\0" in raw or raw.startswith(tuple(_BINARY)))


def _is_chinese(raw: bytes) -> bool:
    """Return whether letters beyond ASCII are those of GB 2312, pairs of high bytes."""
    runs = _BEYOND_ASCII.findall(raw[:65536])
    pairs = [run[at : at + 2] for run in runs for at in range(0, len(run), 2)]
    ideographs = sum(b"\xb0" <= pair[:1] <= b"\xf7" for pair in pairs)
    return (
        bool(runs)
        and all(len(run) % 2 == 0 and min(run) >= 0xA1 for run in runs)
        and 2 * ideographs > len(pairs) > 1
    )


def _is_japanese(raw: bytes) -> bool:
    """Return whether letters beyond ASCII are pairs of Shift-JIS, whose first bytes are no letters.

    In other code pages those are quotation marks and dashes, before ASCII or a byte without one.
    """
    start = raw[:65536].rpartition(b"\n")[0]
    try:
        letters = [letter.encode("cp932") for letter in start.decode("cp932") if letter > "\x7f"]
    except UnicodeDecodeError:
        return False
    wide = [pair for pair in letters if len(pair) == 2 and pair[:1] < b"\xa0"]
    sure = [pair for pair in wide if pair[1:] > b"\x7f" or not b"\x91" <= pair[:1] <= b"\x97"]
    return bool(sure) and 2 * len(wide) >= len(letters)


def _first_row(path: Path, lines: list[Line], expected: str) -> tuple[int, str | None]:
    """Return the index of the first line of numbers, and its separator of cells."""
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
    """Raise `FileError` for a line that begins with a number as a row, but has a word in it."""
    for number, line in lines:
        cells = cells_of(line, separator)
        if not is_comment(line) and len(cells) in counts and is_number(cells[0]):
            fault = next(at for at, cell in enumerate(cells) if not fits(cell))
            raise FileError(
                f"{path}, line {number}: expected a number in column {fault + 1}; "
                f"got {short_repr(cells[fault])}; {MISSING_MARKS}"
            )


def _decimal_sign(path: Path, rows: list[list[str]], numbers: list[int]) -> str:
    first: dict[str, tuple[int, str]] = {}
    for sign, form in ((",", COMMA_NUMBER), (".", NUMBER)):
        for at, row in enumerate(rows):
            cell = next((cell for cell in row if sign in cell and form.fullmatch(cell)), None)
            if cell is not None:
                first[sign] = at, cell
                break
    if len(first) < 2:
        return next(iter(first), ".")
    (before, cell), (after, other) = sorted(first.values())
    raise FileError(
        f"{path}, line {numbers[after]}: expected one decimal sign throughout; "
        f"got {short_repr(other)} after {short_repr(cell)} in line {numbers[before]}"
    )


def _columns(
    above: list[str], count: int, kinds: Collection[str], named: Callable[[str], bool]
) -> list[ColumnTitle]:
    columns, units = [ColumnTitle()] * count, [""] * count
    for cells in filter(None, (_titles(line, count) for line in above)):
        bare = [cell.strip("()[] ") for cell in cells]
        # F is a unit and the title of a force: a line with the name of a quantity holds titles
        words = [cell for cell in bare if not _is_unit(cell, kinds)]
        other = any(named(word) or word.endswith(":") or is_number(word) for word in words)
        if len(words) < count and not other:
            units = bare
            continue
        titles = [_column_title(cell, kinds) for cell in cells]
        if any(named(title.name) or _is_unit(title.unit, kinds) for title in titles):
            columns = titles
    return [
        ColumnTitle(column.name, column.unit or unit or None)
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


def _column_title(title: str, kinds: Collection[str]) -> ColumnTitle:
    """Return name and unit of a title: x [mm], x / mm or, with a unit of `kinds`, x mm or x_mm."""
    for cut in _CUT.finditer(title):
        unit = cut[1] or cut[2]
        if _is_unit(unit, kinds):
            name = title[: cut.start()]
            factor = _FACTOR.search(name)  # a unit with it is unknown, so that it is asked for
            return ColumnTitle(name, f"{factor[0]} {unit}" if factor else unit)
    parts = _NAME_AND_UNIT.fullmatch(title)
    return ColumnTitle(parts[1], parts[2] or parts[3]) if parts else ColumnTitle(title)


def _is_unit(unit: str | None, kinds: Collection[str]) -> bool:
    return any(spelled(unit, kind) for kind in kinds)
