"""Numbers as people read them."""

from __future__ import annotations

import math

import numpy as np

from gripscale.report.tables import significant

NONE = "–"
"""What a cell shows where there is no number."""


def number(value: object, scale: float = 1.0, digits: int = 3) -> str:
    """Return `value` / `scale` with so many significant digits; a dash for NaN."""
    real = float(np.asarray(value, dtype=float)) / scale
    if math.isnan(real):
        return NONE
    if math.isinf(real):
        return "∞" if real > 0.0 else "−∞"
    return significant(real, digits).replace("-", "−")


def whole(value: object) -> str:
    """Return a count, with thin spaces between thousands."""
    real = float(np.asarray(value, dtype=float))
    return NONE if math.isnan(real) else f"{round(real):,}".replace(",", "\u202f")


def percent(value: object) -> str:
    """Return a ratio as a percentage of two significant digits."""
    real = 100.0 * float(np.asarray(value, dtype=float))
    return NONE if math.isnan(real) else f"{significant(real, 2).replace('-', '−')} %"
