"""What the reader must see first: waves that failed, then warnings, ranked by what they change."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.conditions.area_term import heat_left_out
from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.core.provenance import versions
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.measured_friction import friction_doubts
from gripscale.io.table import NONE
from gripscale.questions.answer.findings import LARGE_MISFIT, case_notices, no_answer_notices
from gripscale.questions.answer.page import answer_cards
from gripscale.questions.answer.reliance import friction_sentence, has_answer, no_answer
from gripscale.questions.chain.view import PredictionView
from gripscale.report.elements import Card, number_text, percent_text
from gripscale.report.failures import Failure, chapter_words
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.rubber.material import LEAST_POISSON_RATIO
from gripscale.wave.result import LARGE_MISMATCH

if TYPE_CHECKING:
    from gripscale.questions.chain.run_folder import RunSource

FLAGS = {
    "strain_extrapolated": "the strain lies beyond the strain sweep; its last moduli are used",
    "temperature_extrapolated": "the temperature lies beyond those of the shift",
}
"""What a wave may be flagged for, and in words."""


def conditions_notices(view: PredictionView) -> Iterator[Finding]:
    """Yield a warning for each flag of the rubber of the waves, and for heat left out."""
    for name, words in FLAGS.items():
        if view.has(name):
            yield from _of_waves(view, np.nan_to_num(view.usable(name)) > 0.0, words)
    if view.has("series_misfit"):
        misfit = np.nan_to_num(np.abs(view.usable("series_misfit")))
        words = f"the series misses the softened moduli by up to {misfit.max(initial=0.0):.0%}"
        yield from _of_waves(view, misfit > LARGE_MISFIT, words, misfit)
    if view.has("contact_temperature") and model.ADHESIVE_FRICTION in view.data:
        area_term = float(view.data[model.ADHESIVE_FRICTION])
        for text in heat_left_out(area_term, view.total("friction")):
            yield Finding(Severity.WARNING, text, topic=Topic.RUBBER)


def _of_waves(
    view: PredictionView,
    flagged: np.ndarray,
    words: str,
    error: np.ndarray | float = 1.0,
    doubt: Topic = Topic.RUBBER,
) -> Iterator[Finding]:
    """Yield a warning of the flagged waves; `error` is the relative one of their friction."""
    waves = _named_waves(flagged)
    if waves:
        in_total = math.nan
        if view.moving and view.complete:
            friction = view.column("friction")
            in_total = float(flagged * error @ friction / friction.sum())
        yield Finding(Severity.WARNING, f"{waves}: {words}.", in_total, topic=doubt)


def _named_waves(flagged: np.ndarray) -> str:
    numbers = [str(at + 1) for at in np.flatnonzero(flagged)]
    if len(numbers) > 1 and len(numbers) == flagged.size:
        return f"All {len(numbers)} waves"
    return f"Wave{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}" if numbers else ""


def _share(value: float) -> str:
    return f"{100.0 * value:.3g} %"


def prediction_sentence(view: PredictionView) -> str:
    """Return how many waves, how much of the friction and how far; empty within the band."""
    beyond = model.extrapolation_of(view.data)
    if not view.has("outside_band"):
        return friction_sentence(beyond)
    outside = int(np.count_nonzero(view.column("outside_band") == 1.0))
    if not outside or not beyond.anywhere:
        return ""
    part = "" if math.isnan(beyond.share) else f", {_share(beyond.share)} of the friction,"
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
    most = max(part.share for part in beyond)
    ends = (max(getattr(part, end) for part in beyond) for end in ("below", "above"))
    count = f"{len(beyond)} of {len(every)} predictions, up to {_share(most)} of their friction"
    return f"{count}, lie {Extrapolation(most, *ends).furthest}."


def comparison_notices(comparison: xr.Dataset) -> Iterator[Finding]:
    """Yield a warning for each rung with friction beyond the band, of a comparison over an axis."""
    for at, label in enumerate(comparison.label.values):
        rung = comparison.isel(rung=at)
        text = study_sentence(rung)
        if text:
            share = float(rung[model.FRICTION_OUTSIDE_BAND].max())
            yield Finding(Severity.WARNING, f"{label}: {text}", share, topic=Topic.RUBBER)


def friction_notices(doubts: Iterable[str]) -> Iterator[Finding]:
    """Yield a warning for each doubt of measured friction."""
    yield from (Finding(Severity.DOUBT, text) for text in doubts)


def run_failures(run: RunSource) -> Iterator[Finding]:
    """Yield what has no numbers in a run: waves and predictions."""
    for view in run.predictions:
        text = ""
        for i in np.flatnonzero(~view.converged):
            text = (
                f"wave {i + 1} did NOT converge ({view.why(int(i))}). Its numbers are not to be "
                "used, the waves after it were not solved, and there are no totals. "
                f"{_advice(str(view.data['status'].values[i]))}"
            )
            yield Finding(Severity.ERROR, f"{view.title}: {text}".rstrip())
        if view.complete or text:
            continue
        text = (
            f"the run ended after wave {view.waves} of {view.planned}. The totals would lack the "
            "smaller waves and are not shown; run the case again."
        )
        if view.status != CONVERGED:
            text = f"{view.status}. There are no totals. {_advice(view.status_word)}"
        yield Finding(Severity.ERROR, f"{view.title}: {text}".rstrip())


def _advice(word: str) -> str:
    """Return what to do about a status as sentences of their own; empty where nothing is known."""
    status = Failure("", word).status
    if status is None:
        return ""
    return f"{status.advice} See {chapter_words(status.chapter)}."


def notices(run: RunSource) -> list[Finding]:
    """Return errors first, then warnings by what they change."""
    direct, here = run.direct, versions()["gripscale"]
    answered = direct is not None and has_answer(direct)
    findings = [
        *run_failures(run),
        *friction_notices(friction_doubts(run.measured, run.predictions[0].speed)),
        *no_answer_notices(direct),
        *case_notices(direct, run.record),
    ]
    if direct is not None and not no_answer(direct):
        findings += _beside_the_answer(run.predictions[0], direct)
    for view in run.predictions:
        beyond, share = prediction_sentence(view), model.extrapolation_of(view.data).share
        if beyond and not answered:
            text = f"{view.title}: {beyond} There the Prony series is an extrapolation."
            findings.append(Finding(Severity.WARNING, text, share, topic=Topic.RUBBER))
    for view in run.by_wave:
        of_waves = (
            *_mismatch(view),
            *conditions_notices(view),
            *_compressible(view, run.record.bulk_modulus),
        )
        findings += [
            replace(notice, sentence=f"{view.title}: {notice.sentence}") for notice in of_waves
        ]
    if len({str(view.data.attrs.get("case", "")) for view in run.predictions}) > 1:
        text = "The dynamic and the static result come from different case files."
        findings.append(Finding(Severity.DOUBT, text))
    solved = run.attrs.get("version_gripscale")
    if solved is not None and solved != here:
        text = f"Solved with gripscale {solved}, reported with {here}."
        findings.append(Finding(Severity.WARNING, text, topic=Topic.SOURCE))
    return ranked(findings)


def _beside_the_answer(chain: PredictionView, direct: xr.Dataset) -> Iterator[Finding]:
    """Yield how the totals of the chain differ from the best estimate of the same load."""
    if not chain.complete:
        return
    names = ("friction", "contact_fraction") if chain.moving else ("contact_fraction",)
    ratios = {name: chain.total(name) / float(direct[f"best_{name}"]) for name in names}
    area = f"{ratios['contact_fraction']:.2g} times the contact area"
    text = f"{ratios['friction']:.2g} times the friction and {area}" if chain.moving else area
    yield Finding(
        Severity.WARNING,
        f"The chain of waves has {text} of the best estimate.",
        ratios.get("friction", math.nan) - 1.0,
        ratios["contact_fraction"] - 1.0,
        Topic.SOLUTION,
    )


def _compressible(view: PredictionView, bulk: float) -> Iterator[Finding]:
    """Warn where the bulk modulus is too small for the modulus of a wave."""
    if not view.has("modulus"):
        return
    shear = view.column("modulus") / 3.0
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    low = np.nan_to_num(ratio, nan=0.5) < LEAST_POISSON_RATIO
    if low.any():
        words = (
            f"Poisson's ratio is down to {number_text(ratio[low].min())}, less than "
            f"{LEAST_POISSON_RATIO:g}: the bulk modulus is too small for their moduli"
        )
        yield Finding(Severity.WARNING, f"{_named_waves(low)}: {words}.", topic=Topic.RUBBER)


def _mismatch(view: PredictionView) -> Iterator[Finding]:
    if not view.moving:
        return
    mismatch = np.nan_to_num(view.usable("friction_mismatch"))
    worst = percent_text(mismatch.max(initial=0.0))
    words = f"the two frictions are up to {worst} apart; take a finer mesh"
    large = mismatch > LARGE_MISMATCH
    yield from _of_waves(view, large, words, mismatch, Topic.SOLUTION)


def run_cards(run: RunSource) -> Iterator[Card]:
    """Yield the answer of the measured surface, then the totals of each prediction."""
    answered = [] if run.direct is None else list(answer_cards(run.direct))
    yield from answered
    for view in run.predictions:
        yield from _cards(view, beside_answer=bool(answered))


def _cards(view: PredictionView, *, beside_answer: bool) -> Iterator[Card]:
    """Yield the totals of a prediction, in one card beside the answer of the measured surface."""
    if not view.complete:
        yield Card("No totals", "not converged", view.title, bad=True)
        return
    area = number_text(view.total("contact_fraction"))
    if beside_answer:
        if view.moving:
            friction = number_text(view.total("friction"))
            yield Card("Chain of waves, μ", friction, f"{view.title}; A_r/A_0 {area}")
        else:
            yield Card("Chain of waves, A_r/A_0", area, view.title)
        return
    waves = f"; {view.waves} wave{'s' if view.waves != 1 else ''}" if view.waves else ""
    yield Card("Real contact area A_r/A_0", area, f"{view.title}{waves}")
    if not view.moving:
        return
    lost = number_text(view.total("friction_from_dissipation"))
    friction = number_text(view.total("friction"))
    yield Card("Friction coefficient μ", friction, f"{view.title}; {lost} from energy lost")
    both = model.with_adhesive(view.data)
    if both is not None:
        yield Card("With the area term, μ", number_text(float(both)), f"{view.title}; as stated")
    if not view.has("friction_mismatch"):
        return
    mismatch = view.usable("friction_mismatch")
    largest = percent_text(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
    bad = bool(np.nanmax(mismatch, initial=0.0) > LARGE_MISMATCH)
    yield Card("Largest mismatch of μ", largest, "traction against energy lost", bad=bad)


def exponent_sentence(data: xr.Dataset) -> str:
    """Return how a prediction changes with its smallest wavelength, or why that is not known.

    Empty where there are no totals, or the model does not tell.
    """
    exponents = model.cut_off_exponents_of(data)
    if exponents.why_not in (model.NOT_TOLD.why_not, model.NOT_CONVERGED.why_not):
        return ""
    pairs = (("μ", exponents.friction), ("A_r/A_0", exponents.contact_fraction))
    texts = [
        f"d ln {symbol} / d ln λ_min = {value:z.2f}"
        for symbol, value in pairs
        if math.isfinite(value)
    ]
    if not texts:
        return f"The change with the cut-off is not known: {exponents.why_not}."
    text = f"Change with the cut-off, over its last octave: {', '.join(texts)}"
    if math.isfinite(exponents.friction):
        factor = model.OCTAVE**-exponents.friction
        text += f" (half the smallest wavelength: about {factor:.2g} times the friction)"
    return f"{text}."
