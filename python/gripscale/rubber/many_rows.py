"""Files of moduli with more rows than a fit can use: some of each decade of frequency are kept.

Instruments that log on write 1e5 or 1e6 rows. Rows are kept as they were measured: the mean of a
thousand would have the scatter of none of them, and a series fitted within that follows the drift
of the instrument with a hundred elements.
"""

from __future__ import annotations

import numpy as np

from gripscale.core import Array

MOST_ROWS = 5000  # rows up to which all are kept
ROWS_PER_DECADE = 100  # rows of a decade of frequency, at one temperature, that are kept of more
_SAME_TEMPERATURE = 0.2  # width of a step of temperature [K]


def thinned(rows: Array) -> tuple[Array, tuple[str, ...]]:
    """Return rows without those too many, and a note of it: the middle one of each bin stays.

    The first two of `rows` are temperature [K] and frequency [Hz], shape (columns, rows).
    """
    count = rows.shape[1]
    if count <= MOST_ROWS:
        return rows, ()
    temperature, frequency = np.round(rows[0] / _SAME_TEMPERATURE), np.log10(rows[1])
    bins = 1e6 * temperature + np.round(ROWS_PER_DECADE * frequency)
    order = np.lexsort((frequency, bins))
    _, first, each = np.unique(bins[order], return_index=True, return_counts=True)
    kept = order[first + each // 2]
    return rows[:, kept], (
        f"{kept.size} of {count} rows kept, at most {ROWS_PER_DECADE} of a decade of frequency at "
        "one temperature",
    )
