"""Sheets of an Excel file as rows of cells."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from gripscale.errors import FileError

Rows = list[tuple[object, ...]]


def read_sheets(path: Path) -> dict[str, Rows]:
    """Return the rows of each sheet by its name, in the order of the file.

    Raises `FileError` if openpyxl is missing (`pip install gripscale[formats]`), or the file is no
    xlsx file or has no sheet of cells.
    """
    if not path.is_file():
        raise FileError(f"{path}: no such file")
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
