"""Questions are asked without rendering their figures."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.samples import blank_figures


@pytest.fixture(scope="module", autouse=True)
def _blank() -> Iterator[None]:
    with blank_figures():
        yield
