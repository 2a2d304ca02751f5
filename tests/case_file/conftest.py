"""A case of two waves by hand on a coarse mesh, solved in a fraction of a second; one of files."""

import pytest

from tests.cli.conftest import inputs as inputs
from tests.questions.conftest import _blank as _blank
from tests.samples import TWO_WAVES, case_text

CASE = case_text(TWO_WAVES)


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path
