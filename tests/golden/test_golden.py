"""Whole results equal those kept here: a move of code must not change a number."""

from __future__ import annotations

from pathlib import Path

from .experiment_numbers import experiment_numbers
from .experiments import Experiments
from .instruction_set import kept_values, moved
from .quantities import all_numbers

HERE = Path(__file__).parent


def test_no_number_has_moved() -> None:
    kept, now = kept_values(HERE / "golden.npz"), all_numbers()
    assert kept.keys() - {"instruction_set"} <= now.keys()
    assert not moved(kept, now, ("newton_iterations", "load_steps", "residual"))


def test_no_result_of_a_command_has_moved(experiments: Experiments) -> None:
    kept, now = kept_values(HERE / "experiments.npz"), experiment_numbers(experiments)
    assert kept.keys() - {"instruction_set"} == now.keys()
    counted = ("iterations", "steps", "residual", "mismatch", "error", "passes", "grid_points")
    assert not moved(kept, now, counted)
