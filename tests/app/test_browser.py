"""The page in a real headless Chromium: the whole way, a broken file, stopping, two tabs apart."""

from __future__ import annotations

import http.client
import io
import re
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from gripscale.app.case import MAX_UPLOAD
from gripscale.app.run_tabs import POLL
from gripscale.app.runs import COMMANDS
from gripscale.case_file import EXAMPLES
from gripscale.surface import read_profile
from tests.browsing import BETWEEN, CURVES, GREY, PATIENCE, Visit

from .test_run import SLOW, there

REPORT = "iframe[title^='Report of']"
TABS = ("1 Road", "2 Rubber", "3 Load and conditions", "4 Run", "5 Results", "6 All runs")


class AppVisit(Visit):
    """An open page of the app, and what is done on it."""

    def tab(self, name: str) -> None:
        self.page.locator(".bk-tab", has_text=name).click()

    def press(self, label: str) -> None:
        self.page.get_by_role("button", name=label, exact=True).click()

    def case(self) -> str:
        return str(self.page.get_by_label("case.toml").input_value())

    def write_case(self, text: str) -> None:
        self.page.get_by_label("case.toml").fill(text)
        self.page.get_by_label("case.toml").blur()

    def says(self, words: str) -> Any:
        found = self.page.get_by_text(re.compile(words)).first
        found.wait_for(timeout=PATIENCE)
        return found

    def drop(self, number: int, *files: Path) -> None:
        """Choose files at a place to drop them, by its number on the page; -1 opens a case."""
        places = self.page.locator("input[type=file]")
        places.nth(number if number >= 0 else places.count() + number).set_input_files(
            [str(path) for path in files]
        )

    def complaints(self, count: int) -> None:
        """Wait until so many complaints are to be seen."""
        shown = self.page.locator(".notice.error:visible")
        self.look(lambda: shown.count() == count, f"{count} complaints")

    def look(self, sees: Callable[[], bool], what: str) -> None:
        """Wait until `sees` is true, and fail if it does not come to that."""
        until = time.monotonic() + PATIENCE / 1e3
        while not sees():
            assert time.monotonic() < until, f"no {what}"
            self.page.wait_for_timeout(BETWEEN)

    def charts(self, count: int, grey: int = 0) -> None:
        """Wait until there are so many figures, each with curves on it, some of them only grey.

        A figure of before is counted no more once `forget_charts` was called.
        """
        coloured = f"all.filter({CURVES}).length >= {count - grey}"
        drawn = f"all => all.length === {count} && all.every({GREY}) && {coloured}"
        shown = self.page.locator(".chart:not([data-before])")
        self.look(lambda: shown.evaluate_all(drawn), f"{count} figures with curves")

    def previews(self, table: str, count: int, words: str) -> None:
        """Wait for the page of a preview, with so many figures and a text."""
        frame = self.page.frame_locator(f"iframe[title='Preview of the {table}']")
        frame.locator("html[data-drawn]").wait_for(timeout=PATIENCE, state="attached")
        assert frame.locator("figure").count() == count
        assert frame.get_by_text(re.compile(words)).count()

    def forget_charts(self) -> None:
        self.page.locator(".chart").evaluate_all("all => all.forEach(e => e.dataset.before = 1)")

    def laid_out(self, selector: str) -> list[list[float]]:
        """Wait until elements keep their places, with a width; return their left and right ends."""
        seen: list[list[list[float]]] = [[]]

        def kept() -> bool:
            seen.append(self.page.locator(selector).evaluate_all(ENDS))
            return seen[-2] == seen[-1] and all(left < right for left, right in seen[-1])

        self.look(kept, "lasting places")
        return seen[-1]


ENDS = """all => all.map(e => e.getBoundingClientRect()).map(box => [box.left, box.right])"""
"""Left and right end of elements."""


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("visits")


@pytest.fixture(scope="module")
def server(root: Path) -> Iterator[str]:
    """Start the page as a user does; give its address."""
    command = [sys.executable, "-m", "gripscale", "app", "--no-browser", "--folder", str(root)]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    found = re.search(r"http://127\.0\.0\.1:\d+/", process.stdout.readline())
    assert found is not None
    yield found[0]
    process.terminate()
    process.wait(20)
    process.stdout.close()


