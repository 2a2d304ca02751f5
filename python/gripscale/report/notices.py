"""What the reader must see first: waves that failed, doubts about inputs and numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.page_elements import NONE, Card, Notice, number, percent
from gripscale.charts.view import CONVERGED, PredictionView
from gripscale.core.provenance import versions
from gripscale.core.units import MILLI
from gripscale.model import (
    FRICTION_OUTSIDE_BAND,
    NOT_CONVERGED,
    NOT_TOLD,
    OCTAVE,
    cut_off_exponents_of,
    extrapolation_of,
    with_adhesive,
)
from gripscale.report.source import Run
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.rubber.material import LEAST_POISSON_RATIO
from gripscale.wave.problem import Status
from gripscale.wave.result import LARGE_MISMATCH

if TYPE_CHECKING:
    import xarray as xr

    from gripscale.charts.view import PredictionView
    from gripscale.surface import SlopeByWavelength


# What a reader must know of the rubber in its conditions: what is held, what is missed.

LARGE_MISFIT = 0.05
"""Of the softened series: friction errs by about as much."""

FLAGS = {
    "strain_extrapolated": "the strain lies beyond what the softening was measured for; the last "
    "moduli are held",
    "temperature_extrapolated": "the temperature lies beyond what the shift rests on",
}
"""What a wave may be flagged for, and in words."""


def conditions_sentences(one: PredictionView) -> Iterator[str]:
    """Yield a sentence for each doubt about the rubber of a prediction's waves."""
    for name, words in FLAGS.items():
        if one.has(name):
            yield from _of_waves(np.nan_to_num(one.usable(name)) > 0.0, words)
    if one.has("series_misfit"):
        misfit = np.nan_to_num(np.abs(one.usable("series_misfit")))
        worst = f"{misfit.max(initial=0.0):.0%}"
        words = f"the series misses the softened moduli by up to {worst}"
        yield from _of_waves(misfit > LARGE_MISFIT, words)


def _of_waves(flagged: np.ndarray, words: str) -> Iterator[str]:
    numbers = [str(at + 1) for at in np.flatnonzero(flagged)]
    if len(numbers) > 1 and len(numbers) == flagged.size:
        yield f"All {len(numbers)} waves: {words}."
    elif numbers:
        many = "s" if len(numbers) > 1 else ""
        yield f"Wave{many} {', '.join(numbers)}: {words}."


# Which chapter of the documentation says more about a failure: the one table of it.

_STATUSES = "reading-results.md#statuses-and-what-to-do-about-them"
_WAVES = "limits.md#where-waves-converge"
_MESHES = "limits.md#discretisation"

STATUS_CHAPTERS = {
    Status.CONVERGED: "reading-results.md#how-far-to-trust-a-number",
    Status.ITERATION_LIMIT: _STATUSES,
    Status.ELEMENT_INVERTED: _STATUSES,
    Status.NO_ACTIVE_SET: _STATUSES,
    Status.NOT_FINITE: _STATUSES,
    Status.FOLD: _WAVES,
    Status.MEAN_SHEAR: _WAVES,
    Status.TIME_LIMIT: _STATUSES,
    Status.TOLERANCE_NOT_MET: _MESHES,
    Status.FRICTIONS_DISAGREE: _WAVES,
    Status.ACTIVE_SET_NOT_SETTLED: _STATUSES,
    Status.CONTACT_TOO_NARROW: _WAVES,
    Status.PROFILE_TOO_ROUGH: _MESHES,
    Status.CONDITIONS_NOT_SETTLED: "conditions.md#how-they-settle",
}
"""Chapters in `docs` by status."""


def pointer(failure: object) -> str:
    """Return "; see ..." of an error that something explains, or of a text that names a status."""
    text = str(failure)
    see = " See" if text.endswith("?") else "; see"
    named = [one for one in Status if one is not Status.CONVERGED and one in text]
    places = [getattr(failure, "see", ""), *(f"docs/{STATUS_CHAPTERS[one]}" for one in named)]
    return next((f"{see} {place}" for place in places if place), "")


# What rests on the rubber beyond its measured frequencies, in one sentence for each result.


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


def notices(run: Run) -> list[Notice]:
    """Return errors first, then warnings."""
    errors = [Notice("error", text) for one in run.predictions for text in _failures(one)]
    return errors + [Notice("warning", text) for text in _doubts(run)]


def _failures(one: PredictionView) -> Iterator[str]:
    for i in np.flatnonzero(~one.converged):
        yield (
            f"{one.title}: wave {i + 1} did NOT converge ({one.why(int(i))}). Its numbers are not "
            "to be used, the waves after it were not solved, and there are no totals"
            f"{pointer(one.why(int(i)))}."
        )
    if one.complete or not one.converged.all():
        return
    if one.status != CONVERGED:
        yield f"{one.title}: {one.status}. There are no totals{pointer(one.status)}."
    else:
        yield (
            f"{one.title}: the run ended after wave {one.waves} of {one.planned}. The totals "
            "would lack the smaller waves and are not shown; run the case again."
        )


