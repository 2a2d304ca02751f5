"""The inputs of the reproduction, read and fitted once."""

import pytest

from gripscale.reproduction.inputs import read_inputs


@pytest.fixture(scope="session")
def inputs():
    return read_inputs()
