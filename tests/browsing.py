"""Pages in a real headless Chromium: where it is, what a page said and asked for, how to wait."""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
CHROMIUM = next((path for path in map(shutil.which, NAMES) if path is not None), None)
PATIENCE = 60_000
"""Milliseconds that anything may take on a machine shared with other tests."""
BETWEEN = 100
"""Milliseconds between two looks at what is waited for."""


INK = """(place, least) => {
    const all = root => [...root.querySelectorAll('*')].flatMap(
        e => e.shadowRoot ? [e, ...all(e.shadowRoot)] : [e]);
    const drawn = canvas => {
        const size = [canvas.width, canvas.height];
        if (Math.min(...size) < 100) return false;
        const pixels = canvas.getContext('2d').getImageData(0, 0, ...size).data;
        for (let i = 0, count = 0; i < pixels.length; i += 4) {
            const [red, green, blue, ink] = pixels.subarray(i, i + 4);
            const lightest = Math.max(red, green, blue), darkest = Math.min(red, green, blue);
            count += ink > 100 && lightest - darkest >= least && darkest < 200;
            if (count > 20) return true;
        }
        return false;
    };
    return all(place.shadowRoot ?? place).some(e => e.tagName === 'CANVAS' && drawn(e));
}"""
"""Whether a place holds a figure with more than 20 pixels whose lightest and darkest of three
colours differ by `least`."""
CURVES = f"place => ({INK})(place, 60)"
"""Whether a place holds a figure with curves: axes and letters are grey, a point has 40 pixels."""
GREY = f"place => ({INK})(place, 0)"
"""Whether a place holds a figure with anything drawn, if only axes."""


@contextmanager
def started_browser() -> Iterator[Any]:
    """Start Chromium; skip the test where there is none, or no library that drives it."""
    driver = pytest.importorskip("playwright.sync_api", reason="needs pip install playwright")
    if CHROMIUM is None:
        names = ", ".join(NAMES)
        pytest.skip(f"no browser ({names}); on Debian: apt-get install chromium")
    options = ["--no-sandbox"] if hasattr(os, "geteuid") and os.geteuid() == 0 else []
    with driver.sync_playwright() as started:
        chromium = started.chromium.launch(executable_path=CHROMIUM, args=options)
        yield chromium
        chromium.close()


@dataclass
class Visit:
    """An open page, and what it said and asked for."""

    page: Any
    said: list[str] = field(default_factory=list)
    asked: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.page.on("console", self._listen)
        self.page.on("pageerror", lambda error: self.said.append(str(error)))

    def _listen(self, message: Any) -> None:
        of_this_test = "getImageData" in message.text  # `CURVES` looks at figures again and again
        if message.type in ("error", "warning") and not of_this_test:
            self.said.append(message.text)

    def until(self, script: str, given: Any = None) -> None:
        """Wait until a function of the page is true."""
        self.page.wait_for_function(script, arg=given, timeout=PATIENCE, polling=BETWEEN)

    def width(self) -> int:
        """Return how wide the page is [px]."""
        return int(self.page.evaluate("() => document.documentElement.scrollWidth"))
