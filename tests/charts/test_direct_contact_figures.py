"""The stretch of a direct contact that is drawn to scale, and what figures call its profile."""

import io

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from gripscale.charts.chart import CrossLine
from gripscale.charts.paper import figure_file
from gripscale.half_space.location import with_traces
from gripscale.questions.answer.charts import height_figure, named_traces, trace_sheet

SUMMIT, HALF = 60e-3, 50e-6
"""Middle of the contact and half its length [m]."""


def made_up_trace(thinned=False):
    """Return a line of 100 mm with a contact at the right end of its stretch of 4 mm.

    Thinned, a second contact follows, of pieces of many points.
    """
    x = np.arange(8000) * 12.5e-6
    if thinned:
        x = x[(x < SUMMIT + 3 * HALF) | (np.arange(x.size) % 16 == 0)]
    pressure = np.where(abs(x - SUMMIT) <= 1.001 * HALF, 1e8, 0.0)
    if thinned:
        pressure[(x > SUMMIT + 3 * HALF) & (x < SUMMIT + 2e-3)] = 5e7
    height = 1e-3 * np.exp(-(((x - SUMMIT) / 2e-4) ** 2))
    rubber = np.maximum(height, 0.9e-3 - abs(x - SUMMIT) * 0.1)
    share = np.cumsum(pressure) / pressure.sum()
    lines = {"height": height, "rubber": rubber, "pressure": pressure}
    data = {f"{name}_{end}": ("piece", v) for name, v in lines.items() for end in ("low", "high")}
    data |= {f"running_{name}": ("piece", share) for name in ("friction", "load")}
    ends = {"start": SUMMIT + 2 * HALF - 4e-3, "end": SUMMIT + 2 * HALF}
    numbers = {f"stretch_{name}": ((), at) for name, at in ends.items()}
    numbers |= {"stretch_friction": ((), 1.0), "stretch_load": ((), 1.0)}
    by_height = np.gradient(pressure) * 1e-3
    return xr.Dataset({"x": ("piece", x), "by_height": ("piece", by_height), **data, **numbers})


def ends_of(panel):
    return panel.x.low, panel.x.high


def test_the_stretch_has_its_contact_in_the_middle():
    sheet = trace_sheet(made_up_trace())
    close = sheet.panels[-1]
    low, high = ends_of(close)
    assert 0.5 * (low + high) == pytest.approx(60.0, abs=0.02)
    # eight times the length of the contact
    assert high - low == pytest.approx(0.8, rel=0.05)
    assert close.title == "To scale: the stretch with most friction, 100 % of it under 100 % of " \
        "the load"  # fmt: skip
    for panel in sheet.panels[:-1]:
        shade = next(m for m in panel.marks if isinstance(m, CrossLine) and m.to is not None)
        assert (shade.at, shade.to) == pytest.approx((low, high), abs=0.02)
    # a stretch below a millimetre has the unit of the whole line
    contact = next(m for m in close.marks if getattr(m, "label", "") == "contact")
    assert np.nanmax(np.asarray(contact.y)) == pytest.approx(1.0, rel=1e-3)
    (text,) = (m.label for m in close.marks if "pressure" in getattr(m, "label", ""))
    assert text == "pressure, 100 MPa is 0.05 mm high"


def test_a_stretch_of_a_length_that_was_asked_for_keeps_it():
    low, high = ends_of(trace_sheet(made_up_trace(), length=3e-3).panels[-1])
    assert high - low == pytest.approx(3.0, abs=0.03)
    assert 0.5 * (low + high) == pytest.approx(60.0, abs=0.02)


def test_a_stretch_ends_before_a_contact_of_thinned_points():
    close = trace_sheet(made_up_trace(thinned=True)).panels[-1]
    low, high = ends_of(close)
    assert high == pytest.approx((SUMMIT + 3 * HALF) / 1e-3, abs=0.02)
    x, contact = (np.asarray(part) for part in (close.marks[-2].x, close.marks[-2].y))
    touching = x[np.isfinite(contact)]
    assert low < touching.min() - 0.02
    assert high > touching.max() + 0.02


def test_panels_to_scale_are_as_wide_as_the_others():
    trace = made_up_trace()
    for figure in (height_figure(trace, "road"), trace_sheet(trace).on_paper()):
        figure_file(figure)
        ends = [(axes.get_position().x0, axes.get_position().x1) for axes in figure.axes]
        for end in ends[1:]:
            assert end == pytest.approx(ends[0], abs=1e-4)


def test_what_heights_are_worth_is_named_and_no_label_is_cut():
    figure = height_figure(made_up_trace(), "road")
    content = figure_file(figure)
    legend = figure.legends[0]
    assert legend.get_title().get_text() == "road"
    assert "change of $\\mu$ by the height" in [text.get_text() for text in legend.get_texts()]
    pixels = imread(io.BytesIO(content))
    edges = (pixels[:, :4], pixels[:, -4:], pixels[:4], pixels[-4:])
    assert all((edge[..., :3] == 1.0).all() for edge in (edges[0], *edges[2:]))
    assert figure.axes[0].get_xlabel() == ""  # shared with the panel below


@pytest.mark.parametrize(
    ("profiles", "names"),
    [
        (["road", "lane"], ["road", "lane"]),
        (["road", "road"], ["profile 1", "profile 2"]),
        (["road", ""], ["profile 1", "profile 2"]),
        (None, ["profile 1", "profile 2"]),
    ],
)
def test_traces_are_called_as_their_profiles(profiles, names):
    data = with_traces(xr.Dataset(), [made_up_trace().drop_vars("by_height")] * 2)
    inputs = profiles and xr.Dataset({"profile_name": ("profile", np.array(profiles))})
    called = [name for name, _ in named_traces(data, inputs)]
    assert called == names
    assert all(type(name) is str for name in called)
