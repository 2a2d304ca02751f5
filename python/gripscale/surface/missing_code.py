"""Numbers that stand for missing heights in text files, such as -9999, told from heights.

One is taken for such a code only where it is one in use and lies ten times farther from all other
heights than they lie from each other: no texture has a height like that.
"""

from __future__ import annotations

import numpy as np

from gripscale.surface.profile import FloatArray

_NINES = [10.0**digits - 1.0 for digits in range(3, 10)]
_WORDS = [2.0**bits - less for bits in (15, 16, 31, 32) for less in (0.0, 1.0)]
CODES = np.array([*_NINES, *_WORDS])
"""Codes in use, but for their sign: nines, and the ends of the whole numbers instruments store."""

BEYOND = 1e30
"""Height, in any unit of length, from which on a number is no height but a code."""

ALONE = 10.0
"""Distance of a code from all heights, in the largest difference of two of them."""


def without_codes(heights: FloatArray) -> tuple[FloatArray, float | None]:
    """Return heights, NaN where one is a code for a missing height, and the code if there is one.

    Parameters
    ----------
    heights : array, of any shape
        Heights as printed, NaN where missing.
    """
    suspect = np.isin(np.abs(heights), CODES) | (np.abs(heights) >= BEYOND)
    codes = np.unique(heights[suspect])
    rest = heights[np.isfinite(heights) & ~suspect]
    if codes.size != 1 or rest.size == 0:
        return heights, None
    code = float(codes[0])
    if np.abs(rest - code).min() <= ALONE * np.ptp(rest):
        return heights, None
    return np.where(suspect, np.nan, heights), code
