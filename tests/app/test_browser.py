"""The page in a real headless Chromium: the whole way, a broken file, stopping, two tabs apart."""

import http.client
import re
import subprocess
import sys
import time
import zipfile
from contextlib import closing, contextmanager

import pytest

from gripscale.app.run_tabs import POLL
from gripscale.surface import read_profile
from tests.browsing import BETWEEN, GREY, PATIENCE, Visit

from .test_run import SLOW

REPORT = "iframe[title^='Report of']"
TABS = ("1 Road", "2 Rubber", "3 Load and conditions", "4 Run", "5 Results")


class AppVisit(Visit):
    """An open page of the app, and what is done on it."""

    def tab(self, name):
        self.page.locator(".bk-tab", has_text=name).click()

    def press(self, label):
        self.page.get_by_role("button", name=label, exact=True).click()

    def case(self):
        return str(self.page.get_by_label("case.toml").input_value())

    def write_case(self, text):
        self.page.get_by_label("case.toml").fill(text)
        self.page.get_by_label("case.toml").blur()

    def says(self, words):
        found = self.page.get_by_text(re.compile(words)).first
        found.wait_for(timeout=PATIENCE)
        return found

    def drop(self, number, *files):
        """Choose files at a place to drop them, by its number on the page; -1 opens a case."""
        places = self.page.locator("input[type=file]")
        places.nth(number % places.count()).set_input_files([str(path) for path in files])

    def saved(self, label, path):
        """Save what a button offers into a file."""
        with self.page.expect_download(timeout=PATIENCE) as found:
            self.page.get_by_text(label).click()
        found.value.save_as(path)
        return path

    def complaints(self, count):
        """Wait until so many complaints are to be seen."""
        shown = self.page.locator(".notice.error:visible")
        self.look(lambda: shown.count() == count, f"{count} complaints")

    def look(self, sees, what):
        """Wait until `sees` is true, and fail if it does not come to that."""
        until = time.monotonic() + PATIENCE / 1e3
        while not sees():
            assert time.monotonic() < until, f"no {what}"
            self.page.wait_for_timeout(BETWEEN)

    def drawn(self, count):
        """Wait until there are so many figures, each with something on it.

        A figure of before is counted no more once `forget_charts` was called.
        """
        shown = self.page.locator(".chart:not([data-before])")
        script = f"all => all.length === {count} && all.every({GREY})"
        self.look(lambda: shown.evaluate_all(script), f"{count} figures")

    def preview(self, table, figures):
        """Wait for the page of a preview with so many figures."""
        frame = self.page.frame_locator(f"iframe[title='Preview of the {table}']")
        frame.locator("html[data-drawn]").wait_for(timeout=PATIENCE, state="attached")
        assert frame.locator("figure").count() == figures

    def forget_charts(self):
        self.page.locator(".chart").evaluate_all("all => all.forEach(e => e.dataset.before = 1)")

    def laid_out(self, selector):
        """Wait until elements keep their places, with a width; return their left and right ends."""
        seen = [[]]

        def kept():
            seen.append(self.page.locator(selector).evaluate_all(ENDS))
            return seen[-2] == seen[-1] and all(left < right for left, right in seen[-1])

        self.look(kept, "lasting places")
        return seen[-1]


ENDS = """all => all.map(e => e.getBoundingClientRect()).map(box => [box.left, box.right])"""


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    return tmp_path_factory.mktemp("visits")


@pytest.fixture(scope="module")
def server(root):
    """Start the page as a user does; give its address."""
    command = [sys.executable, "-m", "gripscale", "app", "--no-browser", "--folder", str(root)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    found = re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline())
    yield found[0]
    process.terminate()
    process.wait(20)
    process.stdout.close()


@contextmanager
def visit(browser, server):
    """Open the page; collect warnings, errors and requests to anywhere else."""
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    seen = AppVisit(context.new_page())

    def ask(request):
        if not request.url.startswith((server, "data:", "blob:", "about:")):
            seen.asked.append(request.url)

    seen.page.on("request", ask)
    seen.page.goto(server)
    seen.says("This case can be run")
    seen.page.locator(".chart").wait_for(timeout=PATIENCE)  # the shipped road, as measured
    yield seen
    context.close()


