"""Measured friction beside what models predict: a table of points, and sentences at one speed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.core.units import ZERO_CELSIUS, DisplayUnit, display_unit_of
from gripscale.experiment.measured_friction import measured_variables
from gripscale.io.table import Column, Table, fixed, significant
from gripscale.questions.compare.charts_of_ladder import measured

if TYPE_CHECKING:
    from gripscale.experiment.measured_friction import MeasuredFriction


def residual_table(data: xr.Dataset) -> Table:
    """Return measured and predicted friction, their difference, and it over the spread.

    `data` is what `gripscale.questions.residuals` answers; its root mean squares stand below.
    """
    speeds, pressures = (display_unit_of(data.attrs, name) for name in ("speed", "pressure"))
    spread = bool(np.isfinite(data.measured_spread).any())
    points = [
        Column("speed", data.measured_speed.values, "v", speeds.unit, speeds.divisor),
        Column(
            "temperature",
            data.measured_temperature.values,
            "T",
            "°C",
            zero=ZERO_CELSIUS,
            format=fixed(1),
        ),
        Column("pressure", data.measured_pressure.values, "p", pressures.unit, pressures.divisor),
        Column("measured_friction", data.measured_friction.values, "μ", format=fixed(3)),
        Column("measured_spread", data.measured_spread.values, "spread", format=fixed(3)),
    ]
    points = [column for column in points if np.isfinite(column.values).any()]
    columns, notes = [column.of(column.values, group="measured") for column in points], []
    for name in data.model.values.tolist():
        model = data.sel(model=name).transpose("measurement", ...)
        group = str(name).replace("_", " ")
        parts = [
            Column("hysteresis", heading="μ hyst.", format=fixed(3)),
            Column("friction", heading="μ", format=fixed(3)),
            Column("difference", heading="Δμ", format=fixed(3, "+")),
            Column("difference_in_spread", heading="Δμ / spread", format=fixed(1, "+")),
        ]
        wanted = {"hysteresis": "area_term" in data, "difference_in_spread": spread}
        columns += [
            part.of(model[part.name].values, name=f"{name}_{part.name}", group=group)
            for part in parts
            if wanted.get(part.name, True)
        ]
        rms = f"{float(model.rms_difference):.3f}"
        if spread:
            rms += f", {float(model.rms_difference_in_spread):.1f} times the spread"
        notes.append(f"Root mean square of Δμ, {group}: {rms}.")
    return Table("residuals", columns, "Measured and predicted friction", notes, keys=len(points))


def measured_lines(
    friction: MeasuredFriction, speed: float, speed_unit: DisplayUnit
) -> Iterator[str]:
    """Yield what was measured at `speed` [m/s], interpolated in its logarithm, by temperature.

    Speeds are shown as `speed_unit` says.
    """
    for series in measured(xr.Dataset(measured_variables(friction))):
        at = series.at(speed)
        where = f"{series.label[0].upper()}{series.label[1:]}"
        if at is None:
            low, high = (significant(float(speed_unit.of(series.speed[end]))) for end in (0, -1))
            range_measured = f"from {low} to {high} {speed_unit.unit}"
            yield f"{where}: nothing at {speed_unit.text(speed)}, only {range_measured}."
            continue
        value, spread = at
        about = f" ± {significant(spread, 2)}" if math.isfinite(spread) else ""
        yield (
            f"{where}: mu = {significant(value)}{about} at {speed_unit.text(speed)}; "
            "`gripscale compare` puts every model beside every measured point."
        )
