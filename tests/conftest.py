"""What all tests stand on: the cores of their process, and the browser of those that open pages."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import nullcontext
from typing import Any

import pytest

from gripscale.core.parallel import sharing
from tests.browsing import started_browser


@pytest.fixture(scope="session", autouse=True)
def _own_core() -> Iterator[None]:
    """Let a process of pytest-xdist use one core: the others have theirs."""
    with sharing(1) if "PYTEST_XDIST_WORKER" in os.environ else nullcontext():
        yield


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Start Chromium for one file of tests; what drives it would disturb asyncio in others."""
    with started_browser() as chromium:
        yield chromium
