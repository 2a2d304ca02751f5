"""Tables into CSV files and Excel workbooks."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator, Sequence
from importlib import import_module
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
    book = openpyxl.Workbook(write_only=True)
    taken: set[str] = set()
    for table in tables:
        sheet = book.create_sheet(_title(table.name, taken))
        sheet.freeze_panes = "A2"
        for count, row in enumerate((table.titles, *table.rows()), start=1):
            if count > MOST_ROWS:
                raise InputError(
                    f"tables must have at most {MOST_ROWS - 1} rows for xlsx; got more in "
                    f"{table.name}: csv has no limit"
                )
            sheet.append([_cell(cell_of, sheet, value) for value in row])

    return write_whole(path, book.save)


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


def _title(name: str, taken: set[str]) -> str:
    """Return a title no other sheet has, also where large and small letters are alike."""
    title, number = name[:MOST_TITLE], 2
    while title.lower() in taken:
        end = f"_{number}"
        title, number = name[: MOST_TITLE - len(end)] + end, number + 1
    taken.add(title.lower())
    return title
