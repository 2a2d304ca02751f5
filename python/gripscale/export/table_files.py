"""Tables into CSV files and Excel workbooks."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any, Protocol

from gripscale.errors import FileError, InputError
from gripscale.netcdf import write_whole

MOST_ROWS = 1_048_576
"""Rows of a sheet, its heading included."""
MOST_LETTERS = 32_767
"""Letters of a cell."""
MOST_TITLE = 31
"""Letters of the title of a sheet."""
CUT = " ... [cut: longer than a cell of a workbook; csv has all of it]"
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")


class Rows(Protocol):
    """A table, as far as it is written."""

    @property
    def name(self) -> str:
        """Name of the table."""

    @property
    def titles(self) -> list[str]:
        """The heading."""

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """Yield rows of numbers and texts, None where a value is missing."""


def write_csv(table: Rows, path: Path) -> Path:
    """Write a table as CSV: commas, points, UTF-8, numbers to their last digit; return the path.

    Missing values are empty cells. Raises `FileError` if it cannot be written.
    """

    def write(part: Path) -> None:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(table.titles)
            writer.writerows(table.rows())

    return write_whole(path, write)


def write_workbook(tables: Sequence[Rows], path: Path) -> Path:
    """Write tables as the sheets of an xlsx file; return its path.

    Missing values are empty cells, infinite ones texts; texts longer than a cell are cut and say
    so.

    Raises
    ------
    InputError
        If a table has more rows than a sheet.
    FileError
        If openpyxl is missing (`pip install gripscale[export]`) or the file cannot be written.
    """
    try:
        openpyxl = import_module("openpyxl")
        cell_of = import_module("openpyxl.cell").WriteOnlyCell
    except ImportError as error:
        raise FileError(f"{path}: xlsx needs openpyxl: pip install gripscale[export]") from error
    titles = _titles([table.name for table in tables])
    filled = {
        title: [table.titles, *table.rows()] for title, table in zip(titles, tables, strict=True)
    }
    for title, rows in filled.items():
        if len(rows) > MOST_ROWS:
            raise InputError(
                f"tables must have at most {MOST_ROWS - 1} rows for xlsx; got {len(rows) - 1} in "
                f"{title}: csv has no limit"
            )
    book = openpyxl.Workbook(write_only=True)
    for title, rows in filled.items():
        sheet = book.create_sheet(title)
        sheet.freeze_panes = "A2"
        for row in rows:
            sheet.append([_cell(cell_of, sheet, value) for value in row])
    content = BytesIO()
    book.save(content)

    def write(part: Path) -> None:
        part.write_bytes(content.getvalue())

    return write_whole(path, write)


def _cell(cell_of: Any, sheet: Any, value: Any) -> Any:
    """Return what stands in a cell; texts as texts, whatever they begin with."""
    if isinstance(value, float) and math.isinf(value):
        value = "inf" if value > 0.0 else "-inf"
    if not isinstance(value, str):
        return value
    plain = _CONTROL.sub("?", value)
    if len(plain) > MOST_LETTERS:
        plain = plain[: MOST_LETTERS - len(CUT)] + CUT
    cell = cell_of(sheet, plain)
    cell.data_type = "s"
    return cell


def _titles(names: Sequence[str]) -> list[str]:
    """Return titles of sheets, no two alike, also where large and small letters are."""
    titles: list[str] = []
    for name in names:
        title, number = name[:MOST_TITLE], 2
        while title.lower() in map(str.lower, titles):
            end = f"_{number}"
            title, number = name[: MOST_TITLE - len(end)] + end, number + 1
        titles.append(title)
    return titles