@contextmanager
def visit(browser: Any, server: str) -> Iterator[AppVisit]:
    """Open the page; collect warnings, errors and requests to anywhere else."""
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    seen = AppVisit(context.new_page())

    def ask(request: Any) -> None:
        if not request.url.startswith((server, "data:", "blob:", "about:")):
            seen.asked.append(request.url)

    seen.page.on("request", ask)
    seen.page.goto(server)
    seen.says("This case can be run")
    seen.page.locator(".chart").wait_for(timeout=PATIENCE)  # the shipped road, as measured
    yield seen
    context.close()


def open_small(seen: AppVisit, small: Path) -> None:
    """Drop the small case with its files; wait until it is shown."""
    seen.drop(-1, *(small / name for name in ("case.toml", "road.txt", "dma.txt")))
    seen.look(lambda: '"inputs/dma.txt"' in seen.case(), "files of the case")
    seen.look(lambda: '"inputs/road.txt"' in seen.case(), "files of the case")
    seen.says("This case can be run")


@pytest.fixture(scope="module")
def whole_way(browser: Any, server: str, small: Path) -> Iterator[AppVisit]:
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


def test_road_and_rubber_are_drawn(whole_way: AppVisit) -> None:
    whole_way.tab("1 Road")
    whole_way.charts(1, grey=1)
    whole_way.press("Read, clean and fit")
    whole_way.previews("surface", 3, "Cleaning of road")
    whole_way.tab("2 Rubber")
    whole_way.press("Read and fit")
    whole_way.previews("rubber", 2, "Fast end of the data")


def test_results_are_those_of_the_files(whole_way: AppVisit, tmp_path: Path) -> None:
    whole_way.tab("5 Results")
    whole_way.page.locator(REPORT).wait_for(timeout=PATIENCE)
    with whole_way.page.expect_download(timeout=PATIENCE) as found:
        whole_way.page.get_by_text("Save everything").click()
    found.value.save_as(tmp_path / "all.zip")
    names = zipfile.ZipFile(tmp_path / "all.zip").namelist()
    assert {"run-2/chain.nc", "run-2/report.html"} <= set(names)
    assert {"run-2/case.toml", "run-2/inputs/road.txt"} <= set(names)


def test_the_report_is_as_wide_as_the_page_and_its_links_work(whole_way: AppVisit) -> None:
    whole_way.tab("5 Results")
    frame = whole_way.page.frame_locator(REPORT)
    frame.locator("html[data-drawn]").wait_for(timeout=PATIENCE, state="attached")
    assert frame.locator("h1").inner_text() == "Contact and friction: dma on road"
    box = whole_way.page.locator(REPORT).bounding_box()
    assert box["width"] >= 0.95 * 1400
    assert box["height"] >= 600
    frame.locator("a[href='#rubber']").first.click()
    inside = "e => e.open && e.getBoundingClientRect().top < innerHeight"
    place = frame.locator("#rubber")
    whole_way.look(lambda: place.evaluate(inside), "the chapter on the rubber")
    assert frame.locator("h1").inner_text() == "Contact and friction: dma on road"
    alone = whole_way.page.get_by_text("Open this page alone")
    alone.scroll_into_view_if_needed()  # the jump to a chapter has moved the window as well
    whole_way.page.wait_for_timeout(BETWEEN)
    with whole_way.page.context.expect_page() as opened:
        alone.click()
    assert opened.value.locator("h1").inner_text() == "Contact and friction: dma on road"
    opened.value.close()


def test_runs_are_compared_by_what_is_different(whole_way: AppVisit) -> None:
    whole_way.tab("6 All runs")

    def of_runs() -> list[str]:
        texts = whole_way.page.locator("tbody tr").all_inner_texts()
        return [text for text in texts if text.startswith("run-")]

    whole_way.look(lambda: len(of_runs()) == 2, "both runs")
    rows = of_runs()
    assert [row.split()[0] for row in rows] == ["run-1", "run-2"]
    assert "load.speed = 0.03 m/s" in rows[1]
    numbers = [re.findall(r"= (\d+\.\d+)", row.partition("load.speed")[0]) for row in rows]
    assert len(numbers[0]) == len(numbers[1]) == 2
    assert numbers[0] != numbers[1]


