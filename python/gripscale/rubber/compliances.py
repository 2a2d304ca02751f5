"""Compliances J', J'' of shear or D', D'' of tension in place of moduli.

    G' = J'/(J'^2 + J''^2),   G'' = J''/(J'^2 + J''^2)

as G* = 1/J* with J* = J' - i J'' (J. D. Ferry, Viscoelastic Properties of Polymers (1980), ch. 1).
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np

from gripscale.core import FileError
from gripscale.core.units import listed, quantity_in_si, spelled
from gripscale.io.text_table import ColumnTitle, TextTable
from gripscale.rubber.columns import PRIMES

_PAIR = re.compile(r"([JD])'(?!')"), re.compile(r"([JD])''")


def with_moduli(table: TextTable) -> TextTable:
    """Return a table with moduli [Pa] in place of compliances, or as it is without both of them.

    Raises `FileError` if a title does not state the unit.
    """
    names = [name.translate(PRIMES) for name in table.names]
    hits = [[at for at, name in enumerate(names) if part.match(name)] for part in _PAIR]
    if any(len(columns) != 1 for columns in hits):
        return table
    parts = []
    for (at,) in hits:
        unit = spelled(table.columns[at].unit, "compliance")
        if unit is None:
            units = listed("compliance")
            raise FileError(
                f"{table.path}: expected {names[at]} in {units}; got {table.columns[at].unit}"
            )
        compliance = table.numbers(at, "a compliance", missing=True)
        parts.append(quantity_in_si(compliance, unit, "compliance"))
    letter = "G" if names[hits[0][0]].startswith("J") else "E"
    rows, columns = [[*row] for row in table.rows], [*table.columns]
    with np.errstate(divide="ignore", invalid="ignore"):
        moduli = [part / (parts[0] ** 2 + parts[1] ** 2) for part in parts]
    for (at,), values, primes in zip(hits, moduli, ("'", "''"), strict=True):
        columns[at] = ColumnTitle(f"{letter}{primes}", "Pa")
        for row, value in zip(rows, values, strict=True):
            row[at] = repr(float(value)).replace(".", table.decimal)
    return replace(table, columns=columns, rows=rows)
