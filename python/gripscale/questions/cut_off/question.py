"""What lies below the measurement: friction and contact area against the cut-off.

result = gs.cut_off(case, down_to="10 um")
result.data.curve_friction_from_dissipation
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Picture, Sheet, image
from gripscale.core import Finding, Severity
from gripscale.core.units import MILLI, display_unit_of, in_mm, si_value
from gripscale.experiment.design import CONVERGED
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, change, on_page, significant
from gripscale.model import STATUS, OnProgress
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.variables import HEADINGS, SYMBOLS, AnswerNumber
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.cut_off.curve import (
    AREA,
    FRICTION,
    SLOPE_IN_CONTACT,
    at_cut_off,
    continuation_doubts,
    cut_off_curve,
    refusals,
)
from gripscale.questions.inputs import record
from gripscale.questions.result import Result
from gripscale.report.again import case_title, rerun_section
from gripscale.report.elements import Card, Element, Page, Section, Text
from gripscale.report.failures import explained, failures_in

_LEVEL = f"{100.0 * LEVEL:.0f} %"


class CutOff(Result):
    """Friction and contact area of a case against the cut-off."""

    kind = "cut_off"

    @property
    def lines(self) -> Sequence[str]:
        data = self.data
        if self.failure:
            return [f"Answer: none. {self.failure}"]
        numbers = [f"{SYMBOLS[name]} = {self._last(curve)}" for name, curve in self._curves]
        level = "" if bool(data.curve_measured[-1]) else f" ({_LEVEL} bands)"
        if any(refusals(data)):
            level = ", where the measurement ends: it foretells no octave"
        lead = f"Answer: {', '.join(numbers)} with {self._down_to}{level}"
        return [lead, *(f"  {line}" for line in self.basis)]

    @property
    def basis(self) -> Sequence[str]:
        """The load, the numbers of the measured roughness, and how it is continued."""
        data, resolved = self.data, float(self.data.resolved)
        load = " and ".join(
            display_unit_of(data.attrs, name).text(float(data[f"nominal_{name}"]))
            for name in ("pressure", "speed")
        )
        lead = f"for {load}; direct contact of the measured surface, without factors"
        if bool(data.curve_measured[-1]):
            return [lead]
        measured = ", ".join(
            f"{SYMBOLS[name]} = {significant(at_cut_off(data, curve, resolved))}"
            for name, curve in self._curves
        )
        source = f"below it continued {_source(data)}"
        return [lead, f"measured down to {in_mm(resolved, 3)}: {measured}", source]

    @property
    def failure(self) -> str:
        sentence = str(self.data[STATUS].item())
        return "" if sentence == CONVERGED or "cut_off" in self.data.dims else sentence

    @property
    def findings(self) -> Sequence[Finding]:
        doubts = () if self.failure else continuation_doubts(self.data)
        return (*doubts, *super().findings)

    def parts(self) -> Iterator[str | Table]:
        if not self.failure:
            yield self.rules_table()
            yield self.table()

    def rules_table(self) -> Table:
        """Return the cut-off of each rule, with friction and contact there."""
        data = self.data
        columns = [
            Column("rule", data.rule.values.tolist(), "rule"),
            Column("rule_cut_off", data.rule_cut_off.values, "cut-off", "mm", MILLI),
        ]
        for name, _ in self._curves:
            columns.append(Column(f"rule_{name}", data[f"rule_{name}"].values, SYMBOLS[name]))
        beyond = bool(np.isnan(data.rule_contact_fraction.values).any())
        notes = ["Without numbers: beyond the curve."] if beyond else []
        return Table("rules", columns, "Rules of cut-off", notes, keys=1)

    def table(self) -> Table:
        data, measured = self.data, self.data.curve_measured.values.astype(bool)
        columns = [
            Column("cut_off", data.cut_off.values, "cut-off", "mm", MILLI),
            Column("roughness", ["measured" if flag else "continued" for flag in measured]),
        ]
        for name, curve in self._curves:
            columns.append(Column(name, data[curve].values, SYMBOLS[name]))
            ends = np.stack([data[f"{curve}_{end}"].values for end in ("lower", "upper")], axis=-1)
            ends[measured] = np.nan
            columns.append(Column(f"{name}_band", ends, f"{_LEVEL} band"))
        columns.append(Column("slope", data[SLOPE_IN_CONTACT].values, "slope in contact"))
        return Table("curve", columns, "By octave of the cut-off", keys=1)

    def figures(self) -> Iterator[tuple[str, Sheet]]:
        if not self.failure:
            yield "cut_off", cut_off_sheet(self.data)

    def elements(self) -> list[Element]:
        """Return curves, rules and tables for a page; nothing without a curve."""
        if self.failure:
            return []
        curves = Picture(
            "cut_off",
            cut_off_sheet(self.data).on_paper(),
            "Friction, area and the rms slope where the surface touches against the cut-off: "
            "measured roughness solid, continued dotted, with its 90 % band. Upright lines are "
            "rules of cut-off; small strain ends near a slope of 1.",
            "Three panels of curves against the shortest wavelength of the surface.",
        )
        return [*map(Text, self.basis), image(curves), self.rules_table(), self.table()]

    def page_content(self) -> Page:
        case = case_title(self.data.attrs)
        errors: list[Finding] = []
        cards: list[Card] = []
        if self.failure:
            errors = [Finding(Severity.ERROR, explained(failures_in(self.data)[0]))]
        else:
            for name, curve in self._curves:
                number = self._last(curve)
                value, label = on_page(significant(number.value)), HEADINGS[name].capitalize()
                cards.append(Card(label, value, self._down_to, interval=number.interval))
        title = f"Contact and friction of {case} against the cut-off"
        curves = Section("cut-off", "Against the cut-off", self.elements())
        sections = [curves, rerun_section(self.data.attrs)]
        return Page.of(title, self.lines[0], [*errors, *self.findings], cards, sections)

    @property
    def _down_to(self) -> str:
        """The last cut-off in words."""
        return f"roughness down to {in_mm(float(self.data.cut_off[-1]), 3)}"

    @property
    def _curves(self) -> list[tuple[str, str]]:
        """Names of the numbers of an answer and of their curves; no friction at rest."""
        area = ("contact_fraction", AREA)
        return [("friction", FRICTION), area] if float(self.data.nominal_speed) > 0.0 else [area]

    def _last(self, curve: str) -> AnswerNumber:
        """Return a number at the last cut-off, with its band where this is continued."""
        last = self.data[[curve, f"{curve}_lower", f"{curve}_upper"]].isel(cut_off=-1)
        value, *ends = (float(number) for number in last.values())
        measured = bool(self.data.curve_measured[-1])
        return AnswerNumber(value, *((math.nan, math.nan) if measured else ends))


def _source(data: xr.Dataset) -> str:
    """Return where the continued roughness comes from, and how well it did."""
    if "slope_ratio" not in data:
        overlap = float(data.get("overlap", math.nan))
        compared = "no wavelength is measured by both"
        if math.isfinite(overlap):
            times = f"{significant(overlap, 2)} times as steep"
            compared = f"the faces that touch are {times} where both are measured"
        return f"with the slopes of the finer measurement; {compared}"
    ends = [data.get("withheld_slope_ratio", data.slope_ratio), data.slope_ratio]
    first, end = (significant(float(ratio), 3) for ratio in ends)
    text = f"with slopes {end} times those of the octave above"
    if first != end:
        text += f" in the last octave, {first} times in the last measured one"
    if "withheld_friction_error" not in data:
        return f"{text}, as stated or as usual"
    errors = ", ".join(
        f"{words} {change(float(data[f'withheld_{name}_error']))}"
        for name, words in (("friction", "friction"), ("contact_fraction", "contact area"))
    )
    return f"{text}; the last measured octave, withheld and continued the same way: {errors}"


def cut_off(
    case: Case,
    *,
    down_to: float | str | None = None,
    hurst: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
    on_step: OnProgress = None,
) -> CutOff:
    """Return contact and friction of a case against the cut-off.

    Over `cut_off` the result has the curves of `gripscale.continuation.contact_by_cut_off` with the
    prefix `curve_`; over `rule` the cut-off that each rule gives, with friction and contact there.
    The totals are those of the last cut-off; not numbers where the faces foretell no octave below
    the measurement, at which the curves then end (`findings`). Raises `InputError` or `FileError`
    for what cannot be used; if nothing was measured.

        >>> gs.cut_off(case, down_to="1 mm").to_dataset().rule.values.tolist()
        ['shortest wavelength measured', 'cut-off of the case']

    Parameters
    ----------
    case : Case
        Its surface must be measured profiles.
    down_to : float or str, optional
        Last cut-off [m], or a text such as "10 um"; that of the case by default, else 10 um.
    hurst : float, optional
        Hurst exponent of the continued roughness [-], in place of what the case states.
    folder : path, optional
        Keeps the solution as soon as it is there: what was interrupted resumes.
    workers, on_task, on_step
        As for `gripscale.experiment.Bench`; a step is the `RoughContact` of a line at a cut-off.
    """
    end = si_value("down_to", down_to, "m")
    with bench_in(folder, workers, None, on_task, on_step) as bench:
        data = cut_off_curve(case, case.load, bench, down_to=end, hurst=hurst)
    return cut_off_result(data, case)


def cut_off_result(data: xr.Dataset, case: Case) -> CutOff:
    """Return the curves of a case as the result of the question."""
    data = data.assign_attrs(case.attributes, title="Contact and friction against the cut-off")
    return CutOff(data, record.inputs(case))