def test_the_saved_case_is_the_text_shown(whole_way: AppVisit, tmp_path: Path) -> None:
    whole_way.tab("4 Run")
    with whole_way.page.expect_download(timeout=PATIENCE) as found:
        whole_way.page.get_by_text("Save the case").click()
    found.value.save_as(tmp_path / "case.toml")
    text = (tmp_path / "case.toml").read_text(encoding="utf-8")
    assert text == whole_way.case()
    assert 'speed = "0.03 m/s"' in text


def test_the_run_tab_leads_with_the_answer(whole_way: AppVisit) -> None:
    whole_way.tab("4 Run")
    answer = whole_way.page.locator("iframe.answer")
    answer.wait_for(timeout=PATIENCE)
    assert "0." in whole_way.page.frame_locator("iframe.answer").locator("dl.cards").inner_text()
    question = whole_way.page.get_by_label("Question")
    assert answer.bounding_box()["y"] < question.bounding_box()["y"]


def paper(picture: bytes) -> tuple[int, ...]:
    """Return the commonest colour of a picture."""
    image = Image.open(io.BytesIO(picture)).convert("RGB")
    return tuple(max(image.getcolors(image.width * image.height))[1])


def test_page_and_report_are_dark_in_a_dark_browser(whole_way: AppVisit) -> None:
    """The page is inverted with its figures, and the report in it, dark by itself, is not."""
    whole_way.page.emulate_media(color_scheme="dark")
    whole_way.tab("5 Results")
    frame = whole_way.page.locator(REPORT)
    whole_way.page.frame_locator(REPORT).locator("html[data-drawn]").wait_for(
        timeout=PATIENCE, state="attached"
    )
    for picture in (frame.screenshot(), whole_way.page.screenshot(clip=TOP)):
        assert paper(picture) == pytest.approx((25, 25, 25), abs=3)  # of rounding in filters
    whole_way.page.emulate_media(color_scheme="light")
    for _ in range(50):  # a busy browser takes its time to draw the page anew
        light = paper(whole_way.page.screenshot(clip=TOP))
        if light == (255, 255, 255):
            break
        whole_way.page.wait_for_timeout(100)
    assert light == (255, 255, 255)


TOP = {"x": 0.0, "y": 0.0, "width": 1400.0, "height": 60.0}
"""Where the title of the page stands."""


@pytest.mark.parametrize("width", [1400, 390])
def test_nothing_overflows(whole_way: AppVisit, width: int) -> None:
    whole_way.page.set_viewport_size({"width": width, "height": 900})
    for name in TABS:
        whole_way.tab(name)
        ends = whole_way.laid_out(".bk-tab")
        assert whole_way.width() <= width, name
        assert len(ends) == len(TABS), name
        assert all(0 <= left < right <= width for left, right in ends), (name, ends)
    whole_way.tab("4 Run")
    for question in ("Surfaces under this rubber", "Area term", "Contact and friction"):
        whole_way.page.get_by_label("Question").select_option(label=question)
        whole_way.says(next(each.about for each in COMMANDS if each.title == question))
        assert whole_way.width() <= width, question
    whole_way.page.set_viewport_size({"width": 1400, "height": 900})


def test_silence_and_no_network_but_the_page(whole_way: AppVisit) -> None:
    assert whole_way.said == []
    assert whole_way.asked == []


NAMED = """() => document.addEventListener('input', event => {
    const area = event.composedPath().find(part => part.dataset?.reading)
    window.named = area?.dataset.reading
})"""
"""Keeps what an area says of files in the very event of their choice, before any other."""


def test_what_is_refused_is_one_sentence_and_the_page_lives_on(
    browser: Any, server: str, tmp_path: Path, small: Path
) -> None:
    picture = tmp_path / "picture.png"
    picture.write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00 no profile")
    with visit(browser, server) as seen:
        seen.page.evaluate(NAMED)
        seen.drop(0, picture)
        assert seen.page.evaluate("named") == "Reading picture.png ..."
        complaint = seen.says("picture.png: expected a file with measured values; got a picture")
        assert complaint.inner_text().count("\n") == 0
        seen.complaints(2)  # at the text, and where the road is
        assert seen.page.locator(".notice.good:visible").count() == 0, "never green beside red"
        seen.page.locator("[data-reading]").wait_for(timeout=PATIENCE, state="hidden")
        open_small(seen, small)
        seen.complaints(0)
        seen.press("Read, clean and fit")
        seen.previews("surface", 3, "Cleaning of road")
        seen.write_case(seen.case().replace("inputs/road", "../../road"))
        seen.says("lies outside the folder of this page; drop the file")
        seen.complaints(2)
        seen.tab("2 Rubber")
        seen.complaints(1)
        seen.tab("4 Run")
        seen.press("Run")
        seen.complaints(2)
        assert seen.said == []


