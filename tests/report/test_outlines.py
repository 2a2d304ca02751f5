"""Outlines of a direct contact in a real browser: drawn anew with every extreme as one zooms."""

import json

import numpy as np
import pytest

import gripscale as gs
from gripscale.half_space import contact_trace
from gripscale.questions.answer.charts import trace_charts
from gripscale.report.build import render
from gripscale.report.elements import Page, Section
from tests.samples import ZENER

from .test_browser import drawn, visit

PIECES = 2**14


@pytest.fixture(scope="module")
def trace():
    profile = gs.surface.self_affine_profile(0.8, 5e-3, 5e-4, 0.5, 1e-5, seed=1)
    contact = gs.solve_rough_contact(
        ZENER, profile, pressure=3e5, speed=0.3, smallest_wavelength=4e-5, tolerance=None
    )
    assert contact.x.size > 2 * PIECES
    return contact_trace(contact, pieces=PIECES)


@pytest.fixture(scope="module")
def page(trace, tmp_path_factory):
    path = tmp_path_factory.mktemp("outlines") / "page.html"
    section = Section("contact", "Contact", trace_charts(trace, "profile 1"))
    path.write_text(render(Page("Contact", "", [], [], [section])), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def visited(browser, page):
    with visit(browser, page) as seen:
        yield drawn(seen)


SHOWN = """([start, end]) => {
    const models = Bokeh.documents.flatMap(d => d.roots()).flatMap(r => [...r.references()]);
    const plots = models.filter(m => m.x_range && m.renderers && m.renderers.some(
        r => r.data_source?.tags?.[0] === 'outline'));
    plots[0].x_range.setv({start, end});
    return JSON.stringify(plots.map(plot => [plot.inner_width, plot.renderers.filter(
        r => r.data_source.tags[0] === 'outline').map(r => [...r.data_source.data.y])]));
}"""
"""Zooms along the abscissa; gives width and drawn ordinates of each figure."""


@pytest.mark.parametrize("share", [1.0, 0.1, 0.003])
def test_what_is_drawn_keeps_every_extreme(visited, trace, share):
    x = trace.x.values / 1e-3
    middle = 0.5 * float(trace.stretch_start + trace.stretch_end) / 1e-3
    half = 0.5 * share * float(np.ptp(x))
    start, end = max(middle - half, float(x[0])), min(middle + half, float(x[-1]))
    figures = json.loads(visited.page.evaluate(SHOWN, [start, end]))
    inside = trace.isel(piece=np.flatnonzero((x >= start) & (x <= end)))
    (width, (surface, rubber, _)), (_, (pressure,)), _ = figures
    for values, name, unit in (
        (surface, "height", 1e-3),
        (rubber, "rubber", 1e-3),
        (pressure, "pressure", 1e6),
    ):
        # a piece to the left and to the right goes on beyond the frame
        # and single precision is right to 6e-8
        low, high = (inside[f"{name}_{end}"].values / unit for end in ("low", "high"))
        rounding = 1e-6 * max(abs(low).max(), abs(high).max())
        assert min(values) <= low.min() + rounding
        assert max(values) >= high.max() - rounding
        assert len(values) <= 2 * (width + 4)
    if share < 0.01:  # every point of the strongest stretch, each twice
        assert len(surface) >= 2 * inside.sizes["piece"]
    assert visited.said == []


def test_the_page_keeps_within_its_size(page):
    # the script of Bokeh is 1.3 MB; a piece has 40 bytes, in base64 four letters for three of them
    assert page.stat().st_size < 1.5e6 + 1.4 * 40 * PIECES
