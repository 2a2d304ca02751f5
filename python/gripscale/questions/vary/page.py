"""A study in words, in tables and on its page: how its numbers run, each prediction, curves."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import xarray as xr

from gripscale.charts.chart import spelled_out
from gripscale.charts.draw import image
from gripscale.core.finding import Finding, Severity, Topic, sentences
from gripscale.core.units import display_unit_of
from gripscale.experiment.design import CONVERGED
from gripscale.io.table import NONE, Column, Table, least_to_most, percent, significant
from gripscale.model import (
    ADHESIVE_FRICTION,
    FRICTION_OUTSIDE_BAND,
    STATUS,
    input_doubts_of,
    status_words,
    with_adhesive,
)
from gripscale.questions import view
from gripscale.questions.answer.estimate import ISOTROPY_ASSUMED, LINES_TO_SURFACE
from gripscale.questions.answer.reliance import WORTH_NAMING
from gripscale.questions.answer.variables import HYSTERESIS, INTERFACE, SYMBOLS, is_estimated
from gripscale.questions.chain.findings import study_sentence
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.vary.charts import study_pictures
from gripscale.questions.vary.inputs import OF_THE_CHAIN
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT
from gripscale.report.again import case_title
from gripscale.report.elements import Card, Page, Section, percent_text
from gripscale.report.failures import Failure, explained

# Models in words; others by their names.
_MODELS = {"chain": "chain of sine waves", "direct": "direct contact of the measured surface"}


def study_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a study, what it is for, and what it rests on."""
    texts = [text for name in view.answers(data) if (text := view.course(data, name))]
    if not texts:
        yield "Answer: none; no prediction has a result."
        return
    level = " (90 % intervals)" if view.interval_ends_of(data, view.answers(data)[-1]) else ""
    estimated = is_estimated(data, "contact_fraction")
    by = "" if estimated else f" by the {_model(data)}, without an interval"
    yield f"Answer{by}: {'; '.join(texts)}{level}."
    yield from (f"  {line}" for line in study_basis(data))


def study_basis(data: xr.Dataset) -> Iterator[str]:
    """Yield what the numbers of a study are for, what they are made of and what they rest on."""
    if doubts := input_doubts_of(data):
        yield f"not to be relied on: {sentences(doubts)}"
    held = []  # what was not varied
    for name in ("pressure", "speed"):
        if name not in view.dimensions(data) and f"nominal_{name}" in data.attrs:
            value = float(data.attrs[f"nominal_{name}"])
            held.append(display_unit_of(data.attrs, name).text(value))
    ends = [float(data[name]) for name in ("cutoff_wavelength", CONTINUED_TO) if name in data]
    if ends:
        held.append(f"roughness down to {1e3 * min(ends):.3g} mm")
    if "thickness" in data.attrs and "thickness" not in data.dims:
        thickness = display_unit_of(data.attrs, "thickness").text(data.attrs["thickness"])
        held.append(f"rubber {thickness} thick on a rigid base")
    failed = int((data[STATUS] != CONVERGED).sum())
    count = f"{data[STATUS].size} predictions, {failed or 'none'} without a result"
    yield f"for {', '.join([*held, count])}"
    if is_estimated(data, "contact_fraction"):
        yield f"from {' × '.join(_factors(data))}"
        yield "; ".join(_rests_on(data))
    elif data.attrs.get("surface_measured") and data.attrs.get("model") == "chain":
        yield (
            "the varied input belongs to the chain only: `gripscale run` has the answer"
            if set(view.dimensions(data)) & set(OF_THE_CHAIN)
            else "the surface was measured: `--model direct`, the default, gives the answer"
        )
    elif data.attrs.get("model") == "direct" and "answer_contact_fraction" in data:
        yield "no interval: the surface is too short to tell whether it stands for the whole"
    elif data.attrs.get("model") == "direct":
        yield "no interval: the direct contact alone has none; leave the model out"
    else:
        yield "no interval: no surface was measured that could judge it"


def study_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield the range of friction and contact area over a study."""
    for name in view.answers(data):
        values = data[name].values
        values = values[values > 0.0]  # none at rest
        if not values.size:
            continue
        detail = "answer" if name.startswith("answer") else _model(data)
        if view.interval_ends_of(data, name):
            width = float(data[f"{name}_half_width"].max())
            detail = f"answer; ± {percent_text(width)} (90 %)"
        title = spelled_out(view.title(data[name]))
        yield Card(f"{title[0].upper()}{title[1:]}", least_to_most(values), detail)


def _model(data: xr.Dataset) -> str:
    name = str(data.attrs.get("model", "model"))
    return _MODELS.get(name, name.replace("_", " "))


def _factors(data: xr.Dataset) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first; ranges where they vary."""
    yield _MODELS["direct"]
    for at, label in enumerate(data.factor_label.values):
        ranges = []
        for name in reversed(SYMBOLS):
            values = data[f"answer_{name}_factor"].isel(factor=at).values
            ranges.append(f"{SYMBOLS[name]} × {least_to_most(values)}")
        error = data["answer_friction_factor_uncertainty"].isel(factor=at)
        same = all(text.endswith(f"× {significant(1.0)}") for text in ranges)
        factor = f"1 ± {percent_text(float(error.max()))}" if same else ", ".join(ranges)
        yield f"{label} ({factor})"


