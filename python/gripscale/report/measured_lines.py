"""Measured friction beside a prediction at one speed, in words."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import xarray as xr

from gripscale.figures.measured import measured
from gripscale.measured.differences import measured_variables
from gripscale.report.tables import significant

if TYPE_CHECKING:
    from gripscale.measured.friction import MeasuredFriction
    from gripscale.shown import Shown


def measured_lines(found: MeasuredFriction, speed: float, how: Shown) -> Iterator[str]:
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
