"""Tables as an Excel file: a sheet for each, whose first row stays in sight."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gripscale.core.errors import InputError
from gripscale.io.netcdf import write_whole
from gripscale.io.table import Table

if TYPE_CHECKING:
    from xlsxwriter.worksheet import Worksheet

_MOST_ROWS = 1_048_576
MOST_LETTERS = 32_767
MOST_TITLE = 31
CUT = " ... [cut: longer than a cell of a workbook; csv has all of it]"
# What XML 1.0 cannot hold.
_NO_LETTER = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
_WIDEST = 40


def write_workbook(tables: Sequence[Table], path: Path) -> Path:
    """Write tables as the sheets of an xlsx file; return its path.

    Missing values are empty cells, infinite ones texts; texts longer than a cell are cut and say
    so. Raises `InputError` if a table has more rows than a sheet, `FileError` if the file cannot be
    written.
    """
    import xlsxwriter  # 50 ms, only for what writes a workbook

    titles: list[str] = []  # no two alike, also where large and small letters are
    for table in tables:
        title, number = table.name[:MOST_TITLE], 2
        while title.lower() in map(str.lower, titles):
            end = f"_{number}"
            title, number = table.name[: MOST_TITLE - len(end)] + end, number + 1
        titles.append(title)
    sheets = [[table.titles, *table.rows()] for table in tables]
    for title, rows in zip(titles, sheets, strict=True):
        if len(rows) > _MOST_ROWS:
            raise InputError(
                f"tables must have at most {_MOST_ROWS - 1} rows for xlsx; got {len(rows) - 1} in "
                f"{title}: csv has no limit"
            )

    def write(part: Path) -> None:
        with part.open("wb") as file, xlsxwriter.Workbook(file) as book:
            for title, rows in zip(titles, sheets, strict=True):
                sheet = book.add_worksheet(title)
                sheet.freeze_panes(1, 0)
                for column, heading in enumerate(rows[0]):
                    sheet.set_column(column, column, min(max(len(heading) + 2, 9), _WIDEST))
                for row, values in enumerate(rows):
                    for column, value in enumerate(values):
                        _write_cell(sheet, row, column, value)

    return write_whole(path, write)


def _write_cell(sheet: Worksheet, row: int, column: int, value: Any) -> None:
    """Write a number, truth or text, which is cut where it is longer than a cell."""
    if isinstance(value, bool):
        sheet.write_boolean(row, column, value)
    elif isinstance(value, float | int) and math.isfinite(value):
        sheet.write_number(row, column, value)
    elif value is not None:  # a text stays a text, whatever it begins with
        text = _NO_LETTER.sub("?", str(value))
        if len(text) > MOST_LETTERS:
            text = text[: MOST_LETTERS - len(CUT)] + CUT
        sheet.write_string(row, column, text)
