"""Where numbers stand on the logarithmic axes of a page."""

from __future__ import annotations

import numpy as np
import pytest

from gripscale.charts.chart import Panel, PlotAxis, Series

models = pytest.importorskip("bokeh.models", reason="needs pip install 'gripscale[report]'")


@pytest.mark.parametrize(
    ("low", "high", "marks"),
    [
        (0.4, 0.7, [0.4, 0.5, 0.6, 0.7]),
        (0.3, 0.9, [0.3, 0.4, 0.5, 0.7]),  # 0.6, 0.8 and 0.9 would touch on a telephone
        (0.02, 0.6, [0.02, 0.05, 0.1, 0.2, 0.5]),
        (0.00996, 0.692, [0.01, 0.03, 0.1, 0.3]),
        (1e-9, 1e-7, []),  # as powers of ten, which Bokeh writes for the decades alone
        (0.01, 1e3, []),
    ],
)
def test_a_short_log_axis_has_numbers_along(low: float, high: float, marks: list[float]) -> None:
    from gripscale.charts.bokeh_parts import model
    from gripscale.charts.page import draw_panel

    values = np.array([low, high])
    panel = Panel(PlotAxis("x [-]"), PlotAxis("y [-]", log=True), [Series(values, values)])
    axis = model(draw_panel(panel).figure).yaxis[0]
    if not marks:
        assert isinstance(axis.formatter, models.LogTickFormatter)
        return
    inside = [tick for tick in axis.ticker.ticks if 0.99 * low <= tick <= 1.01 * high]
    assert inside == pytest.approx(marks)
