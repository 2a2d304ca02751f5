"""The law of reliance: whether a result has an answer, and whether it may be relied on.

There is none where the inputs may be those of another case, where more than half of friction or
contact was not measured, where the surface is too small, or where too few of its summits carry.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import xarray as xr

from gripscale import model
from gripscale.core.finding import Finding, Severity, Topic
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.variables import REACH, answer_number, has_answer
from gripscale.report.elements import percent_text
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.surface.random_phases import PHASES_OF

# Share of friction or contact from what was not measured that makes an answer a guess.
MOST_ON_GUESSES = 0.5
_WHOLE, _NONE = 0.99, 1e-3  # contact fraction and friction together that no road has
WORTH_NAMING = 0.005  # share of the contact on filled gaps that is as good as none


def direct_of(data: xr.Dataset) -> xr.Dataset:
    """Return the model of a comparison that its answer is of; the result of a run as it is."""
    if "model" not in data.dims:
        return data
    return data.sel(model=DIRECT) if DIRECT in data.model else data.isel(model=0)


def no_answer(data: xr.Dataset, but: str = "") -> str:
    """Return why a result has no answer, or none to rely on; empty if it has one.

    Doubts with the key `but` do not count.
    """
    doubts = [d.sentence for d in model.input_doubts_of(data) if not (but and d.key == but)]
    if not has_answer(data):
        direct = direct_of(data)
        name = next((name for name in (model.STATUS, "status") if name in direct), "")
        ended = str(direct[name].item()) if name and not direct[name].ndim else ""
        words = f"The {solved_model(data)} has no result: {ended}."
        return " ".join(["none.", *doubts, words])
    area, friction = (answer_number(data, name).value for name in ("contact_fraction", "friction"))
    reasons = doubts
    if is_moving(data) and area > _WHOLE and friction < _NONE:
        reasons.append(
            f"The rubber touches {percent_text(area)} of the surface with a friction of "
            f"{friction:.1g}, as on a smooth plate: are the units of heights, distances and moduli "
            "right?"
        )
    reasons += [share.sentence for share in guesses(data) if share.effect > MOST_ON_GUESSES]
    if float(data.get(REACH, math.nan)) > 1.0:
        reasons.append(
            "So few summits of the profiles carry that the step from profile to surface is beyond "
            "the surfaces it was measured on; a map needs no such step."
        )
    if "filled_answer_contact_fraction" not in data:
        reasons += _sampled_too_little(data)
    return f"none to rely on. {' '.join(reasons)}" if reasons else ""


def guesses(data: xr.Dataset) -> Iterator[Finding]:
    """Yield the shares of an answer on frequencies and heights that were not measured."""
    beyond = model.extrapolation_of(direct_of(data))
    if sentence := friction_sentence(beyond):
        text = f"{sentence} There the Prony series is an extrapolation."
        yield Finding(Severity.WARNING, text, friction=beyond.share, topic=Topic.RUBBER)
    missing = float(data.get("answer_missing_share", math.nan))
    if missing > WORTH_NAMING:
        text = f"{percent_text(missing)} of the contact lies on filled gaps of the measurement."
        yield Finding(Severity.WARNING, text, area=missing, topic=Topic.SURFACE)


def _sampled_too_little(data: xr.Dataset) -> Iterator[str]:
    """Yield that the surface is too small for an interval, or for one that says something."""
    numbers = [answer_number(data, name) for name in estimated_names(data)]
    if not math.isfinite(numbers[-1].low):
        if is_measured(data):
            yield (
                "The measured surface is too small to tell whether it stands for the whole: it "
                "holds fewer than four pieces of two largest waves, or one summit carries it."
            )
        elif "part_label" in data:
            yield "Fewer than two samples have an answer."
    elif any(number.high > 2.0 * number.value for number in numbers):
        # the parts of an interval that is sampled say why
        why = ": the measured surface is too small, or too few of its summits carry"
        why = "" if "part_label" in data else why
        if data.attrs.get(PHASES_OF, "random") != "random":
            why = ": a spectrum does not tell the phases of the surface"
        yield f"The ends of the interval are more than a factor of two from the value{why}."


def friction_sentence(beyond: Extrapolation) -> str:
    """Return how much of a friction and how far; empty where it is not worth saying."""
    if not beyond.share > WORTH_SAYING:
        return ""
    return f"{percent_text(beyond.share)} of the friction lies {beyond.furthest}."


def is_moving(data: xr.Dataset) -> bool:
    """Return whether a result is of sliding rubber."""
    return float(data.nominal_speed) > 0.0


def estimated_names(data: xr.Dataset) -> tuple[str, ...]:
    """Return what is estimated: no friction at rest."""
    return ("friction", "contact_fraction") if is_moving(data) else ("contact_fraction",)


def solved_model(data: xr.Dataset) -> str:
    """Return in words what an answer was solved by."""
    return "direct contact of the measured surface" if is_measured(data) else "chain of waves"


def is_measured(data: xr.Dataset) -> bool:
    """Return whether an answer is of a measured surface: otherwise it is the chain's."""
    return data.sizes.get("factor", 0) > 0
