"""The experiments, run once for numbers, texts and abilities."""

from __future__ import annotations

import pytest

from .experiments import Experiments, run_experiments


@pytest.fixture(scope="session")
def experiments(tmp_path_factory: pytest.TempPathFactory) -> Experiments:
    return run_experiments(tmp_path_factory.mktemp("experiments"))
