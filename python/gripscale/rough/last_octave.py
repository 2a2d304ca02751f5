"""What the last octave of waves does to a direct contact, from the grids it was solved on.

A grid has four points in the shortest wave it is given, and the next one twice as many with waves
half as long. Two such grids are two solutions whose cut-offs are an octave apart, as well resolved
as each other. The friction by octave of the last contact does not serve: without its smallest
waves the larger ones touch more and lose more, so that leaving an octave out changes friction by
half of what is lost in it (docs/cut-off.md).
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gripscale.cut_off_exponents import NOT_CONVERGED, OCTAVE, CutOffExponents, between
from gripscale.rough.grids import GridRecord


def last_octave(grids: Sequence[GridRecord], *, moving: bool) -> CutOffExponents:
    """Return the exponents of the cut-off from the `grids` of a contact, coarse to fine."""
    pairs = [
        (before, last)
        for before in grids
        for last in grids
        if last.cut_off == grids[-1].cut_off
        and last.points == OCTAVE * before.points
        and math.isclose(before.cut_off, OCTAVE * last.cut_off)
    ]
    if not pairs:
        return CutOffExponents(math.nan, math.nan, "solved with one cut-off only")
    before, last = pairs[0]
    if not (before.settled and last.settled):
        return NOT_CONVERGED
    return between(
        OCTAVE,
        (before.contact_fraction, last.contact_fraction),
        (before.friction_from_dissipation, last.friction_from_dissipation),
        moving=moving,
    )
