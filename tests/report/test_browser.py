"""The pages in a real headless Chromium: figures drawn, tables complete, silence, no network."""

import io
from contextlib import contextmanager

import numpy as np
import pytest
from PIL import Image

from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet, image
from gripscale.questions.page_of_folder import write_report
from gripscale.report import write_page
from gripscale.report.elements import Page, Section
from tests.browsing import CURVES, Visit
from tests.run_case import run_case
from tests.samples import HALF_PLANE, case_text

from .conftest import CASE


@contextmanager
def visit(browser, path, width=1280, **options):
    """Open `path` without a network; collect warnings, errors and requests."""
    size = {"width": width, "height": 900}
    context = browser.new_context(viewport=size, offline=True, **options)
    seen = Visit(context.new_page())

    def route(route):
        url = route.request.url
        if url.startswith("file:"):
            route.continue_()
        else:
            seen.asked.append(url)
            route.abort()

    context.route("**/*", route)
    seen.page.goto(path.as_uri())
    yield seen
    context.close()


DRAWN = """() => {
    const seen = [...document.querySelectorAll('.plot')].filter(
        plot => !plot.closest('details:not([open])'));
    return Number(document.documentElement.dataset.drawn) >= seen.length
        && Bokeh.documents.every(each => each.is_idle);
}"""
"""Whether the page says that the figures of its open chapters are made, and each is at rest."""


def drawn(seen):
    """Wait until the figures of all open chapters are drawn."""
    seen.until(DRAWN)
    return seen


def opened(seen):
    """Open all chapters, and wait for their figures."""
    seen.page.get_by_role("button", name="Open all").click()
    return drawn(seen)


@pytest.fixture(scope="module")
def run_page(run_folder, tmp_path_factory):
    return write_report(run_folder, tmp_path_factory.mktemp("page") / "run.html")


@pytest.fixture(scope="module")
def visited(browser, run_page):
    with visit(browser, run_page) as seen:
        yield opened(seen)


FRAMES = """plot => {
    const all = root => [...root.querySelectorAll('*')].flatMap(
        e => e.shadowRoot ? [e, ...all(e.shadowRoot)] : [e]);
    const box = e => { const r = e.getBoundingClientRect(); return [r.x, r.y, r.width, r.height]; };
    const named = name => all(plot).filter(e => e.classList.contains(name)).map(box);
    return {plot: box(plot), frame: named('bk-CartesianFrame'), legend: named('bk-Legend')};
}"""


def check_figures(seen):
    """Assert that every figure fills its place with curves; return how many there are."""
    plots = seen.page.locator(".plot").all()
    for plot in plots:
        name = plot.get_attribute("id")
        boxes = plot.evaluate(FRAMES)
        x, y, width, height = boxes["plot"]
        assert width > 250, name
        assert height >= 290, name
        assert len(boxes["frame"]) in (1, 3), name  # three panels of a contact
        for left, top, wide, high in [*boxes["frame"], *boxes["legend"]]:
            assert left >= x - 1, name
            assert top >= y - 1, name
            assert left + wide <= x + width + 1, name
            assert top + high <= y + height + 1, name
        legends = sum(high for *_, high in boxes["legend"])
        assert legends < 0.3 * height, f"{name}: entries below each other"
        frames = sum(high for *_, high in boxes["frame"])
        assert frames > 0.5 * height, f"{name}: frame is squeezed"
        assert plot.evaluate(CURVES), f"{name} is empty"
    return len(plots)


@pytest.fixture(scope="module")
def folded(browser, run_page):
    """The page of a run as it opens, in a dark browser."""
    with visit(browser, run_page, color_scheme="dark") as seen:
        yield drawn(seen)


def test_the_page_opens_with_two_figures_and_a_chapter_by_its_link(folded):
    """What else there is stands in chapters to be opened: the page is a few windows high."""
    assert folded.page.locator(".plot:visible").count() == 2
    assert folded.page.locator("html").get_attribute("data-drawn") == "2"
    assert folded.page.evaluate("document.documentElement.scrollHeight") <= 6000
    plot = folded.page.locator("#rubber .plot").first
    assert not plot.is_visible()
    folded.page.locator("nav a[href='#rubber']").click()
    folded.until(CURVES, plot.element_handle())
    assert folded.said == []


BACK = "() => getComputedStyle(document.documentElement).backgroundColor"
DARK, LIGHT = "rgb(25, 25, 25)", "rgb(255, 255, 255)"


def paper(picture):
    """Return the commonest colour of a picture."""
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")).reshape(-1, 3)
    colours, counts = np.unique(pixels, axis=0, return_counts=True)
    return np.asarray(colours[counts.argmax()], dtype=np.int64)


def test_page_and_figures_are_dark_as_the_system_or_as_chosen(folded):
    plot = folded.page.locator(".plot:visible").first
    switch = folded.page.get_by_role("button", name="Light or dark")
    assert folded.page.evaluate(BACK) == DARK
    # a filter turns white into the paper of the page, to a shade or two of rounding
    assert paper(plot.screenshot()) == pytest.approx(25, abs=3)
    switch.click()
    assert folded.page.evaluate(BACK) == LIGHT
    assert (paper(plot.screenshot()) == 255).all()
    switch.click()
    assert folded.page.evaluate(BACK) == DARK
    folded.page.emulate_media(media="print")
    assert folded.page.evaluate(BACK) == LIGHT
    assert plot.evaluate("e => getComputedStyle(e).filter") == "none"


