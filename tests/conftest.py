"""What all tests stand on: the cores of their process, the command line, and the browser.

The same roads and rubbers are read by hundreds of tests: they are fitted once in a process.
"""

from __future__ import annotations

import gc
import os
import pickle
import signal
from collections.abc import Callable, Iterator
from contextlib import nullcontext
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.figure  # noqa: F401  # commands of the tests draw in this process
import pytest
import typer.testing
from typer.testing import CliRunner, Result

from gripscale.cli import app
from gripscale.core.parallel import sharing
from gripscale.rubber import maxwell_fit, prony
from gripscale.surface import sine_fit
from tests.browsing import started_browser
from tests.samples import Shell


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Start with the golden files: in the middle, two processes would each prepare their runs."""
    items.sort(key=lambda item: not item.nodeid.startswith("tests/golden"))


def pytest_collection_finish() -> None:
    """Look for garbage less often, and not among what all tests share."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 50, 100)


@pytest.fixture(scope="session", autouse=True)
def _own_core() -> Iterator[None]:
    """Let a process of pytest-xdist use one core: the others have theirs."""
    with sharing(1) if "PYTEST_XDIST_WORKER" in os.environ else nullcontext():
        yield


@pytest.fixture(scope="session", autouse=True)
def _heeds_interrupts() -> Iterator[None]:
    """Heed Ctrl-C where a shell has the tests in the background, too: some send it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def _kept(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that keeps what `function` returns, by all that it is given."""
    known: dict[bytes, Any] = {}

    def call(*given: Any, **options: Any) -> Any:
        key = pickle.dumps((given, options))
        if key not in known:
            known[key] = function(*given, **options)
        return known[key]

    return call


@pytest.fixture(scope="session", autouse=True)
def _fitted_once() -> Iterator[None]:
    """Search for the waves of the same road, and fit the same rubber, once in a process."""
    fits = (
        (sine_fit, "search"),
        (maxwell_fit, "screen_outliers"),
        (maxwell_fit, "fit_spectrum"),
        (prony, "extremes"),
    )
    with pytest.MonkeyPatch.context() as patch:
        for module, name in fits:
            patch.setattr(module, name, _kept(getattr(module, name)))
        yield


@pytest.fixture(scope="session", autouse=True)
def _commands_built_once() -> Iterator[None]:
    """Build the commands from their functions, a tenth of a second, once in a process."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(typer.testing, "_get_command", cache(typer.testing._get_command))
        yield


@pytest.fixture(scope="session")
def shell() -> Shell:
    """Run a command in this process, its output as into a file; fail unless it ends with `code`."""

    def run(*arguments: object, columns: int = 100, code: int = 0) -> Result:
        environment = {"COLUMNS": str(columns), "NO_COLOR": "1", "TERM": "dumb"}
        words = [str(argument) for argument in arguments]
        result = CliRunner().invoke(app, words, env=environment)
        assert result.exit_code == code, result.output
        return result

    return run


@pytest.fixture
def written(tmp_path: Path) -> Callable[..., Path]:
    """Write bytes, a text, or lines to a file, and return its path."""

    def write(
        content: bytes | str | list[str], name: str = "table.csv", encoding: str = "utf-8"
    ) -> Path:
        text = "\n".join(content) if isinstance(content, list) else content
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
        return path

    return write


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Start Chromium for one file of tests; what drives it would disturb asyncio in others."""
    with started_browser() as chromium:
        yield chromium
