"""Whether a file holds sweeps at several temperatures, or one master curve."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gripscale.errors import GripscaleError
from gripscale.rubber.stated import Columns, Stated, columns_of
from gripscale.rubber.sweep_blocks import Block, read_blocks
from gripscale.rubber.sweeps import TOLERANCE


def holds_sweeps(
    path: Path,
    *,
    columns: Columns | None = None,
    sheet: str | int | None = None,
    header: int | None = None,
) -> bool:
    """Return whether `read_sweeps` is the reader of a file, and not `read_master_curve`.

    So it is with RepTate's files, with several tables that state a temperature each, and with a
    column of temperatures over which the same frequencies come again. A master curve may say at
    what temperature each row was measured: its frequencies do not come again. The other arguments
    are those of `read_sweeps`.
    """
    try:
        stated = Stated(columns_of(columns))
        blocks = read_blocks(
            path, sheet=sheet, header=header, expected=stated.expected, temperature_unit="C"
        )
        return (
            blocks[0].temperature is not None
            or any(_repeats(one, stated) for one in blocks)
            or (len(blocks) > 1 and all(_tells(one, stated) for one in blocks))
        )
    except GripscaleError:
        return False


def _tells(block: Block, stated: Stated) -> bool:
    return stated.column(block.table, "temperature") is not None


def _repeats(block: Block, stated: Stated) -> bool:
    table = block.table
    temperature, frequency = (stated.column(table, one) for one in ("temperature", "frequency"))
    if temperature is None or frequency is None:
        return False
    degrees, hertz = (
        table.numbers(at, "a number", missing=True) for at in (temperature, frequency)
    )
    return bool(np.ptp(degrees) > 2.0 * TOLERANCE and len(np.unique(hertz)) <= len(hertz) // 2)
