"""Charts of an area term: fit and measurement, profiles of the parameters."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BLUE, FAINT, GREY, ORANGE, WIDE
from gripscale.core.units import DisplayUnit
from gripscale.experiment.measured_friction import MeasuredSeries
from gripscale.questions.calibration.calibration_law import PARAMETERS, WRITTEN
from gripscale.questions.compare.charts import measured_sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure


CEILING = 2.5  # highest excess that is drawn, over the threshold


def calibration_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the figures of a calibration."""
    yield Picture(
        "measured_and_fitted",
        fitted_figure(data),
        "Measured friction with its spread, the hysteresis alone, and the fit with its band, at "
        "each temperature.",
        "A panel for each temperature with points and two curves over the speed.",
    )
    yield Picture(
        "profiles",
        profiles_figure(data),
        "Rise of the sum of squares if a parameter is held at another value.",
        "A panel for each parameter with a valley around its best value.",
    )


def fitted_figure(data: xr.Dataset) -> Figure:
    """Draw measured friction with its spread, the hysteresis alone, and the total with its band."""
    level = f"{100.0 * data.attrs['level']:.0f} % interval of the fit"

    def fit(series: MeasuredSeries, speed_unit: DisplayUnit) -> list[Mark]:
        rows = series.rows[np.isfinite(data.friction.values[series.rows])]
        speed = speed_unit.of(data.measured_speed.values[rows])
        total, band, hysteresis = (
            data[name].values[rows] for name in ("friction", "friction_band", "hysteresis")
        )
        return [
            ShadedBand(speed, total - band, total + band, ORANGE, level, alpha=0.25),
            Series(speed, total, ORANGE, "hysteresis and area term"),
            Series(speed, hysteresis, BLUE, "hysteresis alone", marker="."),
        ]

    return measured_sheet(data, fit, head=0.5).on_paper()


def profiles_figure(data: xr.Dataset) -> Figure:
    """Draw by how much the sum of squares rises where each parameter is held elsewhere."""
    count = data.sizes["parameter"]
    columns = 2 if count == 4 else min(count, 3)
    panels = [_profile_panel(data.isel(parameter=at)) for at in range(count)]
    height = 0.4 + 2.1 * -(-count // columns)
    look: dict[str, Any] = {"legend_columns": 4, "gap": 0.05, "layout": {"sharey": True}}
    return Sheet(panels, columns, min(3.5 * columns, WIDE), height, **look).on_paper()


def _profile_panel(data: xr.Dataset) -> Panel:
    threshold, level = (float(data.attrs[name]) for name in ("threshold", "level"))
    unit = str(data.unit.item())
    display = WRITTEN.get(unit, DisplayUnit("-" if unit == "1" else unit))
    rows = np.isfinite(data.profile_excess.values)
    value, excess = display.of(data.profile_value.values[rows]), data.profile_excess.values[rows]
    low, high, best = (float(display.of(data[name])) for name in ("low", "high", "estimate"))
    least, most = float(value.min()), float(value.max())
    ends = [end if np.isfinite(end) else edge for end, edge in ((low, least), (high, most))]
    name = str(data.parameter.item())
    missing = [word for word, end in (("lower", low), ("upper", high)) if not np.isfinite(end)]
    title = f"{' and '.join(missing)} end{'s' * (len(missing) > 1)} not determined"
    return Panel(
        PlotAxis(f"{PARAMETERS[name].label} [{display.unit}]", low=least, high=most,
             log=name != "activation_energy" and most > 5.0 * least),
        PlotAxis("rise of the sum of squares [-]", low=0.0, high=CEILING * threshold),
        [
            CrossLine(ends[0], FAINT, "interval", upright=True, to=float(ends[1])),
            Series(value, excess, BLUE, "profile"),
            CrossLine(threshold, ORANGE, f"{100.0 * level:.0f} %", width=1.0),
            CrossLine(best, GREY, "best", width=1.0, upright=True),
        ],
        title=title if missing else "",
    )  # fmt: skip
