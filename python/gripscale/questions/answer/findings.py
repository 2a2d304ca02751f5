"""What may change an answer: findings on the direct contact and on the inputs, ranked."""

from __future__ import annotations

import math
from collections.abc import Iterator

import xarray as xr

from gripscale import model
from gripscale.core.finding import Finding, Severity, Topic, ranked
from gripscale.core.units import MILLI, in_mm
from gripscale.cut_off_exponents import OCTAVE
from gripscale.io.table import significant
from gripscale.questions.answer.reliance import (
    MOST_ON_GUESSES,
    direct_of,
    estimated_names,
    guesses,
    has_answer,
    is_moving,
    no_answer,
)
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.report.elements import number_text, percent_text
from gripscale.rubber.extrapolation import WORTH_SAYING
from gripscale.wave.result import LARGE_MISMATCH

SMALL_CHANGE = 0.05
"""Relative change by half the cut-off that is as good as none."""
LARGE_MISFIT = 0.05
"""Of a series from the moduli it stands for: friction errs by about as much."""
LARGE_RESIDUAL = 0.1
"""Of the heights of the sine waves."""


def no_answer_notices(data: xr.Dataset | None) -> Iterator[Finding]:
    """Yield that a result has no answer, or none to rely on; nothing if it has one."""
    statement = no_answer(data)
    if statement:
        level = "warning" if data is None else "error"
        yield Finding(level, f"Answer: {statement}", math.inf, math.inf)


def answer_notices(data: xr.Dataset | None) -> Iterator[Finding]:
    """Yield what may change an answer, other than what `no_answer` says of it."""
    if data is None or not has_answer(data):
        return
    yield from (share for share in guesses(data) if share.effect <= MOST_ON_GUESSES)
    direct = direct_of(data)
    steep = float(data.get("best_steep_share", math.nan))
    if steep > WORTH_SAYING:
        yield Finding(
            Severity.WARNING,
            f"{percent_text(steep)} of the friction comes from slopes above 1, where neither small "
            "strain nor a measured profile is reliable.",
            friction=steep,
            topic=Topic.SOLUTION,
        )
    octave = {} if CONTINUED_TO in data else changes(data, 1.0 / OCTAVE)
    if max(map(abs, octave.values()), default=0.0) > SMALL_CHANGE:
        half = in_mm(float(data.cutoff_wavelength) / OCTAVE, 3)
        yield Finding(
            Severity.WARNING,
            f"If the roughness goes on as over its last octave, down to {half}, half the cut-off, "
            f"{in_words(octave)}; `gripscale cut-off` computes it.",
            friction=octave.get("friction", math.nan),
            area=octave.get("contact_fraction", math.nan),
            topic=Topic.SURFACE,
        )
    traction, lost = (
        float(direct[f"total_{name}"]) for name in ("friction", "friction_from_dissipation")
    )
    apart = abs(traction / lost - 1.0) if is_moving(data) and lost > 0.0 else 0.0
    if apart > LARGE_MISMATCH:
        yield Finding(
            Severity.WARNING,
            f"The two frictions of the direct contact, from traction and from losses, differ by "
            f"{percent_text(apart)}; the answer takes the one from losses.",
            friction=apart,
            topic=Topic.SOLUTION,
        )


def changes(data: xr.Dataset, ratio: float) -> dict[str, float]:
    """Return the relative change of each number of an answer with `ratio` times its cut-off.

    Numbers whose exponent is not known are left out.
    """
    exponents = model.cut_off_exponents_of(direct_of(data))
    powers = {name: getattr(exponents, name) for name in estimated_names(data)}
    return {name: ratio**power - 1.0 for name, power in powers.items() if math.isfinite(power)}


def in_words(changed: dict[str, float]) -> str:
    """Return relative changes in words, such as `the friction changes by +38 %`."""
    words = {"friction": "the friction", "contact_fraction": "the contact area"}
    first, *others = [
        (words[name], f"by {'+-'[change < 0.0]}{percent_text(abs(change))}")
        for name, change in changed.items()
    ]
    return " and ".join([" changes ".join(first), *map(" ".join, others)])


def case_notices(direct: xr.Dataset | None, record: InputRecord) -> list[Finding]:
    """Return what is known before any wave is solved, ranked: of the answer and of the inputs."""
    parts = answer_notices(direct), _extrapolated_roughness(direct, record), _misfits(record)
    in_answer = set() if direct is None else set(model.input_doubts_of(direct))
    inputs = [finding for finding in record.warnings() if finding not in in_answer]
    return ranked([*(finding for part in parts for finding in part), *inputs])


def _extrapolated_roughness(direct: xr.Dataset | None, record: InputRecord) -> Iterator[Finding]:
    """Yield what the roughness adds that is shorter than the measurement resolves."""
    if not record.number("cut_off_beyond_measurement") > 0.0:
        return
    limit, end = record.number("cut_off_carried_m"), record.number("cut_off_m")
    changed = {}
    if direct is not None and has_answer(direct):
        held = float(direct.cutoff_wavelength)
        if held > 1.01 * end and CONTINUED_TO not in direct:
            cure = (
                ": `gripscale cut-off`, or down_to in [below_measurement], continues the roughness"
            )
            yield Finding(
                Severity.DOUBT,
                f"The cut-off of the case is {in_mm(end, 3)}, but the heights hold no waves "
                f"shorter than {in_mm(held, 3)}, two of their steps"
                f"{'' if record.of_map else cure}.",
                key="below_measurement.down_to",
            )
        end = held
        if not limit > 1.01 * end:
            return
        changed = changes(direct, limit / end)
    lengths = (f"{number_text(length, MILLI)} mm" for length in (limit, end))
    text = "Roughness from {}, where the measurement ends, to {} is extrapolated".format(*lengths)
    yield Finding(
        Severity.WARNING,
        f"{text}: without it {in_words(changed)}." if changed else f"{text}.",
        changed.get("friction", math.nan),
        changed.get("contact_fraction", math.nan),
        Topic.SURFACE,
    )


def _misfits(record: InputRecord) -> Iterator[Finding]:
    """Yield by how much the rubber misses its loss factor, and the sine waves their heights."""
    loss = record.loss_factor_error
    if abs(loss) > LARGE_MISFIT:
        yield Finding(
            Severity.WARNING,
            f"At the frequencies of the waves the loss factor of the Prony series is "
            f"{percent_text(abs(loss))} {'above' if loss > 0.0 else 'below'} the measured one: the "
            "error of the friction is about as large.",
            loss,
            topic=Topic.RUBBER,
        )
    residual = record.number("sines_residual_decades")
    height = 10.0 ** (0.5 * residual) - 1.0  # C_z goes with the square of the height
    if height > LARGE_RESIDUAL:
        yield Finding(
            Severity.WARNING,
            f"The sine waves miss the measured correlation by {significant(residual, 2)} decades: "
            f"{percent_text(height)} of their height. The friction of the chain has a similar "
            "error.",
            height,
            topic=Topic.SURFACE,
        )
