"""The answer of a case: friction and contact area with their interval, and what they rest on.

A case that allows no good answer says so first. What may change a good one follows as warnings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from gripscale.core.finding import Finding
from gripscale.core.units import display_unit_of, in_mm
from gripscale.io.table import Column, Table, fixed, significant
from gripscale.questions.answer import reliance
from gripscale.questions.answer.best_estimate import ISOTROPY_ASSUMED, LINES_TO_SURFACE
from gripscale.questions.answer.charts import named_traces, trace_charts
from gripscale.questions.answer.direct_contact import ISOTROPIC
from gripscale.questions.answer.findings import no_answer_notices
from gripscale.questions.answer.intervals import LEVEL, interval_ends
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.inputs.page import rubber_section, surface_section
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.uncertainty.sampled_answer import FRICTION_BELOW_MEASUREMENT
from gripscale.questions.words import HEADINGS, SYMBOLS
from gripscale.report.again import case_name, rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text, percent_text
from gripscale.report.equations import method_section
from gripscale.testers import TESTER, tester_reading

_PICTURE = (
    "The direct contact of the measured surface. Friction is made where pressure acts on flanks "
    "that rise in the sliding direction. The page holds the lowest and highest values of pieces of "
    "the surface, and every point where most of the friction is made."
)


def answer_lines(data: xr.Dataset | None) -> Iterator[str]:
    """Yield the answer of a result of one load, then what it rests on; or why there is none."""
    statement = reliance.no_answer(data)
    if data is None or not reliance.has_answer(data):
        yield f"Answer: {statement}"
        return
    names = reliance.estimated_names(data)
    texts = (f"{SYMBOLS[name]} = {number_and_interval(data, name)}" for name in names)
    numbers = ", ".join(texts)
    lead = f"{statement} It would be " if statement else ""
    rest = "" if reliance.is_moving(data) else "no friction at rest; "
    level = " without an interval"
    if math.isfinite(float(data.best_contact_fraction_half_width)):
        level = f" ({100.0 * LEVEL:.0f} % intervals)"
    yield f"Answer: {lead}{rest}{numbers}{level}"
    yield from (f"  {line}" for line in basis_lines(data))


def basis_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what a best estimate is for, what it is made of, and what it rests on."""
    if not reliance.has_answer(data):
        return
    names = reliance.estimated_names(data)
    pressure, speed = (
        display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"]))
        for name in ("pressure", "speed")
    )
    motion = f"and {speed}" if reliance.is_moving(data) else "at rest, where there is no friction"
    end = in_mm(float(data.get(CONTINUED_TO, data.cutoff_wavelength)), 3)
    thick = ""
    if "thickness" in data:
        thickness = display_unit_of(data.attrs, "thickness").text(float(data.thickness))
        thick = f", rubber {thickness} thick on a rigid base"
    yield f"for {pressure} {motion}, roughness down to {end}{thick}"
    friction, ends = (
        reliance.answer_number(data, "friction"),
        reliance.answer_interval(data, "friction"),
    )
    if reading := tester_reading(data.attrs.get(TESTER, ""), friction, *ends):
        yield reading
    yield f"from {' × '.join(_factors(data, names))}"
    rests = list(_rests_on(data, names[0]))
    if rests:
        yield "; ".join(rests)