def test_every_figure_picture_and_table_is_drawn(visited):
    """In silence, and without a network."""
    count = check_figures(visited)
    assert count >= 11
    assert visited.page.locator("html").get_attribute("data-drawn") == str(count)
    sizes = visited.page.eval_on_selector_all(
        "main img", "all => all.map(e => [e.complete, e.naturalWidth, e.clientHeight])"
    )
    assert len(sizes) == 13  # equations; all figures are charts
    assert all(complete and width > 30 and height > 10 for complete, width, height in sizes)
    tables = visited.page.eval_on_selector_all(
        "table",
        """all => all.map(t => ({
            caption: t.caption.innerText, shown: t.getBoundingClientRect().height > 20,
            rows: [...t.tBodies[0].rows].map(r => [...r.cells].map(c => c.innerText.trim())),
            heads: t.tHead ? t.tHead.rows[t.tHead.rows.length - 1].cells.length : 2}))""",
    )
    assert len(tables) >= 14
    for table in tables:
        assert table["caption"]
        assert table["shown"], table["caption"]
        assert table["rows"], table["caption"]
        for row in table["rows"]:
            assert len(row) == table["heads"], table["caption"]
            assert all(row), table["caption"]
    assert visited.said == []
    assert visited.asked == []


def test_the_watch_would_notice(browser, tmp_path):
    """A page that warns, fails and asks for a picture is caught at all three."""
    path = tmp_path / "bad.html"
    path.write_text(
        "<img src='http://example.org/a.png'><script>console.warn('w'); throw Error('e')</script>"
    )
    with visit(browser, path) as seen:
        seen.page.evaluate("() => fetch('http://example.org/b.png').catch(() => null)")
        assert seen.asked == [f"http://example.org/{name}.png" for name in "ab"]
        assert "w" in seen.said
        assert "e" in seen.said


def test_injected_script_does_not_run(browser, study_file, tmp_path):
    """Even markup that slipped through the escaping is stopped by the page's policy."""
    path = write_report(study_file, tmp_path / "injected.html")
    text = path.read_text(encoding="utf-8")
    assert "<main>" in text
    path.write_text(text.replace("<main>", "<main><script>document.title = 'taken'</script>"))
    with visit(browser, path) as seen:
        drawn(seen)
        assert seen.page.title() == "Study: tread on <contact>"
        assert any("Content Security Policy" in text for text in seen.said)


def test_case_can_be_copied(visited):
    button = visited.page.locator("button[data-copies=code-case]")
    assert button.is_visible()
    button.click()
    text = visited.page.evaluate("() => document.getElementById('code-case').textContent")
    assert text == CASE
    visited.until("b => b.innerText !== 'Copy'", button.element_handle())
    assert button.inner_text() in ("Copied", "Selected: press Ctrl+C")


def test_a_telephone_has_all_legends_and_nothing_overflows(browser, run_page):
    with visit(browser, run_page, 390) as seen:
        assert check_figures(opened(seen)) >= 11
        for width in (390, 800):
            seen.page.set_viewport_size({"width": width, "height": 900})
            # figures are fitted a moment after the window has changed
            drawn(seen).until("limit => document.documentElement.scrollWidth <= limit", width)
        assert seen.said == []


def test_a_picture_fits_a_telephone_and_a_touch_makes_it_readable(browser, tmp_path):
    sheet = Sheet([Panel(PlotAxis("x"), PlotAxis("y"), [Series([0, 1], [0, 1])])])
    drawn = image(Picture("line", sheet.on_paper(), "A line.", "A line that rises."))
    page = Page.of("Line", "", [], [], [Section("line", "Line", [drawn])])
    with visit(browser, write_page(lambda: page, tmp_path / "line.html"), 390) as seen:
        picture = seen.page.locator(".image img").first
        assert picture.bounding_box()["width"] <= 390 - 2 * 16
        picture.click()
        assert picture.bounding_box()["width"] >= 700
        assert seen.width() <= 390
        picture.click()
        assert picture.bounding_box()["width"] <= 390 - 2 * 16


def test_print_keeps_figures_whole(visited):
    page = visited.page
    before = [plot.bounding_box()["width"] for plot in page.locator(".plot").all()]
    page.emulate_media(media="print")
    after = [plot.bounding_box()["width"] for plot in page.locator(".plot").all()]
    assert after == pytest.approx(before)
    assert not page.locator("nav").is_visible()
    assert page.pdf().startswith(b"%PDF")
    page.emulate_media(media="screen")


def test_smallest_case_has_no_empty_figure(browser, tmp_path):
    """One wave by hand, a rubber by name, the half-plane: no meshes, no stretches, no files."""
    wave = '[[surface.sines]]\nwavelength = "10 mm"\namplitude = "1 mm"'
    (tmp_path / "case.toml").write_text(case_text(wave, solver=HALF_PLANE))
    run_case(tmp_path / "case.toml", tmp_path / "results")
    with visit(browser, write_report(tmp_path / "results")) as seen:
        assert check_figures(opened(seen)) >= 2
        assert seen.said == []
        assert seen.asked == []
