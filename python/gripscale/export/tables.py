"""Any result as plain tables: one for each set of dimensions, with units in the headings.

A row is a place on the dimensions of its table. What is padded in a result, rows in which every
value is missing, is left out of tables of two dimensions and more.
"""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.core import checks
from gripscale.io import netcdf
from gripscale.io.folders import make_folder, write_csv

if TYPE_CHECKING:
    import pandas as pd

SINGLE, ATTRIBUTES = "single_values", "attributes"


def tables_of(result: xr.Dataset | xr.DataTree) -> dict[str, pd.DataFrame]:
    """Return a result as tables by name: a Dataset, such as a prediction, or all groups of a tree.

    There is one for each set of dimensions, named by them, that of numbers without any first; then
    all attributes. Those of a group begin with its name. Raises `InputError` for anything else.
    """
    import pandas as pd

    if isinstance(result, xr.DataTree):
        parts = {
            node.path.strip("/").replace("/", "_"): node.to_dataset(inherit=False)
            for node in result.subtree
        }
    else:
        parts = {"": checks.instance("result", result, xr.Dataset)}
    tables, attributes = {}, []
    for group, data in parts.items():
        attributes += [(group, str(key), _text(value)) for key, value in data.attrs.items()]
        names: dict[tuple[str, ...], list[str]] = {}  # of variables, by their dimensions
        for name, variable in data.variables.items():
            owner = f"{group}/{name}" if group else str(name)
            attributes += [(owner, str(key), _text(value)) for key, value in variable.attrs.items()]
            names.setdefault(tuple(map(str, variable.dims)), []).append(str(name))
        used = {dim for dims, held in names.items() if held != list(dims) for dim in dims}
        for dims in sorted(names, key=len):
            held = [name for name in names[dims] if dims != (name,)]
            if held or dims[0] not in used:
                name = re.sub(r"\W", "_", "_".join(filter(None, [group, *(dims or [SINGLE])])))
                tables[name] = _table(data, dims, held)
    return {**tables, ATTRIBUTES: pd.DataFrame(attributes, columns=["of", "attribute", "value"])}


def _table(data: xr.Dataset, dims: tuple[str, ...], names: list[str]) -> pd.DataFrame:
    """Return variables over the places on their dimensions, numbers from 0 without coordinates."""
    import pandas as pd

    along = [data[dim] for dim in dims]
    places = np.meshgrid(*along, indexing="ij")
    columns = {
        _heading(dim, axis.variable, "" if axis.coords else "1"): values.ravel()
        for dim, axis, values in zip(dims, along, places, strict=True)
    }
    columns |= {_heading(name, data.variables[name]): data[name].values.ravel() for name in names}
    table = pd.DataFrame(columns)
    return table.dropna(how="all", subset=list(columns)[len(dims) :]) if len(dims) > 1 else table


def write_tables(result: xr.Dataset | xr.DataTree | str | Path, folder: str | Path) -> list[Path]:
    """Write a result, or that of a .nc file, as csv tables into a folder; return the files.

    The folder is made if it does not exist; files of the same names are replaced. Raises
    `InputError` if the result cannot be used, `FileError` if a file cannot be read or written.
    """
    tables = tables_of(netcdf.load_tree(result) if isinstance(result, str | Path) else result)
    target = Path(folder)
    make_folder(target)
    return [write_csv(table, target / f"{name}.csv") for name, table in tables.items()]


def _heading(name: str, variable: xr.Variable, unit: str = "") -> str:
    """Return a name with its unit; texts have none."""
    text = variable.dtype.kind in "OUS"
    unit = "" if text else str(variable.attrs.get("units", "")) or unit
    return f"{name} [{'-' if unit == '1' else unit}]" if unit else name


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    return json.dumps(value.tolist() if isinstance(value, np.ndarray | np.generic) else value)
