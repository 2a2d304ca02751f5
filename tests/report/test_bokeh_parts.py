"""Figures as data for BokehJS: Bokeh knows every type and attribute, and reads the same numbers."""

import logging

import numpy as np
import pytest
from bokeh import models
from bokeh.core.serialization import DeserializationError

from gripscale.charts import draw
from gripscale.charts.bokeh_parts import Part, document, model
from gripscale.charts.chart import CrossLine, Outline, Panel, PlotAxis, Series, ShadedBand, ValueMap
from gripscale.charts.page import draw_linked, draw_panel
from gripscale.questions.page_of_folder import read_result

X = np.array([1.0, 2.0, 4.0])
MARKS = [
    Series(X, 2.0 * X, label="$\\mu$", marker="o", beyond=[0, 0, 1]),
    Outline(np.linspace(1.0, 4.0, 5000), np.full(5000, 1.0), np.full(5000, 2.0)),
    ShadedBand(X, X, 3.0 * X, label="range"),
    CrossLine(2.0, label="limit"),
    CrossLine(2.0, upright=True, dash="dotted"),
    CrossLine(2.0, upright=True, to=3.0),
    ValueMap(X, X, np.eye(3), "p"),
]


@pytest.fixture(autouse=True)
def silence(caplog):
    """Bokeh logs an attribute that it has not."""
    logger = logging.getLogger("bokeh.core.has_props")
    logger.addHandler(caplog.handler)
    with caplog.at_level(logging.WARNING, logger.name):
        yield
    logger.removeHandler(caplog.handler)
    assert caplog.get_records("call") == []


@pytest.mark.parametrize("log", [False, True])
def test_bokeh_has_every_attribute_of_every_mark(log):
    axis = PlotAxis("$x$ [mm]", log=log)
    panels = [
        Panel(axis, PlotAxis("y", log=log), MARKS),
        Panel(PlotAxis("x", low=1.0, high=4.0), axis),
    ]
    figure, empty = (model(chart.figure) for chart in draw.panels_on_page(panels))
    drawn = {each.glyph.__class__.__name__ for each in figure.renderers}
    assert drawn == {"Image", "Line", "Scatter", "VArea"}
    named = [item.label.value for item in figure.legend[0].items]
    assert named == ["μ", "range", "limit", "beyond the measured band"]
    (points,) = (each for each in figure.renderers if each.glyph.__class__.__name__ == "Scatter")
    assert points.data_source.data["y"].tolist() == [2.0, 4.0, 8.0]
    assert empty.legend == []
    assert (empty.x_range.start, empty.x_range.end) == pytest.approx((0.94, 4.06))


def test_bokeh_has_every_attribute_of_linked_panels():
    panels = [Panel(PlotAxis("x"), PlotAxis("y"), MARKS[:2])] * 2
    column = model(draw_linked(panels, "linked", "", "").figure)
    first, second = (figure for figure, *_ in column.children)
    assert first.x_range is second.x_range
    assert [len(each.tools) for each in column.toolbar.tools[:4]] == [2] * 4


@pytest.mark.verification
def test_bokeh_has_every_attribute_of_the_pages(run_folder):
    charts = read_result(run_folder).page_content().charts
    assert charts
    for chart in charts:
        assert model(chart.figure).id == chart.figure.id


def test_bokeh_refuses_what_it_has_not(caplog):
    model(Part("Span", colour="red"))
    assert "colour" in caplog.text
    caplog.clear()
    with pytest.raises(DeserializationError, match="Spam"):
        model(Part("Spam"))
    with pytest.raises(ValueError, match="line_width"):
        model(Part("Span", line_width="red"))


def test_a_part_stands_once_in_a_document():
    shared = Part("Range1d", start=0.0, end=1.0)
    plots = [Part("Plot", x_range=shared), Part("Plot", x_range=shared)]
    (root,) = document(Part("Column", children=plots))["roots"]
    first, second = root["attributes"]["children"]
    assert first["attributes"]["x_range"]["attributes"] == {"start": 0.0, "end": 1.0}
    assert second["attributes"]["x_range"] == {"id": shared.id}


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
def test_a_short_log_axis_has_numbers_along(low, high, marks):
    values = np.array([low, high])
    panel = Panel(PlotAxis("x [-]"), PlotAxis("y [-]", log=True), [Series(values, values)])
    axis = model(draw_panel(panel).figure).yaxis[0]
    if not marks:
        assert isinstance(axis.formatter, models.LogTickFormatter)
        return
    inside = [tick for tick in axis.ticker.ticks if 0.99 * low <= tick <= 1.01 * high]
    assert inside == pytest.approx(marks)
