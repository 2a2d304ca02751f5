"""The inputs of the reproduction, read and fitted once."""

from __future__ import annotations

import pytest

from reproduction.inputs import Inputs, read_inputs


@pytest.fixture(scope="session")
def inputs() -> Inputs:
    return read_inputs()
