"""Predictions side by side: totals with their ranges, differences to the first, in a table."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import xarray as xr
from rich.table import Table

from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant

QUANTITIES = ("total_contact_fraction", "total_friction")


class Row(NamedTuple):
    """One prediction: what it is called, its part of the Dataset, whether it is the first."""

    name: str
    one: xr.Dataset
    first: bool


def totals_table(head: str, rows: Iterable[Row], title: str | None = None) -> Table:
    """Return the totals of predictions with their ranges, and the difference to the first."""
    table = printed_table(title)
    table.add_column(head, no_wrap=True)
    for text in ("A_r/A_0", "range", "μ", "range", "μ less that\nof the first", "range"):
        table.add_column(text, justify="right")
    told = list(rows)
    failed = any(status(row.one) != "converged" for row in told)
    if failed:
        table.add_column("status", overflow="fold")
    for row in told:
        table.add_row(row.name, *totals_cells(row), *([status(row.one)] if failed else []))
    return table


def totals_cells(row: Row) -> list[str]:
    """Return area, friction and its difference to the first, each with its range."""
    cells = [
        cell
        for quantity in QUANTITIES
        for cell in (significant(float(row.one[quantity])), _range(row.one, quantity))
    ]
    return [*cells, *(["-", "-"] if row.first else _difference(row.one))]


def status(one: xr.Dataset) -> str:
    """Return "converged", or why there are no totals."""
    return str(one.prediction_status.item())


def difference_words(one: xr.Dataset, name: str, first: str, measured: str) -> str:
    """Return by how much friction differs from the first, and whether beyond what is `measured`.

    Nothing where one of both has no friction.
    """
    difference = float(one.total_friction_difference)
    if math.isnan(difference):
        return ""
    word = "more" if difference > 0.0 else "less"
    text = f"{name} has {significant(abs(difference))} {word} friction than {first}"
    low, high = (float(one.get(f"total_friction_difference_{end}", math.nan))
                 for end in ("low", "high"))  # fmt: skip
    if math.isnan(low + high):
        return text
    beyond = low > 0.0 or high < 0.0
    return f"{text}, {'' if beyond else 'not '}beyond what {measured} leave open"


def _range(one: xr.Dataset, quantity: str) -> str:
    if f"{quantity}_low" not in one or math.isnan(float(one[f"{quantity}_low"])):
        return "-"
    ends = (significant(float(one[f"{quantity}_{end}"])) for end in ("low", "high"))
    return " to ".join(ends)


def _difference(one: xr.Dataset) -> list[str]:
    name = "total_friction_difference"
    value = float(one[name])
    shown = "-" if math.isnan(value) else f"{value:+.3f}"
    if f"{name}_low" not in one or math.isnan(float(one[f"{name}_low"])):
        return [shown, "-"]
    ends = (f"{float(one[f'{name}_{end}']):+.3f}" for end in ("low", "high"))
    return [shown, " to ".join(ends)]