def open_small(seen, small):
    """Drop the small case with its files; wait until it is shown."""
    seen.drop(-1, *(small / name for name in ("case.toml", "road.txt", "dma.txt")))
    seen.look(lambda: '"inputs/dma.txt"' in seen.case(), "files of the case")
    seen.look(lambda: '"inputs/road.txt"' in seen.case(), "files of the case")
    seen.says("This case can be run")


@pytest.fixture(scope="module")
def whole_way(browser, server, small):
    """Open a case with its files, change the speed, run it, and run it slower."""
    with visit(browser, server) as seen:
        open_small(seen, small)
        for number, speed in enumerate(("0.3 m/s", "0.03 m/s"), 1):
            seen.tab("3 Load")
            seen.page.get_by_label("speed").fill(speed)
            seen.page.get_by_label("speed").press("Enter")
            seen.look(lambda: f'speed = "{speed}"' in seen.case(), "speed in the case")  # noqa: B023
            seen.tab("4 Run")
            seen.press("Run")
            seen.says(f"run-{number}, contact and friction, has finished")
        yield seen


def test_road_and_rubber_are_drawn(whole_way):
    whole_way.tab("1 Road")
    whole_way.drawn(1)
    whole_way.press("Read, clean and fit")
    whole_way.preview("surface", 3)
    whole_way.tab("2 Rubber")
    whole_way.press("Read and fit")
    whole_way.preview("rubber", 2)


def test_what_is_saved_is_what_is_shown(whole_way, tmp_path):
    whole_way.tab("5 Results")
    whole_way.page.locator(REPORT).wait_for(timeout=PATIENCE)
    names = zipfile.ZipFile(whole_way.saved("Save everything", tmp_path / "all.zip")).namelist()
    files = ("chain.nc", "report.html", "case.toml", "inputs/road.txt")
    assert {f"run-2/{name}" for name in files} <= set(names)
    whole_way.tab("4 Run")
    saved = whole_way.saved("Save the case", tmp_path / "case.toml").read_text(encoding="utf-8")
    assert saved == whole_way.case()
    cards = whole_way.page.frame_locator("iframe.answer").locator("dl.cards")
    assert "0." in cards.inner_text(timeout=PATIENCE)


def test_the_report_is_as_wide_as_the_page_and_its_links_work(whole_way):
    whole_way.tab("5 Results")
    frame = whole_way.page.frame_locator(REPORT)
    frame.locator("html[data-drawn]").wait_for(timeout=PATIENCE, state="attached")
    title = frame.locator("h1").inner_text()
    assert title == "Contact and friction: dma on road"
    box = whole_way.page.locator(REPORT).bounding_box()
    assert box["width"] >= 0.95 * 1400
    assert box["height"] >= 600
    frame.locator("a[href='#rubber']").first.click()
    inside = "e => e.open && e.getBoundingClientRect().top < innerHeight"
    place = frame.locator("#rubber")
    whole_way.look(lambda: place.evaluate(inside), "the chapter on the rubber")
    alone = whole_way.page.get_by_text("Open this page alone")
    alone.scroll_into_view_if_needed()  # the jump to a chapter has moved the window as well
    whole_way.page.wait_for_timeout(BETWEEN)
    with whole_way.page.context.expect_page() as opened:
        alone.click()
    assert opened.value.locator("h1").inner_text() == title
    opened.value.close()


@pytest.mark.parametrize("width", [1400, 390])
def test_nothing_overflows(whole_way, width):
    whole_way.page.set_viewport_size({"width": width, "height": 900})
    for name in TABS:
        whole_way.tab(name)
        ends = whole_way.laid_out(".bk-tab")
        assert whole_way.width() <= width, name
        assert len(ends) == len(TABS), name
        assert all(0 <= left < right <= width for left, right in ends), (name, ends)
    whole_way.page.set_viewport_size({"width": 1400, "height": 900})


def test_silence_and_no_network_but_the_page(whole_way):
    assert whole_way.said == []
    assert whole_way.asked == []


