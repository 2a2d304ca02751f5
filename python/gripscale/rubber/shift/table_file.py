"""Shift tables as CSV files, to be looked at, edited and given back.

    # reference temperature (C): 20
    temperature (C),log10 a_T,standard error of log10 a_T,b_T,standard error of log10 b_T

Only the first two columns are needed; the sign is that of E*(w, T) = E*(a_T w, T_ref)/b_T.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.netcdf import write_whole
from gripscale.rubber.shift.base import Array
from gripscale.rubber.shift.table import ShiftTable
from gripscale.textfile import TextTable, file_path, read_table, read_text
from gripscale.units import ZERO_CELSIUS, in_si, listed, spelled

_TITLES = (
    "temperature (C)",
    "log10 a_T",
    "standard error of log10 a_T",
    "b_T",
    "standard error of log10 b_T",
)
_REFERENCE = re.compile(r"^\s*[#%!].*reference temperature \((\w)\):\s*([-+.\deE]+)", re.MULTILINE)
_DECIMALS = 6
"""Of a temperature in degrees Celsius: 20.1, not 20.100000000000023."""


def write_shift_table(path: str | Path, table: ShiftTable) -> Path:
    """Write a shift table as CSV, in degrees Celsius; return the path.

    Raises `FileError` if it cannot be written.
    """
    checks.instance("table", table, ShiftTable)
    columns = (
        np.round(table.temperature - ZERO_CELSIUS, _DECIMALS),
        table.horizontal,
        table.horizontal_error,
        10.0**table.vertical,
        table.vertical_error,
    )
    lines = ["# E*(w, T) = E*(a_T w, T_ref) / b_T"]
    if table.reference_temperature is not None:
        celsius = round(table.reference_temperature - ZERO_CELSIUS, _DECIMALS)
        lines.append(f"# reference temperature (C): {celsius!r}")
    lines.append(",".join(_TITLES))
    lines += [",".join(repr(float(v)) for v in row) for row in zip(*columns, strict=True)]
    text = "\n".join(lines) + "\n"
    return write_whole(file_path(path), lambda part: _write(part, text))


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def read_shift_table(path: str | Path, *, temperature_unit: str | None = None) -> ShiftTable:
    """Read a shift table from CSV or text, such as `write_shift_table` writes.

    Titles that say temperature and log a (log10 a_T, log_aT, log aT) name the columns; b, log b and
    errors are read where they are.

    Parameters
    ----------
    path : str or Path
        The file.
    temperature_unit : {"K", "C", "F"}, optional
        Unit of the temperatures, if the header does not state it.

    Returns
    -------
    ShiftTable
        In K, log10 a_T and log10 b_T, with the reference temperature the file states, if any.

    Raises
    ------
    FileError
        If the file cannot be read or has no such columns.
    InputError
        If the unit of the temperatures is neither stated nor given, or the numbers are no table.
    """
    place = file_path(path)
    table = read_table(
        place,
        "rows of temperature and log10 a_T",
        kinds=("temperature",),
        named=lambda name: _meaning(name) is not None,
    )
    found = {_meaning(name): at for at, name in enumerate(table.names)}
    if not {"temperature", "log_a"} <= set(found):
        raise FileError(
            f"{place}: expected columns of temperature and log10 a_T; the header has "
            f"{', '.join(table.names) or 'no names'}"
        )
    columns = {str(name): table.numbers(at, "a number", missing=True) for name, at in found.items()}
    kelvin = in_si(
        columns["temperature"], _unit(table, found["temperature"], temperature_unit), "temperature"
    )
    vertical = columns.get("log_b")
    if vertical is None and "b" in columns:
        vertical = _logarithm(place, columns["b"])
    try:
        return ShiftTable(
            kelvin,
            columns["log_a"],
            columns.get("log_a_error"),
            vertical,
            columns.get("log_b_error"),
            _reference(place),
        )
    except InputError as error:
        raise InputError(f"{place}: {error}") from error


def _meaning(name: str) -> str | None:
    """Return which column of a shift table a title means."""
    low = re.sub(r"[\s_]+", "", name.lower())
    if low.startswith("t") and (low == "t" or low.startswith("temp")):
        return "temperature"
    factor = next((one for one in "ab" if re.search(rf"(^|log(10)?|of|error){one}t?$", low)), None)
    if factor is None:
        return None
    if "error" in low or "uncertainty" in low:
        return f"log_{factor}_error"
    return f"log_{factor}" if "log" in low else (factor if factor == "b" else None)


def _unit(table: TextTable, column: int, given: str | None) -> str:
    written = given or table.columns[column].unit
    if written is None or spelled(written, "temperature") is None:
        raise InputError(
            f"{table.path}: temperature_unit must be given ({listed('temperature')}), because the "
            f"header states {'none' if written is None else repr(written)}"
        )
    return written


def _logarithm(path: Path, b: Array) -> Array:
    if not (b > 0.0).all():
        raise FileError(f"{path}: expected b_T above zero; got {np.nanmin(b):g}")
    return np.asarray(np.log10(b))


def _reference(path: Path) -> float | None:
    found = _REFERENCE.search(read_text(path))
    if found is None:
        return None
    try:
        return float(in_si(float(found[2]), found[1], "temperature"))
    except ValueError as error:
        raise FileError(
            f"{path}: expected a number as reference temperature; got {found[2]}"
        ) from error
