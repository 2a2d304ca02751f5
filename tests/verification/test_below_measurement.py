"""Octaves that were withheld and continued: the band holds the truth as often as it says.

The constants of the bands were chosen on the families of `FITTED` with seeds below 7; `JUDGES` were
made afterwards. `python -m pytest -m verification -s` prints the tables.
"""

from collections.abc import Sequence

import numpy as np
import pytest

from tests.verification.line_families import FITTED, JUDGES
from tests.verification.withheld_octaves import (
    NUMBERS,
    Withheld,
    judged,
    measured_lines,
    synthetic_lines,
)

pytestmark = pytest.mark.verification


def table(results: Sequence[Withheld]) -> None:
    """Print a row for each line family and number of octaves."""
    for line in dict.fromkeys(r.line for r in results):
        for octaves in (1, 2, 3):
            rows = [r for r in results if (r.line, r.octaves) == (line, octaves)]
            answered = [r for r in rows if not r.refused]
            text = f"{line:18} {octaves} refused {len(rows) - len(answered)}"
            for at, name in enumerate(NUMBERS if answered else ()):
                errors, bands = ([getattr(r, n)[at] for r in answered] for n in ("errors", "bands"))
                held = sum(r.holds[at] for r in answered)
                text += f" | {name:.8} {held} of {len(answered)} {np.exp(np.mean(errors)):.2f}"
                text += f" band {np.mean(bands):.2f}"
            print(text)