TEXTS = """text => {
    window.texts = []
    const keep = () => text.value !== window.texts.at(-1) && window.texts.push(text.value)
    setInterval(keep, 5)
}"""
"""Keeps every text that the case has from now on."""


@pytest.mark.verification
def test_files_dropped_together_are_taken_together(
    browser: Any, server: str, small: Path, tmp_path: Path
) -> None:
    lines = [tmp_path / f"line_{number}.txt" for number in range(5)]
    rows = (small / "road.txt").read_text(encoding="utf-8").splitlines()
    for number, line in enumerate(lines):  # the same measurement counts once
        line.write_text("\n".join(rows[: len(rows) - number]) + "\n", encoding="utf-8")
    with visit(browser, server) as seen:
        seen.page.get_by_label("case.toml").evaluate(TEXTS)
        seen.drop(0, *lines)
        seen.look(lambda: all(f'"inputs/{line.name}"' in seen.case() for line in lines), "lines")
        seen.page.locator("iframe[title='Preview of the surface']").wait_for(timeout=PATIENCE)
        texts = seen.page.evaluate("texts")
        assert [text.count("inputs/line_") for text in texts] == [0, len(lines)]
        seen.drop(0, *lines[:2])
        seen.look(lambda: seen.case().count("inputs/line_") == 2, "lines of a second drop")
        with (tmp_path / "large.txt").open("wb") as file:
            file.truncate(MAX_UPLOAD + 1)
        seen.drop(0, lines[0], tmp_path / "large.txt")
        seen.says("large.txt is too large; expected files of at most 50 MB, and none of these")
        assert seen.case().count("inputs/line_") == 2
        assert seen.said == []


def test_a_drag_along_the_profile_is_the_crop_of_the_case(
    browser: Any, server: str, small: Path
) -> None:
    with visit(browser, server) as seen:
        seen.forget_charts()  # of the shipped road
        open_small(seen, small)
        seen.charts(1, grey=1)
        seen.laid_out(".chart")
        box = seen.page.locator(".chart").bounding_box()
        left, right = (box["x"] + share * box["width"] for share in (0.3, 0.6))
        height = box["y"] + 150
        seen.page.mouse.move(left, height)
        seen.page.mouse.down()
        seen.page.mouse.move(right, height, steps=5)
        seen.page.mouse.up()
        seen.look(lambda: "crop = [" in seen.case(), "crop in the case")
        seen.says("This case can be run")
        low, high = re.search(r'crop = \["([\d.]+) mm", "([\d.]+) mm"\]', seen.case()).groups()
        seen.look(
            lambda: (
                seen.page.get_by_label("crop").first.input_value() == f'["{low} mm", "{high} mm"]'
            ),
            "crop in its field",
        )
        # the axes take a tenth of the width, the road all of the rest: 0.3 of it is kept
        length = whole_length(small)
        assert 0.25 < (float(high) - float(low)) / length < 0.45
        assert seen.said == []


def whole_length(small: Path) -> float:
    """Return the length of the small road [mm]."""
    profile = read_profile(small / "road.txt")
    return 1e3 * profile.length


SIGN = 0.3
"""Seconds from a click to a sign of life."""
FIRST_CHANGE = """label => new Promise(done => {
    const roots = [document];
    for (const root of roots)
        for (const e of root.querySelectorAll('*')) if (e.shadowRoot) roots.push(e.shadowRoot);
    const all = roots.flatMap(root => [...root.querySelectorAll('button')]);
    const clicked = all.find(e => e.textContent.trim() === label);
    const start = performance.now();
    const watch = new MutationObserver(() => {
        if (clicked.disabled) { watch.disconnect(); done(performance.now() - start); }
    });
    watch.observe(clicked, {attributes: true});
    clicked.click();
})"""
"""Milliseconds from a click on a button to the moment it is disabled, by the clock of the page."""


