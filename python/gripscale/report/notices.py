"""What the reader must see first: waves that failed, warnings about inputs and numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.charts.view import CONVERGED, PredictionView
from gripscale.conditions.area_term import heat_left_out
from gripscale.core.provenance import versions
from gripscale.io.table import NONE
from gripscale.report.answer import answer_cards
from gripscale.report.elements import Card, Notice, number, percent
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.rubber.material import LEAST_POISSON_RATIO
from gripscale.wave.problem import Status
from gripscale.wave.result import LARGE_MISMATCH

if TYPE_CHECKING:
    from gripscale.report.source import Run

LARGE_MISFIT = 0.05
"""Of the softened series: friction errs by about as much."""

FLAGS = {
    "strain_extrapolated": "the strain lies beyond what the softening was measured for; the last "
    "moduli are held",
    "temperature_extrapolated": "the temperature lies beyond what the shift rests on",
}
"""What a wave may be flagged for, and in words."""


def conditions_sentences(view: PredictionView) -> Iterator[str]:
    """Yield a warning for each flag of the rubber of the waves, and for heat left out."""
    for name, words in FLAGS.items():
        if view.has(name):
            yield from _of_waves(np.nan_to_num(view.usable(name)) > 0.0, words)
    if view.has("series_misfit"):
        misfit = np.nan_to_num(np.abs(view.usable("series_misfit")))
        worst = f"{misfit.max(initial=0.0):.0%}"
        words = f"the series misses the softened moduli by up to {worst}"
        yield from _of_waves(misfit > LARGE_MISFIT, words)
    if view.has("contact_temperature") and model.ADHESIVE_FRICTION in view.data:
        yield from heat_left_out(float(view.data[model.ADHESIVE_FRICTION]), view.total("friction"))


def _of_waves(flagged: np.ndarray, words: str) -> Iterator[str]:
    numbers = [str(at + 1) for at in np.flatnonzero(flagged)]
    if len(numbers) > 1 and len(numbers) == flagged.size:
        yield f"All {len(numbers)} waves: {words}."
    elif numbers:
        many = "s" if len(numbers) > 1 else ""
        yield f"Wave{many} {', '.join(numbers)}: {words}."


@dataclass(frozen=True)
class Failure:
    """A prediction, or a part of one, without numbers to be used."""

    sentence: str
    word: str = ""
    """Of its `Status`; empty if there is none, or the file is of an older version."""

    @property
    def status(self) -> Status | None:
        """Its status, None if there is none."""
        return Status(self.word) if self.word in FAILURES else None

    def __str__(self) -> str:
        return self.sentence


FAILURES = set(Status) - {Status.CONVERGED}
"""Statuses that say why there are no numbers."""


def explained(failure: Failure | Exception) -> str:
    """Return a failure with what to do about it, and what says more about it."""
    text = str(failure)
    status = getattr(failure, "status", None)
    see = getattr(failure, "see", "") or ("" if status is None else status.chapter)
    if not see:
        return text
    pointer = f"see {chapter_words(see)}"
    if status is None:
        return f"{text} S{pointer[1:]}" if text.endswith("?") else f"{text}; {pointer}"
    return f"{text.rstrip('.')}. {status.advice} S{pointer[1:]}"


def chapter_words(see: str) -> str:
    """Return how to find a command, or a chapter such as `docs/limits.md#discretisation`."""
    if see.startswith("`"):
        return see
    page, _, heading = see.removeprefix("docs/").partition("#")
    words = page.removesuffix(".md").replace("-", " ")
    return (
        f'"{words}: {heading.replace("-", " ")}" in the documentation'
        if heading
        else (f'"{words}" in the documentation')
    )


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


def friction_sentence(beyond: Extrapolation) -> str:
    """Return how much of a friction and how far; empty where it is not worth saying."""
    if not beyond.share > WORTH_SAYING:
        return ""
    return f"{_share(beyond.share)} of the friction lies {beyond.furthest}."


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


def comparison_sentences(comparison: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield the label of each rung with friction beyond the band, and its sentence."""
    for at, label in enumerate(comparison.label.values):
        rung = comparison.isel(rung=at)
        alone = not rung[model.FRICTION_OUTSIDE_BAND].ndim
        text = friction_sentence(model.extrapolation_of(rung)) if alone else study_sentence(rung)
        if text:
            yield str(label), text


def notices(run: Run) -> list[Notice]:
    """Return errors first, then warnings."""
    errors = [Notice("error", text) for view in run.predictions for text in _failures(view)]
    return errors + [Notice("warning", text) for text in _warnings(run)]


