"""A Prony series in a table of relaxation times and moduli, such as tau [s] and E_i [MPa].

The modulus of a relaxation time of inf is the equilibrium modulus. Shear moduli are taken three
times, as everywhere.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from gripscale.core import FileError, GripscaleError
from gripscale.core.units import quantity_in_si, spelled
from gripscale.io.text_table import TextTable, is_excel, read_bytes, read_table
from gripscale.rubber.columns import FileLayout

_TIME = re.compile(r"\W*(tau|τ|relax\w*[ _-]?(time|zeit)|temps de relax)", re.IGNORECASE)
_MODULUS = re.compile(r"\W*([EG]_?[ijkn\d]?$|(young|shear|relax\w*)?[ _-]?modul)", re.IGNORECASE)
_MOST_BYTES = 100_000  # of a table with a row for each term


def _table(path: Path) -> tuple[TextTable, int, int] | None:
    if is_excel(path) or len(read_bytes(path)) > _MOST_BYTES:
        return None
    try:
        table = read_table(
            path,
            "rows of relaxation time and modulus",
            kinds=("time", "modulus"),
            named=lambda name: bool(_TIME.match(name)),
        )
    except GripscaleError:
        return None
    times, moduli = (
        [at for at, name in enumerate(table.names) if p.match(name)] for p in (_TIME, _MODULUS)
    )
    return (table, times[0], moduli[0]) if len(times) == len(moduli) == 1 else None


def holds_prony_table(path: Path) -> bool:
    """Return whether a file is a table of relaxation times and moduli, by its titles."""
    return path.is_file() and _table(path) is not None


def read_prony_table(
    path: Path, *, modulus: str | None = None, modulus_unit: str | None = None
) -> dict[str, object]:
    """Return what `Rubber.from_dict` needs: moduli [Pa], relaxation times [s], equilibrium modulus.

    `modulus` is E or G and `modulus_unit` a unit, where the titles do not say. Raises `FileError`
    and `InputError` for a table that lacks one of these.
    """
    columns = _table(path)
    if columns is None:
        raise FileError(f"{path}: expected columns of relaxation time and modulus")
    table, time, column = columns
    layout = FileLayout(modulus=modulus, modulus_unit=modulus_unit)
    unit, kind = layout.unit(table, column, "modulus"), layout.modulus_of(table, [column])
    times = table.numbers(time, "a relaxation time", missing=True)
    times *= quantity_in_si(1.0, spelled(table.columns[time].unit, "time") or "s", "time")
    values = quantity_in_si(table.numbers(column, "a modulus"), unit, "modulus")
    values = values * (3.0 if kind == "G" else 1.0)
    endless = np.isnan(times)
    if endless.sum() != 1:
        raise FileError(
            f"{path}: expected one row with inf as relaxation time, the equilibrium modulus; got "
            f"{int(endless.sum())} among {len(times)} rows"
        )
    return {
        "equilibrium_modulus": float(values[endless][0]),
        "moduli": values[~endless].tolist(),
        "relaxation_times": times[~endless].tolist(),
    }
