"""A calibrated area term in text: its parameters, and what it says of points left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.table import Table

from gripscale.calibration.profile import LEVEL
from gripscale.calibration.snippet import interval, written
from gripscale.report.printed_table import printed_table
from gripscale.report.tables import significant
from gripscale.units import ZERO_CELSIUS

if TYPE_CHECKING:
    from gripscale.calibration import Calibration, HeldOut


def parameter_table(calibration: Calibration) -> Table:
    """Return value, standard error and interval of each parameter, and what was held."""
    table = printed_table()
    table.add_column("parameter")
    for head in ("value", "standard error"):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column(f"{100 * LEVEL:.0f} % by profile likelihood")
    for one in calibration.estimates:
        error = written(one.standard_error, one.unit, 2) if one.determined else "-"
        style = None if one.determined else "yellow"
        table.add_row(one.name, written(one.value, one.unit, 4), error, interval(one), style=style)
    return table


def correlations(calibration: Calibration) -> str:
    """Return the correlations of the estimates in a sentence, empty for a single one."""
    names = [one.name for one in calibration.estimates]
    pairs = [
        f"{name} and {names[b]} {calibration.correlation[a, b]:+.2f}"
        for a, name in enumerate(names)
        for b in range(a + 1, len(names))
    ]
    return f"Correlations: {', '.join(pairs)}." if pairs else ""


def held_out_table(calibration: Calibration) -> Table:
    """Return the errors of the law at each group of points, fitted to the others."""
    groups = calibration.held_out
    spread = any(np.isfinite(one.rms_outside_in_spread) for one in groups)
    table = printed_table()
    table.add_column("left out")
    heads = ["points", "rms\ninside", "rms\noutside", *["outside/\nspread"] * spread]
    for head in heads:
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("")
    for one in groups:
        numbers = [one.rms_inside, one.rms_outside, *[one.rms_outside_in_spread] * spread]
        cells = (significant(number, 2) for number in numbers)
        table.add_row(group_name(calibration, one), str(one.points), *cells, one.why_not)
    return table


def group_name(calibration: Calibration, one: HeldOut) -> str:
    """Return a group in words: its temperature, or its decade of speed."""
    if calibration.held_out_by == "temperature":
        return f"{one.value - ZERO_CELSIUS:.0f} °C"
    return f"{one.value:g} to {10.0 * one.value:g} m/s"
