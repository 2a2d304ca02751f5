"""Estimated errors of contact fraction and friction, from grids that solve the same surface.

With d_n the change from n/2 to n points in the smallest wave, the error at n is estimated as

    contact fraction    max(c d_n, c^2 d_(n/2)), and in quadrature where borders lie between points
    friction            the same max, or |mu - mu_diss| if larger,

c = 0.4: halving the spacing divides errors by two at least (measured on random surfaces; tests hold
the estimates to grids four times finer), and one small change may be chance.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from gripscale.rough.grids import GridRecord

_SHARE = 0.4
JUDGED_BY = 3
"""Grids that the errors of the last are told from, itself among them."""


def errors(same_surface: Sequence[GridRecord]) -> tuple[float, float]:
    """Return the errors of contact fraction and friction [-] of the last and finest grid.

    NaN if there is only one grid, zero for full contact, which is in closed form.
    """
    last = same_surface[-1]
    if last.full:
        return 0.0, 0.0
    if len(same_surface) == 1:
        return math.nan, math.nan
    area = math.hypot(
        _from_changes([grid.contact_fraction for grid in same_surface]), last.border_error
    )
    traction = _from_changes([grid.friction for grid in same_surface])
    return area, max(traction, abs(last.friction - last.friction_from_dissipation))


def _from_changes(values: Sequence[float]) -> float:
    changes = [abs(b - a) for a, b in pairwise(values)]
    return max(
        _SHARE ** (1 + age) * change
        for age, change in enumerate(reversed(changes[1 - JUDGED_BY :]))
    )
