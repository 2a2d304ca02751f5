"""The browser of the tests that open pages."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.browsing import started_browser


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Start Chromium for one file of tests; what drives it would disturb asyncio in others."""
    with started_browser() as chromium:
        yield chromium
