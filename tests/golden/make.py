"""Write the golden file anew (`python -m tests.golden.make`), when a number is meant to move."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .instruction_set import instruction_set
from .quantities import all_numbers

if __name__ == "__main__":
    kept = {"instruction_set": np.array(instruction_set()), **all_numbers()}
    np.savez_compressed(Path(__file__).with_name("golden.npz"), allow_pickle=False, **kept)
