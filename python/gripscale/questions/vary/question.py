"""How the answer varies: friction and contact area over one or two inputs of a case.

result = gs.vary(case, speed=[0.01, 0.1, 1.0], temperature=["0 C", "20 C"])
result.data.answer_friction
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Picture
from gripscale.core.finding import Finding, Severity, Topic, sentences
from gripscale.core.units import display_unit_of
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.solve import OnTask
from gripscale.half_space.model import JUDGED_TO
from gripscale.io.table import Column, Table, least_to_most, percent, significant
from gripscale.model import (
    ADHESIVE_FRICTION,
    FRICTION_OUTSIDE_BAND,
    METHOD,
    STATUS,
    Model,
    input_doubts_of,
    with_adhesive,
)
from gripscale.questions import view
from gripscale.questions.answer.estimate import ISOTROPY_ASSUMED, LINES_TO_SURFACE
from gripscale.questions.answer.reliance import WORTH_NAMING
from gripscale.questions.answer.variables import (
    ANSWER_NUMBERS,
    INTERFACE,
    SYMBOLS,
    is_beside_answer,
    is_estimated,
)
from gripscale.questions.chain.findings import study_sentence
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.inputs.page import input_sections
from gripscale.questions.result import Result
from gripscale.questions.vary.charts import study_pictures
from gripscale.questions.vary.study import BEYOND_SHIFT, Study
from gripscale.report.elements import Card, Section, case_title, percent_text
from gripscale.report.equations import method_section
from gripscale.report.failures import failures_in, first_of

MOST_PRINTED = 200  # predictions in the terminal; a file has all of them


class Variation(Result):
    """Friction and contact area of a case over one or two of its inputs."""

    kind = "study"

    @property
    def noun(self) -> str:
        return "prediction"

    @property
    def title(self) -> str:
        return f"Study: {case_title(self.data.attrs)}"

    @property
    def lines(self) -> Sequence[str]:
        data, (friction, area) = self.data, view.answers(self.data)
        texts = [text for name in (friction, area) if (text := view.course(data, name))]
        if not texts:
            return ("Answer: none; no prediction has a result.",)
        level = " (90 % intervals)" if view.interval_ends_of(data, area) else ""
        estimated = is_estimated(data, "contact_fraction")
        by = "" if estimated else f" by the {view.model_in_words(data)}, without an interval"
        basis = [f"for {', '.join(_held(data))}"]
        if doubts := input_doubts_of(data):
            basis.insert(0, f"not to be relied on: {sentences(doubts)}")
        if estimated:
            basis += [f"from {' × '.join(_factors(data))}", "; ".join(_rests_on(data))]
        else:
            basis.append(_why_no_interval(data))
        answer = f"Answer{by}: {'; '.join(texts)}{level}."
        return (answer, *(f"  {line}" for line in basis))

    @property
    def findings(self) -> Sequence[Finding]:
        findings = []
        if beyond := study_sentence(self.data):
            share = float(self.data[FRICTION_OUTSIDE_BAND].max())
            text = f"{beyond} There the Prony series is an extrapolation."
            findings.append(Finding(Severity.WARNING, text, share, topic=Topic.RUBBER))
        if BEYOND_SHIFT in self.data and bool(self.data[BEYOND_SHIFT].any()):
            flags = self.data[BEYOND_SHIFT]
            count = f"{int(flags.sum())} of {flags.size} predictions"
            text = f"{count} lie beyond the temperatures of the shift of the rubber."
            findings.append(Finding(Severity.WARNING, text, topic=Topic.RUBBER))
        notes = str(self.data.attrs.get("notes", "")).splitlines()
        return (*findings, *(Finding(Severity.WARNING, n, topic=Topic.SURFACE) for n in notes))

    @property
    def failure(self) -> str:
        failed = failures_in(self.data, STATUS)
        return first_of(failed, self.data[STATUS].size, f"{self.noun}s")

    def cards(self) -> Iterator[Card]:
        yield from view.cards(self.data)

    def parts(self) -> Iterator[str | Table]:
        yield view.first_rows(self.table(), MOST_PRINTED)

    def table(self) -> Table:
        """Return friction, area and status of each prediction, over what was varied."""
        data = self.data
        estimated, names = is_estimated(data, "friction"), view.answers(data)
        names += [] if estimated else ["total_friction_from_dissipation"]
        names += [name for name in ANSWER_NUMBERS if is_beside_answer(data, name)]
        both = with_adhesive(data)
        if not estimated and both is not None:
            about = {"symbol": "μ with it", "long_name": "friction of hysteresis and area term"}
            data = data.assign(friction_with_area_term=both.assign_attrs(about))
            names += [ADHESIVE_FRICTION, "friction_with_area_term"]
        columns = list(view.number_columns(data, [name for name in names if name in data]))
        if study_sentence(data):
            share = view.at_places(data, FRICTION_OUTSIDE_BAND)
            columns.append(Column("outside_band", share, "μ", "beyond band", format=percent))
        table = view.table(data, columns, "study", "Predictions of the study")
        if BEYOND_SHIFT not in data:
            return table
        marks = [" *" if beyond else "" for beyond in view.at_places(data, BEYOND_SHIFT)]
        *keys, last = table.columns[: table.keys]
        columns = [*keys, replace(last, marks=marks), *table.columns[table.keys :]]
        return replace(table, columns=columns)

    def pictures(self) -> Iterator[Picture]:
        yield from study_pictures(self.data)

    def chapters(self) -> Iterator[Section]:
        yield from input_sections(self.data)
        yield method_section(json.loads(self.data.attrs.get(METHOD, "[]")))


def _held(data: xr.Dataset) -> Iterator[str]:
    """Yield what was not varied, and the number of predictions."""
    yield from view.load_in_words(data)
    ends = [float(data[name]) for name in ("cutoff_wavelength", CONTINUED_TO) if name in data]
    if ends:
        yield f"roughness down to {1e3 * min(ends):.3g} mm"
    if "thickness" in data.attrs and "thickness" not in data.dims:
        thickness = display_unit_of(data.attrs, "thickness").text(data.attrs["thickness"])
        yield f"rubber {thickness} thick on a rigid base"
    failed = int((data[STATUS] != CONVERGED).sum())
    yield f"{data[STATUS].size} predictions, {failed or 'none'} without a result"


def _why_no_interval(data: xr.Dataset) -> str:
    if data.attrs.get("model") == "direct":
        return "no interval: the direct contact alone has none; leave the model out"
    if not data.attrs.get("surface_measured"):
        return "no interval: no surface was measured that could judge it"
    return "the surface was measured: `--model direct`, the default, gives the answer"


def _factors(data: xr.Dataset) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first; ranges where they vary."""
    yield view.model_in_words(data)
    for at, label in enumerate(data.factor_label.values):
        part = data.isel(factor=at)
        ranges = {
            symbol: least_to_most(part[f"answer_{name}_factor"])
            for name, symbol in reversed(SYMBOLS.items())
        }
        text = ", ".join(f"{symbol} × {values}" for symbol, values in ranges.items())
        if {*ranges.values()} == {significant(1.0)}:
            error = float(part["answer_friction_factor_uncertainty"].max())
            text = f"1 ± {percent_text(error)}"
        yield f"{label} ({text})"


