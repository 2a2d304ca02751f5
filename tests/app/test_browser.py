"""The page in a real headless Chromium: the whole way, a broken file, stopping, two tabs apart."""

from __future__ import annotations

import http.client
import os
import re
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

from gripscale.init import EXAMPLES

from .test_run import SLOW, there

playwright = pytest.importorskip("playwright.sync_api", reason="needs pip install playwright")

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
CHROMIUM = next((path for path in map(shutil.which, NAMES) if path is not None), None)
pytestmark = pytest.mark.skipif(
    CHROMIUM is None, reason=f"no browser ({', '.join(NAMES)}); on Debian: apt-get install chromium"
)
TABS = ("1 Road", "2 Rubber", "3 Load and conditions", "4 Run", "5 Results", "6 Compare")
PATIENCE = 60_000
"""Milliseconds that anything may take on a machine shared with other tests."""


@dataclass
class Visit:
    """An open page, and what it said and asked for."""

    page: Any
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

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

    def complaints(self, count: int) -> bool:
        """Wait until so many complaints are to be seen; return whether it came to that."""
        for _ in range(100):
            if self.page.locator(".notice.error:visible").count() == count:
                return True
            self.page.wait_for_timeout(100)
        return False

    def charts(self, least: int) -> int:
        """Wait for figures; assert that each is drawn and fits; return how many."""
        self.page.locator(".chart").nth(least - 1).wait_for(timeout=PATIENCE)
        self.page.wait_for_function(DRAWN, arg=least, timeout=PATIENCE, polling=300)
        return int(self.page.locator(".chart").count())

    def laid_out(self, selector: str) -> list[list[float]]:
        """Wait until elements keep their places, with a width; return their left and right ends."""
        before: list[list[float]] = []
        for _ in range(100):
            self.page.wait_for_timeout(150)
            ends: list[list[float]] = self.page.locator(selector).evaluate_all(ENDS)
            if ends == before and all(left < right for left, right in ends):
                break
            before = ends
        return ends

    def width(self) -> int:
        return int(self.page.evaluate("() => document.documentElement.scrollWidth"))


DRAWN = """least => {
    const all = root => [...root.querySelectorAll('*')].flatMap(
        e => e.shadowRoot ? [e, ...all(e.shadowRoot)] : [e]);
    const charts = all(document).filter(e => e.classList.contains('chart'));
    const coloured = canvas => {
        const size = [canvas.width, canvas.height];
        if (Math.min(...size) < 100) return false;
        const pixels = canvas.getContext('2d').getImageData(0, 0, ...size).data;
        for (let i = 0, count = 0; i < pixels.length; i += 4) {
            const [red, green, blue] = [pixels[i], pixels[i + 1], pixels[i + 2]];
            if (Math.max(red, green, blue) - Math.min(red, green, blue) > 60) count += 1;
            if (count > 50) return true;
        }
        return false;
    };
    const inside = chart => [chart, ...all(chart.shadowRoot ?? chart)];
    return charts.length >= least && charts.every(chart => inside(chart).some(
        e => e.tagName === 'CANVAS' && coloured(e)));
}"""
"""Whether every figure has a canvas of some size with curves on it: axes and letters are grey."""


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


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    options = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
    with playwright.sync_playwright() as started:
        chromium = started.chromium.launch(executable_path=CHROMIUM, args=options)
        yield chromium
        chromium.close()


@contextmanager
def visit(browser: Any, server: str) -> Iterator[Visit]:
    """Open the page; collect warnings, errors and requests to anywhere else."""
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    seen = Visit(context.new_page())

    def listen(message: Any) -> None:
        if message.type in ("error", "warning"):
            seen.said.append(message.text)

    def ask(request: Any) -> None:
        if not request.url.startswith((server, "data:", "blob:", "about:")):
            seen.asked.append(request.url)

    seen.page.on("console", listen)
    seen.page.on("pageerror", lambda error: seen.said.append(str(error)))
    seen.page.on("request", ask)
    seen.page.goto(server)
    seen.says("This case can be run")
    yield seen
    context.close()