def _doubts(run: Run) -> Iterator[str]:
    inputs = run.inputs
    for one in run.predictions:
        beyond = prediction_sentence(one)
        if beyond:
            yield f"{one.title}: {beyond} There the Prony series is an extrapolation."
    for one in run.by_wave:
        if one.moving:
            yield from _mismatch(one)
        yield from (f"{one.title}: {text}" for text in conditions_sentences(one))
        yield from _compressible(one, float(inputs.attrs.get("bulk_modulus_Pa", np.nan)))
    yield from str(inputs.attrs.get("conditions_notes", "")).splitlines()
    for finding in str(inputs.attrs.get("prony_findings", "")).splitlines():
        yield f"Rubber: {finding}."
    for note in str(inputs.attrs.get("surface_notes", "")).splitlines():
        yield f"Surface: {note.removesuffix('.')}."
    if "no_self_affine" in inputs.attrs:
        yield f"The surface was not described as self-affine: {inputs.attrs['no_self_affine']}"
    if not inputs.data_vars:
        yield (
            "The result holds no record of its inputs (it was not written by `gripscale run`, or "
            "by an older version): profiles, fits and master curve are missing here."
        )
    if len({str(one.data.attrs.get("case", "")) for one in run.predictions}) > 1:
        yield "The dynamic and the static result come from different case files."
    solved, here = run.attrs.get("version_gripscale"), versions()["gripscale"]
    if solved is not None and solved != here:
        yield f"Solved with gripscale {solved}, reported with {here}."


def _compressible(one: PredictionView, bulk: float) -> Iterator[str]:
    """Warn where the bulk modulus is too small for the modulus of a wave."""
    if not one.has("modulus"):
        return
    shear = one.column("modulus") / 3.0
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    low = np.flatnonzero(np.nan_to_num(ratio, nan=0.5) < LEAST_POISSON_RATIO)
    if low.size:
        waves = ", ".join(str(i + 1) for i in low)
        yield (
            f"{one.title}: Poisson's ratio of waves {waves} is down to {number(ratio[low].min())}, "
            f"less than {LEAST_POISSON_RATIO:g}: the bulk modulus is too small for their moduli."
        )


def _mismatch(one: PredictionView) -> Iterator[str]:
    mismatch = one.usable("friction_mismatch")
    large = np.flatnonzero(np.nan_to_num(mismatch) > LARGE_MISMATCH)
    if large.size:
        waves = ", ".join(str(i + 1) for i in large)
        yield (
            f"{one.title}: the two frictions of waves {waves} are up to "
            f"{percent(np.nanmax(mismatch))} apart, more than {percent(LARGE_MISMATCH)}; a finer "
            "mesh is called for."
        )


def cards(run: Run) -> list[Card]:
    """Return the totals of each prediction, and of the direct contact that judges them."""
    return [*(card for one in run.predictions for card in _cards(one)), *_judge(run.direct)]


def _judge(direct: xr.Dataset | None) -> Iterator[Card]:
    if direct is None:
        return
    one = PredictionView(direct)
    area, friction = number(one.total("contact_fraction")), number(one.total("friction"))
    if one.moving:
        yield Card("Direct contact, μ", friction, f"of the profiles; A_r/A_0 {area}")
    else:
        yield Card("Direct contact, A_r/A_0", area, "of the profiles")


def _cards(one: PredictionView) -> Iterator[Card]:
    if not one.complete:
        yield Card("No totals", "not converged", one.title, bad=True)
        return
    waves = f"; {one.waves} wave{'s' if one.waves != 1 else ''}" if one.waves else ""
    area = number(one.total("contact_fraction"))
    yield Card("Real contact area A_r/A_0", area, f"{one.title}{waves}")
    if not one.moving:
        return
    lost = number(one.total("friction_from_dissipation"))
    friction = number(one.total("friction"))
    yield Card("Friction coefficient μ", friction, f"{one.title}; {lost} from energy lost")
    both = with_adhesive(one.data)
    if both is not None:
        yield Card("With the area term, μ", number(float(both)), f"{one.title}; as stated")
    if not one.has("friction_mismatch"):
        return
    mismatch = one.usable("friction_mismatch")
    largest = percent(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
    bad = bool(np.nanmax(mismatch, initial=0.0) > LARGE_MISMATCH)
    yield Card("Largest mismatch of μ", largest, "traction against energy lost", bad=bad)


# What the choice of the smallest wavelength means for a result, in one sentence.


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
