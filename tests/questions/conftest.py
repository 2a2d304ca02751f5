"""Questions are asked without rendering their figures."""

import pytest

from tests.samples import blank_figures


@pytest.fixture(scope="module", autouse=True)
def _blank():
    with blank_figures():
        yield