def open_small(seen: Visit, small: Path) -> None:
    """Drop the small case with its files; wait until it is shown."""
    seen.drop(-1, *small.iterdir())
    seen.page.wait_for_function(
        """() => (function all(root) {
            return [...root.querySelectorAll('*')].some(e =>
                (e.tagName === 'TEXTAREA' && e.value.includes('"inputs/dma.txt"'))
                || (e.shadowRoot && all(e.shadowRoot)));
        })(document)""",
        timeout=PATIENCE,
    )
    seen.says("This case can be run")


@pytest.fixture(scope="module")
def whole_way(browser: Any, server: str, small: Path) -> Iterator[Visit]:
    """Open a case with its files, change the speed, run it, and run it slower."""
    with visit(browser, server) as seen:
        open_small(seen, small)
        for number, speed in enumerate(("0.3 m/s", "0.03 m/s"), 1):
            seen.tab("3 Load")
            seen.page.get_by_label("speed").fill(speed)
            seen.page.get_by_label("speed").press("Enter")
            seen.page.wait_for_timeout(300)
            seen.tab("4 Run")
            seen.press("Run the case")
            seen.says(f"run-{number} has finished")
        yield seen


def test_road_and_rubber_are_drawn(whole_way: Visit) -> None:
    whole_way.tab("1 Road")
    whole_way.press("Read, clean and fit")
    assert whole_way.charts(4) == 4
    whole_way.says("3 sine waves from")
    whole_way.says("Cleaning of road")
    whole_way.tab("2 Rubber")
    whole_way.press("Read and fit")
    assert whole_way.charts(4) == 4
    whole_way.says("Fast end of the data")


def test_results_are_those_of_the_files(whole_way: Visit, root: Path, tmp_path: Path) -> None:
    whole_way.tab("5 Results")
    whole_way.says("Friction coefficient")
    whole_way.says("Direct contact of the measured profiles, all waves at once")
    assert whole_way.charts(4) == 4
    with whole_way.page.expect_download(timeout=PATIENCE) as found:
        whole_way.page.get_by_text("Save everything").click()
    found.value.save_as(tmp_path / "all.zip")
    names = zipfile.ZipFile(tmp_path / "all.zip").namelist()
    assert {"run-2/dynamic.nc", "run-2/report.txt", "run-2/case.toml"} <= set(names)
    assert "run-2/inputs/road.txt" in names


def test_the_report_is_shown_inside_the_page(whole_way: Visit) -> None:
    whole_way.tab("5 Results")
    whole_way.press("Show the report here")
    frame = whole_way.page.frame_locator("iframe")
    frame.locator("html[data-drawn]").wait_for(timeout=PATIENCE, state="attached")
    assert frame.locator("h1").inner_text() == "Contact and friction: run-2.toml"


def test_runs_are_compared_by_what_is_different(whole_way: Visit) -> None:
    whole_way.tab("6 Compare")
    assert whole_way.charts(2) == 2
    rows = whole_way.page.locator("tbody tr").all_inner_texts()
    assert [row.split()[0] for row in rows] == ["run-1", "run-2"]
    assert "load.speed = 0.03 m/s" in rows[1]
    assert float(rows[0].split()[4]) > float(rows[1].split()[4]) > 0.0


def test_the_saved_case_is_the_text_shown(whole_way: Visit, tmp_path: Path) -> None:
    with whole_way.page.expect_download(timeout=PATIENCE) as found:
        whole_way.page.get_by_text("Save the case").click()
    found.value.save_as(tmp_path / "case.toml")
    text = (tmp_path / "case.toml").read_text(encoding="utf-8")
    assert text == whole_way.case()
    assert 'speed = "0.03 m/s"' in text


