"""The experiments, run once for numbers, texts and abilities."""

import pytest

from .experiments import run_experiments


@pytest.fixture(scope="session")
def experiments(tmp_path_factory):
    return run_experiments(tmp_path_factory.mktemp("experiments"))
