"""A case of two waves by hand on a coarse mesh, solved in a fraction of a second; one of files."""

import pytest

from tests.cli.conftest import inputs as inputs
from tests.samples import TWO_WAVES, blank_figures, case_text

CASE = case_text(TWO_WAVES)


@pytest.fixture(scope="module", autouse=True)
def _blank():
    with blank_figures():
        yield


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path