def test_what_is_refused_is_one_sentence_and_the_page_lives_on(browser, server, tmp_path, small):
    picture = tmp_path / "picture.png"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00 no profile")
    with visit(browser, server) as seen:
        seen.drop(0, picture)
        complaint = seen.says("picture.png: expected a file with measured values")
        assert complaint.inner_text().count("\n") == 0
        seen.complaints(2)  # at the text, and where the road is
        assert seen.page.locator(".notice.good:visible").count() == 0, "never green beside red"
        seen.page.locator("[data-reading]").wait_for(timeout=PATIENCE, state="hidden")
        open_small(seen, small)
        seen.complaints(0)
        seen.write_case(seen.case().replace("inputs/road", "../../road"))
        seen.says("lies outside the folder of this page; drop the file")
        seen.complaints(2)
        seen.tab("2 Rubber")
        seen.complaints(1)
        seen.tab("4 Run")
        seen.press("Run")
        seen.complaints(2)
        assert seen.said == []


def test_a_drag_along_the_profile_is_the_crop_of_the_case(browser, server, small):
    with visit(browser, server) as seen:
        seen.forget_charts()  # of the shipped road
        open_small(seen, small)
        seen.drawn(1)
        seen.laid_out(".chart")
        box = seen.page.locator(".chart").bounding_box()
        height = box["y"] + 150
        seen.page.mouse.move(box["x"] + 0.3 * box["width"], height)
        seen.page.mouse.down()
        seen.page.mouse.move(box["x"] + 0.6 * box["width"], height, steps=5)
        seen.page.mouse.up()
        seen.look(lambda: "crop = [" in seen.case(), "crop in the case")
        seen.says("This case can be run")
        low, high = re.search(r'crop = \["([\d.]+) mm", "([\d.]+) mm"\]', seen.case()).groups()
        crop, shown = seen.page.get_by_label("crop").first, f'["{low} mm", "{high} mm"]'
        seen.look(lambda: crop.input_value() == shown, "crop in its field")
        # the axes take a tenth of the width, the road all of the rest: 0.3 of it is kept
        length = 1e3 * read_profile(small / "road.txt").length
        assert 0.25 < (float(high) - float(low)) / length < 0.45
        assert seen.said == []


def test_two_tabs_are_apart_and_a_run_is_stopped(browser, server, root):
    with visit(browser, server) as slow, visit(browser, server) as other:
        slow.write_case(SLOW)
        own = f"{other.case()}# mine"
        other.write_case(own)

        def kept():
            texts = [path.read_text(encoding="utf-8") for path in root.glob("*/case.toml")]
            return SLOW in texts and own in texts

        other.look(kept, "cases of their own")
        assert (slow.case(), other.case()) == (SLOW, own)
        slow.tab("4 Run")
        slow.press("Run")
        slow.says("run-1, contact and friction, is running")
        other.tab("5 Results")
        other.says("No case was run yet")
        slow.page.get_by_text("Command and output").click()
        output = slow.page.locator("pre:visible")
        output.wait_for(timeout=PATIENCE)
        slow.page.wait_for_timeout(3 * POLL)  # what follows the run does not fold it
        assert output.count() == 1
        slow.press("Stop")
        slow.says("run-1, contact and friction, was stopped")
        assert slow.said == []


def test_only_the_page_itself_may_connect(server):
    """Another page in the same browser, which knows address and token, is turned away."""
    host = server.removeprefix("http://").rstrip("/")
    with closing(http.client.HTTPConnection(host, timeout=30)) as connection:
        connection.request("GET", "/")
        found = re.search(r'"token":"([^"]+)"', connection.getresponse().read().decode())
    for origin, status in (("http://evil.example", 403), (server.rstrip("/"), 101)):
        headers = {
            "Origin": origin,
            "Upgrade": "websocket",
            "Connection": "Upgrade",
            "Sec-WebSocket-Version": "13",
            "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
            "Sec-WebSocket-Protocol": f"bokeh, {found[1]}",
        }
        with closing(http.client.HTTPConnection(host, timeout=30)) as connection:
            connection.request("GET", "/ws", headers=headers)
            answer = connection.getresponse()
            answer.close()
        assert answer.status == status
