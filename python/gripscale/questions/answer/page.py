"""The answer of a case: friction and contact area with their interval, and what they rest on.

A case that allows no good answer says so first. What may change a good one follows as warnings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.chain.chain import Chain
from gripscale.core.units import display_unit_of, in_mm
from gripscale.io.table import significant
from gripscale.questions.answer.best_estimate import IsotropicSurface
from gripscale.questions.answer.intervals import LEVEL, interval_ends
from gripscale.questions.chain.view import HEADINGS, SYMBOLS
from gripscale.questions.compare.ladder import DIRECT
from gripscale.questions.cut_off.cut_off_curve import CONTINUED_TO
from gripscale.questions.uncertainty.sampled_answer import FRICTION_BELOW_MEASUREMENT
from gripscale.report.elements import Card, Doubt, Notice, percent
from gripscale.rubber.extrapolation import WORTH_SAYING, Extrapolation
from gripscale.wave.result import LARGE_MISMATCH

MOST_ON_GUESSES = 0.5
"""Share of friction or contact from what was not measured that makes an answer a guess."""
WORTH_NAMING = 0.005
"""Share of the contact on filled gaps that is as good as none."""
SMALL_CHANGE = 0.05
"""Relative change by half the cut-off that is as good as none."""


def has_answer(data: xr.Dataset) -> bool:
    """Return whether a result of one load holds a best estimate of the contact area."""
    area = data.get("best_contact_fraction")
    return area is not None and not area.ndim and math.isfinite(float(area))


def direct_of(data: xr.Dataset) -> xr.Dataset:
    """Return the direct contact of a comparison with its best estimate; that of a run as it is."""
    return data.sel(rung=DIRECT) if DIRECT in data.get("rung", ()) else data


def answer_lines(data: xr.Dataset | None) -> Iterator[str]:
    """Yield the answer of a result of one load, then what it rests on; or why there is none."""
    statement = no_answer(data)
    if data is None or not has_answer(data):
        yield f"Answer: {statement}"
        return
    numbers = ", ".join(
        f"{SYMBOLS[name]} = {number_and_interval(data, name)}" for name in _of(data)
    )
    lead = f"{statement} It would be " if statement else ""
    rest = "" if _moving(data) else "no friction at rest; "
    yield f"Answer: {lead}{rest}{numbers}{_level(data)}"
    yield from (f"  {line}" for line in basis_lines(data))


def no_answer(data: xr.Dataset | None) -> str:
    """Return why a result has no answer, or none to rely on; empty if it has one."""
    if data is None or not (has_answer(data) or _status(data)):
        return (
            "none with an interval. Only the direct contact of a measured surface has an interval, "
            "and none was solved."
        )
    doubts = [*filter(None, [data.attrs.get(model.INPUT_DOUBTS)])]
    if not has_answer(data):
        words = f"The direct contact of the measured surface has no result: {_status(data)}."
        return " ".join(["none.", *doubts, words])
    guesses = [share.text for share in _guesses(data) if share.effect > MOST_ON_GUESSES]
    reasons = [*doubts, *guesses, *_sampled_too_little(data)]
    return f"none to rely on. {' '.join(reasons)}" if reasons else ""


def _status(data: xr.Dataset) -> str:
    """Return how the direct contact of a result ended; empty if none was solved."""
    direct = direct_of(data)
    name = next((name for name in (model.STATUS, "status") if name in direct), "")
    return str(direct[name].item()) if name and not direct[name].ndim else ""


def basis_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what a best estimate is for, what it is made of, and what it rests on."""
    if not has_answer(data):
        return
    names = _of(data)
    pressure, speed = (
        display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"]))
        for name in ("pressure", "speed")
    )
    motion = f"and {speed}" if _moving(data) else "at rest, where there is no friction"
    end = in_mm(float(data.get(CONTINUED_TO, data.cutoff_wavelength)), 3)
    yield f"for {pressure} {motion}, roughness down to {end}"
    yield f"from {' × '.join(_factors(data, names))}"
    rests = list(_rests_on(data, names[0]))
    if rests:
        yield "; ".join(rests)


def no_answer_notices(data: xr.Dataset | None) -> Iterator[Notice]:
    """Yield that a result has no answer, or none to rely on; nothing if it has one."""
    statement = no_answer(data)
    if statement:
        level = "warning" if data is None else "error"
        yield Notice(level, f"Answer: {statement}", math.inf, math.inf)


