"""Any result as plain tables: one for each set of dimensions, with units in the headings.

A row is a place on the dimensions of its table. What is padded in a result, rows in which every
value is missing, is left out of tables of two dimensions and more.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.core import checks
from gripscale.io import netcdf
from gripscale.io.folders import make_folder
from gripscale.io.table import Column as Column
from gripscale.io.table import Table as Table
from gripscale.io.table import write_csv

SINGLE, ATTRIBUTES = "single_values", "attributes"


def tables_of(result: xr.Dataset | xr.DataTree) -> list[Table]:
    """Return a result as tables: a Dataset, such as a prediction, or all groups of a tree.

    There is one for each set of dimensions, named by them, that of numbers without any first; then
    all attributes. Those of a group begin with its name. Raises `InputError` for anything else.
    """
    if isinstance(result, xr.DataTree):
        parts = {
            node.path.strip("/").replace("/", "_"): node.to_dataset(inherit=False)
            for node in result.subtree
        }
    else:
        parts = {"": checks.instance("result", result, xr.Dataset)}
    tables = [table for group, data in parts.items() for table in _tables(group, data)]
    rows = []
    for group, data in parts.items():
        rows += [(group, str(key), _text(value)) for key, value in data.attrs.items()]
        for name, variable in data.variables.items():
            owner = f"{group}/{name}" if group else str(name)
            rows += [(owner, str(key), _text(value)) for key, value in variable.attrs.items()]
    texts = np.array(rows, dtype=object).reshape(len(rows), 3).T
    names = ("of", "attribute", "value")
    columns = [Column(name, values) for name, values in zip(names, texts, strict=True)]
    return [*tables, Table(ATTRIBUTES, tuple(columns))]


def write_tables(result: xr.Dataset | xr.DataTree | str | Path, folder: str | Path) -> list[Path]:
    """Write a result, or that of a .nc file, as csv tables into a folder; return the files.

    The folder is made if it does not exist; files of the same names are replaced. Raises
    `InputError` if the result cannot be used, `FileError` if a file cannot be read or written.
    """
    read = netcdf.load_tree(result) if isinstance(result, str | Path) else result
    tables = tables_of(read)
    target = Path(folder)
    make_folder(target)
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
        along = [data[dim] for dim in dims]  # of a dimension without coordinate a number from 0
        full = np.meshgrid(*along, indexing="ij")
        places = [
            Column(
                str(axis.name), values.ravel(), unit=_unit(axis.variable) if axis.coords else "1"
            )
            for axis, values in zip(along, full, strict=True)
        ]
        columns = []
        for name in by_dimensions[dims]:
            variable = data.variables[name]
            columns.append(Column(name, np.asarray(variable.values).ravel(), unit=_unit(variable)))
        if len(dims) > 1:
            kinds = [(c.values, c.values.dtype.kind) for c in columns]
            missing = [np.isnan(v) if kind == "f" else np.zeros(len(v), bool) for v, kind in kinds]
            kept = ~np.all(missing, axis=0)
            columns, places = (
                [column.of(column.values[kept]) for column in part] for part in (columns, places)
            )
        name = re.sub(r"\W", "_", "_".join(filter(None, [group, *(dims or [SINGLE])])))
        yield Table(name, (*places, *columns))


def _unit(variable: xr.Variable) -> str:
    return "" if variable.dtype.kind in "OUS" else str(variable.attrs.get("units", ""))


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    return json.dumps(value.tolist() if isinstance(value, np.ndarray | np.generic) else value)
