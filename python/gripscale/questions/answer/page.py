"""The answer of a case: friction and contact area with their interval, and what they rest on.

A case that allows no good answer says so first. What may change a good one follows as warnings.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np
import xarray as xr

from gripscale.case import SHEAR_STRESS
from gripscale.chain.chain import Chain
from gripscale.conditions.area_term import DRY_ASSUMPTIONS, DRY_TREAD, STRESS_SCATTER
from gripscale.core.finding import FILLED, Finding
from gripscale.core.units import display_unit_of, in_mm
from gripscale.half_space.model import DirectContact
from gripscale.io.table import Column, Table, fixed, significant
from gripscale.questions.answer import reliance, variables
from gripscale.questions.answer.charts import named_traces, trace_charts
from gripscale.questions.answer.direct_contact import ISOTROPIC
from gripscale.questions.answer.estimate import LINES_TO_SURFACE
from gripscale.questions.answer.findings import MEASURED_FRICTION, measured_words, no_answer_notices
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.variables import HEADINGS, SYMBOLS, answer_number, has_answer
from gripscale.questions.chain.page import chain_section
from gripscale.questions.cut_off.curve import CONTINUED_TO
from gripscale.questions.cut_off.question import CutOff
from gripscale.questions.inputs.page import files_table, rubber_section, surface_section
from gripscale.questions.inputs.record import InputRecord, signed_percent
from gripscale.questions.view import load_in_words
from gripscale.report import elements
from gripscale.report.elements import Card, Facts, Page, Section, percent_text
from gripscale.report.equations import method_section
from gripscale.surface import SineStack
from gripscale.surface.direction import ERROR_OF_RIDGES
from gripscale.surface.random_phases import PHASES_OF
from gripscale.testers import TESTER, tester_reading

HYSTERESIS_ALONE = (
    "Hysteresis alone is a lower bound: far below the friction of a dry road, which interface = "
    '"dry" in [conditions] adds, and nearer to that of a lubricated one.'
)
_LOAD = {
    "nominal_pressure": "Nominal pressure",
    "nominal_speed": "Sliding speed",
    "footprint": "Footprint",
    "thickness": "Thickness of the rubber",
}
_WORDS = {"friction": "friction", "contact_fraction": "area"}
_PICTURE = (
    "The direct contact of the measured surface. Friction is made where pressure acts on flanks "
    "that rise in the sliding direction. The page holds the lowest and highest values of pieces of "
    "the surface, and every point where most of the friction is made."
)


def answer_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield the answer of a result of one load, then what it rests on; or why there is none."""
    both = list(variables.both_answers(data))
    statement = reliance.no_answer(data, FILLED if both else "")
    if not has_answer(data):
        yield f"Answer: {statement}"
        return
    lead = f"{statement} {'Otherwise' if both else 'It would be'} " if statement else ""
    if both:
        yield f"Answer: {lead}{_by_filler(data, both)}"
        yield from (f"  {line}" for line in basis_lines(data))
        return
    numbers = [
        f"{SYMBOLS[name]} = {answer_number(data, name)}" for name in reliance.estimated_names(data)
    ]
    if parts := friction_parts(data):
        numbers[0] += f": {parts}"
    elif reliance.is_moving(data):
        numbers[0] = f"hysteresis friction {numbers[0]}"
    rest = "" if reliance.is_moving(data) else "no friction at rest; "
    by = "" if reliance.is_measured(data) else " by the chain of waves"
    intervals = f" ({100.0 * LEVEL:.0f} % intervals)"
    if not answer_number(data, "contact_fraction").interval:
        intervals = f"{',' if by else ''} without an interval"
    yield f"Answer: {lead}{rest}{('; ' if parts else ', ').join(numbers)}{by}{intervals}"
    yield from (f"  {line}" for line in basis_lines(data))


def _by_filler(
    data: xr.Dataset, both: Sequence[tuple[str, Mapping[str, variables.AnswerNumber]]]
) -> str:
    """Return both numbers where it is not known whether the rubber is filled."""
    alone = reliance.is_moving(data) and not friction_parts(data)
    kinds = {"filled": "filled, as a typical tread", "unfilled": "unfilled"}
    texts = []
    for filler, numbers in both:
        words = [f"{SYMBOLS[name]} = {numbers[name]}" for name in reliance.estimated_names(data)]
        start = "hysteresis friction " if alone else ""
        texts.append(f"{kinds[filler]}: {start}{', '.join(words)}")
    return (
        "one question decides, whether the rubber is filled (carbon black, silica), as every tread "
        f"is. {'; '.join(texts)} ({100.0 * LEVEL:.0f} % intervals). State filled in [rubber]."
    )