def answer_notices(data: xr.Dataset | None) -> Iterator[Notice]:
    """Yield what may change an answer, other than what `no_answer` says of it."""
    if data is None or not has_answer(data):
        return
    yield from (share for share in _guesses(data) if share.effect <= MOST_ON_GUESSES)
    direct = direct_of(data)
    steep = float(data.get("best_steep_share", math.nan))
    if steep > WORTH_SAYING:
        yield Notice(
            "warning",
            f"{percent(steep)} of the friction comes from slopes above 1, where neither small "
            "strain nor a measured profile is reliable.",
            friction=steep,
            doubt=Doubt.SOLUTION,
        )
    octave = {} if CONTINUED_TO in data else changes(data, 1.0 / model.OCTAVE)
    if max(map(abs, octave.values()), default=0.0) > SMALL_CHANGE:
        half = in_mm(float(data.cutoff_wavelength) / model.OCTAVE, 3)
        yield Notice(
            "warning",
            f"If the roughness goes on as over its last octave, down to {half}, half the cut-off, "
            f"{in_words(octave)}; `gripscale cut-off` computes it.",
            friction=octave.get("friction", math.nan),
            area=octave.get("contact_fraction", math.nan),
            doubt=Doubt.SURFACE,
        )
    traction, lost = (
        float(direct[f"total_{name}"]) for name in ("friction", "friction_from_dissipation")
    )
    apart = abs(traction / lost - 1.0) if _moving(data) and lost > 0.0 else 0.0
    if apart > LARGE_MISMATCH:
        yield Notice(
            "warning",
            f"The two frictions of the direct contact, from traction and from losses, differ by "
            f"{percent(apart)}; the answer takes the one from losses.",
            friction=apart,
            doubt=Doubt.SOLUTION,
        )


def changes(data: xr.Dataset, ratio: float) -> dict[str, float]:
    """Return the relative change of each number of an answer with `ratio` times its cut-off.

    Numbers whose exponent is not known are left out.
    """
    exponents = model.cut_off_exponents_of(direct_of(data))
    powers = {name: getattr(exponents, name) for name in _of(data)}
    return {name: ratio**power - 1.0 for name, power in powers.items() if math.isfinite(power)}


def in_words(changed: dict[str, float]) -> str:
    """Return relative changes in words, such as `the friction changes by +38 %`."""
    words = {"friction": "friction", "contact_fraction": "contact area"}
    parts = [f"the {words[n]} by {'+-'[v < 0.0]}{percent(abs(v))}" for n, v in changed.items()]
    return " and ".join(parts).replace(" by ", " changes by ", 1)


def friction_sentence(beyond: Extrapolation) -> str:
    """Return how much of a friction and how far; empty where it is not worth saying."""
    if not beyond.share > WORTH_SAYING:
        return ""
    return f"{percent(beyond.share)} of the friction lies {beyond.furthest}."


def _guesses(data: xr.Dataset) -> Iterator[Notice]:
    """Yield the shares of an answer on frequencies and heights that were not measured."""
    beyond = model.extrapolation_of(direct_of(data))
    if friction_sentence(beyond):
        yield Notice(
            "warning",
            f"{friction_sentence(beyond)} There the Prony series is an extrapolation.",
            friction=beyond.share,
            doubt=Doubt.RUBBER,
        )
    missing = float(data.get("best_missing_share", math.nan))
    if missing > WORTH_NAMING:
        text = f"{percent(missing)} of the contact lies on filled gaps of the measurement."
        yield Notice("warning", text, area=missing, doubt=Doubt.SURFACE)


def _sampled_too_little(data: xr.Dataset) -> Iterator[str]:
    """Yield that the surface is too small for an interval, or for one that says something."""
    widths = [float(data[f"best_{name}_half_width"]) for name in _of(data)]
    if not math.isfinite(float(data.best_contact_fraction_half_width)):
        if not is_measured(data):
            yield "Fewer than two samples have an answer."
            return
        yield (
            "The measured surface is too small to tell how well it represents its road: it holds "
            "fewer than four pieces of two largest waves."
        )
    elif any(math.asinh(width) > math.log(2.0) for width in widths if math.isfinite(width)):
        # the parts of an interval that is sampled say why
        why = "" if "part_label" in data else ": the measured surface is too small"
        yield f"The ends of the interval are more than a factor of two from the value{why}."


