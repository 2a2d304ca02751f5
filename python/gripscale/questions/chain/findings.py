"""What may change the predictions of a chain: conditions, mesh, and rubber beyond its band."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import astuple

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.core.finding import Finding, Severity, Topic
from gripscale.cut_off_exponents import NOT_CONVERGED, NOT_TOLD, OCTAVE
from gripscale.questions.answer.reliance import friction_sentence
from gripscale.questions.chain.view import PredictionView
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation

LARGE_MISFIT = 0.05  # of a series from the moduli it stands for: friction errs by about as much
# What a wave may be flagged for, and in words.
FLAGS = {
    "strain_extrapolated": "the strain lies beyond the strain sweep; its last moduli are used",
    "temperature_extrapolated": "the temperature lies beyond those of the shift",
}


def conditions_notes(view: PredictionView) -> Iterator[str]:
    """Yield which waves are flagged for their rubber, as sentences."""
    for name, words in FLAGS.items():
        if view.has(name):
            yield from _of_waves(np.nan_to_num(view.usable(name)) > 0.0, words)
    if view.has("series_misfit"):
        misfit = np.nan_to_num(np.abs(view.usable("series_misfit")))
        words = f"the series misses the softened moduli by up to {misfit.max(initial=0.0):.0%}"
        yield from _of_waves(misfit > LARGE_MISFIT, words)


def _of_waves(flagged: np.ndarray, words: str) -> Iterator[str]:
    numbers = [str(at + 1) for at in np.flatnonzero(flagged)]
    waves = f"Wave{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}"
    if len(numbers) > 1 and len(numbers) == flagged.size:
        waves = f"All {len(numbers)} waves"
    if numbers:
        yield f"{waves}: {words}."


def prediction_sentence(view: PredictionView) -> str:
    """Return how many waves, how much of the friction and how far; empty within the band."""
    beyond = model.extrapolation_of(view.data)
    if not view.has("outside_band"):
        return friction_sentence(beyond)
    outside = int(np.count_nonzero(view.column("outside_band") == 1.0))
    if not outside or not beyond.anywhere:
        return ""
    part = "" if math.isnan(beyond.share) else f", {100.0 * beyond.share:.3g} % of the friction,"
    verb = "lies" if view.waves == 1 else "lie"
    waves = f"{outside} of {view.waves} wave{'s' if view.waves != 1 else ''}"
    return f"{waves}{part} {verb} {beyond.furthest}."


def study_sentence(data: xr.Dataset) -> str:
    """Return how many predictions of a study, how much of their friction and how far."""
    if model.FRICTION_OUTSIDE_BAND not in data:
        return ""
    share = data[model.FRICTION_OUTSIDE_BAND]
    every = [
        model.extrapolation_of(data.isel(dict(zip(share.dims, index, strict=True))))
        for index in np.ndindex(share.shape)
    ]
    beyond = [part for part in every if part.share > WORTH_SAYING]
    if not beyond:
        return ""
    most = Extrapolation(*map(max, zip(*map(astuple, beyond), strict=True)))
    count = f"{len(beyond)} of {len(every)} predictions"
    return f"{count}, up to {100.0 * most.share:.3g} % of their friction, lie {most.furthest}."


def comparison_notices(comparison: xr.Dataset) -> Iterator[Finding]:
    """Yield a warning for each model of a comparison with friction beyond the band."""
    for at, label in enumerate(comparison.label.values):
        member = comparison.isel(model=at)
        if text := study_sentence(member):
            share = float(member[model.FRICTION_OUTSIDE_BAND].max())
            yield Finding(Severity.WARNING, f"{label}: {text}", share, topic=Topic.RUBBER)


def exponent_sentence(data: xr.Dataset) -> str:
    """Return how a prediction changes with its smallest wavelength, or why that is not known.

    Empty where there are no totals, or the model does not tell.
    """
    exponents = model.cut_off_exponents_of(data)
    if exponents.why_not in (NOT_TOLD.why_not, NOT_CONVERGED.why_not):
        return ""
    powers = {"μ": exponents.friction, "A_r/A_0": exponents.contact_fraction}
    changes = {symbol: power for symbol, power in powers.items() if math.isfinite(power)}
    texts = [f"d ln {symbol} / d ln λ_min = {power:z.2f}" for symbol, power in changes.items()]
    if not texts:
        return f"The change with the cut-off is not known: {exponents.why_not}."
    text = f"Change with the cut-off, over its last octave: {', '.join(texts)}"
    if math.isfinite(exponents.friction):
        factor = OCTAVE**-exponents.friction
        text += f" (half the smallest wavelength: about {factor:.2g} times the friction)"
    return f"{text}."
