"""What may change an answer: findings on the direct contact and on the inputs, ranked."""

from __future__ import annotations

import math
from collections.abc import Iterator

import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.conditions.conditions import Conditions
from gripscale.core.finding import Finding, Severity, Topic, from_json, ranked
from gripscale.core.units import in_mm
from gripscale.cut_off_exponents import OCTAVE
from gripscale.experiment.measured_friction import MeasuredFriction, nearest_series
from gripscale.io.table import significant
from gripscale.questions.answer import reliance
from gripscale.questions.answer.reliance import direct_of, is_measured
from gripscale.questions.answer.variables import answer_number, has_answer
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.inputs import record as inputs
from gripscale.questions.inputs.record import InputRecord, in_words
from gripscale.report.elements import percent_text
from gripscale.rubber.extrapolation import WORTH_SAYING
from gripscale.wave.result import LARGE_MISMATCH

FINDINGS = "findings_of_answer"  # attribute of an answer that holds what a further solution found
SMALL_CHANGE = 0.05  # relative change by half the cut-off that is as good as none


def no_answer_notices(data: xr.Dataset) -> Iterator[Finding]:
    """Yield that a result has no answer, or none to rely on; nothing if it has one."""
    if statement := reliance.no_answer(data):
        yield Finding(Severity.ERROR, f"Answer: {statement}", math.inf, math.inf)


def answer_notices(data: xr.Dataset) -> Iterator[Finding]:
    """Yield what may change an answer, other than what `no_answer` says of it."""
    if not has_answer(data):
        return
    if MEASURED_FRICTION in data:
        answer, measured = answer_number(data, "friction"), float(data[MEASURED_FRICTION])
        difference = answer.value / measured - 1.0
        text = (
            f"The answer is {percent_text(abs(difference))} "
            f"{'below' if difference < 0.0 else 'above'} the measured friction, "
            f"{measured_words(data)}"
        )
        if answer.interval:
            where = "inside" if answer.low <= measured <= answer.high else "outside"
            text += f", which lies {where} its interval"
        yield Finding(Severity.WARNING, f"{text}.", friction=difference, topic=Topic.MEASURED)
    shares = reliance.guesses(data)
    yield from (share for share in shares if share.effect <= reliance.MOST_ON_GUESSES)
    yield from from_json(data.attrs.get(FINDINGS, ""))
    direct = direct_of(data)
    steep = float(data.get("answer_steep_share", math.nan))
    if steep > WORTH_SAYING:
        text = (
            f"{percent_text(steep)} of the friction comes from slopes above 1, where neither small "
            "strain nor a measured profile is reliable."
        )
        yield Finding(Severity.WARNING, text, friction=steep, topic=Topic.SOLUTION)
    octave = {} if CONTINUED_TO in data else changes(data, 1.0 / OCTAVE)
    if max(map(abs, octave.values()), default=0.0) > SMALL_CHANGE:
        half = in_mm(float(data.cutoff_wavelength) / OCTAVE, 3)
        cure = "; `gripscale cut-off` computes it" if is_measured(data) else ""
        text = (
            f"If the roughness goes on as over its last octave, down to {half}, half the cut-off, "
            f"{in_words(octave)}{cure}."
        )
        friction, area = (octave.get(name, math.nan) for name in ("friction", "contact_fraction"))
        yield Finding(Severity.WARNING, text, friction, area, Topic.SURFACE)
    traction, lost = float(direct.total_friction), float(direct.total_friction_from_dissipation)
    apart = abs(traction / lost - 1.0) if reliance.is_moving(data) and lost > 0.0 else 0.0
    if apart > LARGE_MISMATCH:
        text = (
            f"The two frictions of the {reliance.solved_model(data)}, from traction and from "
            f"losses, differ by {percent_text(apart)}; the answer takes the one from "
            f"{'losses' if is_measured(data) else 'traction'}."
        )
        yield Finding(Severity.WARNING, text, friction=apart, topic=Topic.SOLUTION)


# Names of measured friction at the speed of an answer, and of its standard deviation.
MEASURED_FRICTION, MEASURED_SPREAD = "measured_friction_of_load", "measured_spread_of_load"


def measured_at_load(case: Case, measured: MeasuredFriction | None) -> dict[str, xr.Variable]:
    """Return measured friction at the speed of a case; nothing where there is none.

    Of several temperatures it is the one nearest to that of the case.
    """
    if measured is None:
        return {}
    kelvin = (case.conditions or Conditions()).temperature_of(case.rubber)
    series = nearest_series(measured, kelvin)
    at_speed = series.at(case.load.speed) if case.load.speed > 0.0 else None
    about = {"units": "1", "source": measured.source, "state": series.state}
    pairs = zip((MEASURED_FRICTION, MEASURED_SPREAD), at_speed or (), strict=False)
    return {name: xr.Variable((), value, about) for name, value in pairs}


def measured_words(data: xr.Dataset) -> str:
    """Return the measured friction beside an answer, such as `0.64 ± 0.02 at 20 °C`."""
    friction, spread = float(data[MEASURED_FRICTION]), float(data[MEASURED_SPREAD])
    about = f" ± {significant(spread, 2)}" if math.isfinite(spread) else ""
    state = data[MEASURED_FRICTION].attrs["state"]
    return f"{significant(friction)}{about}{f' at {state}' if state else ''}"


def changes(data: xr.Dataset, ratio: float) -> dict[str, float]:
    """Return the relative change of each number of an answer with `ratio` times its cut-off.

    Numbers whose exponent is not known are left out.
    """
    exponents = model.cut_off_exponents_of(direct_of(data))
    powers = {name: getattr(exponents, name) for name in reliance.estimated_names(data)}
    return {name: ratio**power - 1.0 for name, power in powers.items() if math.isfinite(power)}


def case_notices(direct: xr.Dataset, record: InputRecord) -> list[Finding]:
    """Return what may change an answer, ranked: findings of its own and of its inputs."""
    answered = has_answer(direct)
    beyond = _beyond_measurement(direct, record) if answered else inputs.extrapolated(record)
    in_answer = set(model.input_doubts_of(direct))
    of_inputs = (finding for finding in record.warnings() if finding not in in_answer)
    return ranked([*answer_notices(direct), *beyond, *inputs.misfits(record), *of_inputs])


def _beyond_measurement(direct: xr.Dataset, record: InputRecord) -> Iterator[Finding]:
    """Yield what the roughness adds to an answer that is shorter than the measurement resolves."""
    if not record.number("cut_off_beyond_measurement") > 0.0:
        return
    limit, end = record.number("cut_off_carried_m"), record.number("cut_off_m")
    held = float(direct.cutoff_wavelength)
    if held > 1.01 * end and CONTINUED_TO not in direct:
        cure = ": `gripscale cut-off`, or down_to in [below_measurement], continues the roughness"
        text = (
            f"The cut-off of the case is {in_mm(end, 3)}, but the heights hold no waves shorter "
            f"than {in_mm(held, 3)}, two of their steps{'' if record.of_map else cure}."
        )
        yield Finding(Severity.DOUBT, text, key="below_measurement.down_to")
    if limit > 1.01 * held:
        yield inputs.extrapolated_roughness(limit, held, changes(direct, limit / held))
