"""Whole results equal those kept here: a move of code must not change a number.

Newton stops at a residual of 1e-8, so where sums run in another order (other vector instructions)
results may differ by a small multiple of that; on the instructions the file was written with,
the same operations must give the same numbers to round-off.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from .instruction_set import instruction_set
from .quantities import Numbers, all_numbers

SAME, OTHER = 1e-12, 1e-5
ZERO = 1e-9
"""Frictions at rest are zero to the residual of the solver: numbers below this stay so."""


@pytest.fixture(scope="module")
def golden() -> Numbers:
    with np.load(Path(__file__).with_name("golden.npz")) as kept:
        return {name: kept[name] for name in kept.files}


@pytest.fixture(scope="module")
def now() -> Numbers:
    return all_numbers()


def test_every_number_is_there(golden: Numbers, now: Numbers) -> None:
    assert set(golden) - {"instruction_set"} <= set(now)


def test_no_number_has_moved(golden: Numbers, now: Numbers) -> None:
    same = str(golden["instruction_set"]) == instruction_set()
    counted = ("newton_iterations", "load_steps", "residual")
    moved = []
    for name, before in golden.items():
        if name == "instruction_set" or (not same and name.endswith(counted)):
            continue
        after = now[name]
        assert after.shape == before.shape, name
        # A vector's small entries are known to the round-off of its large ones.
        scale = float(np.max(np.abs(before), initial=0.0, where=np.isfinite(before)))
        atol = ZERO if scale < ZERO else (SAME if same else OTHER) * scale
        close = np.isclose(after, before, rtol=0.0, atol=atol, equal_nan=True)
        if not close.all():
            change = np.nanmax(np.abs(after - before)) / (scale or 1.0)
            moved.append(f"{name}: {change:.1e}")
    assert not moved, "\n".join(moved)
