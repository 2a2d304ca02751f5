"""What rests on the rubber beyond its measured frequencies, in one sentence for each result."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from gripscale.model import FRICTION_OUTSIDE_BAND, extrapolation_of
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.figures.view import PredictionView


def share_text(share: float) -> str:
    """Return a share of the friction in per cent, or a dash where it is not known."""
    return "-" if math.isnan(share) else f"{100.0 * share:.3g} %"


def prediction_sentence(view: PredictionView) -> str:
    """Return how many waves, how much of the friction and how far; empty within the band."""
    found = extrapolation_of(view.data)
    if not view.has("outside_band"):
        return friction_sentence(found)
    outside = int(np.count_nonzero(view.column("outside_band") == 1.0))
    if not outside or not found.anywhere:
        return ""
    part = "" if math.isnan(found.share) else f", {share_text(found.share)} of the friction,"
    verb = "lies" if view.waves == 1 else "lie"
    waves = f"{outside} of {view.waves} wave{'s' if view.waves != 1 else ''}"
    return f"{waves}{part} {verb} {found.furthest}."


def friction_sentence(found: Extrapolation) -> str:
    """Return how much of a friction and how far; empty where it is not worth saying."""
    if not found.share > WORTH_SAYING:
        return ""
    return f"{share_text(found.share)} of the friction lies {found.furthest}."


def study_sentence(result: xr.Dataset) -> str:
    """Return how many predictions of a study, how much of their friction and how far."""
    if FRICTION_OUTSIDE_BAND not in result:
        return ""
    every = list(_each(result))
    beyond = [one for one in every if one.share > WORTH_SAYING]
    if not beyond:
        return ""
    most = max(one.share for one in beyond)
    worst = Extrapolation(most, max(o.below for o in beyond), max(o.above for o in beyond))
    count = f"{len(beyond)} of {len(every)} predictions, up to {share_text(most)} of their friction"
    return f"{count}, lie {worst.furthest}."


def comparison_sentences(comparison: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield the label of each rung with friction beyond the band, and its sentence."""
    for at in range(comparison.sizes["rung"]):
        one = comparison.isel(rung=at)
        alone = not one[FRICTION_OUTSIDE_BAND].ndim
        text = friction_sentence(extrapolation_of(one)) if alone else study_sentence(one)
        if text:
            yield str(one.label.item()), text


def _each(result: xr.Dataset) -> Iterator[Extrapolation]:
    """Yield what each prediction of a study tells."""
    share = result[FRICTION_OUTSIDE_BAND]
    for place in np.ndindex(share.shape):
        yield extrapolation_of(result.isel(dict(zip(share.dims, place, strict=True))))
