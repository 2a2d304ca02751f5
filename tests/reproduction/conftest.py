"""The inputs of the reproduction, read and fitted once."""

from __future__ import annotations

import pytest

from gripscale.reproduction.inputs import PaperInputs, read_inputs


@pytest.fixture(scope="session")
def inputs() -> PaperInputs:
    return read_inputs()
