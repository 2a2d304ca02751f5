"""What the choice of the smallest wavelength means for a result, in one sentence."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

from gripscale.cut_off_exponents import NOT_CONVERGED, NOT_TOLD, OCTAVE
from gripscale.figures.palette import MILLI
from gripscale.model import cut_off_exponents_of

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.surface import SlopeByWavelength

EXPONENT = "d ln μ / d ln λ_min"
"""What it is called in tables."""


def exponent_sentence(data: xr.Dataset) -> str:
    """Return how a prediction changes with its smallest wavelength, or why that is not known.

    Empty where there are no totals, or the model does not tell.
    """
    found = cut_off_exponents_of(data)
    if found.why_not in (NOT_TOLD.why_not, NOT_CONVERGED.why_not):
        return ""
    known = [
        f"d ln {symbol} / d ln λ_min = {value:.2f}"
        for symbol, value in (("μ", found.friction), ("A_r/A_0", found.contact_fraction))
        if math.isfinite(value)
    ]
    if not known:
        return f"How it depends on the cut-off is not known: {found.why_not}."
    text = f"By the cut-off, over its last octave: {', '.join(known)}"
    if math.isfinite(found.friction):
        factor = OCTAVE**-found.friction
        text += f" (half the smallest wavelength: about {factor:.2g} times the friction)"
    return f"{text}."


def slope_table(slopes: SlopeByWavelength) -> Iterator[str]:
    """Yield the rms slope down to each wavelength, one a line."""
    yield f"{'down to [mm]':>13} {'rms slope of the surface':>25} {'along a profile':>16}"
    for length in slopes.wavelength:
        surface, profile = (slopes.down_to(float(length), of) for of in ("surface", "profile"))
        yield f"{length / MILLI:>13.3g} {surface:>25.3g} {profile:>16.3g}"