def friction_parts(data: xr.Dataset) -> str:
    """Return what the friction of an answer with an area term is the sum of; else empty."""
    names = ("hysteresis_friction", "interface_friction")
    hysteresis, term = (answer_number(data, name).value for name in names)
    if not math.isfinite(term) or not reliance.is_moving(data):
        return ""
    return f"{significant(hysteresis)} of hysteresis and {significant(term)} of the area term"


def basis_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what an answer is for, how it was solved and corrected, and what its interval holds."""
    if not has_answer(data):
        return
    pressure, speed = load_in_words(data)
    motion = f"and {speed}" if reliance.is_moving(data) else "at rest"
    end = in_mm(float(data.get(CONTINUED_TO, data.cutoff_wavelength)), 3)
    more = ""
    if "thickness" in data:
        thickness = display_unit_of(data.attrs, "thickness").text(float(data.thickness))
        more = f", rubber {thickness} thick on a rigid base"
    more += ", for random phases" if data.attrs.get(PHASES_OF) == "random" else ""
    yield f"For {pressure} {motion}, roughness down to {end}{more}."
    if reliance.is_moving(data) and not friction_parts(data):
        yield HYSTERESIS_ALONE
    if reading := tester_reading(data.attrs.get(TESTER, ""), *answer_number(data, "friction")):
        yield f"{reading}."
    if data.attrs.get(SHEAR_STRESS) == DRY_TREAD.kind:
        yield DRY_ASSUMPTIONS
    if MEASURED_FRICTION in data:
        yield f"Measured: μ = {measured_words(data)}."
    if not reliance.is_measured(data):
        yield "Solved on sine waves by the chain of waves; no measured surface judges it."
        return
    yield _corrections(data)
    if "water_load_share" in data:
        wet = float(data.total_friction_from_dissipation / data.dry_friction)
        ratio = f"friction wet over dry ×{wet:.2f}, " if math.isfinite(wet) else ""
        yield f"With trapped water: {ratio}load on water {float(data.water_load_share):.1%}."
    yield from (f"{line[0].upper()}{line[1:]}." for line in _in_interval(data))


def answer_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield friction and contact area with their intervals."""
    if not has_answer(data):
        return
    bad = bool(reliance.no_answer(data))
    source = "not to be relied on" if bad else "answer"
    if not reliance.is_measured(data):
        source = "by the chain of waves"
    for name in reliance.estimated_names(data):
        title, number = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]}", answer_number(data, name)
        parts = f"; {friction_parts(data) or 'hysteresis alone'}" if name == "friction" else ""
        detail = f"{source}{parts}"
        interval = f"{number.interval} ({100.0 * LEVEL:.0f} %)" if number.interval else ""
        yield Card(title, significant(number.value), detail, bad, interval)
    if MEASURED_FRICTION in data:
        value = significant(float(data[MEASURED_FRICTION]))
        yield Card("Measured friction μ", value, measured_words(data))


def _corrections(data: xr.Dataset) -> str:
    """Return what the direct contact alone says, and each factor on it."""
    names, labels = reliance.estimated_names(data), data.factor_label.values
    factors = {name: data[f"answer_{name}_factor"].values for name in names}
    alone = {}
    for name in names:
        corrected = answer_number(data, variables.of_hysteresis(data, name)).value
        alone["μ" if name == "friction" else "area"] = corrected / np.nanprod(factors[name])
    solved = ", ".join(f"{name} {significant(value)}" for name, value in alone.items())
    steps = []
    for at, label in enumerate(labels):
        values = {_WORDS[name]: float(factors[name][at]) for name in names}
        if not all(map(math.isfinite, values.values())):
            continue
        text = ", ".join(f"{word} {signed_percent(value - 1.0)}" for word, value in values.items())
        if not np.allclose([*values.values()], 1.0):  # others only widen the interval
            steps.append(f"{label}: {text}")
    where = "your profiles" if LINES_TO_SURFACE in labels else "the measured surface"
    where = "lines of your spectrum with random phases" if PHASES_OF in data.attrs else where
    then = f", then corrected: {'; '.join(steps)}" if steps else ""
    return f"Solved on {where} at small strain ({solved}){then}."


