"""Compounds side by side as a table, and in sentences which wave and relaxation times differ."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.figures.palette import MILLI
from gripscale.figures.style import power_of_ten
from gripscale.report.side_by_side_table import Row, difference_words, totals_table
from gripscale.report.tables import significant


def compounds_table(data: xr.Dataset) -> Table:
    """Return totals of each compound with their ranges, and differences to the first."""
    names = data.rubber.values.tolist()
    rows = [Row(name, data.isel(rubber=i), i == 0) for i, name in enumerate(names)]
    return totals_table("compound", rows)


def compounds_sentences(data: xr.Dataset) -> Iterator[str]:
    """Yield, for each compound, whether it differs from the first and what makes the difference."""
    first, *others = data.rubber.values.tolist()
    for i, name in enumerate(others, start=1):
        one = data.isel(rubber=i)
        text = difference_words(one, name, first, "the measured moduli")
        if text:
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
