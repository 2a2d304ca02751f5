"""Numbers no measurement has: one sentence of ours for each, and never a warning."""

import contextlib
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gripscale.core.errors import FileError, InputError
from gripscale.rubber import MasterCurve, Rubber, fit_prony, read_master_curve
from tests.samples import EXAMPLES

DATA = EXAMPLES / "data/rubber"


def test_extreme_products_of_frequency_and_time():
    """w tau from 1e-200 to 1e200: the limits of a solid, without a warning."""
    rubber = Rubber(1e6, [2e6, 4e6], [1e-100, 1e100])
    assert rubber.complex_modulus([1e-99, 1e99]).real == pytest.approx([5e6, 5e6], rel=1e-1)
    assert rubber.complex_modulus([0.0, 1e100]) == pytest.approx([1e6, 6e6], rel=0.4)
    assert Rubber(1e6, [2e6], [1e60]).complex_modulus(1e100) == pytest.approx(3e6)
    assert rubber.relaxation_modulus(1e308) == 1e6
    with pytest.raises(InputError, match=r"omega must be finite numbers of at most 1e.100"):
        rubber.complex_modulus(1e101)
    with pytest.raises(InputError, match="relaxation_times must be numbers of at most"):
        Rubber(1e6, [1e6], [1e155])


@given(
    st.lists(
        st.tuples(*[st.floats(-60, 60).map(lambda power: 10.0**power)] * 3), min_size=2, max_size=25
    )
)
@settings(max_examples=40, deadline=None, derandomize=True)
def test_any_rows_are_fitted_or_refused(rows):
    with contextlib.suppress(InputError):
        rubber = fit_prony(MasterCurve(*np.array(rows).T))
        low, high = rubber.complex_modulus_band(1.0)
        assert np.isfinite([low, high]).all()


def mutated(content, chance):
    """Return a file with a few bytes, digits or lines changed, lost, doubled or swapped."""
    data = bytearray(content)
    for _ in range(chance.randint(1, 4)):
        at = chance.randrange(len(data))
        kind = chance.randrange(6)
        if kind == 0:
            data[at] = chance.randrange(256)
        elif kind == 1:
            del data[at : at + chance.randint(1, 30)]
        elif kind == 2:
            data[at:at] = data[at : at + chance.randint(1, 30)]
        elif kind == 3:
            odd = [b"1e308", b"-", b"nan", b"\t", b",", b"9" * 400, b"\r", b"\xff\xfe", b"E"]
            data[at:at] = chance.choice(odd)
        elif kind == 4:
            data[at : at + 1] = str(chance.randrange(10)).encode()
        else:
            lines = bytes(data).split(b"\n")
            chance.shuffle(lines)
            data = bytearray(b"\n".join(lines))
        if not data:
            return b""
    return bytes(data)


def test_mutations_of_a_shipped_file(tmp_path):
    """Nothing but our own errors, and no warning."""
    place = DATA / "measured_dma.txt"
    content, path = place.read_bytes(), tmp_path / place.name
    chance = random.Random(4)
    for _ in range(150):
        path.write_bytes(mutated(content, chance))
        with contextlib.suppress(InputError, FileError):
            read_master_curve(path)