def _rests_on(data: xr.Dataset) -> Iterator[str]:
    """Yield the largest shares of the answers that rest on what was not measured well."""
    sampling = float(data["answer_friction_sampling_error"].max())
    if math.isfinite(sampling):
        yield f"sampling of the surface up to ± {percent_text(sampling)} of it (standard error)"
    else:
        yield "no interval: the surface is too short to tell whether it stands for the whole"
    steep = float(data["answer_steep_share"].max())
    if steep > WORTH_NAMING:
        yield f"up to {percent_text(steep)} of the friction on slopes above 1"
    if LINES_TO_SURFACE in data.factor_label.values:
        yield ISOTROPY_ASSUMED
    if INTERFACE in data:
        yield f"{least_to_most(data[INTERFACE].values)} of the friction is the area term"
    if math.isfinite(sampling):
        if not {"surface", "rubber"} & set(view.dimensions(data)):
            yield "most of an interval is common to all points: their differences are known better"
        yield "intervals leave out errors of the master curve"


def vary(
    case: Case,
    *,
    model: Model | str | None = None,
    tolerance: float = JUDGED_TO,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    **axes: Any,
) -> Variation:
    """Return friction and contact area of a case over one or two of its inputs.

    The result is per wave and in total, over the varied axes; a speed of zero is rubber at rest. A
    prediction that did not converge has NaN totals and says why in `prediction_status`. Raises
    `InputError` or `FileError` for an input that cannot be used, or a result that cannot be
    written.

        >>> gs.vary(case, speed=["0.36 km/h", 0.3]).to_dataset().total_friction.values.round(3)
        array([0.037, 0.039])

    Parameters
    ----------
    case : Case
        What is not varied is as in the case.
    model, tolerance
        As for `gripscale.questions.Study`.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    **axes
        One or two inputs with their values, such as `speed=[0.1, 1.0]` [m/s] or
        `temperature="0 C,20 C"`; see `gripscale.questions.Study` for all.
    """
    study = Study(case, axes, model=model, tolerance=tolerance)
    data = study.run(folder, workers=workers, client=client, on_task=on_task)
    return Variation(data)
