"""Write numbers and texts anew (`python -m tests.golden.make_experiments`)."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

from .experiment_numbers import experiment_numbers
from .experiments import run_experiments
from .instruction_set import instruction_set
from .texts import write_texts

HERE = Path(__file__).parent

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        made = run_experiments(Path(folder))
        numbers = experiment_numbers(made)
        write_texts(made, HERE / "texts")
    kept = {"instruction_set": np.array(instruction_set()), **numbers}
    np.savez_compressed(HERE / "experiments.npz", allow_pickle=False, **kept)
