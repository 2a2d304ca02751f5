"""Measured friction beside what models predict, point by point, in text."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr
from rich.table import Table

from gripscale.analysis.measured_comparison import measured_variables
from gripscale.charts.ladder import measured
from gripscale.core.units import ZERO_CELSIUS, DisplayUnit, display_unit, significant
from gripscale.report.tables_run import printed_table

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.analysis.measured_friction import MeasuredFriction
    from gripscale.core.units import DisplayUnit


MOST_MODELS = 2
"""In one table: more would not fit on a screen."""


def residual_tables(data: xr.Dataset) -> list[Table]:
    """Return `residual_table` for two models at a time."""
    groups = range(0, data.sizes["model"], MOST_MODELS)
    return [residual_table(data.isel(model=slice(at, at + MOST_MODELS))) for at in groups]


def residual_table(data: xr.Dataset) -> Table:
    """Return measured and predicted friction, their difference, and it over the spread.

    `data` is what `gripscale.analysis.residuals` answers; the last row has root mean squares.
    """
    terms = "area_term" in data
    spread = bool(np.isfinite(data.measured_spread).any())
    table = printed_table()
    for head in _opening(data, spread=spread):
        table.add_column(head, justify="right", no_wrap=True)
    parts = ["μ hyst.", "μ"] if terms else ["μ"]
    parts += ["Δμ", "Δμ/\nspread"] if spread else ["Δμ"]
    for name in data.model.values:
        for at, part in enumerate(parts):
            table.add_column(f"{name if at == 0 else ''}\n{part}", justify="right")
    for at in range(data.sizes["measurement"]):
        one = data.isel(measurement=at)
        table.add_row(*_point(one, data), *_numbers(one, terms=terms, spread=spread))
    table.add_section()
    table.add_row("rms", *[""] * (len(list(_opening(data, spread=spread))) - 1), *_rms(data, parts))
    return table


def _opening(data: xr.Dataset, *, spread: bool) -> Iterator[str]:
    """Yield the titles of the columns of the measurement, those that say something."""
    yield f"v\n{_shown(data, 'speed').unit}"
    if np.isfinite(data.measured_temperature).any():
        yield "T\n°C"
    if np.isfinite(data.measured_pressure).any():
        yield f"p\n{_shown(data, 'pressure').unit}"
    yield "measured\nμ"
    if spread:
        yield "\nspread"


def _shown(data: xr.Dataset, name: str) -> DisplayUnit:
    return display_unit(name, data.attrs)


def _point(one: xr.Dataset, data: xr.Dataset) -> Iterator[str]:
    yield significant(float(_shown(data, "speed").of(one.measured_speed)))
    if np.isfinite(data.measured_temperature).any():
        yield f"{float(one.measured_temperature) - ZERO_CELSIUS:.1f}"
    if np.isfinite(data.measured_pressure).any():
        yield significant(float(_shown(data, "pressure").of(one.measured_pressure)))
    yield _fixed(float(one.measured_friction))
    if np.isfinite(data.measured_spread).any():
        yield _fixed(float(one.measured_spread))


def _numbers(one: xr.Dataset, *, terms: bool, spread: bool) -> Iterator[str]:
    for at in range(one.sizes["model"]):
        model = one.isel(model=at)
        if terms:
            yield _fixed(float(model.hysteresis))
        yield _fixed(float(model.friction))
        yield _signed(float(model.difference), 3)
        if spread:
            yield _signed(float(model.difference_in_spread), 1)


def _rms(data: xr.Dataset, parts: list[str]) -> Iterator[str]:
    for at in range(data.sizes["model"]):
        model = data.isel(model=at)
        yield from [""] * (parts.index("Δμ"))
        yield _fixed(float(model.rms_difference))
        if parts[-1] != "Δμ":
            yield f"{float(model.rms_difference_in_spread):.1f}"


def _fixed(value: float) -> str:
    return "-" if np.isnan(value) else f"{value:.3f}"


def _signed(value: float, digits: int) -> str:
    return "-" if np.isnan(value) else f"{value:+.{digits}f}"


# Measured friction beside a prediction at one speed, in words.


def measured_lines(found: MeasuredFriction, speed: float, how: DisplayUnit) -> Iterator[str]:
    """Yield what was measured at `speed` [m/s], interpolated in its logarithm, by temperature.

    Speeds are shown as `how` says.
    """
    for series in measured(xr.Dataset(measured_variables(found))):
        at = series.at(speed)
        where = f"{series.label[0].upper()}{series.label[1:]}"
        if at is None:
            low, high = (significant(float(how.of(series.speed[end]))) for end in (0, -1))
            yield f"{where}: nothing at {how.text(speed)}, only from {low} to {high} {how.unit}."
            continue
        friction, spread = at
        about = f" ± {significant(spread, 2)}" if math.isfinite(spread) else ""
        yield (
            f"{where}: mu = {significant(friction)}{about} at {how.text(speed)}; "
            "`gripscale compare` puts every model beside every measured point."
        )