def _moving(data: xr.Dataset) -> bool:
    return float(data.nominal_speed) > 0.0


def _of(data: xr.Dataset) -> tuple[str, ...]:
    """Return what is estimated: no friction at rest."""
    return ("friction", "contact_fraction") if _moving(data) else ("contact_fraction",)


def answer_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield friction and contact area with their intervals."""
    if not has_answer(data):
        return
    source = "not to be relied on" if no_answer(data) else "best estimate"
    for name in _of(data):
        title = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"
        ends = interval(data, name)
        detail = f"{source}; {ends} ({100.0 * LEVEL:.0f} %)" if ends else source
        value = significant(float(data[f"best_{name}"]))
        yield Card(title, value, detail, bad=bool(no_answer(data)))


def number_and_interval(data: xr.Dataset, name: str) -> str:
    """Return a best estimate and its interval, such as `0.19 (0.15 to 0.23)`."""
    ends = interval(data, name)
    return f"{significant(float(data[f'best_{name}']))}{f' ({ends})' if ends else ''}"


def interval(data: xr.Dataset, name: str) -> str:
    """Return the interval of a best estimate, such as `0.15 to 0.23`; empty if there is none."""
    ends = interval_ends(data[f"best_{name}"], data[f"best_{name}_half_width"])
    low, high = map(float, ends)
    return f"{significant(low)} to {significant(high)}" if math.isfinite(low) else ""


def _level(data: xr.Dataset) -> str:
    if math.isfinite(float(data.best_contact_fraction_half_width)):
        return f" ({100.0 * LEVEL:.0f} % intervals)"
    return " without an interval"


def is_measured(data: xr.Dataset) -> bool:
    """Return whether an answer is of a measured surface: otherwise it is the chain's."""
    total = data.get("total_friction")
    return total is None or total.attrs.get("source") != Chain.name


def _factors(data: xr.Dataset, names: tuple[str, ...]) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first."""
    yield (
        "the direct contact of the measured surface" if is_measured(data) else "the chain of waves"
    )
    for at, label in enumerate(data.factor_label.values):
        values = {name: float(data[f"best_{name}_factor"][at]) for name in names}
        if not all(map(math.isfinite, values.values())):
            continue
        sigma = float(data[f"best_{names[0]}_factor_uncertainty"][at])
        numbers = ", ".join(f"{SYMBOLS[name]} × {significant(v)}" for name, v in values.items())
        assumed = np.allclose(list(values.values()), 1.0)
        yield f"{label} ({f'1 ± {percent(sigma)}' if assumed else numbers})"


def _rests_on(data: xr.Dataset, name: str) -> Iterator[str]:
    """Yield the error of the sampling, what is assumed or left out, and the area term."""
    sampling = float(data[f"best_{name}_sampling_error"])
    if math.isfinite(sampling):
        yield f"sampling of the road ± {percent(sampling)} (standard error)"
    below = data.get(FRICTION_BELOW_MEASUREMENT)
    if below is not None and not below.ndim and float(below) > WORTH_NAMING:
        limit = in_mm(float(data.resolution_limit), 3)
        yield (
            f"{percent(float(below))} of the friction in waves shorter than {limit}, which were "
            "not measured"
        )
    labels = data.factor_label.values
    if IsotropicSurface.label in labels:
        yield "a road without direction is assumed; ridges 3:1 change the area up to 1.7 times"
    missing = [
        str(n) for n, v in zip(labels, data[f"best_{name}_factor"], strict=True) if v.isnull()
    ]
    if missing:
        yield f"not included: {', '.join(missing)}"
    if "part_label" not in data and math.isfinite(float(data[f"best_{name}_half_width"])):
        yield "errors of the inputs are not in the interval (`gripscale sensitivity` lists them)"
    direct = direct_of(data)
    term = float(direct.get(model.ADHESIVE_FRICTION, math.nan))
    if math.isfinite(term):
        # it is proportional to the contact area
        term *= float(data.best_contact_fraction / direct.total_contact_fraction)
        both = significant(float(data.best_friction) + term)
        yield f"an area term of {significant(term)} comes on top: μ = {both} with it"
