"""All results of the commands equal those kept here: a move of code must not change a number.

The tolerances are those of `test_golden`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from .experiment_numbers import Values, experiment_numbers
from .experiments import Experiments
from .instruction_set import instruction_set

SAME, OTHER = 1e-12, 1e-5
ZERO = 1e-9
"""Numbers below this are zero to the residual of the solvers, and stay so."""

COUNTED = ("iterations", "steps", "residual", "mismatch", "error", "passes", "grid_points")
"""Ends of names of numbers that belong to the way to a solution: other elsewhere."""


@pytest.fixture(scope="module")
def kept() -> Values:
    with np.load(Path(__file__).with_name("experiments.npz")) as file:
        return {name: file[name] for name in file.files}


@pytest.fixture(scope="module")
def now(experiments: Experiments) -> Values:
    return experiment_numbers(experiments)


def test_the_same_variables_are_there(kept: Values, now: Values) -> None:
    assert kept.keys() - {"instruction_set"} == now.keys()


def test_no_result_has_moved(kept: Values, now: Values) -> None:
    same = str(kept["instruction_set"]) == instruction_set()
    moved = []
    for name in sorted(kept.keys() & now.keys()):
        before, after = kept[name], now[name]
        if after.shape != before.shape:
            moved.append(f"{name}: shape {before.shape} became {after.shape}")
        elif before.dtype.kind == "U":
            if same and not np.array_equal(before, after):
                moved.append(f"{name}: {before.tolist()} became {after.tolist()}")
        elif same or not name.endswith(COUNTED):
            scale = float(np.max(np.abs(before), initial=0.0, where=np.isfinite(before)))
            atol = ZERO if scale < ZERO else (SAME if same else OTHER) * scale
            if not np.isclose(after, before, rtol=0.0, atol=atol, equal_nan=True).all():
                change = np.nanmax(np.abs(after - before)) / (scale or 1.0)
                moved.append(f"{name}: {change:.1e}")
    assert not moved, "\n".join(moved)