def _in_interval(data: xr.Dataset) -> Iterator[str]:
    """Yield the errors in the interval, and what is assumed, left out or not in the interval."""
    names, labels = reliance.estimated_names(data), data.factor_label.values
    name = names[0]
    sampling = [float(data[f"answer_{each}_sampling_error"]) for each in names]
    sizes = {"sampling of the surface": sampling} | {
        str(label): [float(data[f"answer_{each}_factor_uncertainty"][at]) for each in names]
        for at, label in enumerate(labels)
    }
    parts = [
        f"{label} {' and '.join(percent_text(size) for size in errors)}"
        for label, errors in sizes.items()
        if max(errors) > reliance.WORTH_NAMING
    ]
    if data.attrs.get(SHEAR_STRESS) == DRY_TREAD.kind:
        parts.append(f"shear stress between treads {percent_text(STRESS_SCATTER)}")
    if variables.ERROR_LEFT in data:
        share = percent_text(1.0 - float(data[variables.ERROR_LEFT]))
        yield (
            f"the area term was fitted to measured friction: {share} of the variance of the "
            "friction cancels here (all of it at the measured points, nothing on another surface "
            "or rubber)"
        )
    if parts:
        of = " and ".join(_WORDS[each] for each in names)
        yield f"in the interval, standard errors of {of}: {'; '.join(parts)}"
    below = data.get(variables.FRICTION_BELOW_MEASUREMENT)
    if below is not None and not below.ndim and float(below) > reliance.WORTH_NAMING:
        limit = in_mm(float(data.resolution_limit), 3)
        yield (
            f"{percent_text(float(below))} of the friction is made in waves shorter than {limit}, "
            "which were not measured"
        )
    missing = labels[data[f"answer_{name}_factor"].isnull().values]
    if missing.size:
        yield f"not included: {', '.join(missing)}"
    unknown = []
    if "part_label" not in data and answer_number(data, name).interval:
        unknown.append("errors of the inputs (`gripscale uncertainty`)")
    if ISOTROPIC in data.attrs:
        yield str(data.attrs[ISOTROPIC]).rstrip(".")
    elif LINES_TO_SURFACE in labels:
        ridges = f"with ridges 3:1 the area changes up to {ERROR_OF_RIDGES:.1f} times"
        unknown.append(f"lay: {ridges}")
    if unknown:
        yield f"not in the interval: {', and '.join(unknown)}"


def answer_page(
    data: xr.Dataset,
    record: InputRecord,
    findings: Sequence[Finding],
    curve: xr.Dataset | None = None,
    chain: xr.Dataset | None = None,
) -> Page:
    """Return the page of an answer: its numbers, the contact, and the inputs with their origin.

    `curve` and `chain` are the contact against the cut-off and the chain of waves of the same case.
    """
    waves = None
    if chain is not None and "sines_wavelength" in chain:
        waves = SineStack(chain["sines_wavelength"].values, chain["sines_amplitude"].values)
    curves = [] if curve is None else CutOff(curve).elements()
    chapters = [Section("cut-off", "Against the cut-off", curves)]
    chapters += [] if chain is None else [chain_section(chain, data)]
    traces = named_traces(data, record.data)
    charts = [chart for name, trace in traces for chart in trace_charts(trace, name)]
    contact: list[elements.Element] = []
    if charts:
        contact = [elements.Text(_PICTURE), charts[0], *slopes_table(data), *charts[1:]]
    files = [files_table(record)] if record.has("file_name") else []
    load = [
        (title, display_unit_of(data.attrs, name.removeprefix("nominal_")).text(float(data[name])))
        for name, title in _LOAD.items()
        if name in data
    ]
    moving = chain if reliance.is_moving(data) else None
    method = [*(DirectContact if reliance.is_measured(data) else Chain).method]
    method += ["surface"] if LINES_TO_SURFACE in data.factor_label.values else []
    method += ["interface"] if friction_parts(data) and reliance.is_measured(data) else []
    return Page.of(
        f"Contact and friction: {elements.case_title(data.attrs)}",
        next(iter(basis_lines(data)), ""),
        [*no_answer_notices(data), *findings],
        answer_cards(data),
        [
            Section("contact", "Rubber on the surface", contact),
            Section("inputs", "Inputs and their origin", [Facts("Load", load), *files]),
            Section("surface", "Surface", surface_section(record, waves)),
            Section("rubber", "Rubber", rubber_section(record, moving)),
            *chapters,
            method_section(method, () if chain is None else Chain.method),
            elements.rerun_section(data.attrs),
        ],
        basis_lines(data),
    )


def slopes_table(direct: xr.Dataset) -> Iterator[Table]:
    """Yield which slopes of the surface carry load and make friction, where that is known."""
    if "answer_friction_by_slope" not in direct:
        return
    ends = direct.slope.values.tolist()
    names = [f"{low:g} to {high:g}" for low, high in pairwise(ends)] + [f"above {ends[-1]:g}"]
    columns = [
        Column(name, shares.values, name, "%", 0.01, format=fixed(1))
        for name in ("friction", "load", "contact")
        if (shares := direct[f"answer_{name}_by_slope"]).notnull().all()
    ]
    caption = "Shares by slope of the surface, direct contact"
    yield Table("slopes", [Column("slope", names, "slope |dh/dx|", words=False), *columns], caption)