def _rests_on(data: xr.Dataset) -> Iterator[str]:
    """Yield the largest shares of the answers that rest on what was not measured well."""
    sampling = float(data["answer_friction_sampling_error"].max())
    has_intervals = math.isfinite(sampling)
    if has_intervals:
        yield f"sampling of the surface up to ± {percent_text(sampling)} of it (standard error)"
    else:
        yield "no interval: the surface is too short to tell whether it stands for the whole"
    steep = float(data["answer_steep_share"].max())
    if steep > WORTH_NAMING:
        yield f"up to {percent_text(steep)} of the friction on slopes above 1"
    if LINES_TO_SURFACE in data.factor_label.values:
        yield ISOTROPY_ASSUMED
    if has_intervals and not {"surface", "rubber"} & set(view.dimensions(data)):
        yield "most of an interval is common to all points: their differences are known better"
    if INTERFACE in data:
        term = data[INTERFACE]
        low, high = float(term.min()), float(term.max())
        yield f"{significant(low)} to {significant(high)} of the friction is the area term"
    if has_intervals:
        yield "intervals leave out errors of the master curve"


def study_table(data: xr.Dataset) -> Table:
    """Return area, friction and status of each prediction of a study, over what was varied."""
    estimated, names = is_estimated(data, "friction"), view.answers(data)
    names += [] if estimated else ["total_friction_from_dissipation"]
    names += [name for name in (HYSTERESIS, INTERFACE) if name in data]
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
    places = [*table.columns]
    places[table.keys - 1] = replace(places[table.keys - 1], marks=marks)
    return replace(table, columns=places)


def shift_sentence(data: xr.Dataset) -> str:
    """Return which temperatures lie beyond the shift; empty if none does."""
    if BEYOND_SHIFT not in data or not bool(data[BEYOND_SHIFT].any()):
        return ""
    flags = view.at_places(data, BEYOND_SHIFT)
    count = f"{int(flags.sum())} of {flags.size} predictions"
    return f"{count} lie beyond the temperatures of the shift of the rubber."


def study_failures(data: xr.Dataset) -> Iterator[Failure]:
    """Yield each prediction that is not `converged`."""
    for where, row in view.points(data):
        if (status := str(row[STATUS].values[()])) != CONVERGED:
            word = str(status_words(row).item())
            yield Failure(f"{where}: NOT converged: {status or NONE}", word)


_NAMED_FAILURES = 12  # failed predictions that have a finding each


def study_findings(data: xr.Dataset) -> Iterator[Finding]:
    """Yield predictions without a result, extrapolation of the rubber, and notes on surfaces."""
    failed = list(study_failures(data))
    yield from (Finding(Severity.ERROR, explained(each)) for each in failed[:_NAMED_FAILURES])
    if rest := len(failed[_NAMED_FAILURES:]):
        yield Finding(
            Severity.ERROR, f"{rest} more did not converge; see the table of predictions."
        )
    if beyond := study_sentence(data):
        share = float(data[FRICTION_OUTSIDE_BAND].max())
        text = f"{beyond} There the Prony series is an extrapolation."
        yield Finding(Severity.WARNING, text, share, topic=Topic.RUBBER)
    notes = [shift_sentence(data), *str(data.attrs.get("notes", "")).splitlines()]
    yield from (Finding(Severity.WARNING, text, topic=Topic.SURFACE) for text in notes if text)


def study_page(data: xr.Dataset) -> Page:
    """Return the page of a study: answer, predictions and curves, then the inputs."""
    labels = [axis.replace("_", " ") for axis in view.dimensions(data)]
    failed, count = len(list(study_failures(data))), data[STATUS].size
    counts = [
        Card("Predictions", str(count), " × ".join(labels)),
        Card("Not converged", str(failed), "see the table of predictions", bad=failed > 0),
    ]
    return view.page(
        data,
        (f"Study: {case_title(data.attrs)}", f"varied: {', '.join(labels)}"),
        study_findings(data),
        [*study_cards(data), *counts],
        [
            Section("predictions", "Predictions", [study_table(data)]),
            Section("curves", "Curves", [*map(image, study_pictures(data))]),
        ],
        study_lines(data),
    )