def answer_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield friction and contact area with their intervals."""
    if not reliance.has_answer(data):
        return
    source = "not to be relied on" if reliance.no_answer(data) else "best estimate"
    for name in reliance.estimated_names(data):
        title = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}"
        ends = interval_text(data, name)
        detail = f"{source}; {ends} ({100.0 * LEVEL:.0f} %)" if ends else source
        value = significant(float(data[f"best_{name}"]))
        yield Card(title, value, detail, bad=bool(reliance.no_answer(data)))


def number_and_interval(data: xr.Dataset, name: str) -> str:
    """Return a best estimate and its interval, such as `0.19 (0.15 to 0.23)`."""
    ends = interval_text(data, name)
    return f"{significant(float(data[f'best_{name}']))}{f' ({ends})' if ends else ''}"


def interval_text(data: xr.Dataset, name: str) -> str:
    """Return the interval of a best estimate, such as `0.15 to 0.23`; empty if there is none."""
    ends = interval_ends(data[f"best_{name}"], data[f"best_{name}_half_width"])
    low, high = map(float, ends)
    return f"{significant(low)} to {significant(high)}" if math.isfinite(low) else ""


def _factors(data: xr.Dataset, names: tuple[str, ...]) -> Iterator[str]:
    """Yield the direct contact and each factor on it, friction first."""
    measured = reliance.is_measured(data)
    yield "the direct contact of the measured surface" if measured else "the chain of waves"
    for at, label in enumerate(data.factor_label.values):
        values = {name: float(data[f"best_{name}_factor"][at]) for name in names}
        if not all(map(math.isfinite, values.values())):
            continue
        sigma = float(data[f"best_{names[0]}_factor_uncertainty"][at])
        numbers = ", ".join(f"{SYMBOLS[name]} × {significant(v)}" for name, v in values.items())
        assumed = np.allclose(list(values.values()), 1.0)
        yield f"{label} ({f'1 ± {percent_text(sigma)}' if assumed else numbers})"


def _rests_on(data: xr.Dataset, name: str) -> Iterator[str]:
    """Yield the error of the sampling, what is assumed or left out, and the area term."""
    sampling = float(data[f"best_{name}_sampling_error"])
    if math.isfinite(sampling):
        yield f"sampling of the road ± {percent_text(sampling)} (standard error)"
    labels = data.factor_label.values
    if LINES_TO_SURFACE in labels:
        isotropic = str(data.attrs.get(ISOTROPIC, ISOTROPY_ASSUMED))
        yield f"{isotropic[0].lower()}{isotropic[1:].rstrip('.')}"
    below = data.get(FRICTION_BELOW_MEASUREMENT)
    if below is not None and not below.ndim and float(below) > reliance.WORTH_NAMING:
        limit = in_mm(float(data.resolution_limit), 3)
        yield (
            f"{percent_text(float(below))} of the friction in waves shorter than {limit}, which "
            "were not measured"
        )
    missing = [
        str(n) for n, v in zip(labels, data[f"best_{name}_factor"], strict=True) if v.isnull()
    ]
    if missing:
        yield f"not included: {', '.join(missing)}"
    if "part_label" not in data and math.isfinite(float(data[f"best_{name}_half_width"])):
        yield "errors of the inputs are not in the interval (`gripscale sensitivity` lists them)"
    term = reliance.answer_number(data, "adhesive_friction")
    if math.isfinite(term):
        both = significant(reliance.answer_number(data, "friction") + term)
        yield f"an area term of {significant(term)} comes on top: μ = {both} with it"


def answer_page(data: xr.Dataset, record: InputRecord, findings: Sequence[Finding]) -> Page:
    """Return the page of an answer: its numbers, the contact, and the inputs with their origin."""
    solved = reliance.is_solved(data)
    contact = contact_elements(data, record) if solved else []
    return Page.of(
        f"Contact and friction: {case_name(data.attrs) or 'a case'}",
        next(iter(basis_lines(data)), ""),
        [*no_answer_notices(data if solved else None), *findings],
        answer_cards(data) if solved else (),
        [
            Section("contact", "Rubber on the surface", contact),
            Section("surface", "Surface", surface_section(record)),
            Section("rubber", "Rubber", rubber_section(record)),
            method_section(),
            rerun_section(data.attrs),
        ],
        basis_lines(data),
    )


def contact_elements(direct: xr.Dataset, record: InputRecord) -> list[Element]:
    """Return the direct contact of the measured surface as pictures and by slope."""
    traces = named_traces(direct, record.data)
    charts = [chart for name, trace in traces for chart in trace_charts(trace, name)]
    if not charts:
        return []
    first, *others = charts
    return [Text(_PICTURE), first, *slopes_table(direct), *others]


def slopes_table(direct: xr.Dataset) -> Iterator[Table]:
    """Yield which slopes of the surface carry load and make friction, where that is known."""
    if "best_friction_by_slope" not in direct:
        return
    ends = direct.slope.values.tolist()
    names = [f"{low:g} to {high:g}" for low, high in pairwise(ends)] + [f"above {ends[-1]:g}"]
    columns = [
        Column(name, direct[f"best_{name}_by_slope"].values, heading, "%", 0.01, format=fixed(1))
        for name, heading in (("friction", "friction"), ("load", "load"), ("contact", "contact"))
        if direct[f"best_{name}_by_slope"].notnull().all()
    ]
    caption = "Shares by slope of the surface, direct contact"
    yield Table("slopes", [Column("slope", names, "slope |dh/dx|", words=False), *columns], caption)
