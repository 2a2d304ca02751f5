"""Young's moduli of the rows of a table, from what instruments print of them.

The modulus is told by two of E', E'', tan delta and |E*|:

    E'' = E' tan d,   E' = E''/tan d,   E' = |E*|/sqrt(1 + tan^2 d)

A shear modulus becomes the Young's modulus of the incompressible solid by E = 3 G.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.errors import FileError, InputError
from gripscale.rubber.stated import MODULI, PAIRS, Stated, missing
from gripscale.textfile import TextTable
from gripscale.units import in_si

Array = NDArray[np.float64]

_ROUNDING = 0.05
"""Relative error of a loss factor by the digits it is printed with."""


def young_moduli(
    table: TextTable, stated: Stated, numbers: Callable[[TextTable, int, str], Array] | None = None
) -> tuple[Array, Array]:
    """Return E' and E'' [Pa] of each row.

    `numbers` reads a column of a quantity; by default NaN where a value is missing.

    Raises `InputError` if columns, units or the kind of modulus are not known, or the loss factor
    beside E' and E'' is E'/E''.
    """
    read = above_zero if numbers is None else numbers
    places = {one: stated.column(table, one) for one in MODULI}
    there = {one: at for one, at in places.items() if at is not None}
    pair = next((pair for pair in PAIRS if set(pair) <= set(there)), None)
    if pair is None:
        raise missing(table, "modulus as two of storage, loss, loss_factor, magnitude", "columns")
    in_pascal = [there[one] for one in pair if one != "loss_factor"]
    size = in_si(1.0, stated.unit(table, in_pascal, "modulus"), "modulus")
    size *= 3.0 if stated.modulus_of(table, in_pascal) == "G" else 1.0
    values = {
        one: read(table, there[one], one) * (1.0 if one == "loss_factor" else size) for one in pair
    }
    if pair == ("storage", "loss"):
        _check_factor(table, there, values["storage"], values["loss"])
        return values["storage"], values["loss"]
    factor = values["loss_factor"]
    if "storage" in values:
        return values["storage"], values["storage"] * factor
    if "loss" in values:
        return values["loss"] / factor, values["loss"]
    storage = values["magnitude"] / np.sqrt(1.0 + factor**2)
    return storage, storage * factor


def _check_factor(table: TextTable, there: dict[str, int], storage: Array, loss: Array) -> None:
    """Refuse a table whose loss factor is that of its storage and loss modulus exchanged."""
    if "loss_factor" not in there:
        return
    printed = np.log(np.abs(table.numbers(there["loss_factor"], "a finite number", missing=True)))
    own = np.log(loss / storage)
    known = np.isfinite(printed) & np.isfinite(own)
    if not known.any():
        return
    off, exchanged = (np.median(np.abs(printed + sign * own)[known]) for sign in (-1.0, 1.0))
    if exchanged < _ROUNDING < off:
        raise InputError(
            f"{table.path}: storage and loss modulus look exchanged, because the loss factor of "
            "the file is their quotient the other way round; columns must name them as they are"
        )


def above_zero(table: TextTable, column: int, wanted: str) -> Array:
    """Return a column of numbers above zero, NaN where missing; `FileError` names other lines."""
    values = table.numbers(column, "a finite number", missing=True)
    good = (values >= checks.LEAST) & (values <= checks.MOST)
    span = f"{checks.LEAST:g} to {checks.MOST:g}"
    expected = f"a {wanted.replace('_', ' ')} above zero, {span},"
    check_rows(table, column, good, values, expected)
    return values


def check_rows(
    table: TextTable, column: int, good: NDArray[np.bool_], values: Array, expected: str
) -> None:
    """Raise `FileError`, naming the line, unless all `values` are `good` or missing."""
    bad = ~good & ~np.isnan(values)
    if bad.any():
        at = int(np.argmax(bad))
        raise FileError(
            f"{table.path}, line {table.line_numbers[at]}: expected {expected} in column "
            f"{table.columns[column].name or column + 1}; got {table.rows[at][column]}"
        )