@pytest.mark.parametrize(
    ("tab", "label"),
    [
        ("1 Road", "Read, clean and fit"),
        pytest.param("1 Road", "Load the example", marks=pytest.mark.verification),
        pytest.param("2 Rubber", "Read and fit", marks=pytest.mark.verification),
        pytest.param("4 Run", "Run", marks=pytest.mark.verification),
    ],
)
def test_a_click_shows_at_once_that_work_is_under_way(
    browser: Any, server: str, small: Path, tab: str, label: str
) -> None:
    """The browser itself changes the button, so that neither server nor network counts.

    Some 10 ms on a free machine; the best of three clicks must keep to the time, as other tests on
    the same two cores may hold the browser back for longer.
    """
    times = []
    with visit(browser, server) as seen:
        open_small(seen, small)
        seen.tab(tab)
        button = seen.page.get_by_role("button", name=label, exact=True)
        for _ in range(3):
            seen.look(lambda: button.is_enabled(), "end of the work")
            times.append(seen.page.evaluate(FIRST_CHANGE, label) / 1e3)
    assert min(times) < SIGN
    assert seen.said == []


@pytest.fixture(scope="module")
def slow(browser: Any, server: str) -> Iterator[AppVisit]:
    """Open a page and write a case of minutes."""
    with visit(browser, server) as seen:
        seen.write_case(SLOW)
        yield seen


def test_two_tabs_are_apart(slow: AppVisit, browser: Any, server: str, root: Path) -> None:
    with visit(browser, server) as other:
        assert "aylesbury" in other.case()
        options = other.page.get_by_label("Shipped example").locator("option").all_inner_texts()
        assert [text.partition(":")[0] for text in options] == list(EXAMPLES)
        own = f"{other.case()}# mine"
        other.write_case(own)

        def kept() -> bool:
            texts = [path.read_text(encoding="utf-8") for path in root.glob("*/case.toml")]
            return SLOW in texts and own in texts

        other.look(kept, "cases of their own")
        assert (slow.case(), other.case()) == (SLOW, own)
        other.tab("5 Results")
        other.says("No case was run yet")


def test_stop_ends_the_process(slow: AppVisit, root: Path) -> None:
    psutil = pytest.importorskip("psutil", reason="looks for the process by psutil")
    server_pid = next(one.pid for one in psutil.Process().children() if str(root) in one.cmdline())
    slow.says("This case can be run")
    slow.tab("4 Run")
    slow.press("Run")
    slow.says("run-1, contact and friction, is running")
    mine = [one for one in psutil.Process(server_pid).children() if "run" in one.cmdline()]
    assert len(mine) == 1
    slow.page.get_by_text("Command and output").click()
    output = slow.page.locator("pre:visible")
    output.wait_for(timeout=PATIENCE)
    slow.page.wait_for_timeout(3 * POLL)  # what follows the run does not fold it
    assert output.count() == 1
    slow.press("Stop")
    slow.says("run-1, contact and friction, was stopped")
    assert not there(mine[0].pid)
    assert slow.said == []


@pytest.fixture(scope="module")
def token(server: str) -> str:
    """Return what the page gives whoever may connect."""
    host = server.removeprefix("http://").rstrip("/")
    with closing(http.client.HTTPConnection(host, timeout=30)) as connection:
        connection.request("GET", "/")
        found = re.search(r'"token":"([^"]+)"', connection.getresponse().read().decode())
    assert found is not None
    return found[1]


@pytest.mark.parametrize(("origin", "status"), [("http://evil.example", 403), ("", 101)])
def test_only_the_page_itself_may_connect(
    server: str, token: str, origin: str, status: int
) -> None:
    """Another page in the same browser, which knows address and token, is turned away."""
    host = server.removeprefix("http://").rstrip("/")
    headers = {
        "Origin": origin or server.rstrip("/"),
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==",
        "Sec-WebSocket-Protocol": f"bokeh, {token}",
    }
    with closing(http.client.HTTPConnection(host, timeout=30)) as connection:
        connection.request("GET", "/ws", headers=headers)
        answer = connection.getresponse()
        answer.close()
    assert answer.status == status
