"""Columns, channels and sheets of a file, as a case names or counts them."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BeforeValidator

from gripscale.case.expected import Words
from gripscale.rubber.stated import columns_of

COLUMN = "its name or its number from 1"
COLUMNS = (
    "three names or numbers from 1, of frequency, storage and loss modulus, or a table such as "
    "{ frequency = 1, storage = 2, loss_factor = 4 }"
)


def _column(value: Any) -> str | int:
    """Accept the name or the number of a column, a channel or a sheet."""
    if isinstance(value, bool) or not isinstance(value, str | int):
        raise ValueError(f"expected {COLUMN}")
    if isinstance(value, int) and value < 1:
        raise ValueError("columns, channels and sheets are counted from 1")
    return value


def _columns(value: Any) -> dict[str, str | int]:
    """Accept three columns, or a table of them by quantity."""
    if not isinstance(value, dict | list):
        raise ValueError(f"expected {COLUMNS}")
    return {name: _column(column) for name, column in columns_of(value).items()}


Column = Annotated[str | int, BeforeValidator(_column), Words(COLUMN)]
Columns = Annotated[dict[str, str | int], BeforeValidator(_columns), Words(COLUMNS)]