@pytest.mark.parametrize("width", [1400, 390])
def test_nothing_overflows(whole_way: Visit, width: int) -> None:
    whole_way.page.set_viewport_size({"width": width, "height": 900})
    for name in TABS:
        whole_way.tab(name)
        ends = whole_way.laid_out(".bk-tab")
        assert whole_way.width() <= width, name
        assert len(ends) == len(TABS), name
        assert all(0 <= left < right <= width for left, right in ends), (name, ends)
    whole_way.tab("5 Results")
    assert whole_way.charts(4) == 4


def test_silence_and_no_network_but_the_page(whole_way: Visit) -> None:
    assert whole_way.said == []
    assert whole_way.asked == []


def test_a_broken_file_is_one_sentence_and_the_page_lives_on(
    browser: Any, server: str, tmp_path: Path, small: Path
) -> None:
    broken = tmp_path / "broken.txt"
    broken.write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00 no profile")
    with visit(browser, server) as seen:
        seen.drop(0, broken)
        complaint = seen.says("inputs/broken.txt")
        assert complaint.inner_text().count("\n") == 0
        assert str(tmp_path) not in complaint.inner_text()
        open_small(seen, small)
        seen.press("Read, clean and fit")
        assert seen.charts(4) == 4
        assert seen.said == []


def test_a_case_that_reaches_outside_is_refused_where_the_road_is(
    browser: Any, server: str
) -> None:
    with visit(browser, server) as seen:
        seen.write_case(seen.case().replace("inputs/2021", "../../2021"))
        sentence = "lies outside the folder of this page; drop the file"
        seen.says(sentence)
        assert seen.complaints(2), "at the text, and where the road is"
        seen.tab("2 Rubber")
        assert seen.complaints(1)
        seen.tab("4 Run")
        seen.press("Run the case")
        assert seen.complaints(2)


def test_stop_ends_the_process(browser: Any, server: str, root: Path) -> None:
    psutil = pytest.importorskip("psutil", reason="looks for the process by psutil")
    server_pid = next(one.pid for one in psutil.Process().children() if str(root) in one.cmdline())
    with visit(browser, server) as seen:
        seen.write_case(SLOW)
        seen.tab("4 Run")
        seen.press("Run the case")
        seen.says("run-1 is running")
        mine = [one for one in psutil.Process(server_pid).children() if "run" in one.cmdline()]
        assert len(mine) == 1
        seen.press("Stop")
        seen.says("run-1 was stopped")
        assert not there(mine[0].pid)
        assert seen.said == []


def test_two_tabs_are_apart(browser: Any, server: str, root: Path) -> None:
    with visit(browser, server) as one, visit(browser, server) as other:
        before = other.case()
        one.write_case(SLOW)
        one.says("This case can be run")
        one.page.wait_for_timeout(300)
        assert other.case() == before
        cases = [path.read_text() for path in root.glob("*/case.toml")]
        assert SLOW in cases
        assert before in cases
        other.tab("5 Results")
        other.says("Nothing was run yet")


@pytest.mark.parametrize(("origin", "status"), [("http://evil.example", 403), ("", 101)])
def test_only_the_page_itself_may_connect(server: str, origin: str, status: int) -> None:
    """Another page in the same browser, which knows address and token, is turned away."""
    host = server.removeprefix("http://").rstrip("/")
    with closing(http.client.HTTPConnection(host, timeout=30)) as connection:
        connection.request("GET", "/")
        found = re.search(r'"token":"([^"]+)"', connection.getresponse().read().decode())
    assert found is not None
    headers = {
        "Origin": origin or server.rstrip("/"),
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


def test_the_usual_example_is_there_at_the_start(browser: Any, server: str) -> None:
    with visit(browser, server) as seen:
        assert "aylesbury" in seen.case()
        options = seen.page.get_by_label("Shipped example").locator("option").all_inner_texts()
        assert [text.partition(":")[0] for text in options] == list(EXAMPLES)
