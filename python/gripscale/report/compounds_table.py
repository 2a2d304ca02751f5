"""Compounds side by side as a table, and in sentences which wave and relaxation times differ."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr
from rich import box
from rich.table import Table

from gripscale.figures.palette import MILLI
from gripscale.figures.style import power_of_ten
from gripscale.report.tables import significant


def compounds_table(data: xr.Dataset) -> Table:
    """Return totals of each compound with their ranges, and differences to the first."""
    table = Table(box=box.SIMPLE_HEAD, padding=(0, 1, 0, 0), pad_edge=False)
    table.add_column("compound", no_wrap=True)
    for head in (
        "A_r/A_0",
        "range",
        "μ",
        "range",
        "μ less that\nof the first",
        "range",
    ):
        table.add_column(head, justify="right")
    failed = (data.prediction_status != "converged").any()
    if failed:
        table.add_column("status", overflow="fold")
    for i, name in enumerate(data.rubber.values.tolist()):
        one = data.isel(rubber=i)
        cells = [
            cell
            for quantity in ("total_contact_fraction", "total_friction")
            for cell in (significant(float(one[quantity])), _range(one, quantity))
        ]
        cells += ["-", "-"] if i == 0 else _difference(one)
        table.add_row(name, *cells, *([str(one.prediction_status.item())] if failed else []))
    return table


def compounds_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each compound, whether it differs from the first and what makes the difference."""
    first = str(data.rubber.values[0])
    for i in range(1, data.sizes["rubber"]):
        one = data.isel(rubber=i)
        difference = float(one.total_friction_difference)
        if math.isnan(difference):
            continue
        word = "more" if difference > 0.0 else "less"
        text = (
            f"{one.rubber.item()} has {significant(abs(difference))} {word} friction than {first}"
        )
        if "total_friction_difference_low" in one:
            low = float(one.total_friction_difference_low)
            high = float(one.total_friction_difference_high)
            if not math.isnan(low + high):
                beyond = low > 0.0 or high < 0.0
                text += ", beyond" if beyond else ", not beyond"
                text += " what the measured moduli leave open"
        yield f"{text}; {_reasons(one)}."


def _reasons(one: xr.Dataset) -> str:
    """Return which wave and which decade of relaxation times differ most."""
    reasons = []
    if "friction_difference" in one and np.isfinite(one.friction_difference).any():
        at = int(np.nanargmax(np.abs(one.friction_difference.values)))
        part, wavelength = (
            float(one[name].values[at]) for name in ("friction_difference", "wavelength")
        )
        reasons.append(f"most, {part:+.3f}, at the wave of {significant(wavelength / MILLI)} mm")
    if "friction_by_decade_difference" in one:
        parts = np.nan_to_num(one.friction_by_decade_difference.values)
        at = int(np.argmax(np.abs(parts)))
        power = round(math.log10(float(one.decade.values[at])))
        reasons.append(
            f"{parts[at]:+.3f} by relaxation times of {power_of_ten(power)} to "
            f"{power_of_ten(power + 1)} s"
        )
    return ", and ".join(reasons) or "the model does not tell by which waves"


def _range(one: xr.Dataset, quantity: str) -> str:
    if f"{quantity}_low" not in one or math.isnan(float(one[f"{quantity}_low"])):
        return "-"
    ends = (significant(float(one[f"{quantity}_{end}"])) for end in ("low", "high"))
    return " to ".join(ends)


def _difference(one: xr.Dataset) -> list[str]:
    name = "total_friction_difference"
    if f"{name}_low" not in one or math.isnan(float(one[f"{name}_low"])):
        return [f"{float(one[name]):+.3f}", "-"]
    ends = (f"{float(one[f'{name}_{end}']):+.3f}" for end in ("low", "high"))
    return [f"{float(one[name]):+.3f}", " to ".join(ends)]
