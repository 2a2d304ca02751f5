"""Whether a file holds sweeps at several temperatures, or one master curve."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gripscale.errors import GripscaleError
from gripscale.rubber.sweep_blocks import EXCEL, Block, read_blocks
from gripscale.rubber.sweeps import TOLERANCE
from gripscale.rubber.sweeps_reader import find_column


def holds_sweeps(path: Path) -> bool:
    """Return whether `read_sweeps` is the reader of a file, and not `read_master_curve`.

    So it is with Excel and RepTate's files, with several tables that state a temperature each, and
    with a column of temperatures over which the same frequencies come again. A master curve may say
    at what temperature each row was measured: its frequencies do not come again.
    """
    if path.suffix.lower() in EXCEL:
        return True
    try:
        blocks = read_blocks(path, sheet=None, expected=[], temperature_unit="C")
        return blocks[0].temperature is not None or any(map(_repeats, blocks))
    except GripscaleError:
        return False


def _repeats(block: Block) -> bool:
    table = block.table
    temperature, frequency = (find_column(table, one, {}) for one in ("temperature", "frequency"))
    if temperature is None or frequency is None:
        return False
    degrees, hertz = (
        table.numbers(at, "a number", missing=True) for at in (temperature, frequency)
    )
    return bool(np.ptp(degrees) > 2.0 * TOLERANCE and len(np.unique(hertz)) <= len(hertz) // 2)