def _failures(view: PredictionView) -> Iterator[str]:
    for i in np.flatnonzero(~view.converged):
        why, word = view.why(int(i)), str(view.data["status"].values[i])
        yield (
            f"{view.title}: wave {i + 1} did NOT converge ({why}). Its numbers are not to be "
            f"used, the waves after it were not solved, and there are no totals. {_advice(word)}"
        ).rstrip()
    if view.complete or not view.converged.all():
        return
    if view.status != CONVERGED:
        advice = _advice(view.status_word)
        yield f"{view.title}: {view.status}. There are no totals. {advice}".rstrip()
    else:
        yield (
            f"{view.title}: the run ended after wave {view.waves} of {view.planned}. The totals "
            "would lack the smaller waves and are not shown; run the case again."
        )


def _advice(word: str) -> str:
    """Return what to do about a status as sentences of their own; empty where nothing is known."""
    status = Failure("", word).status
    if status is None:
        return ""
    return f"{status.advice} See {chapter_words(status.chapter)}."


def _warnings(run: Run) -> Iterator[str]:
    for view in run.predictions:
        beyond = prediction_sentence(view)
        if beyond:
            yield f"{view.title}: {beyond} There the Prony series is an extrapolation."
    for view in run.by_wave:
        if view.moving:
            yield from _mismatch(view)
        yield from (f"{view.title}: {text}" for text in conditions_sentences(view))
        yield from _compressible(view, run.record.bulk_modulus)
    yield from run.record.warnings()
    if len({str(view.data.attrs.get("case", "")) for view in run.predictions}) > 1:
        yield "The dynamic and the static result come from different case files."
    solved, here = run.attrs.get("version_gripscale"), versions()["gripscale"]
    if solved is not None and solved != here:
        yield f"Solved with gripscale {solved}, reported with {here}."


def _compressible(view: PredictionView, bulk: float) -> Iterator[str]:
    """Warn where the bulk modulus is too small for the modulus of a wave."""
    if not view.has("modulus"):
        return
    shear = view.column("modulus") / 3.0
    ratio = (3.0 * bulk - 2.0 * shear) / (2.0 * (3.0 * bulk + shear))
    low = np.flatnonzero(np.nan_to_num(ratio, nan=0.5) < LEAST_POISSON_RATIO)
    if low.size:
        waves = ", ".join(str(i + 1) for i in low)
        yield (
            f"{view.title}: Poisson's ratio of waves {waves} is down to {number(ratio[low].min())},"
            f" less than {LEAST_POISSON_RATIO:g}: the bulk modulus is too small for their moduli."
        )


def _mismatch(view: PredictionView) -> Iterator[str]:
    mismatch = view.usable("friction_mismatch")
    large = np.flatnonzero(np.nan_to_num(mismatch) > LARGE_MISMATCH)
    if large.size:
        waves = ", ".join(str(i + 1) for i in large)
        yield (
            f"{view.title}: the two frictions of waves {waves} are up to "
            f"{percent(np.nanmax(mismatch))} apart, more than {percent(LARGE_MISMATCH)}; take a "
            "finer mesh."
        )


def cards(run: Run) -> list[Card]:
    """Return the answer of the measured surface, then the totals of each prediction."""
    made = [] if run.direct is None else list(answer_cards(run.direct))
    if not made:
        return [card for view in run.predictions for card in _cards(view)]
    return [*made, *(card for view in run.predictions for card in _chain_cards(view))]


def _chain_cards(view: PredictionView) -> Iterator[Card]:
    """Yield the totals of waves one by one, beside the answer of the measured surface."""
    if not view.complete:
        yield from _cards(view)
        return
    area = number(view.total("contact_fraction"))
    if not view.moving:
        yield Card("Chain of waves, A_r/A_0", area, view.title)
        return
    friction = number(view.total("friction"))
    yield Card("Chain of waves, μ", friction, f"{view.title}; A_r/A_0 {area}")


def _cards(view: PredictionView) -> Iterator[Card]:
    if not view.complete:
        yield Card("No totals", "not converged", view.title, bad=True)
        return
    waves = f"; {view.waves} wave{'s' if view.waves != 1 else ''}" if view.waves else ""
    area = number(view.total("contact_fraction"))
    yield Card("Real contact area A_r/A_0", area, f"{view.title}{waves}")
    if not view.moving:
        return
    lost = number(view.total("friction_from_dissipation"))
    friction = number(view.total("friction"))
    yield Card("Friction coefficient μ", friction, f"{view.title}; {lost} from energy lost")
    both = model.with_adhesive(view.data)
    if both is not None:
        yield Card("With the area term, μ", number(float(both)), f"{view.title}; as stated")
    if not view.has("friction_mismatch"):
        return
    mismatch = view.usable("friction_mismatch")
    largest = percent(np.nanmax(mismatch)) if np.isfinite(mismatch).any() else NONE
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
        return f"How it depends on the cut-off is not known: {exponents.why_not}."
    text = f"By the cut-off, over its last octave: {', '.join(texts)}"
    if math.isfinite(exponents.friction):
        factor = model.OCTAVE**-exponents.friction
        text += f" (half the smallest wavelength: about {factor:.2g} times the friction)"
    return f"{text}."
