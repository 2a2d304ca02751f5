"""A case of three small waves by hand on a coarse mesh, which solves in a fraction of a second."""

import numpy as np
import pytest

from tests.samples import THREE_WAVES, case_text

CASE = case_text(THREE_WAVES)


@pytest.fixture
def case(tmp_path):
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


@pytest.fixture
def same_bytes():
    """Assert that two Datasets hold the same, to the last bit."""

    def compare(one, other):
        assert list(one.variables) == list(other.variables)
        assert one.attrs == other.attrs
        for name in one.variables:
            a, b = one[name], other[name]
            assert (a.dims, a.dtype, a.attrs) == (b.dims, b.dtype, b.attrs), name
            if a.dtype == object:
                assert a.values.tolist() == b.values.tolist(), name
            else:
                assert np.ascontiguousarray(a).tobytes() == np.ascontiguousarray(b).tobytes(), name

    return compare
