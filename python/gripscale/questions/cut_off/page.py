"""Contact and friction against the cut-off, in sentences and tables."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from gripscale.core.finding import Finding, Severity
from gripscale.core.units import MILLI, display_unit_of, in_mm
from gripscale.io.table import Column, Table, change, on_page, significant
from gripscale.model import STATUS
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.chain.view import CONVERGED_WORD, HEADINGS, SYMBOLS
from gripscale.questions.cut_off.charts import cut_off_charts
from gripscale.questions.cut_off.curve import (
    AREA,
    FRICTION,
    SLOPE_IN_CONTACT,
    at_cut_off,
)
from gripscale.report.again import case_name, rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text
from gripscale.report.failures import Failure, explained

NAMES = {"friction": FRICTION, "contact_fraction": AREA}
"""Names of the curves by those of the numbers of an answer."""


def cut_off_parts(data: xr.Dataset) -> Iterator[Table]:
    """Yield the rules of cut-off and the curve; nothing without one."""
    if not cut_off_failures(data):
        yield rules_table(data)
        yield curve_table(data)


def cut_off_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield friction and contact at the last cut-off, at the measured one, and the evidence."""
    if cut_off_failures(data):
        yield f"Answer: none. {data[STATUS].item()}"
        return
    end = float(data.cut_off[-1])
    below = not bool(data.curve_measured[-1])
    numbers = ", ".join(
        f"{SYMBOLS[name]} = {significant(float(data[curve][-1]))}"
        + (f" ({_range(data, curve)})" if below else "")
        for name, curve in _drawn(data)
    )
    level = f" ({100.0 * LEVEL:.0f} % bands)" if below else ""
    yield f"Answer: {numbers} with roughness down to {in_mm(end, 3)}{level}"
    yield from (f"  {line}" for line in cut_off_basis(data))


def cut_off_basis(data: xr.Dataset) -> Iterator[str]:
    """Yield the load, the numbers of the measured roughness, and how it is continued."""
    resolved = float(data.resolved)
    load = [
        display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"]))
        for name in ("pressure", "speed")
    ]
    yield f"for {' and '.join(load)}; direct contact of the measured surface, without factors"
    if bool(data.curve_measured[-1]):
        return
    measured = ", ".join(
        f"{SYMBOLS[name]} = {significant(at_cut_off(data, curve, resolved))}"
        for name, curve in _drawn(data)
    )
    yield f"measured down to {in_mm(resolved, 3)}: {measured}"
    yield f"below it continued {_source(data)}"


def _drawn(data: xr.Dataset) -> Iterator[tuple[str, str]]:
    """Yield the numbers of the answer with their curves; no friction at rest."""
    for name, curve in NAMES.items():
        if name != "friction" or float(data.nominal_speed) > 0.0:
            yield name, curve


def _range(data: xr.Dataset, curve: str) -> str:
    low, high = (float(data[f"{curve}_{end}"][-1]) for end in ("lower", "upper"))
    return f"{significant(low)} to {significant(high)}"


def _source(data: xr.Dataset) -> str:
    """Return where the continued roughness comes from, and how well it did."""
    if "slope_ratio" not in data:
        overlap = float(data.get("overlap", math.nan))
        compared = (
            f"; the faces that touch are {significant(overlap, 2)} times as steep where both are "
            "measured"
            if math.isfinite(overlap)
            else "; no wavelength is measured by both"
        )
        return f"with the slopes of the finer measurement{compared}"
    text = f"with slopes {significant(float(data.slope_ratio), 3)} times as steep each octave"
    if "withheld_friction_error" not in data:
        return f"{text}, as stated or as the octaves above"
    errors = ", ".join(
        f"{words} {change(float(data[f'withheld_{name}_error']))}"
        for name, words in (("friction", "friction"), ("contact_fraction", "contact area"))
    )
    return f"{text}; the last measured octave, withheld and continued the same way: {errors}"


def rules_table(data: xr.Dataset) -> Table:
    """Return the cut-off of each rule, with friction and contact there."""
    numbers = [
        Column(f"rule_{name}", data[f"rule_{name}"].values, SYMBOLS[name])
        for name, _ in _drawn(data)
    ]
    columns = [
        Column("rule", data.rule.values.tolist(), "rule"),
        Column("rule_cut_off", data.rule_cut_off.values, "cut-off", "mm", MILLI),
        *numbers,
    ]
    beyond = bool(np.isnan(data.rule_contact_fraction.values).any())
    notes = ["Without numbers: beyond the curve."] if beyond else []
    return Table("rules", columns, "Rules of cut-off", notes, keys=1)


def curve_table(data: xr.Dataset) -> Table:
    """Return friction and contact by octave."""
    columns = [Column("cut_off", data.cut_off.values, "cut-off", "mm", MILLI)]
    kinds = ["measured" if flag else "continued" for flag in data.curve_measured.values]
    columns.append(Column("roughness", kinds))
    for name, curve in _drawn(data):
        columns.append(Column(name, data[curve].values, SYMBOLS[name]))
        ends = np.stack([data[f"{curve}_{end}"].values for end in ("lower", "upper")], axis=-1)
        ends[data.curve_measured.values.astype(bool)] = np.nan
        columns.append(Column(f"{name}_band", ends, f"{100.0 * LEVEL:.0f} % band"))
    columns.append(Column("slope", data[SLOPE_IN_CONTACT].values, "slope in contact"))
    return Table("curve", columns, "By octave of the cut-off", keys=1)


def cut_off_cards(data: xr.Dataset) -> Iterator[Card]:
    """Yield friction and contact at the last cut-off."""
    if cut_off_failures(data):
        return
    end = in_mm(float(data.cut_off[-1]), 3)
    for name, curve in _drawn(data):
        value = on_page(significant(float(data[curve][-1])))
        yield Card(
            HEADINGS[name].capitalize(), value, f"{_range(data, curve)}, roughness down to {end}"
        )


def cut_off_failures(data: xr.Dataset) -> list[Failure]:
    """Return why there is no curve; empty if there is one."""
    sentence = str(data[STATUS].item())
    if sentence == CONVERGED_WORD:
        return []
    return [Failure(sentence, str(data[f"{STATUS}_word"].item()))]


def cut_off_elements(data: xr.Dataset | None) -> list[Element]:
    """Return curves, rules and tables of a result against the cut-off; nothing without one."""
    if data is None or cut_off_failures(data):
        return []
    return [*map(Text, cut_off_basis(data)), *cut_off_charts(data), *cut_off_parts(data)]


def cut_off_page(data: xr.Dataset, findings: Sequence[Finding]) -> Page:
    """Return the page of contact and friction against the cut-off."""
    case = case_name(data.attrs) or "case.toml"
    errors = [Finding(Severity.ERROR, explained(failure)) for failure in cut_off_failures(data)]
    sections = [
        Section("cut-off", "Against the cut-off", cut_off_elements(data)),
        rerun_section(data.attrs),
    ]
    return Page(
        f"Contact and friction of {case} against the cut-off",
        next(cut_off_lines(data)),
        [*errors, *findings],
        list(cut_off_cards(data)),
        [section for section in sections if section.elements],
    )
