"""The inputs of the reproduction, read and fitted once."""

from __future__ import annotations

import pytest

from gripscale.reproduce.bench import Bench
from gripscale.reproduce.bench import bench as read_bench


@pytest.fixture(scope="session")
def bench() -> Bench:
    return read_bench()
