"""Any result as plain tables: one for each set of dimensions, with units in the headings.

A row is a place on the dimensions of its table. What is padded in a result, rows in which every
value is missing, is left out of tables of two dimensions and more.
"""

from __future__ import annotations

import csv
import json
import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.case import folder as folders
from gripscale.core import checks
from gripscale.core.errors import InputError
from gripscale.io import netcdf
from gripscale.io.netcdf import write_whole
from gripscale.io.text_table import import_openpyxl

# Tables into CSV files and Excel workbooks.

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
        If openpyxl is missing (`pip install 'gripscale[export]'`) or the file cannot be written.
    """
    openpyxl = import_openpyxl(path)
    cell_of = import_module("openpyxl.cell").WriteOnlyCell
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


WORKBOOK = "tables.xlsx"
SINGLE, ATTRIBUTES = "single_values", "attributes"


@dataclass(frozen=True)
class Column:
    """A column of a table."""

    name: str
    unit: str
    """As a result states it; "1" is none, empty for text."""
    values: NDArray[Any] = field(repr=False)
    """Shape (rows,)."""

    @property
    def title(self) -> str:
        """Name and unit, as in `friction [-]`."""
        return f"{self.name} [{'-' if self.unit == '1' else self.unit}]" if self.unit else self.name

    @property
    def missing(self) -> NDArray[np.bool_]:
        """Whether each value is missing: NaN."""
        if self.values.dtype.kind == "f":
            return np.asarray(np.isnan(self.values))
        return np.zeros(len(self.values), dtype=bool)


@dataclass(frozen=True)
class Table:
    """A table with a name that is good for a file."""

    name: str
    columns: tuple[Column, ...]

    @property
    def titles(self) -> list[str]:
        """The heading."""
        return [column.title for column in self.columns]

    def rows(self) -> Iterator[tuple[Any, ...]]:
        """Yield the rows as numbers and texts of Python, None where a value is missing."""
        yield from zip(*(_plain(column) for column in self.columns), strict=True)


def tables_of(result: xr.Dataset | xr.DataTree) -> list[Table]:
    """Return a result as tables.

    Parameters
    ----------
    result : Dataset or DataTree
        A prediction, a study, a comparison or any other Dataset; of a tree all groups.

    Returns
    -------
    list of Table
        One for each set of dimensions, named by them, that of numbers without any first; then all
        attributes. Those of a group begin with its name.

    Raises
    ------
    InputError
        If it is neither.
    """
    if isinstance(result, xr.DataTree):
        parts = {
            node.path.strip("/").replace("/", "_"): node.to_dataset(inherit=False)
            for node in result.subtree
        }
    else:
        parts = {"": checks.instance("result", result, xr.Dataset)}
    tables = [table for group, data in parts.items() for table in _tables(group, data)]
    rows = [row for group, data in parts.items() for row in _attributes(group, data)]
    texts = np.array(rows, dtype=object).reshape(len(rows), 3).T
    names = ("of", "attribute", "value")
    columns = [Column(name, "", values) for name, values in zip(names, texts, strict=True)]
    return [*tables, Table(ATTRIBUTES, tuple(columns))]


def write_tables(
    result: xr.Dataset | xr.DataTree | str | Path, folder: str | Path, *, format: str = "csv"
) -> list[Path]:
    """Write a result as tables into a folder; return the files.

    Parameters
    ----------
    result : Dataset, DataTree, str or Path
        A result, or the .nc file of one.
    folder : str or Path
        Made if it does not exist; files of the same names are replaced.
    format : str
        csv, a file for each table, or xlsx, one workbook `tables.xlsx` with a sheet for each.

    Raises
    ------
    InputError
        If the result or the format cannot be used, or a table has more rows than a sheet.
    FileError
        If a file cannot be read or written, or openpyxl is missing for xlsx.
    """
    checks.one_of("format", format, ["csv", "xlsx"])
    read = netcdf.load_tree(result) if isinstance(result, str | Path) else result
    tables = tables_of(read)
    target = Path(folder)
    folders.make(target)
    if format == "xlsx":
        return [write_workbook(tables, target / WORKBOOK)]
    return [write_csv(table, target / f"{table.name}.csv") for table in tables]


def _tables(group: str, data: xr.Dataset) -> Iterator[Table]:
    """Yield the tables of one Dataset, fewest dimensions first."""
    by_dimensions: dict[tuple[str, ...], list[str]] = {}
    for name, variable in data.variables.items():
        dims = tuple(map(str, variable.dims))
        if dims != (name,):
            by_dimensions.setdefault(dims, []).append(str(name))
    used = {dim for dims in by_dimensions for dim in dims}
    by_dimensions |= {(str(index),): [] for index in data.indexes if str(index) not in used}
    for dims in sorted(by_dimensions, key=len):
        places = [_place(data, dims, dim) for dim in dims]
        columns = [_column(name, data.variables[name]) for name in by_dimensions[dims]]
        if len(dims) > 1:
            kept = ~np.all([column.missing for column in columns], axis=0)
            columns = [_chosen(column, kept) for column in columns]
            places = [_chosen(place, kept) for place in places]
        name = re.sub(r"\W", "_", "_".join(filter(None, [group, *(dims or [SINGLE])])))
        yield Table(name, (*places, *columns))


def _place(data: xr.Dataset, dims: tuple[str, ...], dim: str) -> Column:
    """Return where each row stands along one dimension: its coordinate, or a number from 0."""
    along = data.variables.get(dim)
    values = np.arange(data.sizes[dim]) if along is None else along.values
    shape = [data.sizes[other] if other == dim else 1 for other in dims]
    full = np.broadcast_to(values.reshape(shape), [data.sizes[other] for other in dims])
    return Column(dim, "1" if along is None else _unit(along), full.ravel())


def _column(name: str, variable: xr.Variable) -> Column:
    return Column(name, _unit(variable), np.asarray(variable.values).ravel())


def _chosen(column: Column, kept: NDArray[np.bool_]) -> Column:
    return Column(column.name, column.unit, column.values[kept])


def _unit(variable: xr.Variable) -> str:
    return "" if variable.dtype.kind in "OUS" else str(variable.attrs.get("units", ""))


def _attributes(group: str, data: xr.Dataset) -> Iterator[tuple[str, str, str]]:
    yield from ((group, str(key), _text(value)) for key, value in data.attrs.items())
    for name, variable in data.variables.items():
        owner = f"{group}/{name}" if group else str(name)
        yield from ((owner, str(key), _text(value)) for key, value in variable.attrs.items())


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    return json.dumps(value.tolist() if isinstance(value, np.ndarray | np.generic) else value)


def _plain(column: Column) -> list[Any]:
    kind = column.values.dtype.kind
    if kind not in "fiubOUS":
        raise InputError(
            f"{column.name} must hold numbers or texts to be a column; got {column.values.dtype}"
        )
    values = column.values.tolist()
    return [None if gone else one for one, gone in zip(values, column.missing, strict=True)]
