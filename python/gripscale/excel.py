"""Sheets of an Excel file as rows of cells, and as the lines a text file would have."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from gripscale import checks
from gripscale.cells import Line, is_row
from gripscale.errors import FileError, InputError

EXCEL = (".xlsx", ".xlsm")
"""Suffixes of the files that are read as Excel's."""

Rows = list[tuple[object, ...]]


def is_excel(path: Path) -> bool:
    """Return whether a file is read as Excel's, by its suffix."""
    return path.suffix.lower() in EXCEL


def read_sheets(path: Path) -> dict[str, Rows]:
    """Return the rows of each sheet by its name, in the order of the file.

    Raises `FileError` if openpyxl is missing (`pip install gripscale[formats]`), or the file is no
    xlsx file or has no sheet of cells.
    """
    if path.is_dir():
        raise FileError(f"{path}: expected a file; got a directory")
    if not path.is_file():
        raise FileError(f"{path}: cannot be read (no such file)")
    if not path.stat().st_size:
        raise FileError(f"{path}: expected an xlsx file; got an empty file")
    try:
        openpyxl = import_module("openpyxl")
    except ImportError as error:
        raise FileError(f"{path}: xlsx needs openpyxl: pip install gripscale[formats]") from error
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
